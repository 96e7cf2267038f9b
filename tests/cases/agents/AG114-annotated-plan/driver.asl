!drive.
@go[all_unifs] +!drive : car(0, A) <- wait; !drive.
+!drive <- forward(1); !drive.
