{ include("plans.asl") }
!drive.
