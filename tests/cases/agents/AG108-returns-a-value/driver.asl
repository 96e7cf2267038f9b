!drive.
+!drive <- !look(N); forward(N); !drive.
+!look(N) <- wait; !look(N).
