"""Does the path of a trace happen in the running Jason system, and a run of Jason in the model?

In: a trace document (of the model or of a run).  Out: None, or the first difference.  Left to others: finding the path.
The start and the choices of the world are taken from the trace; all else is Jason's and the Java world's.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rotra.diagnostics import Rejected, problem
from rotra.frontends.scenario import instance, resolve_scenario
from rotra.lowering.model import build_model
from rotra.lowering.trace import trace_steps
from rotra.lowering.walk import walk
from rotra.origins import Origin
from rotra.pipeline.drive import load_changes, run_in_jason
from rotra.pipeline.inputs import check_driver, load_drivers, load_law

# what must agree, step by step; the order is the order in which a difference is blamed
COMPARED = ("lights", "cars", "percepts", "beliefs", "situation", "goals", "advice", "acts", "busy", "ignored", "justified", "plans", "finished")


def replay_trace(trace: Mapping[str, Any]) -> dict[str, Any] | None:
    """The first step and value where Jason parts from the trace.  A lasso is driven around once more."""
    steps = [s for s in trace["steps"] if "acts" in s]
    if not steps:
        raise Rejected([problem("TR103", Origin("trace"), "the trace has no step with an act", "record it with `rotra run --trace` or `rotra verify -o`")])
    loop = trace.get("loop")
    path = _while_resting(steps + (steps[loop:] if loop is not None else []))
    (driver,) = load_drivers([trace["agent"]])
    law = load_law(trace.get("rules") or "uk")
    world = instance(resolve_scenario(trace["scenario"]), trace.get("instance") or "all")
    check_driver(driver, world)
    job: dict[str, Any] = {"start": None, "seed": None, "choices": [s.get("hesitates", []) for s in path], "percepts": None, "until": None}
    if world.is_open:
        job["percepts"] = [s["percepts"] for s in path]
    else:
        job["start"] = _start(path[0], world)
    later = load_changes([(n, s["rules"]) for n, s in enumerate(path, start=1) if "rules" in s])
    answer = run_in_jason(driver, law, world, len(path), job, later)
    parted = first_difference(path, answer["steps"])
    if parted is not None:
        number, what = parted
        return {"step": number, "what": what, "trace": path[number - 1][what], "jason": answer["steps"][number - 1][what]}
    if len([s for s in answer["steps"] if "acts" in s]) < len(path):
        fault = answer.get("fault") or {}
        return {"step": len(answer["steps"]), "what": "the run", "trace": "goes on", "jason": fault.get("message") or "ends"}
    return None


def accept_run(trace: Mapping[str, Any]) -> dict[str, Any] | None:
    """The first step and value where the model parts from a run in Jason: is the run a path of the model?"""
    (driver,) = load_drivers([trace["agent"]])
    law = load_law(trace.get("rules") or "uk")
    world = instance(resolve_scenario(trace["scenario"]), trace.get("instance") or "all")
    check_driver(driver, world)
    model = build_model(driver.agent, law.advice, law.origins, world)
    path = [s for s in trace["steps"] if "acts" in s]
    steps = trace_steps(model, walk(model, path))
    parted = first_difference(path, steps)
    if parted is None:
        return None
    number, what = parted
    return {"step": number, "what": what, "trace": path[number - 1][what], "model": steps[number - 1][what]}


def _while_resting(steps: list[Any]) -> list[Any]:
    """The steps up to the first one in which the mind does not come to rest: there a run ends."""
    restless = next((n for n, s in enumerate(steps) if s.get("restless")), len(steps))
    return steps[: restless + 1]


def first_difference(one: Sequence[Mapping[str, Any]], other: Sequence[Mapping[str, Any]]) -> tuple[int, str] | None:
    """Number (from 1) and entry of the first step in which two traces differ, as far as both go and come to rest."""
    for number, (a, b) in enumerate(zip(one, other, strict=False), start=1):
        if a.get("restless") and b.get("restless"):
            return None  # what a mind does that never rests depends on when one stops watching it
        for what in COMPARED:
            if what in a and what in b and _comparable(what, a[what]) != _comparable(what, b[what]):
                return number, what
    return None


def _comparable(what: str, value: Any) -> Any:
    """Values as they are compared: of a scripted car not its last speed; of plans not where the file lies on this machine."""
    if what == "cars":
        return {name: {k: v for k, v in car.items() if k != "speed" or name == "driver"} for name, car in value.items()}
    if what == "plans":
        return [(p["label"], str(p["file"]).rsplit("/", 1)[-1], p["line"]) for p in value]
    return value


def _start(first: Mapping[str, Any], world: Any) -> dict[str, Any]:
    """The start that shows in the first state: places, phases and speeds, as the Java world reads them."""
    raw = first.get("start")
    if raw is None:
        raise Rejected([problem("TR103", Origin("trace"), "the trace does not say how it starts", "record it again with this version")])
    return dict(raw)
