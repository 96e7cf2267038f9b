state(idle).
+light(R,A,red) <- -+state(red); +saw(A).
-light(R,A,red) <- -+state(other).
+saw(A) : A > 1 <- -saw(A); +far.
+saw(A) <- -saw(A); -far.
+far <- +noted.
-far <- -noted.
+speed(S) : S > 0 <- -+last(S).
!go.
+!go : state(red) & noted <- wait; !go.
+!go : not car(0,1) & not car(0,2) <- forward(1); !go.
+!go <- wait; !go.
