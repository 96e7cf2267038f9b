"""One step of Jason's deliberation, run symbolically: from a mind at rest, through cycles, to minds at rest.

    at `drive` waiting for forward(1)     advised & stop_line(0,0)   ->  act wait,       at `drive` waiting for wait
                                          otherwise                  ->  act forward(1), at `drive` waiting for forward(1)

Control (intentions, events, pending acts) is concrete; what is believed is a condition.  Each cycle follows Jason 3.2.1:
at most one event with a plan, one feedback, one formula of one intention; equal controls reached in the same cycle are
merged.  In: a `Control`, the agent, `Knowledge`.  Out: `Leaf`s.  Left to others: which controls exist (mind.py).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace

from rotra.diagnostics import Rejected, problem
from rotra.frontends.agent import Agent, Body, Formula, Plan, Step
from rotra.frontends.terms import Struct, Substitution, Term, Var, is_ground, resolve, show, unify, variables
from rotra.lowering.query import IGNORED_ACTIONS, Indicator, Knowledge, Mind, Solution, indicator, solve
from rotra.origins import Origin
from rotra.system.expr import FALSE, TRUE, Expr, choose, conj, disj, negate
from rotra.system.solver import Satisfiability

MAX_CYCLES = 400
MAX_DEPTH = 40
MAX_EVENTS = 120


@dataclass(frozen=True, slots=True)
class Frame:
    """An intended means: the plan at work on a trigger, what is left of its body, and its live variables.

    `returns`: (variable of the trigger, variable of the frame below) for results that flow back.
    """

    plan: Plan
    op: str
    type: str
    literal: Struct
    body: Body
    bound: tuple[tuple[str, Term], ...]
    returns: tuple[tuple[str, str], ...] = ()

    @property
    def is_goal(self) -> bool:
        return self.type != "belief"


Stack = tuple[Frame, ...]  # bottom first


@dataclass(frozen=True, slots=True)
class Event:
    op: str
    type: str
    literal: Struct
    stack: Stack | None = None  # None: external
    present: Expr = TRUE
    annotations: tuple[Term, ...] = ()
    returns: tuple[tuple[str, str], ...] = ()


# stands for the act of an intention whose act was done: what it was no longer matters, its formula is already gone
DONE = Struct("done")


@dataclass(frozen=True, slots=True)
class Pending:
    """An intention that waits for the result of its act; `asked` is its place among the acts of the step."""

    stack: Stack
    act: Struct
    asked: int


@dataclass(frozen=True, slots=True)
class Control:
    """What is concrete inside a cycle.  `atomic` is Jason's AI with its suspended flag; `acts` those asked for so far."""

    events: tuple[Event, ...] = ()
    running: tuple[Stack, ...] = ()
    pending: tuple[Pending, ...] = ()
    feedback: tuple[int, ...] = ()  # places of the pending acts whose result is due
    atomic: Stack | None = None
    suspended: bool = False
    acts: tuple[tuple[Struct, Origin], ...] = ()
    old: tuple[Pending, ...] = ()  # pending from the step before, until their feedback is read
    selected: Stack | None = None  # the intention of the selected event: seen by .intend in contexts


@dataclass(frozen=True, slots=True)
class Moment:
    """A control, the condition under which it is reached, and the beliefs there."""

    control: Control
    guard: Expr
    beliefs: Mapping[Struct, Expr]


@dataclass(frozen=True, slots=True)
class Leaf:
    """A mind at rest at the end of a step (`restless`: it never came to rest)."""

    control: Control
    guard: Expr
    beliefs: Mapping[Struct, Expr]
    restless: bool = False


