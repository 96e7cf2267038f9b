rule(r1, standard, [lightRed], [], [must-stop]).
