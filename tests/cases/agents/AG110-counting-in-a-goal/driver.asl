!drive(0).
+!drive(N) <- wait; !drive(N + 1).
