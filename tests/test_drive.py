"""What runs in Jason is what the model says, and the other way round.

`cases/minds`: one small driver for each thing that AgentSpeak drivers do (a goal that fails, two acts in a step, an atomic plan, ..),
in a small world of its own.  Each run is drawn by a seed and must be a path of the model, entry by entry.
"""

from __future__ import annotations

import json
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from rotra.emitters.jason_project import COMMAND
from rotra.engines import places
from rotra.pipeline.campaign import Wanted, run_campaign
from rotra.pipeline.drive import drive
from rotra.pipeline.replay import COMPARED, accept_run, first_difference, replay_trace
from rotra.pipeline.translate import translate_to

MINDS = Path(__file__).parent / "cases" / "minds"
DRIVERS = ("reactive", "must_only", "proactive")


@pytest.mark.parametrize("agent", sorted(MINDS.glob("*.asl")), ids=lambda p: p.stem)
@pytest.mark.parametrize("seed", [1, 2])
def test_what_a_mind_does_in_jason_the_model_does(agent: Path, seed: int) -> None:
    run = drive(str(agent), str(MINDS / "road.yaml"), 25, "all", "uk", seed, None)
    assert len(run["steps"]) == 26 or run["fault"]["kind"] == "restless"
    assert accept_run(run) is None


@pytest.mark.parametrize("scenario", ["traffic_light", "overtake", "right_turn"])
@pytest.mark.parametrize("agent", DRIVERS)
def test_a_run_of_a_shipped_driver_is_a_path_of_the_model(agent: str, scenario: str) -> None:
    assert accept_run(drive(agent, scenario, 30, "all", "uk", 7, None)) is None


@pytest.mark.parametrize("entry", ["acts", "beliefs", "goals", "advice", "plans", "percepts"])
def test_an_altered_run_is_not_accepted(entry: str) -> None:
    run = drive("reactive", "traffic_light", 6, "published", "uk", None, None)
    altered: dict[str, Any] = {"acts": {"driver": "change_lane(left,1)"}, "beliefs": ["other"], "goals": [], "advice": [], "plans": [], "percepts": []}
    run["steps"][3][entry] = altered[entry]
    parted = accept_run(run)
    assert parted is not None
    assert (parted["step"], parted["what"]) == (4, entry)


def test_every_counterexample_and_witness_happens_in_jason(tmp_path: Path) -> None:
    wanted = Wanted((), ("traffic_light", "overtake"), (), (), "all", "uk", tmp_path, 2, 600.0)
    rows = run_campaign(wanted, lambda *_: None).rows
    traces = sorted(tmp_path.glob("traces/**/*.json"))
    assert sum(r.verdict == "violated" for r in rows) == sum(t.name.endswith(".trace.json") for t in traces) > 0
    assert any(t.name.endswith(".witness.json") for t in traces)
    parted = {t.name: replay_trace(json.loads(t.read_text())) for t in traces}
    assert {name: p for name, p in parted.items() if p is not None} == {}


def test_a_trace_that_did_not_happen_is_told_from_one_that_did() -> None:
    run = drive("reactive", "traffic_light", 8, "published", "uk", None, None)
    assert replay_trace(run) is None
    run["steps"][4]["acts"] = {"driver": "forward(1)"}
    parted = replay_trace(run)
    assert parted is not None
    assert (parted["step"], parted["what"], parted["jason"]) == (5, "acts", {"driver": "wait"})


@pytest.mark.parametrize("agent", DRIVERS)
def test_stock_jason_leaves_the_same_trace(agent: str, tmp_path: Path) -> None:
    translate_to(agent, "overtake", "published", "uk", tmp_path / "out")
    project = tmp_path / "out" / "jason"
    ended = subprocess.run(["sh", "-c", COMMAND.replace("java ", f"{places.java()} ", 1)], cwd=project, capture_output=True, text=True, timeout=120)
    assert ended.returncode == 0, ended.stderr
    stock = json.loads((project / "trace.json").read_text())["steps"]
    own = drive(agent, "overtake", 40, "published", "uk", None, None)["steps"]
    assert len(stock) == len(own) == 41
    assert first_difference(stock, own) is None
    assert all(set(COMPARED) <= set(step) for step in stock[:-1])


def test_a_seed_gives_the_same_run_again() -> None:
    runs = [drive("reactive", "overtake", 30, "all", "uk", seed, None)["steps"] for seed in (3, 3, 4)]
    assert runs[0] == runs[1] != runs[2]


# ---- the paper's table, seen on the road -----------------------------------------------------------------------------


def driven(agent: str, scenario: str, steps: int = 60) -> list[Mapping[str, Any]]:
    return [s for s in drive(agent, scenario, steps, "published", "uk", None, None)["steps"] if "acts" in s]


def acts(run: list[Mapping[str, Any]]) -> list[str]:
    return [s["acts"]["driver"] for s in run]


@pytest.mark.parametrize("agent", DRIVERS)
@pytest.mark.parametrize("scenario", ["traffic_light", "overtake", "right_turn"])
def test_nobody_crashes_and_no_must_is_ignored(agent: str, scenario: str) -> None:
    run = driven(agent, scenario)
    assert not any(s["cars"]["driver"]["crashed"] for s in run)
    assert not any(d["label"] == "must" for s in run for d in s["ignored"])


def test_reactive_overtakes_and_comes_back_but_must_only_never_does() -> None:
    reactive, must_only = driven("reactive", "overtake"), driven("must_only", "overtake")
    assert "change_lane(left,1)" in acts(reactive)
    assert reactive[-1]["finished"]
    assert any(a.startswith("change_lane(right") for a in acts(must_only))
    assert not any(a.startswith("change_lane(left") for a in acts(must_only))
    assert not must_only[-1]["finished"]


def test_reactive_waits_for_a_gap_and_turns() -> None:
    run = driven("reactive", "right_turn")
    turn = next(n for n, a in enumerate(acts(run)) if a.startswith("turn(right"))
    assert not {"car(1,0)", "car(1,1)"} & set(run[turn]["percepts"])
    assert run[-1]["finished"]


@pytest.mark.parametrize("scenario", ["traffic_light", "overtake", "right_turn"])
def test_proactive_drives_as_reactive_does(scenario: str) -> None:
    assert acts(driven("proactive", scenario)) == acts(driven("reactive", scenario))
