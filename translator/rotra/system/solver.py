"""Can a boolean expression hold at all?  Tseitin encoding into an incremental SAT solver (python-sat).

In: expressions whose leaves are boolean variables, definitions, or comparisons of a variable with constants.
Out: yes or no.  Left to others: what the leaves mean; `at_most_one` and `assume` tell what excludes what.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from pysat.solvers import Solver

from rotra.system.expr import FALSE, TRUE, Expr, children, walk


class Satisfiability:
    """One growing clause set; definitions are looked up in `definitions` when a ref is first met.

    A ref without a definition, and every comparison, is a free proposition: an answer "satisfiable" may be too generous,
    "unsatisfiable" never is.  Translation only uses the latter (it drops a branch), so it stays sound.
    """

    def __init__(self, definitions: Mapping[str, Expr]) -> None:
        self._definitions = definitions
        self._solver = Solver(name="minisat22")
        self._literal: dict[Expr, int] = {}
        self._count = 0
        self._answers: dict[Expr, bool] = {}
        self._solver.add_clause([self._of(TRUE)])

    def _fresh(self) -> int:
        self._count += 1
        return self._count

    def _of(self, root: Expr) -> int:
        if root in self._literal:
            return self._literal[root]
        for e in walk([root]):
            if e in self._literal:
                continue
            if e is FALSE:
                self._literal[e] = -self._of(TRUE)
            elif e.op == "not":
                self._literal[e] = -self._of(e.args[0])
            elif e.op == "ref" and e.args[0] in self._definitions:
                self._literal[e] = self._of(self._definitions[e.args[0]])
            elif e.op in ("and", "or"):
                self._literal[e] = self._junction(e)
            elif e.op == "case" and all(isinstance(v, Expr) and self._boolean(v) for _, v in e.args):
                self._literal[e] = self._case(e)
            else:
                self._literal[e] = self._fresh()
        return self._literal[root]

    def _boolean(self, e: Expr) -> bool:
        return e in (TRUE, FALSE) or e.op in ("not", "and", "or", "eq", "in", "lt", "le", "var", "ref") or (e.op == "case" and all(self._boolean(v) for _, v in e.args))

    def _junction(self, e: Expr) -> int:
        sign = 1 if e.op == "and" else -1
        whole = self._fresh()
        parts = [self._literal[c] for c in children(e)]
        for part in parts:
            self._solver.add_clause([-sign * whole, sign * part])
        self._solver.add_clause([sign * whole, *(-sign * part for part in parts)])
        return whole

    def _case(self, e: Expr) -> int:
        whole = self._fresh()
        blocked: list[int] = []
        for condition, value in e.args:
            c, v = self._literal[condition], self._literal[value]
            self._solver.add_clause([*blocked, -c, -whole, v])
            self._solver.add_clause([*blocked, -c, whole, -v])
            blocked.append(c)
        return whole

    def assume(self, e: Expr) -> None:
        """From now on `e` holds."""
        self._solver.add_clause([self._of(e)])
        self._answers.clear()

    def at_most_one(self, parts: Iterable[Expr]) -> None:
        """From now on no two of the parts hold together."""
        literals = [self._of(p) for p in parts]
        for i, a in enumerate(literals):
            for b in literals[i + 1 :]:
                self._solver.add_clause([-a, -b])
        self._answers.clear()

    def possible(self, e: Expr) -> bool:
        if e is TRUE or e is FALSE:
            return e is TRUE
        if e not in self._answers:
            self._answers[e] = bool(self._solver.solve(assumptions=[self._of(e)]))
        return self._answers[e]
