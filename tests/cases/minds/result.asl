!go.
+!go <- !choose(N); !move(N); !go.
+!choose(0) : car(0,1).
+!choose(M) : car(0,2) <- M = 1.
+!choose(2).
+!move(0) <- wait.
+!move(N) <- forward(N).
