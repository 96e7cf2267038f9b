// Obeys the law and follows the advice, of this situation and of the next one that it predicts.
// In: the percepts of the car.  Out: one act a step.  Left to others: how to drive (driving.asl), what the Code asks (the rules).

{ include("driving.asl") }

heeds(must).
heeds(should).

heeded(Action) :- heeds(Label) & advised_next(Label, Action).

// the next situation, as far as it can be told: what is intended goes on, and what is seen stays as it is
next_context(Context) :- context(Context).
next_believes(Belief) :- believes(Belief).
next_intends(Intention) :- intends(Intention).
