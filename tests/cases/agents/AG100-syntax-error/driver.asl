!drive.
+!drive <- wait !drive.
