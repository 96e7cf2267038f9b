"""The running system and the model are one graph; a model altered by hand is not."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from rotra.pipeline.crosscheck import crosscheck
from rotra.pipeline.translate import translate_to

DRIVERS = ("reactive", "must_only", "proactive")


@pytest.mark.parametrize("scenario", ["traffic_light", "overtake"])
@pytest.mark.parametrize("agent", DRIVERS)
def test_published_instances_are_equal(agent: str, scenario: str) -> None:
    found = crosscheck(agent, scenario, "published", "uk", None, 60)
    assert found["divergence"] is None and found["equal"]
    assert found["notion"] == "one to one"
    assert (found["states"], found["edges"]) == (found["jason"]["states"], found["jason"]["edges"])
    assert found["jason"]["asked_again"] >= 5


ALTERED = {
    "an act": (" | rest_9", "", "act"),
    "a rule": ("  rule_r124 := world.p_speed_2;", "  rule_r124 := !world.p_speed_2;", "rule:r124"),
    "a move": ("next(phase_tl) := (phase_tl + 1) mod 10", "next(phase_tl) := (phase_tl + 2) mod 10", "phase_tl"),
    "a plan": ("  take_1 := (at = start)", "  take_1 := (at = wait)", "act"),
    "a choice where there is none": ("  next(at) := at_rest;\n", "", "driver.at"),
    "a start": ("  init(y) := 7;", "  init(y) := 6;", "y"),
    "a value outside": ("next(y) := sub1_driver_y;", "next(y) := sub1_driver_y + 8;", "the model's text"),
}


@pytest.mark.parametrize("altered", sorted(ALTERED))
def test_an_altered_line_is_a_divergence(altered: str, tmp_path: Path, translation: Callable[[Path], Path]) -> None:
    before, after, what = ALTERED[altered]
    folder = translation(tmp_path)
    text = (folder / "model.smv").read_text()
    assert before in text
    (folder / "model.smv").write_text(text.replace(before, after, 1))
    found = crosscheck("reactive", "traffic_light", "published", "uk", folder, 60)
    assert not found["equal"]
    assert found["divergence"]["what"] == what and found["divergence"]["jason"] != found["divergence"]["model"]


def test_a_divergence_names_step_rule_and_plan(tmp_path: Path, translation: Callable[[Path], Path]) -> None:
    folder = translation(tmp_path)
    model = folder / "model.smv"
    model.write_text(model.read_text().replace("rule_r176 := world.p_stop_line_0_0 &", "rule_r176 := world.p_stop_line_0_1 &", 1))
    parted = crosscheck("reactive", "traffic_light", "published", "uk", folder, 60)["divergence"]
    assert parted["step"] > 1 and len(parted["hesitates"]) == parted["step"]
    assert parted["from"].startswith("rule r176 <- rules/uk/")
    assert any("driving.asl:" in plan for plan in parted["by"])


@pytest.fixture
def translation() -> Callable[[Path], Path]:
    def make(folder: Path) -> Path:
        translate_to("reactive", "traffic_light", "published", "uk", folder / "out")
        return folder / "out"

    return make
