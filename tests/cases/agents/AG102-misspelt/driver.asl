!drive.
+!drive : .desires(drive) <- wait; !drive.
+!drive <- forward(1); !drive.
