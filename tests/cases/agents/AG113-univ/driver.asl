!drive.
+!drive : task(T) & T =.. L <- wait; !drive.
