"""Bind the formula of a property to a model: words become expressions, `forall` is written out, time stays.

    always (percept(stop_line(0,_)) implies does(wait))   ->   always State(...)

In: Formula, the vocabulary of a model (words.py).  Out: `Bound`, or `Impossible` with the reason.  Left to others: which
engine checks it.  Source of the vacuity conditions: design, section 7.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rotra.frontends.properties import Formula
from rotra.frontends.terms import Struct, Sum, Term, Var, resolve, show
from rotra.system.expr import FALSE, TRUE, Expr, arithmetic, conj, const, disj, eq, iff, implies, negate


@dataclass(frozen=True, slots=True)
class Impossible:
    """A known word that can never be true here."""

    reason: str


@dataclass(frozen=True, slots=True)
class State:
    """Something about one moment."""

    expr: Expr


@dataclass(frozen=True, slots=True)
class Temporal:
    """op: always eventually next until historically once previously since not and or implies iff."""

    op: str
    args: tuple[Bound, ...]


Bound = State | Temporal
_LTL = {"always": "G", "eventually": "F", "next": "X", "historically": "H", "once": "O", "previously": "Y", "until": "U", "since": "S", "and": "&", "or": "|", "implies": "->", "iff": "<->", "not": "!"}


def bind(formula: Formula, words: Any) -> Bound | Impossible:
    """The formula over the model.  `Impossible` where all of it rests on words that cannot be true here."""
    reasons: list[str] = []
    bound = _bind(formula, {}, words, reasons)
    if reasons and isinstance(bound, State) and bound.expr in (TRUE, FALSE):
        return Impossible("; ".join(dict.fromkeys(reasons)))
    if reasons and isinstance(bound, Temporal) and all(e in (TRUE, FALSE) for e in expressions(bound)):
        return Impossible("; ".join(dict.fromkeys(reasons)))
    return bound


def _bind(formula: Formula, given: Mapping[str, Term], words: Any, reasons: list[str]) -> Bound:
    match formula.op:
        case "forall":
            name, domain, inner = formula.args
            values = members(domain, words)
            if not values:
                reasons.append(f"there are no {domain} here")
            return _combine("and", [_bind(inner, {**given, name: value}, words, reasons) for value in values])
        case "compare":
            relation, left, right = formula.args
            return State(_compare(relation, _number(left, given, words, reasons), _number(right, given, words, reasons)))
        case "atom":
            answer = _ask(formula.args[0], [resolve(_any(t), given) for t in formula.args[1:]], words)
            if isinstance(answer, Impossible):
                reasons.append(answer.reason)
                return State(FALSE)
            return State(answer)
    return _combine(formula.op, [_bind(part, given, words, reasons) for part in formula.args])


def _combine(op: str, parts: Sequence[Bound]) -> Bound:
    if op in ("not", "and", "or", "implies", "iff") and all(isinstance(p, State) for p in parts):
        values = [p.expr for p in parts if isinstance(p, State)]
        match op:
            case "not":
                return State(negate(values[0]))
            case "and":
                return State(conj(*values))
            case "or":
                return State(disj(*values))
            case "implies":
                return State(implies(*values))
        return State(iff(*values))
    return Temporal(op, tuple(parts))


_fresh = iter(range(10**12))


def _any(term: Term) -> Term:
    """Every `_` a variable of its own."""
    if isinstance(term, Var) and term.name == "_":
        return Var(f"_{next(_fresh)}")
    if isinstance(term, Struct):
        return Struct(term.name, tuple(map(_any, term.args)), term.negated)
    return term


def members(domain: Any, words: Any) -> list[Term]:
    if not isinstance(domain, str):
        return list(domain)
    if domain == "cars":
        return [Struct(c.name) for c in words.scenario.traffic]
    if domain == "lights":
        return [Struct(x.name) for x in words.scenario.lights]
    if domain == "beliefs":
        return [t for t, _ in words.adviser.solutions("believes", Var("Any"))]
    if domain == "intentions":
        return [t for t, _ in words.adviser.solutions("intends", Var("Any"))]
    return [Struct(a) for a in dict.fromkeys(d.action for d in words.adviser.directives)]


def _ask(word: str, terms: list[Term], words: Any) -> Expr | Impossible:
    if word == "ignored":
        result = words.ignored(terms[0], terms[1] if len(terms) > 1 else None)
    elif word in ("belief", "goal", "does", "percept") and not isinstance(terms[0], Struct):
        return Impossible(f"{word}({show(terms[0])}) names nothing")
    else:
        result = getattr(words, word)(*terms)
    assert isinstance(result, Expr | Impossible)
    return result


def _number(term: Term, given: Mapping[str, Term], words: Any, reasons: list[str]) -> Expr | None:
    value = resolve(term, given) if not isinstance(term, Sum) else term
    if isinstance(value, int):
        return const(value)
    if isinstance(value, Sum):
        left, right = (_number(a, given, words, reasons) for a in value.args)
        return None if left is None or right is None else arithmetic("add" if value.op == "+" else "sub", left, right)
    if isinstance(value, Struct):
        answer = words.number(value.name)
        if isinstance(answer, Impossible):
            reasons.append(answer.reason)
            return None
        assert isinstance(answer, Expr)
        return answer
    reasons.append(f"{show(value)} has no value")
    return None


def _compare(relation: str, left: Expr | None, right: Expr | None) -> Expr:
    if left is None or right is None:
        return FALSE
    match relation:
        case "=":
            return eq(left, right)
        case "!=":
            return negate(eq(left, right))
        case "<":
            return arithmetic("lt", left, right)
        case "<=":
            return arithmetic("le", left, right)
        case ">":
            return arithmetic("lt", right, left)
    return arithmetic("le", right, left)


def expressions(bound: Bound) -> list[Expr]:
    if isinstance(bound, State):
        return [bound.expr]
    return [e for part in bound.args for e in expressions(part)]


def is_invariant(bound: Bound) -> Expr | None:
    """The state formula of `always p`, also where several are joined by `and` (a forall written out)."""
    if isinstance(bound, Temporal) and bound.op == "always" and isinstance(bound.args[0], State):
        return bound.args[0].expr
    if isinstance(bound, Temporal) and bound.op == "and":
        parts = [is_invariant(p) for p in bound.args]
        if all(p is not None for p in parts):
            return conj(*(p for p in parts if p is not None))
    return None


def promised(bound: Bound) -> Expr | None:
    """What must come about at last: b of `eventually b`, `always eventually b`, `always (a implies eventually b)`."""
    if isinstance(bound, Temporal) and bound.op == "always":
        bound = bound.args[0]
        if isinstance(bound, Temporal) and bound.op == "implies" and isinstance(bound.args[0], State):
            bound = bound.args[1]
    if isinstance(bound, Temporal) and bound.op == "eventually" and isinstance(bound.args[0], State):
        return bound.args[0].expr
    return None


def negation(bound: Bound) -> Bound:
    return _combine("not", [bound])


def evaluate_on_lasso(bound: Bound, states: Sequence[Any], loop: int, holds: Callable[[Expr, Any], bool]) -> bool:
    """Is the claim true of the path that runs through `states` and then returns to `states[loop]` for ever?

    `holds(expr, state)` reads one moment.  Past operators settle one round of the loop later for each level of nesting,
    so the loop is written out that often; on the last round every value repeats.
    """
    period = len(states) - loop
    path = [*states, *(list(states[loop:]) * _past_depth(bound))]
    back = len(path) - period

    def previous(v: list[bool]) -> list[bool]:
        return [False, *v[:-1]]

    def since(left: list[bool], right: list[bool]) -> list[bool]:
        result: list[bool] = []
        for a, b in zip(left, right, strict=True):
            result.append(b or (a and bool(result) and result[-1]))
        return result

    def until(left: list[bool], right: list[bool]) -> list[bool]:
        result = [False] * len(path)
        for _ in range(2):  # the second round knows what the return to `back` finds
            for i in reversed(range(len(path))):
                result[i] = right[i] or (left[i] and result[i + 1 if i + 1 < len(path) else back])
        return result

    def flip(v: list[bool]) -> list[bool]:
        return [not x for x in v]

    always_true = [True] * len(path)

    def values(b: Bound) -> list[bool]:
        if isinstance(b, State):
            return [bool(holds(b.expr, s)) for s in path]
        parts = [values(p) for p in b.args]
        match b.op:
            case "not":
                return flip(parts[0])
            case "and":
                return [all(column) for column in zip(*parts, strict=True)] if parts else always_true
            case "or":
                return [any(column) for column in zip(*parts, strict=True)] if parts else flip(always_true)
            case "implies":
                return [not p or q for p, q in zip(*parts, strict=True)]
            case "iff":
                return [p == q for p, q in zip(*parts, strict=True)]
            case "next":
                return [*parts[0][1:], parts[0][back]]
            case "until":
                return until(*parts)
            case "eventually":
                return until(always_true, parts[0])
            case "always":
                return flip(until(always_true, flip(parts[0])))
            case "previously":
                return previous(parts[0])
            case "since":
                return since(*parts)
            case "once":
                return since(always_true, parts[0])
            case "historically":
                return flip(since(always_true, flip(parts[0])))
        raise AssertionError(b.op)

    return values(bound)[0]


def _past_depth(bound: Bound) -> int:
    if isinstance(bound, State):
        return 0
    return (bound.op in ("previously", "once", "historically", "since")) + max(map(_past_depth, bound.args), default=0)


def to_ltl(bound: Bound, write: Callable[[Expr], str]) -> str:
    if isinstance(bound, State):
        return f"({write(bound.expr)})"
    match bound:
        case Temporal("always", (Temporal("implies", (State(a), Temporal("eventually", (State(b),)))),)) if b is negate(a):
            # where not a, b holds at once; so the antecedent says nothing, and without it the tableau is smaller
            return f"(G (F ({write(b)})))"
    word = _LTL[bound.op]
    if len(bound.args) == 1:
        return f"({word} {to_ltl(bound.args[0], write)})"
    return "(" + f" {word} ".join(to_ltl(p, write) for p in bound.args) + ")"


def to_ctl(bound: Bound, write: Callable[[Expr], str]) -> str | None:
    """The same claim in CTL, or None where it has no form in the deterministic fragment that both logics share.

    A model checker answers the CTL form on reachable states alone, without a tableau.  Source: M. Maidl, The common
    fragment of CTL and LTL, FOCS 2000.
    """
    if isinstance(bound, State):
        return f"({write(bound.expr)})"
    match bound.op, bound.args:
        case "always", (inner,):
            return _prefixed("AG", to_ctl(inner, write))
        case "next", (inner,):
            return _prefixed("AX", to_ctl(inner, write))
        case "eventually", (State(expr),):
            return f"(AF ({write(expr)}))"
        case "until", (State(left), State(right)):
            return f"A [({write(left)}) U ({write(right)})]"
        case "implies", (State(left), right):
            inside = to_ctl(right, write)
            return None if inside is None else f"(({write(left)}) -> {inside})"
        case "and", parts:
            written = [to_ctl(p, write) for p in parts]
            return None if None in written else "(" + " & ".join(w for w in written if w is not None) + ")"
    return None


def _prefixed(operator: str, inside: str | None) -> str | None:
    return None if inside is None else f"({operator} {inside})"


def hollow(formula: Formula, words: Any) -> list[tuple[str, Bound]]:
    """What must be true at some time, or the truth of the formula is hollow: antecedents, and what could be ignored.

    For a forall one instance that is not hollow is enough, so its instances are joined by `or`.
    """
    found: list[tuple[str, Bound]] = []
    for what, instances in _hollow(formula, {}, words):
        found.append((what, instances[0] if len(instances) == 1 else _combine("or", instances)))
    return found


def _hollow(formula: Formula, given: Mapping[str, Term], words: Any) -> list[tuple[str, list[Bound]]]:
    match formula.op:
        case "forall":
            name, domain, inner = formula.args
            columns: dict[int, tuple[str, list[Bound]]] = {}
            for value in members(domain, words):
                for i, (what, instances) in enumerate(_hollow(inner, {**given, name: value}, words)):
                    columns.setdefault(i, (what, []))[1].extend(instances)
            return list(columns.values())
        case "implies":
            left, right = formula.args
            antecedent = _bind(left, given, words, [])
            return [(f"the condition `{text(left)}`", [antecedent]), *_hollow(right, given, words)]
        case "atom":
            if formula.args[0] == "ignored":
                terms = [resolve(_any(t), given) for t in formula.args[1:]]
                at_stake = words.at_stake(terms[0], terms[1] if len(terms) > 1 else None)
                return [(f"a directive that `{text(formula)}` could be about", [State(at_stake)])]
            return []
        case "compare":
            return []
    return [entry for part in formula.args for entry in _hollow(part, given, words)]


def text(formula: Formula) -> str:
    """The formula in its own language."""
    match formula.op:
        case "forall":
            name, domain, inner = formula.args
            shown = domain if isinstance(domain, str) else "{" + ", ".join(show(t) for t in domain) + "}"
            return f"forall {name} in {shown}: {text(inner)}"
        case "compare":
            return f"{show(formula.args[1])} {formula.args[0]} {show(formula.args[2])}"
        case "atom":
            inside = ", ".join(show(t) for t in formula.args[1:])
            return f"{formula.args[0]}({inside})" if inside else str(formula.args[0])
        case "not" | "always" | "eventually" | "next" | "historically" | "once" | "previously":
            return f"{formula.op} {_nested(formula.args[0])}"
    return f" {formula.op} ".join(_nested(part) for part in formula.args)


def _nested(formula: Formula) -> str:
    return text(formula) if formula.op in ("atom", "not") else f"({text(formula)})"
