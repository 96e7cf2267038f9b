"""The rule base: every refusal by its case, the shipped base, the AgentSpeak text, the command line's functions.

A case under cases/rules/ is a folder of files that replace or join those of cases/rules/base; expected.txt holds what is said.
"""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from rotra.diagnostics import Rejected
from rotra.emitters.agentspeak import emit_advice
from rotra.frontends.meaning import formula_fault, pattern_fault
from rotra.frontends.rules import PROJECT, load_rule_base
from rotra.pipeline.advise import advise_lines, advise_one
from rotra.pipeline.rules_view import list_rules, show_rule

CASES = Path(__file__).parent / "cases" / "rules"


@pytest.fixture
def tiny(tmp_path: Path) -> Path:
    return Path(shutil.copytree(CASES / "base", tmp_path / "tiny"))


@pytest.mark.parametrize("case", sorted(p.name for p in CASES.iterdir() if p.is_dir() and p.name != "base"))
def test_refusals(case: str, tiny: Path, expected: Callable[[Path, str], None]) -> None:
    for file in (CASES / case).glob("*.yaml"):
        shutil.copy(file, tiny / file.name)
    with pytest.raises(Rejected) as refusal:
        load_rule_base(tiny)
    assert case.split("-")[0] in {d.code for d in refusal.value.diagnostics}
    assert all(d.hint and d.origin.line for d in refusal.value.diagnostics)
    expected(CASES / case / "expected.txt", str(refusal.value).replace(f"{tiny}/", "") + "\n")


def refused(call: Callable[[], object]) -> str:
    with pytest.raises(Rejected) as refusal:
        call()
    return refusal.value.diagnostics[0].code


def test_refusals_without_a_file(tiny: Path) -> None:
    assert refused(lambda: load_rule_base("uc")) == "RB100"
    assert refused(lambda: load_rule_base(tiny.parent)) == "RB100"
    assert refused(lambda: show_rule("uk", "r1750")) == "RB113"
    assert refused(lambda: advise_one("uk", "standard", ["light_rad"], [], strict=True)) == "RB112"
    assert refused(lambda: list(advise_lines("uk", tiny / "absent.jsonl"))) == "IO100"
    (tiny / "lights.yaml").unlink()
    assert refused(lambda: load_rule_base(tiny)) == "RB111"


def test_a_base_is_read_again_when_a_file_changes(tiny: Path) -> None:
    first = load_rule_base(tiny)
    assert load_rule_base(tiny) is first
    (tiny / "lights.yaml").write_text((tiny / "lights.yaml").read_text().replace("id: t1", "id: t2"))
    assert [r.id for r in load_rule_base(tiny).rules] == ["t2"]
    (tiny / "lights.yaml").write_text("")
    assert refused(lambda: load_rule_base(tiny)) == "IO103"


def test_line_ends_do_not_get_into_comments(tiny: Path) -> None:
    rules = (tiny / "lights.yaml").read_text()
    (tiny / "lights.yaml").write_text(rules.replace("id: t1", 'id: "t1\\n"'))
    assert refused(lambda: load_rule_base(tiny)) == "IO103"
    (tiny / "lights.yaml").rename(tiny / "lights\nadvised(must, go).yaml")
    assert refused(lambda: load_rule_base(tiny)) == "IO105"


def test_alias_and_exception(tiny: Path) -> None:
    (rule,) = load_rule_base(tiny).rules
    assert rule.beliefs == ("light_red",)
    assert (rule.unless_beliefs, rule.unless_intentions) == ((), ("overtake",))
    assert rule.origin.line == 3


def test_text_is_exact(tiny: Path) -> None:
    text = emit_advice(load_rule_base(tiny)).replace(f"{tiny}/", "")
    assert "intends(overtake) :- .intend(overtake).  // overtake <- ontology.yaml:8" in text
    assert "advised(must,stop) :- context(standard) & believes(light_red) & not intends(overtake).  // t1 <- lights.yaml:3" in text
    assert (
        "advised_next(must,stop) :- next_context(standard) & next_believes(light_red) & not next_intends(overtake).  // t1 <- lights.yaml:3" in text
    )
    assert 'rule_of("t1",must,stop) :- context(standard) & believes(light_red) & not intends(overtake).  // t1 <- lights.yaml:3' in text
    assert "contradicted(stop, forward(N)) :- stop_line(0, A) & N > A.  // stop <- directives.yaml:2" in text


