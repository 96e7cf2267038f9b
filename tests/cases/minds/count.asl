near(A) :- car(0,A) & A > 0.
!go.
+!go : .count(near(_), N) & N > 0 & .member(N, [1,2]) <- wait; !go.
+!go : not .member(1,[2,3]) & light(_,_,C) & C \== red <- forward(1); !go.
+!go <- wait; !go.
