!a. !b.
+!a <- wait; !a.
+!b <- wait; +never; !b.
-!b[busy] <- +was_busy; !!c.
-!b <- +was_other.
+!c : was_busy <- -was_busy; wait.