def test_imported_action_with_a_hyphen_is_quoted(tiny: Path) -> None:
    ontology = (tiny / "ontology.yaml").read_text() + "  road_surfaces-avoid_non: {means: Stay on the road.}\n"
    (tiny / "ontology.yaml").write_text(ontology)
    (tiny / "lights.yaml").write_text(
        "section: S\nrules:\n  - {id: 'r145#2', published_name: r145, paragraph: 145, says: x, directives: [should road_surfaces-avoid_non]}\n"
    )
    text = emit_advice(load_rule_base(tiny))
    assert 'rule_of("r145#2",should,"road_surfaces-avoid_non") :- context(standard).' in text


@pytest.mark.parametrize(
    "text",
    [
        "stop_line(0, A) & A >= 0",
        "not (car(1,0) | car(-1, 1))",
        "(A + 1) * 2 > N - 1",
        "limit(L) & not L == 2",
        "true",
        "heading(north)",
        "task(T) & T \\== overtake",
    ],
)
def test_conditions_that_are_read(text: str) -> None:
    assert formula_fault(text) == ""


@pytest.mark.parametrize(
    "text", ["", "car(1,0) &", ".print(x)", "car(1,0) // x", "car", "car(1,0) car(1,1)", "believes(x)", "A", '"x" == "y"', "car((1,0)"]
)
def test_conditions_that_are_refused(text: str) -> None:
    assert formula_fault(text) != ""


@pytest.mark.parametrize("text", ["wait", "forward(N)", "forward(_)", "change_lane(left, 1)", "turn(S,N)"])
def test_acts_that_are_read(text: str) -> None:
    assert pattern_fault(text) == ""


# ---- the shipped base ------------------------------------------------------------------------------------------------


def actions(beliefs: list[str], intentions: Sequence[str] = ()) -> set[str]:
    return {f"{d['label']} {d['action']}" for d in advise_one("uk", "standard", beliefs, intentions, strict=True)["directives"]}


@pytest.mark.parametrize("colours", [["light_red"], ["lightRed", "lightAmber"], ["lightAmber"]])
def test_a_light_holds_a_car_at_the_line_and_before_it(colours: list[str]) -> None:
    assert "must stop_at_white_line" in actions([*colours, "at_traffic_light"])
    assert "must stop_at_white_line" in actions(colours, ["approachingTrafficLight"])


def test_green_goes_only_where_there_is_room() -> None:
    assert not any("white_line" in a for a in actions(["light_green", "at_traffic_light"], ["approaching_traffic_light"]))
    assert "should wait_at_white_line" in actions(["light_green", "at_traffic_light", "exit_not_clear"])
    assert "must stop_at_white_line" not in actions(["light_amber", "at_traffic_light", "cannot_stop_safely_by_white_line"])


def test_back_to_the_left_only_after_passing() -> None:
    beside = ["driving", "in_overtaking_lane", "overtaking", "safe_to_move_left"]
    assert "should move_left" not in actions(beside, ["overtake"])
    assert "should move_left" in actions(["driving", "in_overtaking_lane", "vehicle_passed", "safe_to_move_left"], ["overtake"])
    assert "should move_left" in actions(["driving", "in_overtaking_lane", "safe_to_move_left"])


def test_must_is_law_and_the_nearest_published_words_are_known() -> None:
    base = load_rule_base("uk")
    assert all(r.legal for r in base.rules for d in r.directives if d.label == "must")
    assert len(base.rules) >= 110
    for kind, word in (("belief", "redLight"), ("belief", "lightNotGreen"), ("intention", "setOff"), ("action", "returnToLane")):
        assert base.ontology.canonical(kind, word)


