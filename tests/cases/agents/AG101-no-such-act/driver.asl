!drive.
+!drive <- brake; !drive.
