rule(r1, standard, [lightRed, redLight], [], [must-stop]).
