!drive.
+!drive <- wait; !drive.
^!drive[state(failed)] <- +failed.
