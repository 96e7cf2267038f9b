"""Write a transition system as readable SMV: one module each for world, adviser and driver, and the map of names back.

    Definition("p:light(0,1,red)", ...)        p_light_0_1_red := ...;  -- light tl <- model/scenarios/x.yaml:12

In: System, specifications.  Out: `Smv` (text, names).  Left to others: running it (engines/nusmv.py).
Ids from files never reach the text as they are: every name is rewritten to letters, digits and `_`, and kept unique.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

from rotra.origins import Origin
from rotra.system.expr import TRUE, Expr, Value, render, walk
from rotra.system.transition import Part, System

_RESERVED = frozenset(
    "MODULE DEFINE MDEFINE CONSTANTS VAR IVAR FROZENVAR INIT TRANS INVAR SPEC CTLSPEC LTLSPEC PSLSPEC COMPUTE NAME INVARSPEC FAIRNESS JUSTICE "
    "COMPASSION ISA ASSIGN CONSTRAINT SIMPWFF CTLWFF LTLWFF PSLWFF COMPWFF IN MIN MAX MIRROR PRED PREDICATES process array of boolean integer "
    "real word word1 bool signed unsigned extend resize sizeof uwconst swconst EX AX EF AF EG AG E F O G H X Y Z A U S V T BU EBF ABF EBG ABG "
    "case esac mod next init union in xor xnor self TRUE FALSE count abs max min toint main world adviser driver".split()
)


@dataclass(frozen=True, slots=True)
class Specification:
    """One check.  kind: invariant, ltl or ctl; `text` is a finished SMV formula over qualified names."""

    name: str
    kind: str
    text: str


@dataclass(frozen=True, slots=True)
class Names:
    """SMV names of the system's names (`part`, `local`), of its constants, and the way back."""

    local: dict[str, tuple[str, str]]
    constants: dict[str, str]

    def qualified(self, name: str) -> str:
        part, local = self.local[name]
        return f"{part}.{local}"

    def variable(self, qualified: str) -> str | None:
        return self._back().get(qualified)

    def value(self, text: str) -> Value:
        if text in ("TRUE", "FALSE"):
            return text == "TRUE"
        return int(text) if re.fullmatch(r"-?\d+", text) else self._constant_back().get(text, text)

    def _back(self) -> dict[str, str]:
        return _inverse(tuple((f"{p}.{n}", name) for name, (p, n) in self.local.items()))

    def _constant_back(self) -> dict[str, str]:
        return _inverse(tuple((safe, name) for name, safe in self.constants.items()))


@lru_cache(maxsize=8)
def _inverse(pairs: tuple[tuple[str, str], ...]) -> dict[str, str]:
    return dict(pairs)


@dataclass(frozen=True, slots=True)
class Smv:
    text: str
    names: Names


def _safe(name: str, taken: set[str]) -> str:
    base = re.sub(r"-(?=\d)", "m", name)
    base = re.sub(r"[^A-Za-z0-9]+", "_", base).strip("_") or "name"
    if not base[0].isalpha() or base in _RESERVED:
        base = f"n_{base}"
    candidate, number = base, 1
    while candidate in taken:
        number += 1
        candidate = f"{base}_{number}"
    taken.add(candidate)
    return candidate


def name_everything(system: System) -> Names:
    """Unique SMV names: locals differ inside a part, constants differ from every local of every part."""
    local: dict[str, tuple[str, str]] = {}
    used: set[str] = set()
    for part in system.parts:
        taken: set[str] = set()
        for name in (*(v.name for v in part.variables), *(d.name for d in part.definitions)):
            local[name] = (part.name.replace("@", "_"), _safe(name, taken))
        used |= taken
    constants: dict[str, str] = {}
    for value in sorted(_constants(system)):
        constants[value] = _safe(value, used)
    return Names(local, constants)


def _constants(system: System) -> set[str]:
    found: set[str] = set()
    roots: list[Expr] = []
    for part in system.parts:
        for v in part.variables:
            found.update(x for x in (*v.domain, *v.initial) if isinstance(x, str))
            if v.next is not None:
                roots.append(v.next)
        roots += [d.expr for d in part.definitions] + [*part.invariant, *part.initially]
    for e in walk(roots):
        if e.op == "const" and isinstance(e.args[0], str):
            found.add(e.args[0])
        if e.op == "in":
            found.update(x for x in e.args[1] if isinstance(x, str))
    return found


