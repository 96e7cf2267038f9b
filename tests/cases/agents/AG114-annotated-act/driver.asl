!drive.
+!drive <- forward(1)[fast]; !drive.
