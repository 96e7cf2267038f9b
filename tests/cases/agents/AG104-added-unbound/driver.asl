!drive.
+!drive <- +seen(X); wait; !drive.
