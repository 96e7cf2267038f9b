!drive.
+!drive <- wait; !drive.
+car(0, 1)[source(self)] <- +seen(car).
