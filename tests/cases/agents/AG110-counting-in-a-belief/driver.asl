driven(0). !drive. +!drive : driven(N) <- -+driven(N + 1); wait; !drive.
