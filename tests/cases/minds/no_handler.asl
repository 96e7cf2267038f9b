!top. !watch.
+!top <- !mid; !top.
+!mid : not car(0,1) <- !low; wait.
+!low : not car(0,2) <- forward(1).
+!watch : not .intend(top) <- wait; !!top; !watch.
+!watch <- +w; -w; !wait_one; !watch.
+!wait_one : car(0,_) <- wait.
+!wait_one.
-!watch <- !watch.
