+!drive : speed(0) <- forward(1); !drive.
+!drive <- wait !drive.
