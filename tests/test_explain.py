"""Traces in words: reading them, telling them, drawing them."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import pytest

from rotra.diagnostics import Rejected
from rotra.pipeline.draw import draw_step
from rotra.pipeline.explain import act_words, explain, percept_words, read_trace

RULES = {"r175": ("175", "At a red light you must stop behind the line."), "r180": ("180", "Wait until there is a safe gap.")}


def step(number: int, **other: Any) -> dict[str, Any]:
    """A step at the line of a red light, and what is different in it."""
    return {
        "step": number,
        "lights": {"tl": "red"},
        "cars": {"driver": {"x": 2, "y": 5, "heading": "north", "speed": 1, "crashed": False}, "t1": {"x": 2, "y": 3, "heading": "south", "crashed": False}},
        "percepts": ["car(0,2)", "heading(north)", "light(-1,0,red)", "stop_line(0,0)"],
        "situation": {"context": "standard", "beliefs": ["at_traffic_light", "light_red"], "intentions": []},
        "beliefs": [],
        "goals": ["drive"],
        "advice": [{"label": "must", "action": "stop_at_white_line", "rules": ["r175"]}],
        "plans": [{"label": "hold", "file": "driving.asl", "line": 12}],
        "acts": {"driver": "wait"},
        "busy": [],
        "ignored": [],
        "justified": [],
        "hesitates": [],
        "finished": False,
        **other,
    }


def trace(*steps: dict[str, Any], **other: Any) -> dict[str, Any]:
    return {"agent": "a.asl", "scenario": "s", "instance": "all", "rules": "uk", "property": None, "says": None, "verdict": None, "loop": None, "steps": list(steps), **other}


def ignoring() -> dict[str, Any]:
    """It waits, then drives off on red into t1, and has crashed."""
    drives_off = step(2, acts={"driver": "forward(1)"}, plans=[{"label": "", "file": "a.asl", "line": 7}], ignored=[{"label": "must", "action": "stop_at_white_line"}])
    wreck = {"driver": {"x": 2, "y": 4, "heading": "north", "speed": 1, "crashed": True}, "t1": {"x": 2, "y": 4, "heading": "south", "crashed": True}}
    last = {"step": 3, "lights": {"tl": "red"}, "cars": wreck, "finished": False}
    return trace(step(1), drives_off, last, property="never_ignores_must", says="The driver obeys.", verdict="violated")


def test_says_what_was_seen_told_and_done() -> None:
    told = explain(trace(step(1)), False, RULES)
    assert "a car 2 ahead" in told
    assert "must      stop_at_white_line, by r175 (paragraph 175: At a red light you must stop behind the line)" in told
    assert "@hold (driving.asl:12)" in told
    assert "step 1  at (2,5) facing north, speed 1: waits" in told
    assert "heading(north)" not in told and "faces north" not in told


def test_says_only_what_changed() -> None:
    told = explain(trace(step(1), step(2)), False, RULES)
    second = told.split("step 2")[1].split("blame")[0].strip().splitlines()
    assert len(second) == 1


def test_full_says_everything_again() -> None:
    told = explain(trace(step(1), step(2)), True, RULES)
    assert told.count("that it faces north [heading(north)]") == 2
    assert told.count("paragraph 175") == 2


def test_names_what_came_and_went() -> None:
    green = step(2, lights={"tl": "red_amber"}, situation={"context": "standard", "beliefs": ["at_traffic_light", "light_amber"], "intentions": ["turn_right"]}, advice=[])
    told = explain(trace(step(1), green), False, RULES)
    assert "lights    tl red and amber" in told
    assert "believes  light_amber; no longer light_red" in told
    assert "intends   turn_right" in told
    assert "released  must stop_at_white_line: r175 no longer applies" in told
    assert "blame: none; no directive in force was ignored; the last to fall silent: must stop_at_white_line in step 2: r175 no longer applies" in told


def test_blames_plan_and_rule_and_says_what_was_right() -> None:
    told = explain(ignoring(), False, RULES, lambda s, action: "wait")
    assert "never_ignores_must is violated: The driver obeys." in told
    assert "blame: step 2: forward(1) by plan (a.asl:7) ignores must stop_at_white_line, by r175 (paragraph 175); it should have chosen wait" in told


def test_names_the_crash() -> None:
    told = explain(ignoring(), False, RULES)
    assert "the driver has crashed at (2,4) with t1" in told


def test_names_the_loop_and_the_finish() -> None:
    told = explain(trace(step(1), step(2), step(3), loop=1), False)
    assert "after step 3 comes step 2 again" in told
    assert "-- from here on it repeats --" in told
    assert "finish: never" in told
    assert "FINISH" in explain(trace(step(1), step(2, finished=True)), False)


def test_a_rule_without_paragraph_is_named_all_the_same() -> None:
    assert "stop_at_white_line, by r175\n" in explain(trace(step(1)), False)


def test_an_open_trace_has_no_places() -> None:
    told = explain(trace(step(1, cars={}, lights={})), False, RULES)
    assert "step 1: waits" in told


@pytest.mark.parametrize(
    ("text", "words"),
    [("wait", "waits"), ("forward(1)", "drives 1 cell ahead"), ("change_lane(left,3)", "changes to the lane on the left and drives 2 cells ahead"), ("turn(right,2)", "turns right, 2 cells"), ("hop((", "does hop((")],
)
def test_acts(text: str, words: str) -> None:
    assert act_words(text) == words


@pytest.mark.parametrize(
    ("text", "words"),
    [("stop_line(0,0)", "a stop line under the car"), ("car(-1,-2)", "a car 2 behind and 1 to the left"), ("light(0,1,red_amber)", "a light at red and amber 1 ahead"), ("odd", "odd")],
)
def test_percepts(text: str, words: str) -> None:
    assert percept_words(text) == words


def test_reads_what_was_written(tmp_path: Path) -> None:
    file = tmp_path / "t.json"
    file.write_text(json.dumps(ignoring()))
    assert read_trace(file) == ignoring()


def refused(file: Path) -> list[tuple[str, int, str]]:
    with pytest.raises(Rejected) as caught:
        read_trace(file)
    return [(d.code, d.origin.line, d.message) for d in caught.value.diagnostics]


def test_refuses_a_missing_file(tmp_path: Path) -> None:
    assert refused(tmp_path / "none.json")[0][0] == "IO100"
    assert refused(tmp_path)[0][0] == "IO100"


@pytest.mark.parametrize(("text", "line"), [("", 1), ('{\n"agent": \n}', 3), ("[" * 100_000, 0)])
def test_refuses_what_is_not_json(tmp_path: Path, text: str, line: int) -> None:
    file = tmp_path / "t.json"
    file.write_text(text)
    assert [(c, n) for c, n, _ in refused(file)] == [("TR101", line)]


def test_refuses_what_is_not_text(tmp_path: Path) -> None:
    file = tmp_path / "t.json"
    file.write_bytes(b"\xff\xfe\x00")
    assert refused(file)[0][0] == "TR101"


@pytest.mark.parametrize("document", [[], {}, {"agent": "a", "scenario": "s", "steps": []}, {"agent": "a", "scenario": 3, "steps": [{"step": 1}]}, {"agent": "a", "scenario": "s", "steps": [{"step": 1}], "loop": 1}])
def test_refuses_another_shape(tmp_path: Path, document: Any) -> None:
    file = tmp_path / "t.json"
    file.write_text(json.dumps(document))
    assert {c for c, _, _ in refused(file)} == {"TR102"}


def test_whatever_is_accepted_can_be_told(tmp_path: Path) -> None:
    """Any key of any step may be missing, except its number."""
    for key in step(1):
        if key != "step":
            document = copy.deepcopy(ignoring())
            for s in document["steps"]:
                s.pop(key, None)
            file = tmp_path / "t.json"
            file.write_text(json.dumps(document))
            for full in (False, True):
                assert "step 2" in explain(read_trace(file), full, RULES)
            for s in document["steps"]:
                assert draw_step(["..^.."] * 8, s)


def test_draws_the_grid() -> None:
    drawn = draw_step(["..^.."] * 8, step(1), {"tl": (1, 5)}).splitlines()
    assert drawn[5].startswith(". R ▲ . .")
    assert drawn[3].startswith(". . t . .")
    assert drawn[0].endswith("step 1")
    assert any("must stop_at_white_line" in line for line in drawn)
    assert "X" in draw_step(["..^.."] * 8, ignoring()["steps"][2])


def test_draws_without_a_grid() -> None:
    assert draw_step([], step(1, cars={}, lights={})).startswith("step 1\n")
