!drive.
+!drive : X[source(percept)] <- wait; !drive.
