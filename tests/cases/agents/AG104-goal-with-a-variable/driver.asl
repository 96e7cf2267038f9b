!drive(N).
+!drive(N) <- wait; !drive(N).
