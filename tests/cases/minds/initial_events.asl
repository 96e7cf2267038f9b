a. b(1). b(2).
+a <- +c.
+b(X) : c <- +d(X).
+b(X) <- +e(X).
!go.
+!go : d(1) <- wait; !go.
+!go : e(2) <- wait; .abolish(e(2)); !go.
+!go <- wait; !go.