def write_expr(e: Expr, names: Names, inside: str | None = None) -> str:
    """SMV text of an expression, as seen from the part `inside` (None: from main)."""

    def constant(value: Value) -> str:
        if isinstance(value, bool):
            return "TRUE" if value else "FALSE"
        return str(value) if isinstance(value, int) else names.constants.get(value) or _unknown(value)

    def name(leaf: Expr) -> str:
        part, local = names.local[leaf.args[0]]
        return local if part == inside else f"{part}.{local}"

    return render(e, constant, name)


def _unknown(value: str) -> str:
    raise KeyError(f"constant {value!r} is not in the model")


def emit_smv(system: System, title: str, specifications: Iterable[Specification] = (), names: Names | None = None) -> Smv:
    """The whole model as text."""
    names = names or name_everything(system)
    parts = [p.name.replace("@", "_") for p in system.parts]
    lines = [f"-- {_comment(title)}", "-- Written by rotra translate; names map back through names.json.", "", "MODULE main", "VAR"]
    for part in parts:
        lines.append(f"  {part} : module_{part}({', '.join(parts)});")
    if names.constants:
        lines += ["CONSTANTS", f"  {', '.join(names.constants.values())};"]
    for spec in specifications:
        keyword = {"invariant": "INVARSPEC", "ltl": "LTLSPEC", "ctl": "CTLSPEC"}[spec.kind]
        lines.append(f"{keyword} NAME {spec.name} := {spec.text};")
    for module in system.parts:
        lines += ["", *_module(module, parts, names)]
    return Smv("\n".join(lines) + "\n", names)


def _comment(text: str) -> str:
    return re.sub(r"[^\x20-\x7e]", "?", text)


def _from(origin: Origin) -> str:
    return f"  -- {_comment(str(origin))}" if origin.file else ""


def _module(part: Part, parts: list[str], names: Names) -> list[str]:
    inside = part.name.replace("@", "_")
    lines = [f"MODULE module_{inside}({', '.join(p if p != inside else 'itself' for p in parts)})"]

    def local(name: str) -> str:
        return names.local[name][1]

    def text(e: Expr) -> str:
        return write_expr(e, names, inside)

    def value(v: Value) -> str:
        return ("TRUE" if v else "FALSE") if isinstance(v, bool) else names.constants[v] if isinstance(v, str) else str(v)

    def domain(values: tuple[Value, ...]) -> str:
        if set(values) <= {False, True} and all(isinstance(v, bool) for v in values):
            return "boolean"
        numbers = [v for v in values if isinstance(v, int)]
        if len(numbers) == len(values) and sorted(numbers) == list(range(min(numbers), max(numbers) + 1)):
            return f"{min(numbers)}..{max(numbers)}"
        return "{" + ", ".join(map(value, values)) + "}"

    for keyword, frozen in (("VAR", False), ("FROZENVAR", True)):
        chosen = [v for v in part.variables if v.frozen == frozen]
        if chosen:
            lines.append(keyword)
            lines += [f"  {local(v.name)} : {domain(v.domain)};{_from(v.origin)}" for v in chosen]
    if part.definitions:
        lines.append("DEFINE")
        for d in part.definitions:
            lines += _assignment(f"  {local(d.name)} :=", d.expr, text, _from(d.origin))
    if part.variables:
        lines.append("ASSIGN")
        for v in part.variables:
            if set(v.initial) != set(v.domain):
                initial = "{" + ", ".join(map(value, v.initial)) + "}" if len(v.initial) > 1 else value(v.initial[0])
                lines.append(f"  init({local(v.name)}) := {initial};{_from(v.origin)}")
            if v.next is not None:
                lines += _assignment(f"  next({local(v.name)}) :=", v.next, text, "")
    lines += [f"INVAR {text(e)};" for e in part.invariant] + [f"INIT {text(e)};" for e in part.initially]
    return lines


def _assignment(left: str, e: Expr, text: object, comment: str) -> list[str]:
    write = text  # a function Expr -> str
    if e.op != "case":
        return [f"{left} {write(e)};{comment}"]  # type: ignore[operator]
    lines = [f"{left} case{comment}"]
    for condition, value in e.args:
        lines.append(f"    {'TRUE' if condition is TRUE else write(condition)} : {write(value)};")  # type: ignore[operator]
    return [*lines, "  esac;"]
