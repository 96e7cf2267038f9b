!go.
+!go <- !step; !go.
+!step : light(_,_,green) & .intend(ease) <- .drop_intention(ease); wait.
+!step : light(_,_,red) & not .intend(ease) <- !!ease; wait.
+!step : car(0,1) <- .drop_desire(ease); wait.
+!step : not car(0,2) <- forward(1).
+!step <- wait.
+!ease <- wait; wait; !ease.
-!ease <- !ease.
