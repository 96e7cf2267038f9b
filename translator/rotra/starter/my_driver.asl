// My driver: heeds every directive that it knows how to heed, and else drives as fast as it may.
// In: the percepts of the car.  Out: one act a step.  Left to others: what the car believes (perception.asl), the rules.

{ include("perception.asl") }

heeds(must).
heeds(should).
heeded(Action) :- heeds(Label) & advised(Label, Action).

cells(2). cells(1).                    // fastest first

// the line that must not be crossed now, A cells ahead
held(A) :- stop_line(0, A) & A >= 0 & heeded(stop_at_white_line).
held(A) :- stop_line(0, A) & A >= 0 & heeded(wait_at_white_line).

closed(A) :- cells(A) & not road(0, A, ahead).
closed(A) :- cells(A) & car(0, A).
closed(A) :- held(Line) & cells(A) & A > Line.

free(N) :- cells(N) & limit(L) & N <= L & not (closed(A) & A <= N).

light_ahead :- stop_line(0, A) & A > 0.

!drive.

@drive
+!drive <- !travel; !drive.

// a goal of the name of an intention is what the adviser is told
@approach
+!travel : light_ahead <- !approaching_traffic_light.
@cruise
+!travel <- !proceed.

@approaching
+!approaching_traffic_light <- !proceed.

@proceed
+!proceed : free(N) <- forward(N).
@hold
+!proceed <- wait.
