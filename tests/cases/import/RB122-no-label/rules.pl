rule(r1, standard, [a], [], [stop]).
rule(r2, standard, [a], [], [must-stop, 'must-']).
