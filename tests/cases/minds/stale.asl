!go.
+!go <- !a; !go.
+!a : light(_,_,red) & not .desire(help) <- !!help; wait.
+!a : .intend(help) <- wait; wait.
+!a : not car(0,1) & not car(0,2) <- forward(1).
+!a <- wait.
+!help <- !deep.
+!deep : light(_,_,green) <- .fail.
+!deep <- wait; !deep.
-!deep : car(0,1) <- .drop_intention(help).
