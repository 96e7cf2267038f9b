!drive.
+!drive <- .wait(1000); wait; !drive.
