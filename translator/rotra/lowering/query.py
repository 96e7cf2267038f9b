"""Answer a logical formula symbolically: every substitution that may satisfy it, with the condition under which it does.

    light(0,A,red) & A > 0      ->  ({A: 1}, p:light(0,1,red)), ({A: 2}, p:light(0,2,red)), ...

In: Formula, a substitution, `Mind` (what is believed under which condition).  Out: `Solution`s in Jason's order.
Left to others: which solution is taken and what then happens (mind.py).  Source of the order: Jason's belief base keeps
initial beliefs and rules in source order; percepts are sorted (design, section 4); run-time beliefs are newest first,
which no symbolic condition knows, so those solutions are marked `unordered`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import count

from rotra.diagnostics import Rejected, problem
from rotra.frontends.agent import Formula, Rule
from rotra.frontends.terms import (
    Items,
    Struct,
    Substitution,
    Sum,
    Term,
    Text,
    Var,
    apart,
    is_ground,
    order,
    rename,
    resolve,
    show,
    unify,
    variables,
    walk_to,
)
from rotra.origins import NOWHERE, Origin
from rotra.system.expr import FALSE, TRUE, Expr, conj, disj, negate

Indicator = tuple[str, int]
MAX_DEPTH = 60


def indicator(literal: Struct) -> Indicator:
    return literal.name, len(literal.args)


@dataclass(frozen=True, slots=True)
class Solution:
    bound: Substitution
    guard: Expr
    unordered: frozenset[Struct] = frozenset()
    origin: Origin = NOWHERE  # the rule by which it was found


@dataclass(frozen=True, slots=True)
class Knowledge:
    """What never changes: the rules and initial facts by functor, the percepts that can occur, the functors that change.

    `changing`: the answers of these depend on more than percepts.  `answers` keeps what was found once, for the next mind.
    """

    rules: Mapping[Indicator, tuple[Rule, ...]]
    percepts: Mapping[Indicator, tuple[Struct, ...]]
    dynamic: frozenset[Indicator]
    percept: Callable[[Struct], Expr]
    changing: frozenset[Indicator]
    answers: dict[object, tuple[Solution, ...]] = field(default_factory=dict)
    index: dict[tuple[Indicator, int], dict[Term | None, list[Rule]]] = field(default_factory=dict)
    fresh: Iterator[int] = field(default_factory=count)


@dataclass(slots=True)
class Mind:
    """The symbolic mind at one moment: own beliefs under their conditions, and the goals that stand.

    `goals(pattern, desired)` yields (goal literal, condition); `name(literal, expr, origin)` may give a shared name to the
    condition of a ground query.  `memo` belongs to this moment alone, as does `state`: all that an answer may depend on.
    """

    knowledge: Knowledge
    beliefs: Mapping[Struct, Expr]
    goals: Callable[[bool], Iterable[tuple[Struct, Expr]]]
    name: Callable[[Struct, Expr, Origin], Expr]
    at: Origin
    memo: dict[Struct, Expr] = field(default_factory=dict)
    state: object = None


def solve(formula: Formula, bound: Substitution, mind: Mind, depth: int = 0) -> Iterator[Solution]:
    """All solutions in order.  Errors: AG104 a variable without a value where one is needed; AG107 recursion in rules."""
    match formula.op:
        case "true":
            yield Solution(bound, TRUE)
        case "false":
            return
        case "and":
            left, right = formula.args
            for first in solve(left, bound, mind, depth):
                for second in solve(right, first.bound, mind, depth):
                    guard = conj(first.guard, second.guard)
                    if guard is not FALSE:
                        yield Solution(second.bound, guard, first.unordered | second.unordered)
        case "or":
            for part in formula.args:
                yield from solve(part, bound, mind, depth)
        case "not":
            guard = negate(disj(*(s.guard for s in solve(formula.args[0], bound, mind, depth))))
            if guard is not FALSE:
                yield Solution(bound, guard)
        case "rel":
            yield from _relation(formula, bound, mind)
        case "internal":
            yield from internal(formula.name, formula.args, bound, mind, depth)
        case "lit":
            yield from _literal(formula.args[0], bound, mind, depth)


def _literal(literal: Term, bound: Substitution, mind: Mind, depth: int) -> Iterator[Solution]:
    if depth > MAX_DEPTH:
        raise Rejected([problem("AG107", mind.at, f"the rules for {show(literal)} call each other without end", "write rules without recursion")])
    asked = resolve(literal, bound)
    if not isinstance(asked, Struct):
        raise Rejected([problem("AG104", mind.at, f"variable {show(asked)} stands for a whole query", "name the belief that is asked for")])
    rules = mind.knowledge.rules.get(indicator(asked), ())
    if is_ground(asked) and any(r.body.op != "true" for r in rules):
        if asked not in mind.memo:
            answers = _answers(asked, mind, depth)
            mind.memo[asked] = mind.name(asked, disj(*(s.guard for s in answers)), _together(s.origin for s in answers))
        if mind.memo[asked] is not FALSE:
            yield Solution(bound, mind.memo[asked])
        return
    for found in _answers(asked, mind, depth):
        yield Solution({**bound, **found.bound}, found.guard, found.unordered)


def _answers(asked: Struct, mind: Mind, depth: int) -> tuple[Solution, ...]:
    """All solutions of a query in which every known variable is replaced; each binds the others and no more."""
    knowledge = mind.knowledge
    steady = indicator(asked) not in knowledge.changing
    if not steady and mind.state is None:
        mind.state = (frozenset(mind.beliefs.items()), tuple(mind.goals(False)), tuple(mind.goals(True)))
    key = (asked, None if steady else mind.state)
    if key not in knowledge.answers:
        knowledge.answers[key] = tuple(_candidates(asked, {}, mind, depth))
    return knowledge.answers[key]


def changing(rules: Mapping[Indicator, tuple[Rule, ...]], dynamic: frozenset[Indicator]) -> frozenset[Indicator]:
    """The functors in whose answers a belief that changes or a goal has a part."""
    needs = {key: {n for r in group for n in _needs(r.body)} for key, group in rules.items()}
    found = {*dynamic, _MIND}
    while True:
        more = {key for key, needed in needs.items() if needed & found} - found
        if not more:
            return frozenset(found)
        found |= more


# stands for what is asked of the mind itself, by `.intend` and the like
_MIND: Indicator = (".mind", 0)


def _needs(formula: Formula) -> Iterator[Indicator]:
    if formula.op == "internal":
        yield _MIND
    for part in formula.args:
        if isinstance(part, Formula):
            yield from _needs(part)
        elif formula.op == "lit":
            yield indicator(part) if isinstance(part, Struct) else _MIND


def _candidates(asked: Struct, bound: Substitution, mind: Mind, depth: int) -> Iterator[Solution]:
    knowledge, key = mind.knowledge, indicator(asked)
    if key in knowledge.dynamic:
        held = [(b, g) for b, g in mind.beliefs.items() if indicator(b) == key and g is not FALSE]
        for belief, guard in sorted(held, key=lambda h: order(h[0])):
            extended = unify(asked, belief, bound)
            if extended is not None:
                yield Solution(extended, guard, frozenset([belief]) if len(held) > 1 and not is_ground(asked) else frozenset())
    for percept in knowledge.percepts.get(key, ()):
        extended = None if apart(asked, percept) else unify(asked, percept, bound)
        if extended is not None:
            yield Solution(extended, knowledge.percept(percept))
    for rule in _fitting(asked, knowledge):
        if apart(asked, rule.head):
            continue
        if rule.body.op == "true":
            if key not in knowledge.dynamic:
                extended = unify(asked, rule.head, bound)
                if extended is not None:
                    yield Solution(extended, TRUE)
            continue
        suffix = f"~{next(knowledge.fresh)}"
        inside = unify(rename(rule.head, suffix), asked, {})
        if inside is None:
            continue
        outer = sorted(variables(asked))
        for found in solve(_renamed(rule.body, suffix), inside, mind, depth + 1):
            extended = dict(bound)
            for name in outer:
                value = resolve(Var(name), found.bound)
                if not isinstance(value, Var):
                    extended[name] = value
            yield Solution(extended, found.guard, found.unordered, rule.origin)


def _together(origins: Iterable[Origin]) -> Origin:
    """One place that names them all."""
    places = list(dict.fromkeys(o for o in origins if o is not NOWHERE))
    if len(places) == 1:
        return places[0]
    return Origin(" and ".join(f"{o.what} {o.file}:{o.line}".strip() for o in places))


def _fitting(asked: Struct, knowledge: Knowledge) -> Iterable[Rule]:
    """The rules that may answer, in order: by the argument that leaves the fewest."""
    key = indicator(asked)
    fewest: Iterable[Rule] = knowledge.rules.get(key, ())
    count = len(knowledge.rules.get(key, ()))
    for position, argument in enumerate(asked.args):
        if not _plain(argument):
            continue
        if (key, position) not in knowledge.index:
            knowledge.index[key, position] = _by_argument(knowledge.rules.get(key, ()), position)
        values = knowledge.index[key, position]
        found = values.get(argument, values[None])
        if len(found) < count:
            fewest, count = found, len(found)
    return fewest


def _by_argument(rules: Iterable[Rule], position: int) -> dict[Term | None, list[Rule]]:
    """Value -> the rules whose head may have it there; under None those that may have any."""
    values: dict[Term | None, list[Rule]] = {None: []}
    for rule in rules:
        argument = rule.head.args[position]
        if not _plain(argument):
            for found in values.values():
                found.append(rule)
        else:
            values.setdefault(argument, list(values[None])).append(rule)
    return values


def _plain(term: Term) -> bool:
    """Is it an atom, a number or a text, equal to nothing but itself?"""
    return isinstance(term, int | Text) or (isinstance(term, Struct) and not term.args)


def _renamed(formula: Formula, suffix: str) -> Formula:
    parts = tuple(_renamed(a, suffix) if isinstance(a, Formula) else rename(a, suffix) for a in formula.args)
    return Formula(formula.op, parts, formula.name)


def _number(term: Term, bound: Substitution, mind: Mind) -> Term:
    value = resolve(term, bound)
    if isinstance(value, Var | Sum):
        name = show(term).split("~")[0]
        raise Rejected([problem("AG104", mind.at, f"variable {name} has no finite domain", "bind it first, to a percept or a belief, as in `speed(S) & S < 3`")])
    return value


def _relation(formula: Formula, bound: Substitution, mind: Mind) -> Iterator[Solution]:
    left, right = formula.args
    match formula.name:
        case "=":
            if isinstance(left, Sum):
                left = _number(left, bound, mind)
            if isinstance(right, Sum):
                right = _number(right, bound, mind)
            extended = unify(left, right, bound)
            if extended is not None:
                yield Solution(extended, TRUE)
            return
        case "==" | "\\==" | "!=":
            same = resolve(left, bound) == resolve(right, bound)
            if same == (formula.name == "=="):
                yield Solution(bound, TRUE)
            return
    a, b = order(_number(left, bound, mind)), order(_number(right, bound, mind))
    if {"<": a < b, "<=": a <= b, ">": a > b, ">=": a >= b}[formula.name]:
        yield Solution(bound, TRUE)


IGNORED_ACTIONS = frozenset({".print", ".println", ".log"})
QUERY_ACTIONS = frozenset({".intend", ".desire", ".member", ".count", ".ground"})


def internal(name: str, args: tuple[Term, ...], bound: Substitution, mind: Mind, depth: int) -> Iterator[Solution]:
    """The internal actions that ask something; the ones that only print are true."""
    if name in IGNORED_ACTIONS:
        yield Solution(bound, TRUE)
    elif name in (".intend", ".desire"):
        for goal, guard in mind.goals(name == ".desire"):
            extended = unify(args[0], goal, bound)
            if extended is not None and guard is not FALSE:
                yield Solution(extended, guard)
    elif name == ".member":
        items = walk_to(args[1], bound)
        if not isinstance(items, Items):
            raise Rejected([problem("AG104", mind.at, f"{show(args[1])} is not a list of fixed length", "write the list out")])
        for item in items.items:
            extended = unify(args[0], item, bound)
            if extended is not None:
                yield Solution(extended, TRUE)
    elif name == ".ground":
        if is_ground(resolve(args[0], bound)):
            yield Solution(bound, TRUE)
    elif name == ".count":
        guards = [s.guard for s in solve(Formula("lit", (args[0],)), bound, mind, depth)]
        for total, guard in enumerate(_exactly(guards)):
            extended = unify(args[1], total, bound)
            if extended is not None and guard is not FALSE:
                yield Solution(extended, guard)
    else:
        raise AssertionError(f"internal action {name} passed the fragment check")


def _exactly(guards: list[Expr]) -> list[Expr]:
    """result[n]: exactly n of the guards hold."""
    result = [TRUE]
    for guard in guards:
        longer = [*result, FALSE]
        result = [disj(conj(guard, longer[n - 1] if n else FALSE), conj(negate(guard), longer[n])) for n in range(len(longer))]
    return result


def holds(formula: Formula, bound: Substitution, mind: Mind) -> Expr:
    """The condition under which the formula has a solution."""
    return disj(*(s.guard for s in solve(formula, bound, mind)))
