!drive.
+!drive : other::speed(0) <- wait; !drive.
+!drive <- forward(1); !drive.
