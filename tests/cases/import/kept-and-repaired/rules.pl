% Comments, a header, code that is no rule, odd hyphens: everything that is taken all the same.
:- module(rules, [rule/5]).
/* rule(commented, standard, [], [], [must-not_be_read]). */
rule(r1, standard, [lightRed, 'Odd word!', roundabouts-mini], [setOff], [must-stop, should-(look-right), -(must, wait)]).
rule(r1, standard, [lightRed, lightRed], [], [must–stop,   % a dash that is no hyphen
    'should-beep', must-road_surfaces-avoid_non]).
rule('Rule 2', emergency, [not, 'it''s'], [], ['MAY'-stop]).
rule(r3, standard, [], [], []).
rule(r4, standard, [lightRed], [], [greenFilter], [overtake], [must-stop]).
getRecommended(C, B, I, A) :- findall(X, rule(X, C, _, _, _), A).
