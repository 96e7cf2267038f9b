"""Rules that fall silent where they should speak: the published entries on the red light, in place of ours.

The published base demands to stop at a red light of whoever approaches it (175), and to wait at the line of whoever intends to
set off (176).  A car at the line does neither, so no rule holds it there; the checker must say so and name the rules.
"""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from typing import Any

import pytest
import yaml

from rotra.engines import places
from rotra.frontends.rules import load_rule_base
from rotra.pipeline.campaign import Wanted, run_campaign
from rotra.pipeline.explain import explain
from rotra.pipeline.replay import replay_trace
from rotra.pipeline.silence import silent_rules

PUBLISHED: dict[str, dict[str, Any]] = {
    "r175a": {"beliefs": ["lightRed"], "intentions": ["approachingTrafficLight"], "directives": ["must stop_at_white_line"]},
    "r175b": {"beliefs": ["lightAmber", "ableToStopByWhiteLine"], "intentions": ["approachingTrafficLight"], "directives": ["must stop_at_white_line"]},
    "r176": {"beliefs": ["atTrafficLight", "lightNotGreen"], "intentions": ["setOff"], "directives": ["must wait_at_white_line"]},
}


@pytest.fixture
def published(tmp_path: Path) -> Path:
    """Our rule base with those entries, and without the rule of ours that holds a car at an amber light."""
    base = tmp_path / "uk"
    shutil.copytree(places.PROJECT / "rules" / "uk", base)
    file = base / "traffic_lights.yaml"
    section = yaml.safe_load(file.read_text(encoding="utf-8"))
    kept = [{k: r[k] for k in ("id", "paragraph", "says")} | PUBLISHED[r["id"]] if r["id"] in PUBLISHED else r for r in section["rules"] if r["id"] != "r175c"]
    file.write_text(yaml.safe_dump({**section, "rules": kept}, sort_keys=False), encoding="utf-8")
    return base


@pytest.mark.parametrize("agent", ["reactive", "must_only", "proactive"])
def test_who_heeds_the_published_entries_drives_off_on_red(agent: str, published: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    (row,) = run_campaign(Wanted((agent,), ("traffic_light",), ("never_crosses_on_red",), (), "all", str(published), out, 1, 100.0), lambda *_: None).rows
    assert row.verdict == "violated"
    assert "r175a is silent: approaching_traffic_light is not intended" in row.reason
    assert "r176 is silent: set_off is not intended" in row.reason
    assert row.trace is not None
    trace = json.loads((out / row.trace).read_text(encoding="utf-8"))
    assert trace["steps"][-1]["acts"]["driver"].startswith("forward")
    assert replay_trace(trace) is None
    base = load_rule_base(str(published))
    assert "r175a is silent" in explain(trace, False, None, None, lambda step: silent_rules(base, step))


def test_every_belief_that_perception_derives_is_a_word_of_the_rules() -> None:
    text = (places.PROJECT / "agents" / "perception.asl").read_text(encoding="utf-8")
    derived = {b for b in re.findall(r"^believes\((\w+)\)", text, re.MULTILINE)}
    assert derived
    assert derived <= set(load_rule_base("uk").ontology.beliefs)
