!ping.
+!ping : car(0,1) <- wait; !pong.
+!ping : not car(0,2) <- forward(1); !pong.
+!ping <- !pong.
+!pong <- wait; !!ping.
