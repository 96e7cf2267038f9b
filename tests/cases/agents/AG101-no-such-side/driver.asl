!drive.
+!drive <- turn(nearside, 1); !drive.
