!drive.
+!drive : speed(S) <- !note(S); ?seen(N); forward(N); !drive.
+!note(0) <- +seen(1); +seen(2).
+!note(S) <- +seen(2); +seen(1).
