// Obeys the law and follows the advice, of this situation and of the next one that it predicts.
// In: the percepts of the car.  Out: one act a step.  Left to others: how to drive (driving.asl), what the Code asks (the rules).

{ include("driving.asl") }

heeds(must).
heeds(should).

heeded(Action) :- heeds(Label) & advised_next(Label, Action).

// the next situation, as far as it can be told: what is intended and seen now goes on, and at the limit the car gets as
// far as the line or the junction that is near
next_context(Context) :- context(Context).
next_intends(Intention) :- intends(Intention).
next_believes(Belief) :- believes(Belief).
next_believes(at_traffic_light) :- next_line(A) & limit(L) & A <= L & not believes(light_green).
next_believes(at_junction) :- junction(_, A) & limit(L) & A <= L.
