!drive.
+!drive : task(T) <- T; !drive.
