!drive.
+!drive : B & speed(0) <- wait; !drive.
+!drive <- forward(1); !drive.
