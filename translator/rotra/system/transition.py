"""The one transition system that every model, trace and verdict is about.

In: variables, initial sets, next-state expressions and named definitions.  Out: `System`, joined from `Part`s (world,
adviser, driver).  Left to others: SMV text (emitters/smv.py), building the parts (lowering/).
"""

from __future__ import annotations

from dataclasses import dataclass

from rotra.origins import NOWHERE, Origin
from rotra.system.expr import Expr, Value


@dataclass(frozen=True, slots=True)
class Variable:
    """A state variable: its finite domain, its initial values, and its next value (None: any of the domain, each step).

    `frozen` variables keep their initial value for ever and have no `next`.
    """

    name: str
    domain: tuple[Value, ...]
    initial: tuple[Value, ...]
    next: Expr | None
    origin: Origin = NOWHERE
    frozen: bool = False


@dataclass(frozen=True, slots=True)
class Definition:
    """A named expression, read at rest; `origin` names the rule, plan or world line it comes from."""

    name: str
    expr: Expr
    origin: Origin = NOWHERE


@dataclass(frozen=True, slots=True)
class Part:
    """One module of the model: `world`, `adviser` or `driver`.  `invariant`: constraints on every state (exclusions);
    `initially`: constraints on the first state alone."""

    name: str
    variables: tuple[Variable, ...]
    definitions: tuple[Definition, ...]
    invariant: tuple[Expr, ...] = ()
    initially: tuple[Expr, ...] = ()


@dataclass(frozen=True, slots=True)
class System:
    parts: tuple[Part, ...]

    def definitions(self) -> dict[str, Expr]:
        return {d.name: d.expr for part in self.parts for d in part.definitions}

    def variables(self) -> dict[str, Variable]:
        return {v.name: v for part in self.parts for v in part.variables}
