!drive.
+!drive : advised(must, stop_at_white_lines) <- wait; !drive.
+!drive <- forward(1); !drive.
