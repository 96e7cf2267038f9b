"""Drive an agent in Jason, in lockstep with the Java world, and give back its trace.

In: names or paths, the instance, a seed; which other rules hold from which step on.  Out: a trace document.  Left to others: showing it (draw.py, explain.py).
"""

from __future__ import annotations

import json
import re
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rotra.diagnostics import Rejected, problem
from rotra.engines.jvm import ask_java, placed
from rotra.frontends.scenario import Scenario, instance, resolve_scenario, scenario_json
from rotra.origins import Origin
from rotra.pipeline.campaign import trace_document
from rotra.pipeline.inputs import Driver, Law, check_driver, load_drivers, load_law

# other rules, and the step from which on they advise
Change = tuple[int, str]

# reasoning cycles in one step, after which a driver is said not to come to rest
CAP = 500


def drive(agent: str, scenario: str, steps: int, which: str, rules: str, seed: int | None, until: str | None, then: Sequence[Change] = ()) -> dict[str, Any]:
    """A run of at most `steps` steps; without a seed the published start is taken and nobody hesitates."""
    (driver,) = load_drivers([agent])
    law = load_law(rules)
    later = load_changes(then)
    world = instance(resolve_scenario(scenario), which)
    check_driver(driver, world)
    job = {"start": None, "seed": seed if seed is not None else 0 if which == "all" else None, "choices": None, "percepts": None, "until": until}
    answer = run_in_jason(driver, law, world, steps, job, later)
    document = trace_document(driver, world, which, rules, answer["steps"], None, None, None, None)
    return {**document, "seed": seed, "fault": answer.get("fault"), "steps_per_second": answer.get("steps_per_second")}


def read_changes(given: Sequence[str], last: int) -> tuple[Change, ...]:
    """`de@20`: from step 20 on the rules are `de`.  `last`: the last step of the run.  Errors: TR104."""
    found = {text: re.fullmatch(r"(.+)@([1-9]\d{0,8})", text) for text in given}
    wrong = [text for text, shape in found.items() if shape is None]
    steps = [int(shape[2]) for shape in found.values() if shape is not None]
    faults = [problem("TR104", Origin("--then"), f"{text!r} does not say from which step on which rules hold", "write it as in --then de@20") for text in wrong]
    faults += [problem("TR104", Origin("--then"), f"two rule bases are to hold from step {n} on", "give each its own step") for n in sorted(set(steps)) if steps.count(n) > 1]
    faults += [problem("TR104", Origin("--then"), f"step {n} comes after the last one, {last}", "ask for more --steps") for n in sorted(set(steps)) if n > last]
    if faults:
        raise Rejected(faults)
    return tuple((int(shape[2]), shape[1]) for shape in found.values() if shape is not None)


def load_changes(changes: Sequence[Change]) -> tuple[tuple[int, str, Law], ...]:
    return tuple((at, name, load_law(name)) for at, name in changes)


def run_request(world: Scenario, steps: int) -> dict[str, Any]:
    """A run of the published start as `rotra.jason.Job` reads it; agent and rules are still to be named."""
    return {"world": scenario_json(world), "steps": steps, "start": None, "seed": None, "choices": None, "percepts": None, "until": None, "trace": True, "cap": CAP}


def run_in_jason(driver: Driver, law: Law, world: Scenario, steps: int, job: dict[str, Any], then: Sequence[tuple[int, str, Law]] = ()) -> dict[str, Any]:
    """The Java side's answer to a run; `job` gives start, seed, choices, percepts and until, `then` the rules that come later."""
    with tempfile.TemporaryDirectory(prefix="rotra-") as folder:

        def written(rules: Law, name: str) -> str:
            file = Path(folder) / name
            file.write_text(rules.text, encoding="utf-8")
            return str(file)

        changes = [{"at": at, "name": name, "rules": written(rules, f"advice{at}.asl")} for at, name, rules in then]
        request = {**run_request(world, steps), "agent": str(driver.file.resolve()), "rules": written(law, "advice.asl"), "then": changes, **job}
        answer = ask_java("run", request, timeout=60 + steps / 100)
    assert isinstance(answer, dict)
    answer["steps"] = placed(answer["steps"])
    return answer


def write_trace(path: Path, trace: dict[str, Any]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(trace, indent=1, sort_keys=True) + "\n", encoding="utf-8")
