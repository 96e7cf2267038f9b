{ include("../../../agents/perception.asl") }
!drive.
+!drive : believes(light_red) & not .intend(approaching_traffic_light) <- !approaching_traffic_light; !drive.
+!drive : not car(0,1) & not car(0,2) <- forward(1); !drive.
+!drive <- wait; !drive.
+!approaching_traffic_light : not believes(light_red).
+!approaching_traffic_light : advised(must, stop_at_white_line) & not stop_line(0,0) & not car(0,1) <- forward(1); !approaching_traffic_light.
+!approaching_traffic_light <- wait; !approaching_traffic_light.
