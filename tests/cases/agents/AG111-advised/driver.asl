!drive.
+!drive <- wait; !drive.
+advised(must, stop_at_white_line) <- +held.
