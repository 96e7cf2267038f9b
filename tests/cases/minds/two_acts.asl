{ include("../../../agents/perception.asl") }
!a. !b.
+!a : not car(0,1) & not car(0,2) <- forward(1); !a.
+!a <- wait; !a.
+!b : light(_,_,red) <- wait; !b.
+!b <- change_lane(left,1); !b.
-!b[error(E)] <- !b.
