near(A) :- car(0, A)[source(percept)].
!drive.
+!drive : near(1) <- wait; !drive.
+!drive <- forward(1); !drive.
