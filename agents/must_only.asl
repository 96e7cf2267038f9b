// Obeys the law and nothing else: never gives way out of courtesy, never goes back to its lane because it should.
// In: the percepts of the car.  Out: one act a step.  Left to others: how to drive (driving.asl), what the Code asks (the rules).

{ include("driving.asl") }

heeds(must).