@dataclass(slots=True)
class Machine:
    """The agent's plans, compiled for look-up, and the sinks for what deliberation finds out on the way.

    `legal`: can the act be done; `select` records a chosen plan and names its condition; `single`: which belief variables are
    of a functor of which one belief at a time stands.
    """

    agent: Agent
    knowledge: Knowledge
    solver: Satisfiability
    legal: Callable[[Struct], bool]
    name: Callable[[Struct, Expr, Origin], Expr]
    select: Callable[[Plan, Expr, int], Expr]
    single: Mapping[Expr, Indicator] = field(default_factory=dict)
    plans: dict[tuple[str, str, Indicator], list[Plan]] = field(default_factory=dict)
    live: dict[Body, frozenset[str]] = field(default_factory=dict)
    cycle: int = 0

    def __post_init__(self) -> None:
        for plan in self.agent.plans:
            key = (plan.trigger.op, plan.trigger.type, indicator(plan.trigger.literal))
            self.plans.setdefault(key, []).append(plan)

    def candidates(self, op: str, type_: str, literal: Struct) -> list[Plan]:
        return self.plans.get((op, type_, indicator(literal)), [])

    # ---- the step ----------------------------------------------------------------------------------------------

    def step(self, start: Moment) -> Iterator[Leaf]:
        """Run cycles until every branch is at rest; ends with the same control are one leaf."""
        ends: dict[Control, Moment] = {}
        level = [start]
        for self.cycle in range(MAX_CYCLES):
            merged: dict[Control, Moment] = {}
            for moment in level:
                for after in self._cycle(moment):
                    for settled in self._settled(after):
                        if isinstance(settled, Leaf):
                            _merge(ends, Moment(settled.control, settled.guard, settled.beliefs))
                        else:
                            _merge(merged, settled)
            level = list(merged.values())
            if not level:
                break
        yield from (Leaf(m.control, m.guard, m.beliefs) for m in ends.values())
        for moment in level:
            yield Leaf(replace(moment.control, events=(), running=(), atomic=None, selected=None), moment.guard, moment.beliefs, True)

    def _settled(self, m: Moment) -> Iterator[Moment | Leaf]:
        """A leaf where Jason's canSleep() holds; an event that is only perhaps there is decided when it alone is left."""
        c = m.control
        if c.feedback:
            yield m
        elif c.atomic is not None and c.suspended:
            yield from (Leaf(s.control, s.guard, s.beliefs) for s in self._decide_events(m))
        elif c.running or c.atomic is not None or c.events:
            yield m  # a cycle in which none of the perhaps-events is there changes nothing
        else:
            yield Leaf(replace(c, selected=None), m.guard, m.beliefs)

    def _decide_events(self, m: Moment) -> Iterator[Moment]:
        undecided = next((i for i, e in enumerate(m.control.events) if e.present is not TRUE), None)
        if undecided is None:
            yield m
            return
        events = m.control.events
        there = replace(events[undecided], present=TRUE)
        for s in self._branch(m, events[undecided].present):
            yield from self._decide_events(replace(s, control=replace(m.control, events=(*events[:undecided], there, *events[undecided + 1 :]))))
        for s in self._branch(m, negate(events[undecided].present)):
            yield from self._decide_events(replace(s, control=replace(m.control, events=(*events[:undecided], *events[undecided + 1 :]))))

    def _branch(self, m: Moment, condition: Expr) -> Iterator[Moment]:
        guard = conj(m.guard, condition)
        if guard is m.guard or self.solver.possible(guard):
            yield replace(m, guard=guard)

    def _cycle(self, m: Moment) -> Iterator[Moment]:
        for deliberated in self._deliberate(m):
            for fed in self._feedback(deliberated):
                yield from self._act(fed)

    # ---- deliberate: one event with a plan -----------------------------------------------------------------------

    def _deliberate(self, m: Moment) -> Iterator[Moment]:
        c = m.control
        if c.atomic is not None or not c.events:
            yield replace(m, control=replace(c, selected=None))
            return
        # Jason keeps the event of an atomic intention apart and takes it first
        index = next((i for i, e in enumerate(c.events) if e.stack is not None and _is_atomic(e.stack)), 0)
        event = c.events[index]
        rest = replace(m, control=replace(c, events=(*c.events[:index], *c.events[index + 1 :])))
        for present in self._branch(rest, event.present):
            yield from self._handle(event, present)
        if event.present is not TRUE:
            for absent in self._branch(rest, negate(event.present)):
                yield from self._deliberate(absent)

    def _handle(self, event: Event, m: Moment) -> Iterator[Moment]:
        m = replace(m, control=replace(m.control, selected=event.stack))
        left = TRUE
        for plan in self.candidates(event.op, event.type, event.literal):
            bound = unify(plan.trigger.literal, event.literal, {})
            if bound is None or not _annotated(plan, event, bound):
                continue
            mind = self.mind(m, plan.origin)
            keep = self.live_in(plan.body) | {name for name, _ in event.returns}
            for found, guard in self.first(solve(plan.context, bound, mind), keep, left, m.guard, plan.origin):
                chosen = conj(m.guard, guard)
                if not self.solver.possible(chosen):
                    continue
                chosen = self.select(plan, chosen, self.cycle)
                yield self._push(event, plan, found, replace(m, guard=chosen))
                left = conj(left, negate(guard))
            if left is FALSE or not self.solver.possible(conj(m.guard, left)):
                return
        for s in self._branch(m, left):
            yield from self._without_plan(event, s)

    def _without_plan(self, event: Event, m: Moment) -> Iterator[Moment]:
        c = m.control
        if event.type != "belief":
            if event.op == "+":
                known = bool(self.candidates(event.op, event.type, event.literal))
                reason = "no_applicable" if known else "no_relevant"
                fail = self._failure_event(event.stack, event.op, event.type, event.literal, (Struct("error", (Struct(reason),)),))
                if fail is not None:
                    yield replace(m, control=replace(c, events=(*c.events, fail)))
                    return
            yield m  # no handler: the intention is gone
        elif event.stack is not None:
            yield replace(m, control=_offer(c, advance(event.stack)))
        else:
            yield from self._deliberate(m)  # an external event without a plan costs nothing

    def _push(self, event: Event, plan: Plan, bound: Substitution, m: Moment) -> Moment:
        literal = resolve(event.literal, bound)
        assert isinstance(literal, Struct)
        frame = self.frame(plan, event.op, event.type, literal, plan.body, bound, event.returns)
        stack = event.stack
        if stack is None:
            return replace(m, control=_offer(m.control, (frame,)))
        top = stack[-1] if stack else None
        # Jason's tail recursion optimisation
        if top and top.op == event.op == "+" and top.is_goal and event.type != "belief" and len(top.body) == 1 and indicator(top.literal) == indicator(event.literal):
            if top.returns:
                raise Rejected([problem("AG108", plan.origin, f"{plan.title} calls itself last and returns a value", "return the value from a goal that does not call itself")])
            stack, frame = stack[:-1], replace(frame, returns=())
        if len(stack) >= MAX_DEPTH:
            raise Rejected([problem("AG105", plan.origin, f"the goal {show(event.literal)} calls itself and its intention grows without end", "let the goal call itself last and under its own name, or start it anew with `!!`")])
        return replace(m, control=_offer(m.control, (*stack, frame)))

    # ---- feedback of one act -------------------------------------------------------------------------------------

    def _feedback(self, m: Moment) -> Iterator[Moment]:
        c = m.control
        for position, place in enumerate(c.feedback):
            waiting = next((p for p in c.old if p.asked == place), None)
            if waiting is None:
                continue  # its intention was dropped: Jason takes the next feedback
            c = replace(c, feedback=c.feedback[position + 1 :], old=tuple(p for p in c.old if p is not waiting))
            atomic = _is_atomic(waiting.stack)
            if atomic:
                c = replace(c, atomic=None, suspended=False)
            if waiting.act == DONE:
                yield replace(m, control=self._clear(_offer(c, waiting.stack), waiting.stack))
            else:
                reason = "busy" if place else "no_such_act"
                yield self._fail(waiting.stack, replace(m, control=c), (Struct("error", (Struct("action_failed"),)), Struct(reason)))
            return
        yield replace(m, control=replace(c, feedback=()))

    # ---- act: one formula of one intention -------------------------------------------------------------------------

    def _act(self, m: Moment) -> Iterator[Moment]:
        c = m.control
        if c.atomic is not None and not c.suspended:
            stack, c = c.atomic, replace(c, atomic=None)
        elif not c.suspended and c.running:
            stack, c = c.running[0], replace(c, running=c.running[1:])
        else:
            yield m
            return
        m = replace(m, control=c)
        frame = stack[-1]
        if not frame.body:
            yield replace(m, control=self._clear(_offer(c, stack), stack))
            return
        yield from self._execute(frame.body[0], stack, m)

    def _execute(self, step: Step, stack: Stack, m: Moment) -> Iterator[Moment]:
        frame, c = stack[-1], m.control
        bound = dict(frame.bound)
        match step.kind:
            case "action":
                act = resolve(self._literal(step, bound), bound)
                assert isinstance(act, Struct)
                if not is_ground(act):
                    raise Rejected([problem("AG104", step.origin, f"the act {show(act)} has a variable without a value", "bind it in the context, as in `limit(L)`")])
                waiting = Pending(stack, act, len(c.acts))
                if _is_atomic(stack):
                    c = replace(c, atomic=stack, suspended=True)
                yield replace(m, control=replace(c, pending=(*c.pending, waiting), acts=(*c.acts, (act, step.origin))))
            case "achieve":
                goal, returns = _outgoing(resolve(self._literal(step, bound), bound))
                yield replace(m, control=self._queue(c, Event("+", "achieve", goal, stack, returns=returns), step))
            case "achieve_new":
                goal, _ = _outgoing(resolve(self._literal(step, bound), bound))
                yield self._done(stack, replace(m, control=self._queue(c, Event("+", "achieve", goal), step)))
            case "test" | "constraint":
                assert step.formula is not None
                yield from self._test(step, step.formula, stack, m)
            case "if":
                yield from self._if(step, stack, m)
            case "add" | "add_end" | "add_new" | "del" | "del_new" | "update":
                yield from self._revise(step, stack, m)
            case "internal":
                yield from self._internal(step, stack, m)
            case _:
                raise AssertionError(f"{step.kind} passed the fragment check")

    def _literal(self, step: Step, bound: Substitution) -> Term:
        assert step.literal is not None
        literal = resolve(step.literal, bound) if isinstance(step.literal, Var) else step.literal
        if not isinstance(literal, Struct):
            raise Rejected([problem("AG104", step.origin, f"variable {show(step.literal)} has no value here", "bind it in the context")])
        return literal

    def _test(self, step: Step, formula: Formula, stack: Stack, m: Moment) -> Iterator[Moment]:
        frame = stack[-1]
        keep = self.live_in(frame.body[1:]) | {name for name, _ in frame.returns}
        left = TRUE
        for found, guard in self.first(solve(formula, dict(frame.bound), self.mind(m, step.origin, stack)), keep, TRUE, m.guard, step.origin):
            for s in self._branch(m, guard):
                yield self._done((*stack[:-1], self.rebound(frame, found)), s)
            left = conj(left, negate(guard))
        for s in self._branch(m, left):
            literal = resolve(formula.args[0], dict(frame.bound)) if formula.op == "lit" and step.kind == "test" else None
            if isinstance(literal, Struct) and self.candidates("+", "test", literal):
                goal, returns = _outgoing(literal)
                yield replace(s, control=self._queue(s.control, Event("+", "test", goal, stack, returns=returns), step))
            else:
                reason = "test_goal_failed" if step.kind == "test" else "constraint_failed"
                yield self._fail(stack, s, (Struct("error", (Struct(reason),)),))

    def _if(self, step: Step, stack: Stack, m: Moment) -> Iterator[Moment]:
        frame = stack[-1]
        condition, branch = step.branches[0]
        body = (frame.body[0], *branch, *frame.body[1:])
        keep = self.live_in(body[1:]) | {name for name, _ in frame.returns}
        left = TRUE
        for found, guard in self.first(solve(condition, dict(frame.bound), self.mind(m, step.origin, stack)), keep, TRUE, m.guard, step.origin):
            for s in self._branch(m, guard):
                yield self._done((*stack[:-1], replace(self.rebound(frame, found), body=body)), s)
            left = conj(left, negate(guard))
        for s in self._branch(m, left):
            if len(step.branches) > 1:  # `elif` is an if inside the else
                inner: Body = (Step("if", step.origin, branches=step.branches[1:], otherwise=step.otherwise),)
            else:
                inner = step.otherwise or ()
            yield self._done((*stack[:-1], replace(frame, body=(frame.body[0], *inner, *frame.body[1:]))), s)

    def _revise(self, step: Step, stack: Stack, m: Moment) -> Iterator[Moment]:
        """+b, -b, -+b: the belief base changes; a real change raises an event that the intention waits for."""
        literal = resolve(self._literal(step, dict(stack[-1].bound)), dict(stack[-1].bound))
        assert isinstance(literal, Struct)
        focused = step.kind not in ("add_new", "del_new")
        if step.kind in ("del", "del_new"):
            yield from self._delete(step, literal, stack, m, focused)
            return
        if not is_ground(literal):
            raise Rejected([problem("AG104", step.origin, f"the belief {show(literal)} is added with a variable that has no value", "bind it in the context")])
        if step.kind == "update":
            others = {b: g for b, g in m.beliefs.items() if indicator(b) == indicator(literal) and g is not FALSE}
            self._exclusive(step, others, m)
            beliefs = {**m.beliefs, **{b: FALSE for b in others}}
            events = tuple(Event("-", "belief", b, None, g) for b, g in sorted(others.items(), key=lambda i: show(i[0])) if self.candidates("-", "belief", b))
            # the old belief is really deleted first, so adding the same one again is a real addition
            m = replace(m, beliefs=beliefs, control=replace(m.control, events=(*m.control.events, *events)))
        held = m.beliefs.get(literal, FALSE)
        for already in self._branch(m, held):
            yield self._done(stack, already)
        for added in self._branch(m, negate(held)):
            yield self._believe("+", literal, stack, replace(added, beliefs={**added.beliefs, literal: TRUE}), focused, step)

    def _delete(self, step: Step, literal: Struct, stack: Stack, m: Moment, focused: bool) -> Iterator[Moment]:
        matching = {b: g for b, g in m.beliefs.items() if g is not FALSE and unify(literal, b, {}) is not None}
        if len(matching) > 1:
            self._exclusive(step, matching, m)
        left = TRUE
        for belief, held in sorted(matching.items(), key=lambda i: show(i[0])):
            for there in self._branch(m, conj(left, held)):
                yield self._believe("-", belief, stack, replace(there, beliefs={**there.beliefs, belief: FALSE}), focused, step)
            left = conj(left, negate(held))
        for s in self._branch(m, left):
            yield self._done(stack, s)

    def _alone(self, one: object, other: object) -> bool:
        """Are both conditions that a belief stood when the step began, of a functor of which one at a time stands?"""
        return one in self.single and self.single[one] == self.single.get(other)  # type: ignore[index, call-overload]

    def _exclusive(self, step: Step, held: Mapping[Struct, Expr], m: Moment) -> None:
        pairs = sorted(held.items(), key=lambda i: show(i[0]))
        for i, (a, x) in enumerate(pairs):
            for b, y in pairs[i + 1 :]:
                if not self._alone(x, y) and self.solver.possible(conj(m.guard, x, y)):
                    raise Rejected([problem("AG106", step.origin, f"which of {show(a)} and {show(b)} is removed depends on which was added last", "name the belief to remove, or keep one at a time with `-+`")])

    def _believe(self, op: str, literal: Struct, stack: Stack, m: Moment, focused: bool, step: Step) -> Moment:
        if focused:
            return replace(m, control=self._queue(m.control, Event(op, "belief", literal, stack), step))
        event = Event(op, "belief", literal)
        events = self._queue(m.control, event, step) if self.candidates(op, "belief", literal) else m.control
        return self._done(stack, replace(m, control=events))

    def _internal(self, step: Step, stack: Stack, m: Moment) -> Iterator[Moment]:
        bound = dict(stack[-1].bound)
        c = m.control
        match step.name:
            case name if name in IGNORED_ACTIONS:
                yield self._done(stack, m)
            case ".fail":
                yield self._fail(stack, m, (Struct("error", (Struct("ia_failed"),)), *(resolve(a, bound) for a in step.args)))
            case ".drop_intention" | ".drop_desire":
                if not step.args:
                    yield m
                    return
                goal = resolve(step.args[0], bound)
                assert isinstance(goal, Struct)
                keep = [s for s in c.running if not _has_goal(s, goal)]
                events = [e for e in c.events if (e.stack is None or not _has_goal(e.stack, goal)) and not (step.name == ".drop_desire" and e.op == "+" and e.type == "achieve" and unify(goal, e.literal, {}) is not None)]
                c = replace(c, running=tuple(keep), events=tuple(events), pending=tuple(p for p in c.pending if not _has_goal(p.stack, goal)), old=tuple(p for p in c.old if not _has_goal(p.stack, goal)))
                if c.atomic is not None and _has_goal(c.atomic, goal):
                    c = replace(c, atomic=None, suspended=False)
                m = replace(m, control=c)
                yield m if _has_goal(stack, goal) else self._done(stack, m)
            case ".abolish":
                pattern = resolve(step.args[0], bound)
                gone = {b: g for b, g in m.beliefs.items() if g is not FALSE and unify(pattern, b, {}) is not None}
                raised = tuple(Event("-", "belief", b, None, g) for b, g in sorted(gone.items(), key=lambda i: show(i[0])) if self.candidates("-", "belief", b))
                yield self._done(stack, replace(m, beliefs={**m.beliefs, **{b: FALSE for b in gone}}, control=replace(c, events=(*c.events, *raised))))
            case _:
                yield from self._test(step, Formula("internal", step.args, step.name), stack, m)

    # ---- the end of a formula, of a plan, of a goal ------------------------------------------------------------------

    def _done(self, stack: Stack, m: Moment) -> Moment:
        """The current formula is done: the intention goes on at the end of the queue; finished frames are cleared."""
        after = self.trimmed(advance(stack))
        return replace(m, control=self._clear(_offer(m.control, after), after))

    def _clear(self, c: Control, stack: Stack) -> Control:
        """Jason's ClrInt on the intention just queued: pop every finished frame, as far as that goes."""
        queued = stack
        while stack and not stack[-1].body:
            top, stack = stack[-1], stack[:-1]
            if top.is_goal and top.op == "-" and stack:
                stack = _popped_after_failure(stack, top.literal)
            if stack and stack[-1].body:
                stack = (*stack[:-1], self._with_results(stack[-1], top))
                stack = self.trimmed(advance(stack))
        return c if stack is queued else _replaced(c, queued, stack)

    def _with_results(self, below: Frame, top: Frame) -> Frame:
        bound = dict(below.bound)
        for inner, outer in top.returns:
            value = resolve(Var(inner), dict(top.bound))
            if not isinstance(value, Var):
                bound[outer] = value
        return replace(below, bound=tuple(sorted(bound.items(), key=lambda b: b[0])))

    def _fail(self, stack: Stack, m: Moment, annotations: tuple[Term, ...]) -> Moment:
        top = stack[-1]
        event = self._failure_event(stack, top.op, top.type, top.literal, annotations)
        if not top.is_goal or event is None:
            return m  # Jason only logs: the intention is gone
        return replace(m, control=replace(m.control, events=(*m.control.events, event)))

    def _failure_event(self, stack: Stack | None, op: str, type_: str, literal: Struct, annotations: tuple[Term, ...]) -> Event | None:
        """Intention.findEventForFailure: the nearest goal, from the top, for which some -! plan stands in the library."""
        if stack is None:
            return Event("-", type_, literal, None, annotations=annotations) if self.candidates("-", type_, literal) else None
        frames = list(reversed(stack))
        at = 0
        if type_ != "belief" and op == "-":
            at, frame, found = 1, frames[0], False
            while at < len(frames) and not found:
                frame, at = frames[at], at + 1
                while at < len(frames) and unify(frame.literal, literal, {}) is not None:
                    frame, at, found = frames[at], at + 1, True
            type_, literal = frame.type, frame.literal
        while not self.candidates("-", type_, literal) and at < len(frames):
            type_, literal = frames[at].type, frames[at].literal
            at += 1
        if type_ != "belief" and self.candidates("-", type_, literal):
            return Event("-", type_, literal, stack, annotations=annotations)
        return None

    def _queue(self, c: Control, event: Event, step: Step) -> Control:
        if len(c.events) >= MAX_EVENTS:
            raise Rejected([problem("AG109", step.origin, f"more than {MAX_EVENTS} events wait in one step", "react to fewer changes, or read the percept in a context")])
        return replace(c, events=(*c.events, event))

    # ---- minds and frames --------------------------------------------------------------------------------------------

    def mind(self, m: Moment, at: Origin, current: Stack | None = None) -> Mind:
        c = m.control

        def goals(desired: bool) -> Iterable[tuple[Struct, Expr]]:
            stacks = [s for s in (c.selected, current) if s is not None]
            stacks += [e.stack for e in c.events if e.stack is not None]
            stacks += [p.stack for p in (*c.old, *c.pending)] + list(c.running) + ([c.atomic] if c.atomic else [])
            seen: dict[Struct, Expr] = {}
            if desired:
                for e in c.events:
                    if e.op == "+" and e.type == "achieve":
                        seen[e.literal] = disj(seen.get(e.literal, FALSE), e.present)
            for stack in stacks:
                for frame in reversed(stack):
                    if frame.op == "+" and frame.type == "achieve":
                        seen[frame.literal] = TRUE
            return list(seen.items())

        return Mind(self.knowledge, m.beliefs, goals, self.name, at)

    def first(self, solutions: Iterator[Solution], keep: frozenset[str], left: Expr, path: Expr, at: Origin) -> list[tuple[Substitution, Expr]]:
        """The first solution that holds, as exclusive cases; solutions alike in what is used later are one case."""
        cases: dict[tuple[tuple[str, Term], ...], list[object]] = {}
        for s in solutions:
            guard = conj(left, s.guard)
            if guard is FALSE:
                continue
            shown = tuple((n, resolve(Var(n), s.bound)) for n in sorted(keep) if resolve(Var(n), s.bound) != Var(n))
            if shown in cases:
                cases[shown][1] = disj(cases[shown][1], guard)  # type: ignore[arg-type]
                cases[shown][2] |= s.unordered  # type: ignore[operator]
                cases[shown][3] = disj(cases[shown][3], s.guard)  # type: ignore[arg-type]
            else:
                cases[shown] = [s.bound, guard, set(s.unordered), s.guard]
            left = conj(left, negate(s.guard))
            if left is FALSE:
                break
        found = list(cases.values())
        for i, (_, _, a, here) in enumerate(found):
            for _, _, b, there in found[i + 1 :]:
                for x in sorted(a, key=show):  # type: ignore[call-overload]
                    for y in sorted(b, key=show):  # type: ignore[call-overload]
                        if x != y and indicator(x) == indicator(y) and not self._alone(here, there) and self.solver.possible(conj(path, here, there)):  # type: ignore[arg-type]
                            raise Rejected([problem("AG106", at, f"which of {show(x)} and {show(y)} is found first depends on which was added last", "ask for one of them by name, or keep one at a time with `-+`")])
        return [(bound, guard) for bound, guard, _, _ in found]  # type: ignore[misc]

    def live_in(self, body: Body) -> frozenset[str]:
        if body not in self.live:
            names: set[str] = set()
            for step in body:
                names |= _step_variables(step)
            self.live[body] = frozenset(names)
        return self.live[body]

    def frame(self, plan: Plan, op: str, type_: str, literal: Struct, body: Body, bound: Substitution, returns: tuple[tuple[str, str], ...]) -> Frame:
        keep = self.live_in(body) | {n for n, _ in returns}
        return Frame(plan, op, type_, literal, body, _kept(bound, keep), returns)

    def rebound(self, frame: Frame, bound: Substitution) -> Frame:
        return replace(frame, bound=_kept(bound, self.live_in(frame.body) | {n for n, _ in frame.returns}))

    def trimmed(self, stack: Stack) -> Stack:
        if not stack:
            return stack
        top = stack[-1]
        return (*stack[:-1], replace(top, bound=_kept(dict(top.bound), self.live_in(top.body) | {n for n, _ in top.returns})))


