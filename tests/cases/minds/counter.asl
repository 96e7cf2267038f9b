n(0).
!go.
+!go : n(N) & N < 3 <- M = N + 1; -+n(M); wait; !go.
+!go : n(3) & not car(0,1) & not car(0,2) <- -+n(0); forward(1); !go.
+!go <- wait; !go.
