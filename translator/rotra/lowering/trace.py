"""Turn states of the model into trace steps, in the words of the design (section 4).

In: a Model, the value of every state variable, step by step.  Out: trace steps as JSON-ready dicts.  Left to others:
where the states come from (engines/nusmv.py), showing them (pipeline/explain.py).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rotra.frontends.terms import Var, order, parse_ground, show
from rotra.lowering.mind import legal_act
from rotra.lowering.model import Model
from rotra.system.expr import TRUE, Expr, Value, evaluate, ref, var


@dataclass(frozen=True, slots=True)
class Situation:
    """What is told to the adviser at rest, each word with the condition under which it is told."""

    contexts: tuple[tuple[str, Expr], ...]
    beliefs: tuple[tuple[str, Expr], ...]
    intentions: tuple[tuple[str, Expr], ...]


def trace_steps(model: Model, states: Sequence[Mapping[str, Value]]) -> list[dict[str, Any]]:
    """One record a state; `states` give every variable of `model.system()` by name."""
    adviser = model.adviser
    situation = Situation(*(tuple((show(t), g) for t, g in adviser.solutions(f, Var("Any"))) for f in ("context", "believes", "intends")))
    wanted = {d: (adviser.advised(d), adviser.against(d), adviser.justified(d)) for d in adviser.directives}
    own = {b: ref(f"now:{show(b)}") for b in model.driver.beliefs} | dict.fromkeys(model.driver.facts, TRUE)
    system = model.everything()
    # what the model leaves out because nobody asks for it: any value will do, so the plainest
    plain = {v.name: v.initial[0] for v in system.parts[0].variables}
    states = [{**plain, **state} for state in states]
    definitions = system.definitions()
    percepts = tuple(name for name in definitions if name.startswith("p:"))
    records = [_record(n, model, situation, wanted, own, percepts, state, definitions) for n, state in enumerate(states, start=1)]
    if records and not model.scenario.is_open:
        records[0]["start"] = _start(model, states[0])
    return records


def _start(model: Model, state: Mapping[str, Value]) -> dict[str, Any]:
    """What the world chose at the start, as the Java world reads it (`Start`)."""

    def initial(name: str, otherwise: Value) -> Value:
        return state.get(name, otherwise)

    scenario = model.scenario
    return {
        "driverAt": [initial("x", scenario.driver.at.published[0]), initial("y", scenario.driver.at.published[1])],
        "phases": {light.name: initial(f"phase_{light.name}", light.phase.published) for light in scenario.lights},
        "trafficAt": {c.name: [initial(f"car_{c.name}_x", c.at.published[0]), initial(f"car_{c.name}_y", c.at.published[1])] for c in scenario.traffic},
        "trafficSpeed": {c.name: initial(f"car_{c.name}_speed", c.speed.published) for c in scenario.traffic},
    }


def _record(number: int, model: Model, situation: Situation, wanted: Mapping[Any, tuple[Expr, Expr, Expr]], own: Mapping[Any, Expr], percepts: Iterable[str], state: Mapping[str, Value], definitions: Mapping[str, Expr]) -> dict[str, Any]:
    memo: dict[Expr, Any] = {}

    def value(e: Expr) -> Any:
        return evaluate(e, state, definitions, memo)

    def read(name: str) -> Any:
        return value(var(name) if name in state else ref(name))

    scenario = model.scenario
    cars: dict[str, dict[str, Any]] = {}
    if not scenario.is_open:
        cars["driver"] = {k: read(k) for k in ("x", "y", "heading", "speed", "crashed")}
        for car in scenario.traffic:
            cars[car.name] = {"x": read(f"car_{car.name}_x"), "y": read(f"car_{car.name}_y"), "heading": car.heading, "crashed": read(f"car_{car.name}_crashed")}
    crashed = bool(cars) and bool(cars["driver"]["crashed"])
    seen = sorted((parse_ground(p[2:]) for p in percepts if not crashed and read(p)), key=lambda p: (p.name, order(p)))
    leaf = next((leaf for name, leaf in model.driver.leaves if read(name)), None)
    asked = [a for a, _ in leaf.control.acts] if leaf else []
    done = asked[0] if asked and legal_act(asked[0], scenario.top_speed) else None
    act = show(done) if done else "wait"
    plans = [c for c in model.driver.choices if read(c.name)]
    plans.sort(key=lambda c: c.cycle)
    ignored: list[dict[str, str]] = []
    justified: list[dict[str, str]] = []
    advice: list[dict[str, Any]] = []
    for d, (advised, against, excused) in sorted(wanted.items(), key=lambda i: (i[0].label != "must", i[0].label, i[0].action)):
        if not value(advised):
            continue
        rules = [r for r in model.adviser.directives[d] if read(f"rule:{r}")]
        advice.append({"label": d.label, "action": d.action, "rules": sorted(rules)})
        if value(against):
            (justified if value(excused) else ignored).append({"label": d.label, "action": d.action})
    mind = model.driver.minds.get(str(read("at_rest")))
    goals = {show(f.literal) for p in (mind.pending if mind else ()) for f in p.stack if f.op == "+" and f.type == "achieve"}
    contexts = [c for c, g in situation.contexts if value(g)]
    return {
        "step": number,
        "lights": {light.name: read(f"light_{light.name}") for light in scenario.lights},
        "cars": cars,
        "percepts": [show(p) for p in seen],
        "situation": {
            "context": contexts[0] if contexts else None,
            "beliefs": sorted(b for b, g in situation.beliefs if value(g)),
            "intentions": sorted(i for i, g in situation.intentions if value(g)),
        },
        "beliefs": sorted(show(b) for b, e in own.items() if value(e)),
        "goals": sorted(goals),
        "advice": advice,
        "plans": [{"label": c.plan.label, "file": c.plan.origin.file, "line": c.plan.origin.line} for c in plans],
        "acts": {"driver": act},
        "busy": [show(a) for a in asked[1:]],
        "ignored": ignored,
        "justified": justified,
        "hesitates": [car.name for car in scenario.traffic if f"hesitates_{car.name}" in state and read(f"hesitates_{car.name}")],
        **({"restless": True} if read("restless") else {}),
        "finished": bool(read("finished")) if "finished" in state else False,
    }

