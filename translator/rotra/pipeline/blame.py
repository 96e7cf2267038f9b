"""Which act would not have gone against a directive, read off the percepts of a trace step.

    stop_at_white_line contradicted by forward(N) when stop_line(0, A) where N > A
    percepts stop_line(0,0), limit(2)   ->   wait

In: a rule base, a trace step, an action.  Out: an act, None where the meaning of the action does not tell.
Left to others: words (explain.py); whether a directive was ignored, which the trace says.  The conditions are those of
`directives.yaml`, well formed as frontends/meaning.py has found.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import takewhile
from typing import Any

from rotra.frontends.rules import Contradiction, RuleBase
from rotra.frontends.terms import Struct, Substitution, Sum, Term, Var, compute, parse_ground, resolve

_TOKEN = re.compile(r"\s*(\d+|[A-Za-z_][A-Za-z0-9_]*|==|\\==|<=|>=|[-+*(),&|<>=])")
_ORDER: dict[str, Callable[[Any, Any], bool]] = {"<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge}
_RELATIONS = frozenset({*_ORDER, "=", "==", "\\=="})
# a step without `limit` comes from a world that has none in sight: one cell is always a legal act
_LIMIT = 1


def better_act(base: RuleBase) -> Callable[[Mapping[str, Any], str], str | None]:
    """For `explain`: the act that goes against the fewest musts, then the fewest shoulds, and not against the action."""
    against = {m.action: m.contradicted_by for m in base.meanings}
    ranks = list(base.ontology.labels)

    def better(step: Mapping[str, Any], action: str) -> str | None:
        if not against.get(action):
            return None
        percepts = _facts(step)
        fit = [act for act in _acts(percepts) if not contradicts(act, against[action], percepts)]

        def cost(act: str) -> list[int]:
            broken = [d["label"] for d in step.get("advice", []) if contradicts(act, against.get(d["action"], ()), percepts)]
            return [broken.count(label) for label in ranks]

        return min(fit, key=cost, default=None)

    return better


def act_contradicts(base: RuleBase, step: Mapping[str, Any], act: str, action: str) -> bool:
    """Does the act go against the action in this step, by what the rule base says it means?"""
    meaning = base.meaning(action)
    return meaning is not None and contradicts(act, meaning.contradicted_by, _facts(step))


def contradicts(act: str, meanings: Sequence[Contradiction], percepts: Sequence[Struct]) -> bool:
    """Does the act go against an action of these meanings, with these percepts?"""
    done = parse_ground(act)
    for meaning in meanings:
        start = _unify(_Reader(meaning.act).term(), done, {})
        if start is None:
            continue
        condition = ("and", *(_Reader(text).formula() for text in (meaning.when, meaning.where) if text))
        if next(_solve(condition, start, percepts), None) is not None:
            return True
    return False


def _facts(step: Mapping[str, Any]) -> tuple[Struct, ...]:
    found = []
    for text in step.get("percepts", []):
        try:
            found.append(parse_ground(text))
        except (ValueError, IndexError):
            continue
    return tuple(found)


def _acts(percepts: Sequence[Struct]) -> Iterator[str]:
    """Acts to choose from: to stand, or to drive over cells ahead that are seen to be free road, within the limit."""
    yield "wait"
    limit = next((p.args[0] for p in percepts if p.name == "limit" and p.args), _LIMIT)
    known = set(percepts)

    def free(n: int) -> bool:
        return Struct("road", (0, n, Struct("ahead"))) in known and Struct("car", (0, n)) not in known

    if isinstance(limit, int):
        yield from (f"forward({n})" for n in takewhile(free, range(1, limit + 1)))


class _Reader:
    """A condition as nested tuples: (and|or, f, ..), (not, f), (rel, op, left, right), (lit, term), (true,), (false,)."""

    def __init__(self, text: str) -> None:
        self.tokens = _TOKEN.findall(text)
        self.at = 0
        self.unnamed = 0

    def peek(self, ahead: int = 0) -> str:
        return self.tokens[self.at + ahead] if self.at + ahead < len(self.tokens) else ""

    def take(self) -> str:
        self.at += 1
        return str(self.tokens[self.at - 1])

    def formula(self) -> tuple[Any, ...]:
        parts = [self.both()]
        while self.peek() == "|":
            self.take()
            parts.append(self.both())
        return parts[0] if len(parts) == 1 else ("or", *parts)

    def both(self) -> tuple[Any, ...]:
        parts = [self.condition()]
        while self.peek() == "&":
            self.take()
            parts.append(self.condition())
        return parts[0] if len(parts) == 1 else ("and", *parts)

    def condition(self) -> tuple[Any, ...]:
        if self.peek() == "not":
            self.take()
            return ("not", self.condition())
        if self.peek() in ("true", "false"):
            return (self.take(),)
        if self.peek() == "(" and not self._sum_in_brackets():
            self.take()
            inside = self.formula()
            self.take()
            return inside
        left = self.sum()
        return ("rel", self.take(), left, self.sum()) if self.peek() in _RELATIONS else ("lit", left)

    def _sum_in_brackets(self) -> bool:
        """Does the bracket that opens here belong to a sum of a comparison?"""
        depth, n = 0, 0
        while self.peek(n):
            depth += {"(": 1, ")": -1}.get(self.peek(n), 0)
            n += 1
            if depth == 0:
                break
        return self.peek(n) in _RELATIONS or self.peek(n) in ("+", "-", "*", "div", "mod")

    def sum(self) -> Term:
        left = self.product()
        while self.peek() in ("+", "-"):
            left = Sum(self.take(), (left, self.product()))
        return left

    def product(self) -> Term:
        left = self.term()
        while self.peek() in ("*", "div", "mod"):
            left = Sum(self.take(), (left, self.term()))
        return left

    def term(self) -> Term:
        token = self.take()
        if token == "-":
            return Sum("-", (self.term(),))
        if token == "(":
            inside = self.sum()
            self.take()
            return inside
        if token.isdigit():
            return int(token)
        if token == "_":
            self.unnamed += 1
            return Var(f"_{self.unnamed}")
        if token[0].isupper() or token[0] == "_":
            return Var(token)
        args: list[Term] = []
        if self.peek() == "(":
            while self.peek() != ")":
                self.take()
                args.append(self.sum())
            self.take()
        return Struct(token, tuple(args))


def _value(term: Term, bound: Substitution) -> Term:
    found = resolve(term, bound)
    return compute(found) if isinstance(found, Sum) else found


def _solve(f: tuple[Any, ...], bound: Substitution, percepts: Sequence[Struct]) -> Iterator[Substitution]:
    match f:
        case ("true",) | ("and",):
            yield bound
        case ("and", first, *rest):
            for found in _solve(first, bound, percepts):
                yield from _solve(("and", *rest), found, percepts)
        case ("or", *parts):
            for part in parts:
                yield from _solve(part, bound, percepts)
        case ("not", part):
            if next(_solve(part, bound, percepts), None) is None:
                yield bound
        case ("lit", literal):
            for percept in percepts:
                if (unified := _unify(literal, percept, bound)) is not None:
                    yield unified
        case ("rel", op, left, right):
            yield from _compare(op, _value(left, bound), _value(right, bound), bound)


def _compare(op: str, a: Term, b: Term, bound: Substitution) -> Iterator[Substitution]:
    if op == "=":
        if (unified := _unify(a, b, bound)) is not None:
            yield unified
    elif op in ("==", "\\=="):
        if (a == b) == (op == "=="):
            yield bound
    elif isinstance(a, int | float) and isinstance(b, int | float) and _ORDER[op](a, b):
        yield bound


def _unify(a: Term, b: Term, bound: Substitution) -> Substitution | None:
    a, b = _value(a, bound), _value(b, bound)
    if a == b:
        return bound
    if isinstance(a, Var):
        return {**bound, a.name: b}
    if isinstance(b, Var):
        return {**bound, b.name: a}
    if isinstance(a, Struct) and isinstance(b, Struct) and a.name == b.name and len(a.args) == len(b.args):
        result: Substitution | None = bound
        for x, y in zip(a.args, b.args, strict=True):
            result = _unify(x, y, result) if result is not None else None
        return result
    return None
