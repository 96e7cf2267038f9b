!drive.
+!drive <- wait |&| +seen; !drive.
