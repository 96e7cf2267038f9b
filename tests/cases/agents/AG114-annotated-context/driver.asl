!drive.
+!drive : car(0, A)[source(percept)] <- wait; !drive.
+!drive <- forward(1); !drive.
