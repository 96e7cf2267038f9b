!a. !b.
+!a <- +t1; -t1; +t2; -t2; wait; !a.
+!b : t1 <- +saw1; wait; -saw1; !b.
+!b : t2 <- +saw2; wait; -saw2; !b.
+!b <- wait; !b.
-!b <- .print("later"); !b.
-!a <- !a.
