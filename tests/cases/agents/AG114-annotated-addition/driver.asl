!drive.
+!drive <- +seen(car)[at(3)]; wait; !drive.
