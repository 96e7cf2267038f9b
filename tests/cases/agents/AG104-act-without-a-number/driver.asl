!drive.
+!drive <- forward(N); !drive.
