"""Explore the running system and the model to the end, and say whether they are one graph.

In: names or paths of a driver and a scenario.  Out: a JSON-ready answer.  Left to others: the walk (evidence/crosscheck.py).
The model's side is its emitted text, read a second time; NuSMV must count as many states as that reading.
"""

from __future__ import annotations

import json
import tempfile
import time
from pathlib import Path
from typing import Any

from rotra.diagnostics import Rejected, problem
from rotra.engines import places
from rotra.engines.jvm import EngineError, ask_java
from rotra.engines.nusmv import check_model
from rotra.evidence.crosscheck import Explored, agreement, read_explored
from rotra.evidence.smv_text import TooManyStates
from rotra.frontends.scenario import Scenario, instance, resolve_scenario, scenario_json
from rotra.origins import Origin
from rotra.pipeline.drive import CAP
from rotra.pipeline.inputs import Driver, Law, check_driver, load_drivers, load_law
from rotra.pipeline.translate import model_files

MOST_STATES = 200_000
# of the pairs of mind and percepts so many are asked again, of an agent with another history
ASKED_AGAIN = 0.01


def crosscheck(agent: str, scenario: str, which: str, rules: str, folder: Path | None, timeout: float) -> dict[str, Any]:
    """`folder`: a translation (model.smv, names.json) to be checked instead of a fresh one."""
    (driver,) = load_drivers([agent])
    law = load_law(rules)
    world = instance(resolve_scenario(scenario), which)
    check_driver(driver, world)
    if world.is_open:
        raise Rejected([problem("CC100", Origin(scenario), "an open scenario has too many states to try every one", "crosscheck a scenario with a road")])
    files = _translated(folder) if folder is not None else model_files(driver, law, world, which)
    table = json.loads(files["names.json"])
    begun = time.monotonic()
    try:
        explored = _explored(driver, law, world, timeout)
        explored_in = time.monotonic() - begun
        agreed = agreement(explored, files["model.smv"], table["names"], table["constants"], MOST_STATES)
    except TooManyStates as many:
        raise _too_many(scenario, which, str(many)) from many
    divergence = agreed.divergence or _counted_otherwise(files["model.smv"], agreed.states, timeout)
    summary = explored.summary
    return {
        "equal": divergence is None,
        "states": agreed.states,
        "edges": agreed.edges,
        "divergence": divergence,
        "notion": "one to one" if agreed.one_to_one else "bisimulation",
        "jason": {key: summary[key] for key in ("states", "edges", "minds", "pairs", "asked_again")},
        "states_per_second": round(summary["states"] / max(explored_in, 1e-9)),
    }


def _explored(driver: Driver, law: Law, world: Scenario, timeout: float) -> Explored:
    lines: list[str] = []
    with tempfile.TemporaryDirectory(prefix="rotra-") as folder:
        advice = Path(folder) / "advice.asl"
        advice.write_text(law.text, encoding="utf-8")
        job = {"agent": str(driver.file.resolve()), "rules": str(advice), "world": scenario_json(world), "cap": CAP, "most": MOST_STATES, "chance": ASKED_AGAIN}
        ask_java("explore", job, timeout, lines.append)
    explored = read_explored(lines)
    if not explored.summary["whole"]:
        raise TooManyStates(f"more than {MOST_STATES} states, or minds that grow without end")
    return explored


def _translated(folder: Path) -> dict[str, str]:
    missing = [folder / name for name in ("model.smv", "names.json") if not (folder / name).is_file()]
    if missing:
        raise Rejected([problem("CC101", Origin(str(file)), "this is not there", "name a folder that `rotra translate` has written") for file in missing])
    return {name: (folder / name).read_text(encoding="utf-8") for name in ("model.smv", "names.json")}


def _too_many(scenario: str, which: str, why: str) -> Rejected:
    return Rejected([problem("CC100", Origin(scenario), f"instance {which} has {why}", "crosscheck a smaller instance")])


def _counted_otherwise(text: str, states: int, timeout: float) -> dict[str, Any] | None:
    """NuSMV reads the same text: does it reach as many states?"""
    with tempfile.TemporaryDirectory(prefix="rotra-") as folder:
        file = Path(folder) / "model.smv"
        file.write_text(text, encoding="utf-8")
        answers = check_model(places.nusmv(), file, [], timeout)
    if answers.states is None:
        raise EngineError(f"NuSMV counted no states: {answers.log[-300:]}")
    return None if answers.states == states else {"step": 0, "what": "the number of states", "jason": None, "model": states, "nusmv": answers.states}
