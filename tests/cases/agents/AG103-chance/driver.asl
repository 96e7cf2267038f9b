!drive.
+!drive : .random(R) & R < 0.5 <- wait; !drive.
+!drive <- forward(1); !drive.
