limit(9).
!drive.
+!drive : limit(9) <- wait; !drive.
