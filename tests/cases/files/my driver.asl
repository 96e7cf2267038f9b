!drive.
+!drive <- wait; !drive.
