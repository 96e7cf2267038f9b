// Obeys the law and follows the advice.
// In: the percepts of the car.  Out: one act a step.  Left to others: how to drive (driving.asl), what the Code asks (the rules).

{ include("driving.asl") }

heeds(must).
heeds(should).
