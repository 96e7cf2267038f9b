a(X) :- b(X).
b(X) :- a(X).
!drive.
+!drive : a(1) <- wait; !drive.
+!drive <- forward(1); !drive.
