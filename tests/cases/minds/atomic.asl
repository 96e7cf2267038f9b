!go. !other.
@[atomic] 
+!go <- +busy_now; -busy_now; wait.
+!other : not .intend(go) <- +free; wait; -free; !other.
+!other <- !!go; wait; !other.
-!other <- !other.
