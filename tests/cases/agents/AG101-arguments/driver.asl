!drive.
+!drive <- forward; !drive.
