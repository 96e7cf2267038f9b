car(0, 1) :- speed(0).
!drive.
+!drive : car(0, 1) <- wait; !drive.
