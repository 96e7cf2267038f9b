!drive.
+!drive <- .findall(A, car(0, A), Cars); wait; !drive.
