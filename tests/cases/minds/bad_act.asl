!go.
+!go : speed(0) & limit(L) <- N = 3 * L; forward(N); +never; !go.
+!go <- wait; !go.
-!go[no_such_act] : light(_,_,red) <- forward(1); !go.
-!go <- wait; !go.
