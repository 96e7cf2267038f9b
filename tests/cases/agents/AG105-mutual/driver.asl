!drive.
+!drive <- wait; !again; +driven.
+!again <- !drive; +again.