def _kept(bound: Substitution, keep: Iterable[str]) -> tuple[tuple[str, Term], ...]:
    shown = ((n, resolve(Var(n), bound)) for n in sorted(keep))
    return tuple((n, v) for n, v in shown if v != Var(n))


def _formula_variables(formula: Formula) -> frozenset[str]:
    result: set[str] = set()
    for part in formula.args:
        result |= _formula_variables(part) if isinstance(part, Formula) else variables(part)
    return frozenset(result)


def _step_variables(step: Step) -> frozenset[str]:
    names = set(variables(step.literal)) if step.literal is not None else set()
    if step.formula is not None:
        names |= _formula_variables(step.formula)
    for argument in step.args:
        names |= variables(argument)
    for condition, body in step.branches:
        names |= _formula_variables(condition)
        for inner in body:
            names |= _step_variables(inner)
    for inner in step.otherwise or ():
        names |= _step_variables(inner)
    return frozenset(names)


def step_key(step: Step) -> tuple[object, ...]:
    """Equal for steps that do the same, wherever they stand."""
    branches = tuple((condition, tuple(map(step_key, body))) for condition, body in step.branches)
    otherwise = None if step.otherwise is None else tuple(map(step_key, step.otherwise))
    return (step.kind, step.literal, step.formula, step.name, step.args, branches, otherwise)


