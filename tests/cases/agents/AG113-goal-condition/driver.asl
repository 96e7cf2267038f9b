!drive.
+!drive <: speed(0) <- wait; !drive.
