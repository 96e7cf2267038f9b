mode(slow). prefer(fast,2). prefer(slow,1).
!go.
+!go : mode(M) & prefer(M,N) & not (car(0,A) & A <= N & A > 0) <- .print(M, N); forward(N); !next; !go.
+!go <- wait; !next; !go.
+!next : mode(slow) & light(_,_,green) <- -mode(slow); +mode(fast).
+!next : mode(fast) & light(_,_,red) <- -+mode(slow).
+!next.
