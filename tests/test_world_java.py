"""The Java world against the plain simulator, in the made-up worlds of test_world.py; so it agrees with the lowered one."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rotra.engines import places
from rotra.engines.process import run
from rotra.frontends.scenario import Scenario, resolve_scenario, scenario_json
from rotra.lowering.world import possible_percepts
from simulator import Simulator
from test_world import MANY, all_acts, begin, scenarios

SOURCE = Path(__file__).parent / "java" / "WorldSteps.java"
SHIPPED = [resolve_scenario(name) for name in ("traffic_light", "overtake", "right_turn")]


def shown(sim: Simulator) -> dict[str, Any]:
    cars = {c.name: {"x": c.at[0], "y": c.at[1], "heading": c.heading, "speed": c.speed, "crashed": c.crashed} for c in sim.cars}
    return {"lights": {x.name: sim.colour(x.name) for x in sim.scenario.lights}, "cars": cars, "finished": sim.finished}


def drive(s: Scenario, draw: Any) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    """A job for the Java world, and what it should answer."""
    sim, order = begin(s, draw), possible_percepts(s)
    start = {
        "driverAt": sim.cars[0].at, "phases": dict(sim.phases),
        "trafficAt": {c.name: c.at for c in sim.cars[1:]}, "trafficSpeed": {c.name: c.pace for c in sim.cars[1:]},
    }
    steps, answers = [], []
    for _ in range(6):
        sim.hesitating = {c.name for c in s.traffic if any(c.hesitates.all) and draw(st.booleans())}
        act = draw(st.sampled_from(all_acts(s.top_speed)))
        steps.append({"hesitates": sorted(sim.hesitating), "act": act})
        seen = sim.percepts()
        sim.step(act)
        answers.append({"percepts": " ".join(t for t in order if t in seen), "state": shown(sim)})
    return {"scenario": scenario_json(s), "start": start, "steps": steps}, answers


def test_java_world(tmp_path: Path) -> None:
    listing = places.classpath_file()
    if not listing.is_file() or not places.classes()[1].is_dir():
        pytest.skip("the Java side is not built: run `make setup`")
    jobs: list[dict[str, Any]] = []
    expected: list[dict[str, Any]] = []

    @settings(MANY, max_examples=200)
    @given(st.one_of(scenarios(), st.sampled_from(SHIPPED)), st.data())
    def collect(s: Scenario, data: st.DataObject) -> None:
        job, answers = drive(s, data.draw)
        jobs.append(job)
        expected.extend(answers)

    collect()
    classes = ":".join((str(places.classes()[1]), listing.read_text().strip()))
    outcome = run([places.java(), "-cp", classes, str(SOURCE)], stdin=json.dumps(jobs), timeout=120)
    assert outcome.ok, outcome.why()
    got = [json.loads(line) for line in outcome.stdout.splitlines()]
    assert len(got) == len(expected)
    for n, (theirs, ours) in enumerate(zip(got, expected, strict=True)):
        assert theirs == ours, json.dumps(jobs[n // 6])
