seen([1, 2]).
!drive.
+!drive : seen([H | T]) <- forward(H); !drive.
