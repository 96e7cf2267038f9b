"""Drive an agent in Jason, in lockstep with the Java world, and give back its trace.

In: names or paths, the instance, a seed.  Out: a trace document.  Left to others: showing it (draw.py, explain.py).
"""

from __future__ import annotations

import json
import tempfile
from pathlib import Path
from typing import Any

from rotra.engines.jvm import ask_java, placed
from rotra.frontends.scenario import Scenario, instance, resolve_scenario, scenario_json
from rotra.pipeline.campaign import trace_document
from rotra.pipeline.inputs import Driver, Law, check_driver, load_drivers, load_law

# reasoning cycles in one step, after which a driver is said not to come to rest
CAP = 500


def drive(agent: str, scenario: str, steps: int, which: str, rules: str, seed: int | None, until: str | None) -> dict[str, Any]:
    """A run of at most `steps` steps; without a seed the published start is taken and nobody hesitates."""
    (driver,) = load_drivers([agent])
    law = load_law(rules)
    world = instance(resolve_scenario(scenario), which)
    check_driver(driver, world)
    answer = run_in_jason(driver, law, world, steps, {"start": None, "seed": seed if seed is not None else 0 if which == "all" else None, "choices": None, "percepts": None, "until": until})
    document = trace_document(driver, world, which, rules, answer["steps"], None, None, None, None)
    return {**document, "seed": seed, "fault": answer.get("fault"), "steps_per_second": answer.get("steps_per_second")}


def run_request(world: Scenario, steps: int) -> dict[str, Any]:
    """A run of the published start as `rotra.jason.Job` reads it; agent and rules are still to be named."""
    return {"world": scenario_json(world), "steps": steps, "start": None, "seed": None, "choices": None, "percepts": None, "until": None, "trace": True, "cap": CAP}


def run_in_jason(driver: Driver, law: Law, world: Scenario, steps: int, job: dict[str, Any]) -> dict[str, Any]:
    """The Java side's answer to a run; `job` gives start, seed, choices, percepts and until."""
    with tempfile.TemporaryDirectory(prefix="rotra-") as folder:
        advice = Path(folder) / "advice.asl"
        advice.write_text(law.text, encoding="utf-8")
        request = {**run_request(world, steps), "agent": str(driver.file.resolve()), "rules": str(advice), **job}
        answer = ask_java("run", request, timeout=60 + steps / 100)
    assert isinstance(answer, dict)
    answer["steps"] = placed(answer["steps"])
    return answer


def write_trace(path: Path, trace: dict[str, Any]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(trace, indent=1, sort_keys=True) + "\n", encoding="utf-8")
