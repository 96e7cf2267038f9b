!drive.
+!drive <- for (car(0, A)) { +seen(A) }; wait; !drive.
