!drive.
+!drive <- wait; !drive[soon].
