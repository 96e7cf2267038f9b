"""One model from one driver, one rule base and one scenario: world, adviser and driver joined.

In: a checked Agent, the advice as parsed rules, the origins of the rules, a Scenario with its instance applied.
Out: `Model`.  Left to others: SMV text (emitters/smv.py), what is asked (atoms.py), running anything.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from rotra.frontends.agent import Agent, Rule
from rotra.frontends.scenario import Scenario
from rotra.frontends.terms import order, parse_ground
from rotra.lowering.mind import DriverModel, Senses, driver_part, lower_driver
from rotra.lowering.vocabulary import Adviser
from rotra.lowering.world import lower_world, possible_percepts, views
from rotra.origins import Origin
from rotra.system.expr import FALSE, Expr, var, walk
from rotra.system.sharing import share
from rotra.system.transition import Part, System


@dataclass(slots=True)
class Model:
    """`adviser` and `driver` may still name new questions; `system()` closes the model with the percepts in use."""

    scenario: Scenario
    driver: DriverModel
    adviser: Adviser
    observer: tuple[DriverModel, Adviser] | None = None
    whole_world: Part | None = None

    def system(self, asked: Iterable[Expr] = ()) -> System:
        minds = [driver_part(self.driver), self.adviser.part()]
        if self.observer is not None:
            minds += [driver_part(self.observer[0]), self.observer[1].part()]
        return share(_with_world(self.scenario, minds, asked, self.driver.acts))

    def everything(self) -> System:
        """The same with every percept there can be: for traces, not for the engine."""
        if self.whole_world is None:
            self.whole_world = lower_world(self.scenario, possible_percepts(self.scenario), self.driver.acts)
        return System((self.whole_world, driver_part(self.driver), self.adviser.part()))


def senses_of(scenario: Scenario) -> Senses:
    percepts = sorted((parse_ground(text) for text in possible_percepts(scenario)), key=lambda p: (p.name, order(p)))
    lights = tuple(light.name for light in scenario.lights)
    return Senses(tuple(percepts), scenario.top_speed, not scenario.is_open, () if scenario.is_open else views(scenario), lights)


def build_model(agent: Agent, advice: tuple[Rule, ...], rules: Mapping[str, Origin], scenario: Scenario) -> Model:
    return Model(scenario, *_mind(agent, advice, rules, scenario, ""))


def build_product(first: Agent, second: Agent, advice: tuple[Rule, ...], rules: Mapping[str, Origin], scenario: Scenario) -> Model:
    """Two drivers in one world that the first one drives; as long as their acts agree the second is in the same world."""
    return replace(build_model(first, advice, rules, scenario), observer=_mind(second, advice, rules, scenario, "@2"))


def _mind(agent: Agent, advice: tuple[Rule, ...], rules: Mapping[str, Origin], scenario: Scenario, suffix: str) -> tuple[DriverModel, Adviser]:
    senses = senses_of(scenario)
    driver = lower_driver(agent, advice, senses, suffix)
    adviser = Adviser(driver, advice, rules, scenario.top_speed, FALSE if scenario.is_open else var("crashed"))
    adviser.advise()
    return driver, adviser


def _with_world(scenario: Scenario, minds: list[Part], asked: Iterable[Expr], acts: tuple[str, ...]) -> System:
    """The minds in the world, of which only those percepts are written that somebody asks for."""
    roots = [d.expr for p in minds for d in p.definitions] + [v.next for p in minds for v in p.variables if v.next is not None] + list(asked)
    percepts = sorted({e.args[0][2:] for e in walk(roots) if e.op == "ref" and e.args[0].startswith("p:")})
    return System((lower_world(scenario, tuple(percepts), acts), *minds))
