!drive.
+!drive <- .send(other, tell, coming); wait; !drive.
