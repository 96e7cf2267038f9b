!drive.
+!drive : .count(car(0, A) & A > 1, N) & N > 1 <- wait; !drive.
+!drive <- forward(1); !drive.
