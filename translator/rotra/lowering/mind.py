"""The driver's module of the model: every mind at rest that can come up, and one symbolic step from each.

    at = drive_12_forward_1 & take:3 (plan hold)   ->   act wait, next(at) = hold_12_wait

In: a checked Agent, the advice as rules, what can be sensed.  Out: `DriverModel` (the Part, the names of the minds, the
plans chosen under which condition).  Left to others: the world (world.py), what is asked about it (vocabulary.py).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

from rotra.diagnostics import Rejected, problem
from rotra.frontends.agent import Agent, Plan, Rule, Step, steps_of
from rotra.frontends.terms import Struct, is_ground, order, parse_ground, show, unify
from rotra.lowering.deliberation import DONE, MAX_EVENTS, Control, Event, Frame, Leaf, Machine, Moment, Pending, Stack, advance, step_key
from rotra.lowering.query import Indicator, Knowledge, Mind, changing, indicator
from rotra.origins import NOWHERE, Origin
from rotra.system.expr import FALSE, TRUE, Expr, Value, among, choose, conj, const, disj, eq, negate, ref, var
from rotra.system.solver import Satisfiability
from rotra.system.transition import Definition, Part, Variable

MAX_MINDS = 3000
MAX_ROUNDS = 64
# of each of these percepts the car has one at a time: the last argument is a function of the others
FUNCTIONAL = ("speed", "limit", "heading", "drives", "task", "light")
START, RESTLESS = "start", "restless"
# before the first step; not the mind that has given up everything, which gets no initial goals
FIRST = Control(feedback=(-1,))


@dataclass(frozen=True, slots=True)
class Senses:
    """What a driver may sense and do in a scenario: every percept that can occur (sorted), and the fastest move.

    `views`: the sets of percepts that a place shows (`light(1,2,tl)` for light `tl` there), of which one is seen at a time.
    """

    percepts: tuple[Struct, ...]
    top_speed: int
    may_crash: bool
    views: tuple[frozenset[str], ...] = ()
    lights: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Choice:
    """A plan chosen: the definition that says when, the plan, and the reasoning cycle (for the order in a trace)."""

    name: str
    plan: Plan
    cycle: int


@dataclass(frozen=True, slots=True)
class DriverModel:
    """`definitions` still grows while questions about the mind at rest are named; `driver_part` closes it.

    `leaves`: the definition that says when a step ends so, and how it then ends.  `beliefs` may change, `facts` never do.
    """

    variables: tuple[Variable, ...]
    definitions: dict[str, Definition]
    choices: tuple[Choice, ...]
    leaves: tuple[tuple[str, Leaf], ...]
    minds: dict[str, Control]
    acts: tuple[str, ...]
    beliefs: tuple[Struct, ...]
    rest: Mind
    initial_goals: tuple[Struct, ...]
    facts: tuple[Struct, ...]
    suffix: str = ""


def driver_part(model: DriverModel) -> Part:
    return Part(f"driver{model.suffix}", model.variables, tuple(model.definitions.values()))


def legal_act(act: Struct, top_speed: int) -> bool:
    """An act that the world knows, its number of cells in 1..top_speed (design, section 4)."""

    def cells(term: object) -> bool:
        return isinstance(term, int) and 1 <= term <= top_speed

    match act.name, act.args:
        case "wait", ():
            return True
        case "forward", (n,):
            return cells(n)
        case "change_lane" | "turn", (Struct(("left" | "right"), ()), n):
            return cells(n)
    return False


def legal_acts(top_speed: int) -> tuple[str, ...]:
    """Every act there is, `wait` first."""
    sideways = (f"{name}({side},{n})" for name in ("change_lane", "turn") for side in ("left", "right") for n in range(1, top_speed + 1))
    return ("wait", *(f"forward({n})" for n in range(1, top_speed + 1)), *sideways)


def lower_driver(agent: Agent, advice: Iterable[Rule], senses: Senses, suffix: str = "") -> DriverModel:
    """`suffix` keeps two drivers of one product model apart.  Errors: the AG1xx codes of the fragment, as `Rejected`."""
    rules = tuple(advice)
    try:
        return _explored(agent, rules, senses, suffix, _replaced_only(agent))
    except Rejected as refusal:
        if any(d.code != "AG106" for d in refusal.diagnostics):
            raise
        # the order of beliefs matters only where there are several: try to prove that there never are
        return _explored(agent, rules, senses, suffix, _one_at_first(agent))


def _explored(agent: Agent, advice: tuple[Rule, ...], senses: Senses, suffix: str, single: frozenset[Indicator]) -> DriverModel:
    """`single`: the functors of which one belief at most is taken to stand at rest, as long as that proves to be so."""
    known = tuple(sorted({b for b in _initial_beliefs(agent) if indicator(b) in _dynamic(agent)}, key=show))
    for _ in range(MAX_ROUNDS):
        build = _Build(agent, advice, senses, known, single, suffix)
        model = build.run()
        found = tuple(sorted(build.instances, key=show))
        several = build.several() if found == known else frozenset()
        if found == known and not several:
            return model
        known, before = found, known
        single -= several
    worst = max((b for b in known if b not in before), key=lambda b: len(show(b)), default=known[0])
    raise Rejected([problem("AG110", _grown(agent, worst), f"beliefs of the form {worst.name}/{len(worst.args)} grow without end, or to more than {MAX_ROUNDS} values one after the other", "keep the counter inside a bound, as in `N < 4`")])


def _grown(agent: Agent, belief: Struct) -> Origin:
    """The first step that adds such a belief."""
    steps = (s for p in agent.plans for s in steps_of(p.body))
    adding = (s.origin for s in steps if s.kind in ("add", "add_end", "add_new", "update") and isinstance(s.literal, Struct) and indicator(s.literal) == indicator(belief))
    return next(adding, Origin(agent.file, 1))


def _initial_beliefs(agent: Agent) -> Iterator[Struct]:
    return (r.head for r in agent.knowledge if r.body.op == "true")


def _dynamic(agent: Agent) -> frozenset[Indicator]:
    changed: set[Indicator] = set()
    for plan in agent.plans:
        for step in steps_of(plan.body):
            if step.kind in ("add", "add_end", "add_new", "del", "del_new", "update") and isinstance(step.literal, Struct):
                changed.add(indicator(step.literal))
            if step.kind == "internal" and step.name == ".abolish" and isinstance(step.args[0], Struct):
                changed.add(indicator(step.args[0]))
    return frozenset(changed)


def _one_at_first(agent: Agent) -> frozenset[Indicator]:
    """Functors of which at most one belief may stand at rest: so it is at the start; whether it stays so is proved step by step."""
    initial = tuple(_initial_beliefs(agent))
    return frozenset(key for key in _dynamic(agent) if sum(indicator(b) == key for b in initial) <= 1)


def _replaced_only(agent: Agent) -> frozenset[Indicator]:
    """Those of them that no plan adds but by `-+`, which takes the old one away."""
    added = {indicator(s.literal) for p in agent.plans for s in steps_of(p.body) if s.kind in ("add", "add_end", "add_new") and isinstance(s.literal, Struct)}
    return _one_at_first(agent) - added


class _Build:
    """One exploration with a fixed set of possible beliefs; collects what it finds (the only mutable thing here)."""

    def __init__(self, agent: Agent, advice: tuple[Rule, ...], senses: Senses, known: tuple[Struct, ...], single: frozenset[Indicator], suffix: str) -> None:
        self.agent, self.senses, self.known, self.single, self.suffix = agent, senses, known, single, suffix
        self.leaves: list[Leaf] = []
        self.instances = set(known)
        self.definitions: dict[str, Definition] = {}
        self.by_expr: dict[tuple[str, Expr], Expr] = {}
        self.lookup: dict[str, Expr] = {}
        self.solver = Satisfiability(self.lookup)
        self.choices: list[Choice] = []
        self.minds: dict[Control, str] = {}
        self.steps: dict[tuple[object, ...], Step] = {}
        self.plans: dict[tuple[object, ...], Plan] = {}
        self.exclusive()
        rules: dict[Indicator, list[Rule]] = {}
        for rule in (*agent.knowledge, *advice):
            rules.setdefault(indicator(rule.head), []).append(rule)
        percepts: dict[Indicator, list[Struct]] = {}
        for percept in senses.percepts:
            percepts.setdefault(indicator(percept), []).append(percept)
        dynamic = _dynamic(agent)
        by_functor = {k: tuple(v) for k, v in rules.items()}
        self.knowledge = Knowledge(by_functor, {k: tuple(v) for k, v in percepts.items()}, dynamic, self.percept, changing(by_functor, dynamic))
        self.machine = Machine(agent, self.knowledge, self.solver, lambda act: legal_act(act, senses.top_speed), self.name, self.select, {self.belief(b): indicator(b) for b in self.known if indicator(b) in self.single})
        self.current = START

    # ---- names ----------------------------------------------------------------------------------------------------

    def own(self, name: str) -> str:
        return name + self.suffix

    def percept(self, percept: Struct) -> Expr:
        if percept.name in FUNCTIONAL and percept.name != "light" and len(self.alike[indicator(percept)]) == 1:
            return TRUE  # the only one there can be: the driver always senses it
        return ref(f"p:{show(percept)}")

    def exclusive(self) -> None:
        self.alike: dict[Indicator, list[Struct]] = {}
        for percept in self.senses.percepts:
            self.alike.setdefault(indicator(percept), []).append(percept)
        for name in FUNCTIONAL:
            groups: dict[tuple[object, ...], list[Expr]] = {}
            for percept in self.senses.percepts:
                if percept.name == name:
                    groups.setdefault(percept.args[:-1], []).append(self.percept(percept))
            for parts in groups.values():
                self.solver.at_most_one(parts)
                if name != "light":
                    self.solver.assume(disj(*parts))
        watched = {show(p) for op in "-+" for p in self.watched(op)}
        if len(watched) > 1:  # their events come in every combination that is not ruled out here
            self.one_view("now", {show(p): self.percept(p) for p in self.senses.percepts})
            self.one_view("was", {text: self.was(parse_ground(text)) for text in watched})
        for key in self.single:
            self.solver.at_most_one([self.belief(b) for b in self.known if indicator(b) == key])

    def one_view(self, when: str, percepts: Mapping[str, Expr]) -> None:
        """Tell the solver that of the views one at most is seen, what each shows, and that a light has one colour."""
        views = [(var(f"view {when} {n}"), view) for n, view in enumerate(self.senses.views)]
        self.solver.at_most_one(v for v, _ in views)
        colours: dict[str, set[str]] = {}
        for text, seen in percepts.items():
            percept = parse_ground(text)
            if not views or percept.name not in ("road", "stop_line", "light"):
                continue
            if percept.name == "light":
                right, ahead, colour = map(show, percept.args)
                shown = {light: [v for v, view in views if f"light({right},{ahead},{light})" in view] for light in self.senses.lights}
                for light in shown:
                    colours.setdefault(light, set()).add(colour)
                ways = [conj(disj(*places), var(f"shows {when} {light} {colour}")) for light, places in shown.items()]
            else:
                ways = [v for v, view in views if text in view]
            self.solver.assume(disj(negate(seen), *ways))
            self.solver.assume(disj(seen, conj(*map(negate, ways))))
        for light, shades in colours.items():
            self.solver.at_most_one(var(f"shows {when} {light} {colour}") for colour in sorted(shades))

    def belief(self, literal: Struct) -> Expr:
        return var(self.own(f"b:{show(literal)}"))

    def define(self, name: str, expr: Expr, origin: Origin = NOWHERE) -> Expr:
        name = self.own(name)
        assert name not in self.definitions, name
        self.definitions[name] = Definition(name, expr, origin)
        self.lookup[name] = expr
        return ref(name)

    def name(self, literal: Struct, expr: Expr, origin: Origin, prefix: str = "q") -> Expr:
        """A definition for the condition of a ground query, the same one wherever the condition is the same."""
        if expr.op in ("const", "var", "ref") or (expr.op == "not" and expr.args[0].op in ("var", "ref")):
            return expr
        key = (f"{prefix}:{show(literal)}", expr)
        if key not in self.by_expr:
            number = sum(1 for title, _ in self.by_expr if title == key[0])
            title = key[0] if not number else f"{key[0]}#{number + 1}"
            self.by_expr[key] = self.define(title, expr, Origin(origin.file, origin.line, show(literal)))
        return self.by_expr[key]

    def select(self, plan: Plan, guard: Expr, cycle: int) -> Expr:
        number = len(self.choices) + 1
        origin = Origin(plan.origin.file, plan.origin.line, f"plan {plan.title}")
        chosen = self.define(f"take:{number}", guard, origin)
        self.choices.append(Choice(self.own(f"take:{number}"), plan, cycle))
        return chosen

    # ---- exploration ----------------------------------------------------------------------------------------------

    def run(self) -> DriverModel:
        start = FIRST
        self.minds[start] = START
        todo = [start]
        leaves: list[tuple[Expr, Leaf, str]] = []
        at = var(self.own("at"))
        alive = negate(var("crashed")) if self.senses.may_crash else TRUE
        beliefs = {b: self.belief(b) for b in self.known}
        while todo:
            rest = todo.pop(0)
            name = self.minds[rest]
            begin = self.begin(rest, first=name == START)
            root = conj(eq(at, const(name)), alive)
            for leaf in self.machine.step(Moment(begin, root, beliefs)):
                after = self.settled(leaf)
                if after not in self.minds:
                    if len(self.minds) > MAX_MINDS:
                        self.grows(after)
                    self.minds[after] = RESTLESS if leaf.restless else self.title(after)
                    if not leaf.restless:
                        todo.append(after)
                number = len(leaves) + 1
                guard = self.define(f"rest:{number}", leaf.guard, self.ending(leaf))
                leaves.append((guard, leaf, self.minds[after]))
                self.instances.update(leaf.beliefs)
                self.leaves.append(leaf)
        return self.model(at, alive, leaves)

    def several(self) -> frozenset[Indicator]:
        """The functors taken to be single of which a step may end with two beliefs (induction: they were single before it)."""
        wrong: set[Indicator] = set()
        for leaf in self.leaves:
            held: dict[Indicator, list[Expr]] = {}
            for belief, condition in leaf.beliefs.items():
                if condition is not FALSE and indicator(belief) in self.single:
                    held.setdefault(indicator(belief), []).append(condition)
            for key, conditions in held.items():
                pairs = ((a, b) for i, a in enumerate(conditions) for b in conditions[i + 1 :])
                if key not in wrong and any(self.solver.possible(conj(leaf.guard, a, b)) for a, b in pairs):
                    wrong.add(key)
        return frozenset(wrong)

    def ending(self, leaf: Leaf) -> Origin:
        """What a step ended with: the line of the act, or of the agent where it asked for none."""
        if not leaf.control.acts:
            return Origin(self.agent.file, 0, "no act")
        act, origin = leaf.control.acts[0]
        return Origin(origin.file, origin.line, f"act {show(act)}")

    def begin(self, rest: Control, first: bool) -> Control:
        """The control at the start of a step: last step's acts have their results, percept events are queued."""
        rest = Control() if first else rest
        events = list(rest.events)
        if first:
            # Jason adds what it finds at the start from the last to the first
            events += [Event("+", "belief", b) for b in reversed(tuple(_initial_beliefs(self.agent))) if self.machine.candidates("+", "belief", b)]
            events += [Event("+", "achieve", goal) for goal, _ in self.agent.goals]
        for op in "-+":
            for percept in self.watched(op):
                now, was = self.percept(percept), self.was(percept)
                events.append(Event(op, "belief", percept, None, conj(now, negate(was)) if op == "+" else conj(was, negate(now))))
        if len(events) > MAX_EVENTS:
            patterns = [p for p in self.agent.plans if p.trigger.type == "belief"]
            raise Rejected([problem("AG109", patterns[0].origin, f"up to {len(events)} events wait at the beginning of a step; at most {MAX_EVENTS} can be followed", "react to fewer changes, or read the percept in a context")])
        return replace(rest, old=rest.pending, pending=(), feedback=tuple(p.asked for p in rest.pending), events=tuple(e for e in events if e.present is not FALSE))

    def watched(self, op: str) -> list[Struct]:
        """The percepts whose coming (+) or going (-) some plan waits for, in the order of their events."""
        patterns = [p.trigger.literal for p in self.agent.plans if p.trigger.type == "belief" and p.trigger.op == op]
        return [s for s in self.senses.percepts if any(unify(p, s, {}) is not None for p in patterns)]

    def was(self, percept: Struct) -> Expr:
        return var(self.own(f"was:{show(percept)}"))

    def settled(self, leaf: Leaf) -> Control:
        """The part of a mind at rest that lasts, in normal form (decisions: equal futures, equal names)."""
        if leaf.restless:
            return Control(suspended=True)
        c = leaf.control
        pending = [self.waiting(p, i) for i, p in enumerate(c.pending)]
        atomic = next((n.stack for n, p in zip(pending, c.pending, strict=True) if c.atomic is p.stack), None) if c.atomic else None
        return Control(events=c.events, pending=tuple(pending), atomic=atomic, suspended=c.suspended)

    def waiting(self, p: Pending, position: int) -> Pending:
        if p.asked == 0 and legal_act(p.act, self.senses.top_speed):
            return Pending(self.shared(self.normal(self.machine.trimmed(advance(p.stack)))), DONE, 0)
        return Pending(self.shared(self.normal(p.stack)), Struct("refused"), 0 if p.asked == 0 else position + 1)

    def shared(self, stack: Stack) -> Stack:
        """The same stack with bodies that do the same made one: minds with equal futures get one name."""
        frames = []
        for f in stack:
            body = tuple(self.steps.setdefault(step_key(s), s) for s in f.body)
            plan = self.plans.setdefault((f.op, f.type, indicator(f.literal), f.plan.atomic, body), f.plan)
            frames.append(replace(f, body=body, plan=plan))
        return tuple(frames)

    def normal(self, stack: Stack) -> Stack:
        """Cut out repeated frames that can only fall through: same trigger, nothing left to do, no result wanted.

        Harmless because every frame from the first to the second occurrence is spent: after a success each is popped at
        once, after a failure the handler found above leads to the same frame below (design, section 6).
        """

        def spent(i: int) -> bool:
            f = stack[i]
            if f.returns:
                return False
            return failed(i) or (len(f.body) == 1 and f.body[0].kind == "achieve")

        def failed(i: int) -> bool:
            """Under a handler, and not below the goal that it handles: gone as soon as the handler is done."""
            for j in range(i + 1, len(stack)):
                if stack[j].op == "-" and stack[j].is_goal:
                    goal = next((k for k in range(j - 1, -1, -1) if stack[k].op == "+" and stack[k].literal == stack[j].literal), j)
                    if goal <= i:
                        return True
            return False

        def same(a: Frame, b: Frame) -> bool:
            return (a.op, a.type, a.literal) == (b.op, b.type, b.literal)

        for j in range(len(stack)):
            for i in range(len(stack) - 2, j, -1):
                if same(stack[i], stack[j]) and all(spent(k) for k in range(j, i + 1)):
                    cut = (*stack[: j + 1], *stack[i + 1 :])
                    if all(any(same(f, g) for g in cut) for f in stack[j + 1 : i + 1]):
                        return self.normal(cut)
        return stack

    def title(self, rest: Control) -> str:
        """A readable name: the goal that waits and its line; `idle` where no intention is left."""
        if not rest.pending:
            base = "idle"
        else:
            stack = rest.pending[0].stack
            goals = [f.literal.name for f in stack]
            base = re.sub(r"\W+", "_", f"{'_'.join(goals[-3:])}_{stack[-1].plan.origin.line}").strip("_")
        taken = set(self.minds.values())
        return next(n for n in (base, *(f"{base}__{i}" for i in range(2, MAX_MINDS + 3))) if n not in taken)

    def grows(self, rest: Control) -> None:
        frame = rest.pending[0].stack[-1] if rest.pending else None
        place = frame.plan.origin if frame else Origin(self.agent.file, 1)
        what = f"plan {frame.plan.title}" if frame else "the agent"
        raise Rejected([problem("AG110", place, f"{what} leads to more than {MAX_MINDS} different minds", "bound the numbers that its goals carry")])

    # ---- the part -------------------------------------------------------------------------------------------------

    def model(self, at: Expr, alive: Expr, leaves: list[tuple[Expr, Leaf, str]]) -> DriverModel:
        def by_leaf(value: object, otherwise: Expr) -> Expr:
            # leaves are exclusive, so equal values are one case
            cases: dict[Expr, list[Expr]] = {}
            for guard, leaf, name in leaves:
                cases.setdefault(value(leaf, name), []).append(guard)  # type: ignore[operator]
            return choose(*((disj(*guards), v) for v, guards in cases.items() if v is not otherwise), (TRUE, otherwise))

        def act(leaf: Leaf, _: str) -> Expr:
            first = leaf.control.acts[0][0] if leaf.control.acts else Struct("wait")
            return const(show(first) if legal_act(first, self.senses.top_speed) else "wait")

        acts = {str(act(leaf, "").args[0]) for _, leaf, _ in leaves} | {"wait"}
        self.define("act", by_leaf(act, const("wait")))
        self.define("at_rest", by_leaf(lambda _, name: const(name), at))
        now: dict[Struct, Expr] = {}
        variables = [Variable(self.own("at"), tuple(sorted({*self.minds.values(), START, RESTLESS})), (START,), ref(self.own("at_rest")))]
        initial = frozenset(_initial_beliefs(self.agent))
        for belief in sorted(self.instances, key=show):
            old = self.belief(belief)
            value = by_leaf(lambda leaf, _, b=belief, o=old: leaf.beliefs.get(b, FALSE), old)
            now[belief] = self.define(f"now:{show(belief)}", value)
            variables.append(Variable(self.own(f"b:{show(belief)}"), (False, True), (belief in initial,), now[belief]))
        watched = sorted({*self.watched("+"), *self.watched("-")}, key=order)
        for percept in watched:
            name = self.own(f"was:{show(percept)}")
            variables.append(Variable(name, (False, True), (False,), choose((alive, self.percept(percept)), (TRUE, var(name)))))
        self.define("busy", disj(*(g for g, leaf, _ in leaves if len(leaf.control.acts) > 1)))
        self.define("restless", disj(eq(at, const(RESTLESS)) if RESTLESS in self.minds.values() else FALSE, *(g for g, leaf, _ in leaves if leaf.restless)))
        minds = {name: rest for rest, name in self.minds.items()}
        rest = Mind(self.knowledge, now, lambda desired: self.goals_at_rest(minds, desired), lambda lit, e, o: self.name(lit, e, o, "rest"), Origin(self.agent.file, 1))
        goals = tuple(goal for goal, _ in self.agent.goals)
        self.define("main_goal", conj(*(disj(*(g for found, g in self.goals_at_rest(minds, True) if found == goal)) for goal in goals)))
        return DriverModel(
            tuple(variables), self.definitions, tuple(self.choices), tuple((guard.args[0], leaf) for guard, leaf, _ in leaves),
            minds, tuple(sorted(acts)), tuple(sorted(self.instances, key=show)), rest, goals,
            tuple(b for b in dict.fromkeys(_initial_beliefs(self.agent)) if b not in self.instances), self.suffix,
        )

    def goals_at_rest(self, minds: dict[str, Control], desired: bool) -> list[tuple[Struct, Expr]]:
        found: dict[Struct, set[Value]] = {}
        for name, control in minds.items():
            for pending in control.pending:
                for frame in pending.stack:
                    if frame.op == "+" and frame.type == "achieve" and is_ground(frame.literal):
                        found.setdefault(frame.literal, set()).add(name)
            if desired:
                for event in control.events:
                    if event.op == "+" and event.type == "achieve":
                        found.setdefault(event.literal, set()).add(name)
        return [(goal, among(ref(self.own("at_rest")), names)) for goal, names in sorted(found.items(), key=lambda f: show(f[0]))]
