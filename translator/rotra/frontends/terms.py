"""AgentSpeak terms as frozen values, their text, and unification.

In: parts.  Out: `Term`s and substitutions (dicts from variable name to term).  Left to others: what a term means.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Var:
    name: str


@dataclass(frozen=True, slots=True)
class Text:
    """A string in quotes."""

    value: str


@dataclass(frozen=True, slots=True)
class Struct:
    """An atom (no arguments), a literal or a structure; `negated` is strong negation (`~p`)."""

    name: str
    args: tuple[Term, ...] = ()
    negated: bool = False


@dataclass(frozen=True, slots=True)
class Items:
    """A list of fixed length."""

    items: tuple[Term, ...]


@dataclass(frozen=True, slots=True)
class Sum:
    """Arithmetic not yet computed: `op` is + - * / div mod or ** (or unary -)."""

    op: str
    args: tuple[Term, ...]


Term = Var | Text | Struct | Items | Sum | int | float
Substitution = Mapping[str, Term]
_ATOM = re.compile(r"[a-z][A-Za-z0-9_]*\Z")


def show(term: Term) -> str:
    """The term as AgentSpeak text without spaces, e.g. `stop_line(0,0)`."""
    match term:
        case bool():
            return "true" if term else "false"
        case int() | float():
            return str(term)
        case Var(name):
            return name
        case Text(value):
            return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
        case Items(items):
            return "[" + ",".join(map(show, items)) + "]"
        case Sum(op, args):
            return "(" + (f"{op}{show(args[0])}" if len(args) == 1 else f" {op} ".join(map(show, args))) + ")"
        case Struct(name, args, negated):
            inside = f"({','.join(map(show, args))})" if args else ""
            return ("~" if negated else "") + name + inside
    raise AssertionError(term)


def parse_ground(text: str) -> Struct:
    """The literal that `show` wrote: atoms, integers and nested structures only."""
    tokens = re.findall(r"[A-Za-z_][A-Za-z0-9_]*|-?\d+|[(),]", text)
    at = 0

    def read() -> Term:
        nonlocal at
        token = tokens[at]
        at += 1
        if re.match(r"-?\d", token):
            return int(token)
        args: list[Term] = []
        if at < len(tokens) and tokens[at] == "(":
            while tokens[at] != ")":
                at += 1
                args.append(read())
            at += 1
        return Struct(token, tuple(args))

    result = read()
    if not isinstance(result, Struct) or at != len(tokens):
        raise ValueError(f"not a ground literal: {text!r}")
    return result


def walk_to(term: Term, bound: Substitution) -> Term:
    """Follow variables to their value, one level."""
    while isinstance(term, Var) and term.name in bound:
        term = bound[term.name]
    return term


def resolve(term: Term, bound: Substitution) -> Term:
    """The term with every bound variable replaced, at every depth."""
    term = walk_to(term, bound)
    match term:
        case Struct(name, args, negated) if args:
            return Struct(name, tuple(resolve(a, bound) for a in args), negated)
        case Items(items):
            return Items(tuple(resolve(a, bound) for a in items))
        case Sum(op, args):
            return compute(Sum(op, tuple(resolve(a, bound) for a in args)))
    return term


def compute(term: Sum) -> Term:
    """The number where all operands are numbers; else the sum as it stands.  Division by zero stays uncomputed."""
    numbers = [a for a in term.args if isinstance(a, int | float)]
    if len(numbers) < len(term.args):
        return term
    if len(numbers) == 1:
        return -numbers[0] if term.op == "-" else numbers[0]
    a, b = numbers
    if term.op in ("/", "div", "mod") and b == 0:
        return term
    match term.op:
        case "+":
            value: float = a + b
        case "-":
            value = a - b
        case "*":
            value = a * b
        case "/":
            value = a / b
        case "div":
            value = int(a / b)
        case "mod":
            value = a - int(a / b) * b  # Java's %: the sign of the dividend
        case "**":
            value = a**b
        case _:
            return term
    return int(value) if value == int(value) else value


def variables(term: Term) -> frozenset[str]:
    match term:
        case Var(name):
            return frozenset([name])
        case Struct(_, args, _) | Items(args) | Sum(_, args):
            return frozenset().union(*map(variables, args)) if args else frozenset()
    return frozenset()


def is_ground(term: Term) -> bool:
    return not variables(term) and not isinstance(term, Sum)


def rename(term: Term, suffix: str) -> Term:
    """The term with every variable's name made fresh by a suffix."""
    match term:
        case Var(name):
            return Var(name + suffix)
        case Struct(name, args, negated) if args:
            return Struct(name, tuple(rename(a, suffix) for a in args), negated)
        case Items(items):
            return Items(tuple(rename(a, suffix) for a in items))
        case Sum(op, args):
            return Sum(op, tuple(rename(a, suffix) for a in args))
    return term


def unify(a: Term, b: Term, bound: Substitution) -> dict[str, Term] | None:
    """`bound` extended so that both are equal, or None."""
    result = dict(bound)
    todo = [(a, b)]
    while todo:
        left, right = (resolve(t, result) if isinstance(t, Sum) else walk_to(t, result) for t in todo.pop())
        if left == right and type(left) is type(right):
            continue
        if isinstance(left, Var):
            result[left.name] = right
        elif isinstance(right, Var):
            result[right.name] = left
        elif isinstance(left, int | float) and isinstance(right, int | float):
            if left != right:
                return None
        elif isinstance(left, Struct) and isinstance(right, Struct):
            if left.name != right.name or len(left.args) != len(right.args) or left.negated != right.negated:
                return None
            todo.extend(zip(left.args, right.args, strict=True))
        elif isinstance(left, Items) and isinstance(right, Items) and len(left.items) == len(right.items):
            todo.extend(zip(left.items, right.items, strict=True))
        else:
            return None
    return result


def apart(a: Struct, b: Struct) -> bool:
    """Do two atoms or numbers in the same place differ, so that the two can never be made equal?  Quick, and not the whole story."""
    for x, y in zip(a.args, b.args, strict=False):
        if type(x) is type(y):
            if x != y and not (isinstance(x, Var | Items | Sum) or (isinstance(x, Struct) and x.args and isinstance(y, Struct) and y.args)):
                return True
        elif isinstance(x, Struct | Text) and isinstance(y, Struct | Text | int | float) or isinstance(y, Struct | Text) and isinstance(x, int | float):
            return True
    return False


def order(term: Term) -> tuple[object, ...]:
    """A sort key: numbers before atoms before structures, as percepts are ordered."""
    match term:
        case int() | float():
            return (0, term)
        case Struct(name, args, _):
            return (1, name, tuple(map(order, args)))
    return (2, show(term))
