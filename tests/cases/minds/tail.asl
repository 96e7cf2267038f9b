{ include("../../../agents/perception.asl") }
!drive.
+!drive : car(0,1) <- wait; !drive.
+!drive : car(0,2) <- forward(1); !drive.
+!drive <- forward(2); !drive.
