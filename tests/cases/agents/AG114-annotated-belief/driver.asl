seen(car)[certain].
!drive.
+!drive : seen(car) <- wait; !drive.
