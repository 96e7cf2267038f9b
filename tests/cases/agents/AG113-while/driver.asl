!drive.
+!drive <- while (speed(0)) { wait }; !drive.
