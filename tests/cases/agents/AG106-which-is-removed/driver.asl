!drive.
+!drive : speed(0) <- +seen(1); +seen(2); -seen(X); wait; !drive.
+!drive <- +seen(2); +seen(1); -seen(X); wait; !drive.
