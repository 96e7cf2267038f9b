fast(S).
!drive.
+!drive : fast(2) <- wait; !drive.