def advance(stack: Stack) -> Stack:
    return (*stack[:-1], replace(stack[-1], body=stack[-1].body[1:]))


def _is_atomic(stack: Stack) -> bool:
    return any(f.plan.atomic for f in stack)


def _has_goal(stack: Stack, goal: Struct) -> bool:
    return any(f.op == "+" and f.type == "achieve" and unify(goal, f.literal, {}) is not None for f in stack)


def _offer(c: Control, stack: Stack) -> Control:
    return replace(c, atomic=stack, suspended=False) if _is_atomic(stack) else replace(c, running=(*c.running, stack))


def _replaced(c: Control, queued: Stack, by: Stack) -> Control:
    """The intention at the end of the queue changed by clearing; an empty one leaves."""
    if c.atomic is queued:
        return replace(c, atomic=by or None)
    return replace(c, running=(*c.running[:-1], by) if by else c.running[:-1])


def _popped_after_failure(stack: Stack, goal: Struct) -> Stack:
    """applyClrInt after a -!g plan: take off the frames up to the goal that failed."""

    def calls(frame: Frame) -> bool:
        step = frame.body[0] if frame.body else None
        if step is None or step.kind != "achieve" or not isinstance(step.literal, Struct):
            return False
        return unify(resolve(step.literal, dict(frame.bound)), goal, {}) is not None

    frame = stack[-1]
    if not calls(frame):
        stack = stack[:-1]
    while stack and not (frame.is_goal and unify(frame.literal, goal, {}) is not None) and not calls(frame):
        frame, stack = stack[-1], stack[:-1]
    return stack


