!drive.
+!drive : S < 3 <- forward(S); !drive.
