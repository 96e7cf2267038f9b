"""The AST that Jason's own parser gave (JSON), as frozen dataclasses.

In: the JSON of agents/java's `parse`.  Out: `Agent`.  Left to others: whether it is inside the fragment (fragment.py).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, cast

from rotra.frontends.terms import Items, Struct, Sum, Term, Text, Var, resolve, show
from rotra.origins import Origin


@dataclass(frozen=True, slots=True)
class Formula:
    """A logical formula.  op: and or not rel lit internal true false.

    `args` are sub-formulas (and, or, not) or terms (rel: left, right; lit: the literal; internal: its arguments);
    `name` is the relation or the internal action.
    """

    op: str
    args: tuple[Any, ...] = ()
    name: str = ""


TRUE_FORMULA = Formula("true")


@dataclass(frozen=True, slots=True, eq=False)
class Step:
    """One formula of a plan body, the same as another only if it is that one (identity).  kind: action internal achieve achieve_new test add add_end add_new del del_new update
    constraint if for while fork."""

    kind: str
    origin: Origin
    literal: Struct | Var | None = None
    formula: Formula | None = None
    name: str = ""
    args: tuple[Term, ...] = ()
    branches: tuple[tuple[Formula, Body], ...] = ()
    otherwise: Body | None = None


Body = tuple[Step, ...]


@dataclass(frozen=True, slots=True)
class Trigger:
    op: str  # + or -
    type: str  # belief, achieve, test
    literal: Struct
    annotations: tuple[Term, ...] = ()

    def __str__(self) -> str:
        return self.op + {"belief": "", "achieve": "!", "test": "?"}[self.type] + show(self.literal)


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    label: str
    trigger: Trigger
    context: Formula
    body: Body
    origin: Origin
    atomic: bool = False
    annotations: tuple[Term, ...] = ()

    @property
    def title(self) -> str:
        return self.label or str(self.trigger)


@dataclass(frozen=True, slots=True)
class Rule:
    head: Struct
    body: Formula
    origin: Origin


@dataclass(frozen=True, slots=True)
class Agent:
    """A driver.  `knowledge`: initial beliefs (body true) and rules in the order of the source."""

    file: str
    knowledge: tuple[Rule, ...]
    goals: tuple[tuple[Struct, Origin], ...]
    plans: tuple[Plan, ...]
    warnings: tuple[str, ...] = ()
    unread: tuple[Unread, ...] = ()


@dataclass(frozen=True, slots=True)
class Unread:
    """Something the AST of Jason holds and ours has no place for; kept so that it is refused and not lost."""

    code: str
    what: str
    origin: Origin


def read_term(data: Mapping[str, Any]) -> Term:
    match data["t"]:
        case "atom":
            return Struct(data["name"])
        case "int":
            return int(data["value"])
        case "real":
            value = float(data["value"])
            return int(value) if value == int(value) else value
        case "string":
            return Text(data["value"])
        case "var":
            return Var(data["name"])
        case "list":
            return Items(tuple(map(read_term, data["items"])) + ((read_term(data["tail"]),) if data.get("tail") else ()))
        case "arith":
            return resolve(Sum(data["op"], tuple(map(read_term, data["args"]))), {})
        case "struct":
            return Struct(data["name"], tuple(map(read_term, data.get("args") or ())), bool(data.get("neg")))
        case "formula":
            return Struct("formula", ())
    return Struct("body", ())


def _literal(data: Mapping[str, Any]) -> Struct | Var:
    term = read_term(data)
    assert isinstance(term, Struct | Var), data
    return term


def read_formula(data: Mapping[str, Any] | None) -> Formula:
    if data is None:
        return TRUE_FORMULA
    match data["f"]:
        case "and" | "or" as op:
            return Formula(op, tuple(map(read_formula, data["args"])))
        case "not":
            return Formula("not", (read_formula(data["arg"]),))
        case "rel":
            return Formula("rel", (read_term(data["left"]), read_term(data["right"])), data["op"])
        case "lit":
            return Formula("lit", (_literal(data["literal"]),))
        case "internal":
            return Formula("internal", tuple(map(read_term, data["args"])), data["name"])
    return Formula(data["f"])


def read_body(data: list[Mapping[str, Any]] | None) -> Body:
    return tuple(_read_step(step) for step in data or ())


def _read_step(data: Mapping[str, Any]) -> Step:
    origin = Origin(data.get("file", ""), int(data.get("line") or 0))
    kind = data["b"]
    if kind == "if":
        branches = tuple((read_formula(b["cond"]), read_body(b["body"])) for b in data["branches"])
        return Step(kind, origin, branches=branches, otherwise=read_body(data["else"]) if data.get("else") is not None else None)
    return Step(
        kind,
        origin,
        literal=_literal(data["literal"]) if data.get("literal") else None,
        formula=read_formula(data["formula"]) if data.get("formula") else None,
        name=data.get("name", ""),
        args=tuple(map(read_term, data.get("args") or ())) if kind == "internal" else (),
    )


def _head(data: Mapping[str, Any]) -> Struct:
    """What is believed, wanted or triggers; a variable there is refused by the fragment check, which comes next."""
    return cast(Struct, _literal(data))


def read_agent(file: str, ast: Mapping[str, Any]) -> Agent:
    knowledge: list[tuple[int, Rule]] = []
    for i, belief in enumerate(ast["beliefs"]):
        head = _head(belief["literal"])
        knowledge.append((belief.get("index", i), Rule(head, TRUE_FORMULA, Origin(belief["file"], belief["line"]))))
    for i, rule in enumerate(ast["rules"]):
        knowledge.append((rule.get("index", 10**6 + i), Rule(_head(rule["head"]), read_formula(rule["body"]), Origin(rule["file"], rule["line"]))))
    goals = tuple((_head(g["literal"]), Origin(g["file"], g["line"])) for g in ast["goals"])
    plans = []
    for p in ast["plans"]:
        t = p["trigger"]
        annotations = tuple(read_term(a) for a in p.get("annotations") or ())
        trigger = Trigger(t["op"], t["type"], _head(t["literal"]), tuple(read_term(a) for a in t["literal"].get("annots") or ()))
        origin = Origin(p.get("file") or t["file"], int(t.get("line") or p["line"]), p["label"])
        atomic = any(isinstance(a, Struct) and a.name == "atomic" for a in annotations)
        plans.append(Plan(p["label"], trigger, read_formula(p["context"]), read_body(p["body"]), origin, atomic, annotations))
    warnings = tuple(w["message"] if isinstance(w, dict) else str(w) for w in ast.get("warnings") or ())
    return Agent(file, tuple(r for _, r in sorted(knowledge, key=lambda k: k[0])), goals, tuple(plans), warnings, tuple(_unread(ast, Origin(file))))


def _unread(part: Any, near: Origin) -> Iterator[Unread]:
    """Annotations (but those of triggers, which are kept), namespaces, open lists and extended plans, wherever they stand."""
    if isinstance(part, list):
        for item in part:
            yield from _unread(item, near)
    if not isinstance(part, Mapping):
        return
    if part.get("line"):
        near = Origin(part.get("file") or near.file, int(part["line"]))
    if part.get("b") in ("for", "while", "fork"):
        return  # refused as a whole
    if part.get("t") in ("formula", "body"):
        yield Unread("AG113", "a formula or a plan body as an argument", near)
    if part.get("extended"):
        yield Unread("AG113", "a plan with a goal condition or plans inside it", near)
    if part.get("ns") and str(part["ns"]) != "default":
        yield Unread("AG113", f"the namespace {part['ns']}", near)
    if part.get("t") == "list" and part.get("tail"):
        yield Unread("AG113", "a list with an open end, [H|T],", near)
    if part.get("t") in ("struct", "var") and part.get("annots"):
        written = ",".join(show(read_term(a)) for a in part["annots"])
        yield Unread("AG114", f"the annotation [{written}] of {part.get('name')}", near)
    for key, inner in part.items():
        if key == "trigger":
            yield from _unread({**inner, "literal": {**inner["literal"], "annots": []}}, near)
        else:
            yield from _unread(inner, near)


def steps_of(body: Body) -> Iterator[Step]:
    """Every step of a body, those inside `if` too."""
    for step in body:
        yield step
        for _, branch in step.branches:
            yield from steps_of(branch)
        if step.otherwise:
            yield from steps_of(step.otherwise)


def literals_of(formula: Formula) -> Iterator[Struct | Var]:
    """Every literal asked for in a formula."""
    if formula.op == "lit":
        yield formula.args[0]
    elif formula.op in ("and", "or", "not"):
        for part in formula.args:
            yield from literals_of(part)
