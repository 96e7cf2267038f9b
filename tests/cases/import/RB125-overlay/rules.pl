rule(r1, standard, [lightRed, night], [], [must-stop]).
