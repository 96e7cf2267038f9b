near :- car(0, 1).
!drive.
+!drive <- wait; !drive.
+near <- +seen(car).
