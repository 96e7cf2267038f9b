!go.
+!go : speed(S) & limit(L) <- if (S < L & not car(0,1) & not car(0,2)) { X = S + 1; !move(X) } else { if (car(0,1)) { wait } else { +near; wait; -near } }; !go.
+!move(N) : N <= 2 <- forward(N).
+!move(_) <- wait.
