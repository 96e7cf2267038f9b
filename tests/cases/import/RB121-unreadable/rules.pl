rule(r1, standard, [Light], [], [must-stop]).
rule(r2, standard, [a, [], [must-stop]).
rule(r3, standard, [a], [], [must-stop])
rule(r4, standard, [a], [], [must-stop]).
rule(r5, standard, [a], [], [must-stop]) :- asserted(a).
rule(r6, standard, a, [], [must-stop]).
rule(r7, standard, ['\q'], [], [must-stop]).
rule(r8, standard, [''], [], [must-stop]).
rule(r9, standard, [[a]], [], [must-stop]).
rule(r10, standard, [3], [], [must-stop]).
rule(r11, standard, ['never closed], [], [must-stop]).
rule(r12, standard, [a], [], [must-stop]
