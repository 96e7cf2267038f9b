"""Follow one path of the model: the one that given choices of the world single out.

    start {driverAt: [2, 7], phases: {tl: 0}}, who hesitates in each step   ->   the values of all variables, step by step

In: a Model, a start and each step's choices as a trace has them.  Out: states.  Left to others: reading states (trace.py).
The states are found by evaluating the transition system itself; no engine takes part.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rotra.frontends.terms import parse_ground, show
from rotra.lowering.model import Model
from rotra.system.expr import Expr, Value, evaluate

State = dict[str, Value]


def walk(model: Model, steps: Sequence[Mapping[str, Any]]) -> list[State]:
    """One state for each of `steps`; of these are read: `start` in the first, `hesitates`, and in an open scenario `percepts`."""
    system = model.everything()
    variables = system.variables()
    definitions = system.definitions()
    states: list[State] = []
    for step in steps:
        if states:
            memo: dict[Expr, Any] = {}
            last = states[-1]
            state = {n: last[n] for n, v in variables.items() if v.frozen} | {n: evaluate(v.next, last, definitions, memo) for n, v in variables.items() if v.next is not None}
        else:
            state = {n: v.initial[0] for n, v in variables.items()} | _start(model, step.get("start") or {}, variables)
        states.append(state | _chosen(model, step, variables))
    return states


def _start(model: Model, start: Mapping[str, Any], variables: Mapping[str, Any]) -> State:
    values: State = {}
    if start.get("driverAt"):
        values["x"], values["y"] = start["driverAt"]
    for light, phase in start.get("phases", {}).items():
        values[f"phase_{light}"] = phase
    for car, (x, y) in start.get("trafficAt", {}).items():
        values[f"car_{car}_x"], values[f"car_{car}_y"] = x, y
    for car, speed in start.get("trafficSpeed", {}).items():
        values[f"car_{car}_speed"] = speed
    return {name: value for name, value in values.items() if name in variables}


def _chosen(model: Model, step: Mapping[str, Any], variables: Mapping[str, Any]) -> State:
    values: State = {f"hesitates_{car.name}": car.name in step.get("hesitates", ()) for car in model.scenario.traffic}
    if model.scenario.is_open:
        sensed = [parse_ground(text) for text in step["percepts"]]
        values |= {f"sensed {text}": parse_ground(text) in sensed for text in model.scenario.percepts}
        values |= {f"sensed_{p.name}": show(p.args[0]) for p in sensed if f"sensed_{p.name}" in variables}
    return {name: value for name, value in values.items() if name in variables}
