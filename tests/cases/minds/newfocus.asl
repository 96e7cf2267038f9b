!go.
+!go <- ++seen(1); +again; --seen(1); -again; !act; !go.
+seen(X) <- +got(X).
-seen(X) <- -got(X).
+again : got(1) <- +order1.
+again <- +order2.
+!act : order1 & not car(0,1) & not car(0,2) <- -order1; forward(1).
+!act : order2 <- -order2; wait.
+!act <- wait.