def test_every_action_of_the_grid_can_be_heeded_by_some_act() -> None:
    """Where all acts of some pattern are against an action, another pattern is left."""
    for meaning in load_rule_base("uk").meanings:
        always = {c.act.split("(")[0] for c in meaning.contradicted_by if not c.when and not c.where}
        assert always < {"wait", "forward", "change_lane", "turn"}


def test_exclusions_go_both_ways() -> None:
    ontology = load_rule_base("uk").ontology
    for kind in ("belief", "intention"):
        terms = ontology.terms(kind)
        lame = [(t.name, o) for t in terms.values() for o in t.excludes if t.name not in terms[o].excludes]
        assert lame == []


def test_perception_says_only_words_of_the_ontology() -> None:
    text = (PROJECT / "agents" / "perception.asl").read_text()
    said = set(re.findall(r"^believes\((\w+)\)", text, re.MULTILINE))
    assert said and said <= set(load_rule_base("uk").ontology.beliefs)


def test_published_entries_fall_silent_at_the_line(tmp_path: Path) -> None:
    """With r175a, r175b and r176 as published nothing holds a car at a red light (design, section 5)."""
    folder = Path(shutil.copytree(PROJECT / "rules" / "uk", tmp_path / "uk"))
    lights = (folder / "traffic_lights.yaml").read_text()
    head, *rules = re.split(r"(?m)^(?=  - id: )", lights)
    kept = [r for r in rules if not re.match(r"  - id: (r175a|r175b|r176)\n", r)]
    published = (
        "  - {id: r175a, paragraph: 175, says: x, beliefs: [lightRed], intentions: [approachingTrafficLight], directives: [must stop_at_white_line], legal: [x]}\n"
        "  - {id: r175b, paragraph: 175, says: x, beliefs: [lightAmber, ableToStopByWhiteLine], intentions: [approachingTrafficLight], directives: [must stop_at_white_line], legal: [x]}\n"
        "  - {id: r176, paragraph: 176, says: x, beliefs: [atTrafficLight, lightNotGreen], intentions: [setOff], directives: [must wait_at_white_line], legal: [x]}\n"
    )
    assert len(kept) == len(rules) - 3
    (folder / "traffic_lights.yaml").write_text(head + published + "".join(kept))

    def said(beliefs: list[str], intentions: list[str]) -> set[str]:
        return {d["action"] for d in advise_one(str(folder), "standard", beliefs, intentions)["directives"]}

    assert "stop_at_white_line" in said(["light_red", "traffic_light_ahead"], ["approaching_traffic_light"])
    assert not {"stop_at_white_line", "wait_at_white_line"} & said(["light_red", "at_traffic_light"], [])


# ---- the command line's functions ------------------------------------------------------------------------------------


def test_advise_lines(tmp_path: Path) -> None:
    source = tmp_path / "situations.jsonl"
    lines = [
        '{"context": "standard", "beliefs": ["lightRed", "purple"], "intentions": ["approaching_traffic_light"]}',
        "",
        "{",
        "[]",
        '{"beliefs": "light_red"}',
        '{"context": "emergency"}',
    ]
    source.write_text("\n".join(lines))
    first, *wrong, emergency = advise_lines("uk", source)
    assert first["unknown"] == ["purple"]
    assert {"label": "must", "action": "stop_at_white_line", "rules": ["r175a"]} in first["directives"]
    assert [list(w) for w in wrong] == [["error"]] * 3
    assert emergency == {"directives": [], "unknown": []}
    strict, *_ = advise_lines("uk", source, strict=True)
    assert "purple" in strict["error"]


def test_rules_view() -> None:
    rows = list_rules("uk")
    assert {"id", "paragraph", "says", "directives"} <= set(rows[0])
    assert show_rule("uk", "r175a")["directives"] == ["must stop_at_white_line"]
    json.dumps([rows, show_rule("uk", "r175a")])


def test_every_must_of_the_uk_names_its_law() -> None:
    assert [r.id for r in load_rule_base("uk").rules if any(d.label == "must" for d in r.directives) and not r.legal] == []
