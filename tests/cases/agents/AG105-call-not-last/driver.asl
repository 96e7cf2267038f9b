!drive.
+!drive <- wait; !drive; +driven.