def _annotated(plan: Plan, event: Event, bound: dict[str, Term]) -> bool:
    """Every annotation that the plan asks for is one of the event's; extends `bound`."""
    for wanted in plan.trigger.annotations:
        if isinstance(wanted, Struct) and wanted.name == "source":
            continue
        for offered in event.annotations:
            extended = unify(wanted, offered, bound)
            if extended is not None:
                bound.clear()
                bound.update(extended)
                break
        else:
            return False
    return True


def _outgoing(goal: Term) -> tuple[Struct, tuple[tuple[str, str], ...]]:
    """The goal with its unbound variables renamed apart, and which result flows back into which variable."""
    assert isinstance(goal, Struct)
    free = sorted(variables(goal))
    bound = {name: Var(f"{name}^") for name in free}
    literal = resolve(goal, bound)
    assert isinstance(literal, Struct)
    return literal, tuple((f"{name}^", name) for name in free)


def _merge(level: dict[Control, Moment], m: Moment) -> None:
    other = level.get(m.control)
    if other is None:
        level[m.control] = m
        return
    beliefs = {}
    for belief in {**other.beliefs, **m.beliefs}:
        a, b = other.beliefs.get(belief, FALSE), m.beliefs.get(belief, FALSE)
        beliefs[belief] = a if a is b else choose((m.guard, b), (TRUE, a))
    level[m.control] = Moment(m.control, disj(other.guard, m.guard), beliefs)
