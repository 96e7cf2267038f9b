!top.
+!top <- !mid; !top.
+!mid <- !low; wait.
+!low : car(0,1) <- .fail.
+!low : car(0,2) <- ?missing(X); wait.
+!low <- forward(1).
-!mid : light(_,_,red) <- wait.
-!mid[error(ia_failed)] <- wait; wait.
-!low[error(E)] : speed(0) & car(0,2) <- +tried; wait; -tried.
