"""Expressions over the variables of a transition system: built small, shared, evaluated, walked.

    conj(var("a"), TRUE, negate(FALSE))  ==  var("a")      every node exists once, so equal means identical

In: names and constants.  Out: `Expr`.  Left to others: SMV text (emitters/smv.py), satisfiability (system/solver.py).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import cache
from typing import Any

Value = bool | int | str


class Expr:
    """One interned node: `op` and `args`.

    op      args
    const   (value,)
    var     (name,)            a state variable
    ref     (name,)            a definition
    not     (e,)
    and/or  (e1, e2, ...)      at least two, flattened, no repetition
    eq lt le add sub mod       (left, right)
    in      (e, frozenset)     e is one of the constants
    case    ((cond, value), ..., (TRUE, value))   the first condition that holds
    """

    __slots__ = ("args", "key", "op", "__weakref__")
    op: str
    args: tuple[Any, ...]
    key: int

    def __repr__(self) -> str:
        return render(self, repr)

    def __lt__(self, other: Expr) -> bool:
        return self.key < other.key


_table: dict[tuple[Any, ...], Expr] = {}


def _node(op: str, args: tuple[Any, ...]) -> Expr:
    # True == 1 in Python, so the type of a constant is part of its identity
    identity = (op, args, type(args[0])) if op == "const" else (op, args)
    found = _table.get(identity)
    if found is None:
        found = Expr()
        found.op, found.args, found.key = op, args, len(_table)
        _table[identity] = found
    return found


def const(value: Value) -> Expr:
    return _node("const", (value,))


TRUE = const(True)
FALSE = const(False)


def var(name: str) -> Expr:
    return _node("var", (name,))


def ref(name: str) -> Expr:
    return _node("ref", (name,))


def negate(e: Expr) -> Expr:
    if e is TRUE:
        return FALSE
    if e is FALSE:
        return TRUE
    return e.args[0] if e.op == "not" else _node("not", (e,))


def _junction(op: str, neutral: Expr, absorbing: Expr, parts: Iterable[Expr]) -> Expr:
    flat: dict[Expr, None] = {}
    for part in parts:
        for e in part.args if part.op == op else (part,):
            if e is absorbing or negate(e) in flat:
                return absorbing
            if e is not neutral:
                flat[e] = None
    if not flat:
        return neutral
    return next(iter(flat)) if len(flat) == 1 else _node(op, tuple(flat))


def conj(*parts: Expr) -> Expr:
    return _junction("and", TRUE, FALSE, parts)


def disj(*parts: Expr) -> Expr:
    return _junction("or", FALSE, TRUE, parts)


def implies(a: Expr, b: Expr) -> Expr:
    return disj(negate(a), b)


def iff(a: Expr, b: Expr) -> Expr:
    return disj(conj(a, b), conj(negate(a), negate(b)))


def eq(a: Expr, b: Expr) -> Expr:
    if a is b:
        return TRUE
    if a.op == b.op == "const":
        return FALSE
    if b.op == "case" and a.op == "const":
        a, b = b, a
    if a.op == "case" and b.op == "const":
        return choose(*((c, eq(v, b)) for c, v in a.args))
    return _node("eq", (a, b))


def among(e: Expr, values: Iterable[Value]) -> Expr:
    wanted = frozenset(values)
    if not wanted:
        return FALSE
    if e.op == "const":
        return TRUE if e.args[0] in wanted else FALSE
    return eq(e, const(next(iter(wanted)))) if len(wanted) == 1 else _node("in", (e, wanted))


_ARITHMETIC: dict[str, Callable[[Any, Any], Any]] = {
    "lt": lambda a, b: a < b,
    "le": lambda a, b: a <= b,
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mod": lambda a, b: a % b,
}


def arithmetic(op: str, a: Expr, b: Expr) -> Expr:
    """`lt`, `le`, `add`, `sub` or `mod` of two integers; constants are folded (mod is never negative)."""
    if a.op == b.op == "const":
        return const(_ARITHMETIC[op](a.args[0], b.args[0]))
    if op in ("add", "sub") and b is const(0):
        return a
    return _node(op, (a, b))


def choose(*branches: tuple[Expr, Expr]) -> Expr:
    """The value of the first branch whose condition holds; the last condition is read as TRUE."""
    kept: list[tuple[Expr, Expr]] = []
    for condition, value in branches:
        if condition is FALSE:
            continue
        kept.append((condition, value))
        if condition is TRUE:
            break
    if not kept:
        raise ValueError("a case without a branch")
    kept[-1] = (TRUE, kept[-1][1])
    while len(kept) > 1 and kept[-1][1] is kept[-2][1]:
        kept.pop(-2)
    if len(kept) == 1:
        return kept[0][1]
    if all(v in (TRUE, FALSE) for _, v in kept) or (len(kept) == 2 and any(v in (TRUE, FALSE) for _, v in kept)):
        result, blocked = FALSE, TRUE
        for condition, value in kept:
            result = disj(result, conj(blocked, condition, value))
            blocked = conj(blocked, negate(condition))
        return result
    return _node("case", tuple(kept))


def children(e: Expr) -> tuple[Expr, ...]:
    match e.op:
        case "const" | "var" | "ref":
            return ()
        case "in":
            return (e.args[0],)
        case "case":
            return tuple(part for branch in e.args for part in branch)
    return e.args


def rebuild(e: Expr, parts: tuple[Expr, ...]) -> Expr:
    """The same operation on other operands."""
    match e.op:
        case "not":
            return negate(parts[0])
        case "and":
            return conj(*parts)
        case "or":
            return disj(*parts)
        case "eq":
            return eq(*parts)
        case "in":
            return among(parts[0], e.args[1])
        case "case":
            return choose(*zip(parts[::2], parts[1::2], strict=True))
        case "const" | "var" | "ref":
            return e
    return arithmetic(e.op, *parts)


def walk(roots: Iterable[Expr]) -> Iterable[Expr]:
    """Every node below the roots once, children before parents."""
    seen: set[Expr] = set()
    stack: list[tuple[Expr, bool]] = [(root, False) for root in roots]
    while stack:
        e, ready = stack.pop()
        if ready:
            yield e
        elif e not in seen:
            seen.add(e)
            stack.append((e, True))
            stack.extend((c, False) for c in children(e) if c not in seen)


def substitute(e: Expr, of: Callable[[Expr], Expr | None], memo: dict[Expr, Expr] | None = None) -> Expr:
    """`e` with every leaf (var or ref) replaced by what `of` gives for it; None keeps it."""
    done = {} if memo is None else memo
    for node in walk([e]):
        if node not in done:
            if node.op in ("var", "ref"):
                done[node] = of(node) or node
            else:
                done[node] = rebuild(node, tuple(done[c] for c in children(node)))
    return done[e]


def evaluate(e: Expr, state: Mapping[str, Value], definitions: Mapping[str, Expr], memo: dict[Expr, Any] | None = None) -> Any:
    """The value of `e` where `state` gives the variables and `definitions` the refs; `memo` may be shared in one state."""
    done: dict[Expr, Any] = {} if memo is None else memo

    def value(node: Expr) -> Any:
        if node in done:
            return done[node]
        match node.op:
            case "const":
                result = node.args[0]
            case "var" | "ref":  # what is a variable in one world may be a constant definition in another
                result = state[node.args[0]] if node.args[0] in state else defined(node)
            case "not":
                result = not value(node.args[0])
            case "and":
                result = all(value(a) for a in node.args)
            case "or":
                result = any(value(a) for a in node.args)
            case "eq":
                result = value(node.args[0]) == value(node.args[1])
            case "in":
                result = value(node.args[0]) in node.args[1]
            case "case":
                result = next(value(v) for c, v in node.args if value(c))
            case _:
                result = _ARITHMETIC[node.op](value(node.args[0]), value(node.args[1]))
        done[node] = result
        return result

    def defined(name: Expr) -> Any:
        """Definitions build on one another thousands deep: what is needed first is found first, without recursion."""
        todo = [name]
        while todo:
            expr = definitions[todo[-1].args[0]]
            needed = [r for r in _names_in(expr) if r not in done and r.args[0] not in state and r.args[0] in definitions]
            if needed:
                todo += needed
            else:
                done[todo.pop()] = value(expr)
        return done[name]

    return value(e)


@cache
def _names_in(e: Expr) -> tuple[Expr, ...]:
    """The variables and definitions that the expression itself speaks of."""
    return tuple(part for part in walk([e]) if part.op in ("var", "ref"))


_SYMBOL = {"eq": "=", "lt": "<", "le": "<=", "add": "+", "sub": "-", "mod": "mod", "and": "&", "or": "|"}


def render(e: Expr, constant: Callable[[Value], str], name: Callable[[Expr], str] | None = None) -> str:
    """SMV-like text of `e`; `constant` writes constants, `name` may write a node (a leaf, or a shared definition)."""

    def text(node: Expr, nested: bool) -> str:
        match node.op:
            case "const":
                return constant(node.args[0])
            case "var" | "ref":
                return name(node) if name else node.args[0]
            case "not":
                return "!" + text(node.args[0], True)
            case "in":
                values = sorted(node.args[1], key=lambda v: (str(type(v)), v))
                inner = f"{text(node.args[0], True)} in {{{', '.join(map(constant, values))}}}"
            case "case":
                return "case " + " ".join(f"{text(c, False)} : {text(v, False)};" for c, v in node.args) + " esac"
            case _:
                inner = f" {_SYMBOL[node.op]} ".join(text(a, True) for a in node.args)
        return f"({inner})" if nested else inner

    return text(e, False)
