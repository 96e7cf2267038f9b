// How our drivers drive: the plans that all of them share.
// In: what perception.asl believes, `heeds(Label)` of the driver that includes this file.  Out: one act a step.
// Left to others: what the Code asks for (the adviser), which of it is heeded (the driver).
// Cells are the car's own: R to its right, A ahead.

{ include("perception.asl") }

// ---- what is heeded -------------------------------------------------------------------------------------------------

heeded(Action) :- heeds(Label) & advised(Label, Action).

// the way back to the nearside, in the word of either side of the road
called_back :- heeded(move_left).
called_back :- heeded(move_right).

// ---- the road, as far as it can be driven ---------------------------------------------------------------------------

cells(3). cells(2). cells(1).          // fastest first
lane(right, 1). lane(left, -1).

// the line that must not be crossed now, A cells ahead
held(A) :- stop_line(0, A) & A >= 0 & heeded(stop_at_white_line).
held(A) :- stop_line(0, A) & A >= 0 & heeded(wait_at_white_line).

closed(A) :- cells(A) & not road(0, A, ahead).
closed(A) :- cells(A) & car(0, A).
closed(A) :- held(Line) & cells(A) & A > Line.
closed(A) :- .intend(turn_off(Side)) & junction(Side, J) & cells(A) & A > J.

pace(N) :- cells(N) & limit(L) & N <= L & not (closed(A) & A <= N).

// ---- overtaking -----------------------------------------------------------------------------------------------------

slow_car(A) :- car(0, A) & A > 0 & A <= 2.

// N cells into the lane on that side and along it; a car that drives up from behind counts as there
free_lane(Side, N) :- lane(Side, R) & cells(N) & limit(L) & N <= L & road(R, 0, ahead) & not taken(R, N).
taken(R, N) :- car(R, A) & A >= -1 & A < N.
taken(R, N) :- lane(_, R) & cells(N) & cells(A) & A < N & not road(R, A, ahead).

beside(A) :- nearside(Side) & lane(Side, R) & car(R, A).
past :- not (beside(A) & A >= -1 & A <= 0).

// back into the lane of those who do not overtake: nobody there, nobody about to be there
back_in(Side) :- nearside(Side) & free_lane(Side, 1).

worth_overtaking :- task(overtake) & slow_car(_) & not next_line(_) & offside(Side) & free_lane(Side, _).

// ---- turning --------------------------------------------------------------------------------------------------------

junction(Side, A) :- lane(Side, R) & road(R, A, Side) & A >= 0.

// nobody enters the cell that the turn enters, at the speed at which traffic drives here
can_enter(Side) :- lane(Side, R) & not car(R, 0) & not car(R, 1).
near_traffic(Side) :- lane(Side, R) & car(R, A) & A >= 0 & A <= 3.
gap(Side) :- can_enter(Side) & not (heeded(wait_until_safe_gap) & near_traffic(Side)).

corner(Side, N) :- cells(N) & limit(L) & N <= L & not (blocked(Side, K) & K <= N).
blocked(Side, K) :- lane(Side, R) & cells(K) & X = R * K & not road(X, 0, Side).
blocked(Side, K) :- lane(Side, R) & cells(K) & X = R * K & car(X, 0).

turn_due(Side) :- turning(T, Side) & task(T) & not turned(Side) & junction(Side, _).
turning(turn_right, right). turning(turn_left, left).

manoeuvring :- .intend(overtake).
manoeuvring :- .intend(turn_right).
manoeuvring :- .intend(turn_left).

due :- turn_due(_).
due :- worth_overtaking.

// ---- the one thing it always wants ----------------------------------------------------------------------------------

!drive.

@drive
+!drive <- !travel; !drive.

// what to pursue now; a goal of an intention's name is what the adviser is told
@turn_right
+!travel : turn_due(right) <- !turn_right.
@turn_left
+!travel : turn_due(left) <- !turn_left.
@overtake
+!travel : worth_overtaking <- !overtake.
@approach
+!travel : believes(traffic_light_ahead) <- !approaching_traffic_light.
@cruise
+!travel <- !proceed.
// an act that could not be done: stand for a step, then pursue whatever is due
@recover
-!travel <- wait.

// ---- moving on ------------------------------------------------------------------------------------------------------

@keep_in
+!proceed : called_back & back_in(Side) <- change_lane(Side, 1).
@proceed
+!proceed : pace(N) <- forward(N).
@hold
+!proceed <- wait.

// one step ahead inside a manoeuvre: a light ahead counts there too
@ahead_to_light
+!ahead : believes(traffic_light_ahead) <- !approaching_traffic_light.
@ahead
+!ahead <- !proceed.

// lasts while the line is ahead; chosen in a subgoal, so that the advice is for a car that approaches
@near_light
+!approaching_traffic_light : believes(traffic_light_ahead) & manoeuvring <- !proceed.
@approaching
+!approaching_traffic_light : believes(traffic_light_ahead) & not due <- !proceed; !approaching_traffic_light.
@approached
+!approaching_traffic_light.

// ---- overtaking: out, level, past, back ------------------------------------------------------------------------------

@overtaking
+!overtake <- !pull_out; !draw_level; !get_past; !return_to_lane.
@give_up_overtaking
-!overtake <- !ahead.

@call_off
+!pull_out : heeded(cancel_overtaking) | heeded(avoid_overtaking) | called_back <- .fail.
@pull_out
+!pull_out : offside(Side) & free_lane(Side, N) <- change_lane(Side, N).

// not faster past it than needed to see it fall behind
@draw_level
+!draw_level : not believes(traffic_light_ahead) & beside(A) & A > 0 & pace(N) & N <= A + 1 <- forward(N); !draw_level.
@level
+!draw_level.

// nor so fast that it is out of sight when it has fallen behind
@get_past
+!get_past : not believes(traffic_light_ahead) & beside(A) & A >= -1 & A <= 0 & pace(N) & N <= A + 3 <- forward(N); !get_past.
@stuck_beside
+!get_past : not past <- !ahead; !get_past.
@got_past
+!get_past.

@return
+!return_to_lane : called_back & back_in(Side) <- change_lane(Side, 1).
@stay_out
+!return_to_lane.

// ---- turning --------------------------------------------------------------------------------------------------------

@to_the_right
+!turn_right <- !turn_off(right).
@to_the_left
+!turn_left <- !turn_off(left).

@keep_in_first
+!turn_off(Side) : called_back & back_in(In) <- change_lane(In, 1); !turn_off(Side).
@turn
+!turn_off(Side) : junction(Side, 0) & not held(0) & gap(Side) & corner(Side, N) <- turn(Side, N); +turned(Side).
@await_gap
+!turn_off(Side) : junction(Side, 0) <- wait; !turn_off(Side).
@to_junction
+!turn_off(Side) : junction(Side, _) <- !ahead; !turn_off(Side).
@no_junction
+!turn_off(_).

// another errand: the turn that was done no longer counts
@right_again
-task(turn_right) <- -turned(right).
@left_again
-task(turn_left) <- -turned(left).
