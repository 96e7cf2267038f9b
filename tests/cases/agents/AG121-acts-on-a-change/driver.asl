!drive.
+!drive <- wait; !drive.
+car(0, 1) <- turn(left, 1).
