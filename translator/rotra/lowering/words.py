"""The words of the property language in one model: every atom as an expression over the system, read at rest.

In: a Model.  Out: `Words`, the vocabulary that atoms.bind asks.  Left to others: temporal operators (atoms.py).
A word that is known but cannot be true here is `Impossible`, with the reason (design, section 7).
"""

from __future__ import annotations

from rotra.frontends.terms import Struct, Term, is_ground, parse_ground, show, unify
from rotra.lowering.atoms import Impossible
from rotra.lowering.mind import legal_acts
from rotra.lowering.model import Model
from rotra.system.expr import FALSE, Expr, conj, const, disj, eq, ref, var

Answer = Expr | Impossible


def _expr(e: Expr, reason: str) -> Answer:
    return Impossible(reason) if e is FALSE else e


class Words:
    """One method a word; terms may hold variables, which match anything."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self.adviser = model.adviser
        self.driver = model.driver
        self.scenario = model.scenario
        self.percepts = tuple(parse_ground(p) for p in sorted(self._possible()))

    def _possible(self) -> set[str]:
        return {show(p) for group in self.driver.rest.knowledge.percepts.values() for p in group}

    def believes(self, pattern: Term) -> Answer:
        return _expr(self.adviser.somewhere("believes", pattern), f"the driver never believes {show(pattern)} here")

    def intends(self, pattern: Term) -> Answer:
        return _expr(self.adviser.somewhere("intends", pattern), f"the driver never intends {show(pattern)} here")

    def belief(self, pattern: Struct) -> Answer:
        return _expr(self.adviser.own_beliefs(pattern), f"the driver's mind never holds {show(pattern)} here")

    def goal(self, pattern: Struct) -> Answer:
        return _expr(self.adviser.goals(pattern), f"the driver never has the goal {show(pattern)} here")

    def does(self, pattern: Struct) -> Answer:
        if pattern.name == "wait" or any(unify(pattern, parse_ground(a), {}) is not None for a in legal_acts(self.scenario.top_speed)):
            return _expr(self.adviser.does(pattern), f"the driver never does {show(pattern)} here")
        return Impossible(f"there is no act {show(pattern)} here")

    def percept(self, pattern: Struct) -> Answer:
        seen = [ref(f"p:{show(p)}") for p in self.percepts if unify(pattern, p, {}) is not None]
        return _expr(disj(*seen), f"{show(pattern)} can never be sensed here")

    def advised(self, label: Term, action: Term) -> Answer:
        found = disj(*(self.adviser.advised(d) for d in self.adviser.matching(label, action)))
        return _expr(found, f"no rule advises {show(label)} {show(action)} here")

    def ignored(self, label: Term, action: Term | None) -> Answer:
        found = self.adviser.matching(label, action)
        matching = [d for d in found if self.adviser.shown(d.action)]
        if not found:
            return Impossible(f"no rule advises {show(label)} {'_' if action is None else show(action)} here")
        if not matching:
            return Impossible("no act can go against such a directive here")
        return disj(*(self.adviser.ignored(d) for d in matching))

    def at_stake(self, label: Term, action: Term | None) -> Expr:
        """Such a directive is in force together with an act that would contradict it."""
        return disj(*(self.adviser.at_stake(d) for d in self.adviser.matching(label, action)))

    def crashed(self) -> Answer:
        return Impossible("there is no road to crash on") if self.scenario.is_open else var("crashed")

    def finished(self) -> Answer:
        if self.scenario.is_open or self.scenario.goal is None:
            return Impossible("the scenario has no goal")
        return var("finished")

    def hesitates(self, car: Term) -> Answer:
        names = [c.name for c in self.scenario.traffic if unify(car, Struct(c.name), {}) is not None and any(c.hesitates.all)]
        return _expr(disj(*(var(f"hesitates_{n}") for n in names)), f"no car {show(car)} may hesitate here")

    def busy(self) -> Answer:
        return ref("busy" + self.driver.suffix)

    def restless(self) -> Answer:
        return ref("restless" + self.driver.suffix)

    def main_goal(self) -> Answer:
        return ref("main_goal" + self.driver.suffix) if self.driver.initial_goals else Impossible("the driver starts with no goal")

    def number(self, name: str) -> Answer:
        """x, y, speed or limit."""
        if self.scenario.is_open and name in ("x", "y"):
            return Impossible("there are no places in the open scenario")
        if self.scenario.is_open:
            return Impossible(f"{name} is a percept in the open scenario; ask percept({name}(_))")
        return ref("limit") if name == "limit" else var(name)

    def heading(self, direction: Term) -> Answer:
        if self.scenario.is_open:
            return self.percept(Struct("heading", (direction,)))
        choices = [h for h in ("north", "east", "south", "west") if unify(direction, Struct(h), {}) is not None]
        return disj(*(eq(var("heading"), const(h)) for h in choices))

    def light(self, name: Term, colour: Term) -> Answer:
        found = []
        for light in self.scenario.lights:
            if unify(name, Struct(light.name), {}) is not None:
                shown = [c for c, _ in light.cycle if unify(colour, Struct(c), {}) is not None]
                found += [eq(ref(f"light_{light.name}"), const(c)) for c in dict.fromkeys(shown)]
        return _expr(disj(*found), f"no light {show(name)} shows {show(colour)} here")

    def car(self, name: Term, x: Term, y: Term) -> Answer:
        found = []
        for car in self.scenario.traffic:
            if unify(name, Struct(car.name), {}) is not None:
                place = [eq(var(f"car_{car.name}_{axis}"), const(v)) for axis, v in (("x", x), ("y", y)) if is_ground(v) and isinstance(v, int)]
                found.append(conj(*place))
        return _expr(disj(*found), f"there is no car {show(name)} here")


