// What the car senses -> what it believes, in the words of the rule base; included by every driver.
//
// In: the percepts of model/README.md.  Out: believes(B), context(C), nearside(S), offside(S).
// Left to others: intentions (the driver's own goals), advice (the rule base), acts.
// Everything is a rule, so nothing here can be stale: a belief holds exactly as long as its percepts do.

context(standard).

// ---- sides: one driver for roads that drive on the left and roads that drive on the right ----
nearside(left)  :- drives(left).
nearside(right) :- drives(right).
offside(right)  :- drives(left).
offside(left)   :- drives(right).

// the same as a cell number: R in car(R,A) of the lane next to ours
nearside_cell(-1) :- drives(left).
nearside_cell(1)  :- drives(right).
offside_cell(1)   :- drives(left).
offside_cell(-1)  :- drives(right).

// ---- traffic lights: the next line of our own lane, and the light that stands at it or beyond it ----
next_line(A)      :- stop_line(0,A) & A >= 0 & not nearer_line(A).
nearer_line(A)    :- stop_line(0,B) & B >= 0 & B < A.
light_shows(C)    :- next_line(A) & light(_,L,C) & L >= A & not nearer_light(A,L).
nearer_light(A,L) :- light(_,M,_) & M >= A & M < L.

believes(light_red)   :- light_shows(red).
believes(light_red)   :- light_shows(red_amber).
believes(light_amber) :- light_shows(red_amber).
believes(light_amber) :- light_shows(amber).
believes(light_green) :- light_shows(green).
believes(light_against_us) :- light_shows(C) & C \== green.
believes(at_traffic_light)    :- stop_line(0,0).
believes(traffic_light_ahead) :- next_line(A) & A > 0.
believes(able_to_stop_by_white_line) :- next_line(_).      // a car of this world can stop in any cell
believes(exit_blocked) :- next_line(A) & car(0,B) & B > A & B <= A + 2.

// ---- speed ----
believes(driving).
believes(stationary) :- speed(0).
believes(moving)     :- speed(S) & S > 0.
believes(exceeding_speed_limit) :- speed(S) & limit(L) & S > L.

// ---- the own lane ----
believes(vehicle_in_front) :- car(0,A) & A > 0.
believes(road_ahead_clear) :- road(0,1,ahead) & not believes(vehicle_in_front).

// ---- the lane beside: a lane goes ahead only; the middle of a crossing (every way) is none ----
nearside_lane(R) :- nearside_cell(R) & road(R,0,ahead) & not road(R,0,back).
offside_lane(R)  :- offside_cell(R)  & road(R,0,ahead) & not road(R,0,back).

believes(in_overtaking_lane) :- nearside_lane(_).
believes(overtaking)         :- nearside_lane(R) & car(R,A) & A >= -1.     // beside us, ahead of us, or too close behind to cut in
believes(vehicle_passed)     :- nearside_lane(R) & car(R,A) & A < -1.
// a car just behind in that lane may enter the very cell we would
believes(safe_to_move_left)  :- nearside_lane(R) & not car(R,0) & not car(R,-1) & not stop_line(0,0).
// before pulling out: no lane to pull out into, or somebody in it beside us, ahead or about to pass
believes(overtaking_road_blocked) :- not nearside_lane(_) & not offside_lane(_).
believes(overtaking_road_blocked) :- not nearside_lane(_) & offside_lane(R) & car(R,A) & A >= -1.

// ---- junctions ----
believes(at_junction) :- road(1,0,right).
believes(at_junction) :- road(-1,0,left).
believes(approaching_junction) :- road(1,A,right) & A > 0.
believes(approaching_junction) :- road(-1,A,left) & A > 0.
// the turn across the road enters (R,0): the car there may stay, the car at (R,1) may enter it too
believes(oncoming_traffic_close) :- offside_cell(R) & car(R,0).
believes(oncoming_traffic_close) :- offside_cell(R) & car(R,1).
believes(safe_gap) :- believes(at_junction) & not believes(oncoming_traffic_close).
