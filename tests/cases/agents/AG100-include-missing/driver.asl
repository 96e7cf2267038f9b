{ include("nowhere.asl") }
!drive.
+!drive <- wait; !drive.
