!go.
+!go <- ?pace(N); !move(N); !go.
+?pace(0) : car(0,1).
+?pace(1) : car(0,2) | light(_,_,red).
+?pace(2).
+!move(0) <- wait.
+!move(N) <- forward(N).
