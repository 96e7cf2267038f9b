"""Other laws and the other side of the road: rule bases without findings, mirrored worlds, rules swapped in a run."""

from __future__ import annotations

from itertools import pairwise

import pytest

from rotra.diagnostics import Rejected
from rotra.engines import places
from rotra.frontends.properties import load_properties
from rotra.frontends.rules import load_rule_base, shipped_rule_bases
from rotra.frontends.scenario import mirrored_world, resolve_scenario, scenario_json
from rotra.pipeline.advise import advise_one
from rotra.pipeline.campaign import Row, Wanted, run_campaign
from rotra.pipeline.drive import drive, read_changes
from rotra.pipeline.explain import explain
from rotra.pipeline.replay import replay_trace
from rotra.pipeline.rules_check import check_rules

OTHER_LAWS = [name for name in shipped_rule_bases() if name != "uk"]
CASES = places.PROJECT / "tests" / "cases" / "jurisdictions"
MIRRORED = {"traffic_light_right": "traffic_light", "overtake_right": "overtake", "left_turn": "right_turn"}


def verdicts(agent: str, scenario: str, rules: str, names: tuple[str, ...] = (), catalogue: str = "") -> dict[str, Row]:
    wanted = Wanted((agent,), (scenario,), names, (catalogue,) if catalogue else (), "all", rules, None, 1, 100.0)
    return {row.property: row for row in run_campaign(wanted, lambda *_: None).rows}


# ---- the rule bases --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("rules", OTHER_LAWS)
def test_nothing_is_wrong_with_the_rules(rules: str) -> None:
    assert [f for f in check_rules(rules) if not f.accepted] == []


@pytest.mark.parametrize("rules", OTHER_LAWS)
def test_a_must_names_its_law_and_every_action_has_a_meaning(rules: str) -> None:
    base = load_rule_base(rules)
    assert [r.id for r in base.rules if any(d.label == "must" for d in r.directives) and not r.legal] == []
    assert [a for a in base.ontology.actions if base.meaning(a) is None] == []


@pytest.mark.parametrize("rules", OTHER_LAWS)
def test_words_that_british_law_has_too_are_of_the_same_kind(rules: str) -> None:
    british, other = load_rule_base("uk").ontology, load_rule_base(rules).ontology
    kinds = ("belief", "intention", "action")
    assert [(w, k) for k in kinds for w in other.terms(k) for b in kinds if b != k and w in british.terms(b)] == []


def asked(rules: str, beliefs: str, intentions: str = "") -> set[str]:
    answer = advise_one(rules, "standard", beliefs.split(), intentions.split(), strict=True)
    return {f"{d['label']} {d['action']}" for d in answer["directives"]}


def test_german_rules_hold_a_car_at_a_red_light_but_for_the_plate() -> None:
    at_red = "driving at_traffic_light light_red"
    assert "must wait_at_white_line" in asked("de", at_red, "turn_right")
    assert "must wait_at_white_line" in asked("de", f"{at_red} green_arrow_plate", "turn_left")
    on_plate = asked("de", f"{at_red} green_arrow_plate", "turn_right")
    assert "must stop_before_turning_on_red" in on_plate and "must wait_at_white_line" not in on_plate


def test_german_rules_order_back_to_the_right_but_in_dense_traffic() -> None:
    passed = "driving in_overtaking_lane vehicle_passed"
    assert "must move_right" in asked("de", passed, "overtake")
    assert "must move_right" not in asked("de", f"{passed} dense_traffic", "overtake")
    assert "must move_right" not in asked("de", passed, "turn_left")


# ---- mirrored worlds -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["traffic_light", "overtake", "right_turn", "open"])
def test_a_mirror_of_a_mirror_is_the_world_itself(name: str) -> None:
    world = resolve_scenario(name)
    assert mirrored_world(world) != world
    assert scenario_json(mirrored_world(mirrored_world(world))) == scenario_json(world)


@pytest.mark.parametrize(("mirrored", "world"), MIRRORED.items())
def test_the_catalogue_holds_where_german_cars_drive_on_the_right(mirrored: str, world: str) -> None:
    rows = verdicts("reactive", mirrored, "de")
    named = {p.id for p in load_properties(None, load_rule_base("uk")) if world in p.scenarios}
    assert named <= set(rows)
    assert [r.property for r in rows.values() if r.as_expected is False] == []
    hold = {"never_ignores_must", "never_crashes", "never_speeds", "one_act_a_step", "main_goal_survives", "comes_to_rest"} | {
        n for n in rows if n.startswith("finishes")
    }
    assert {n: rows[n].verdict for n in hold} == dict.fromkeys(hold, "holds")


def test_red_holds_on_the_other_side_too() -> None:
    rows = verdicts("reactive", "traffic_light_right", "de", ("never_crosses_on_red", "stops_on_amber", "goes_on_green", "stops_at_white_line"))
    assert {r.verdict for r in rows.values()} == {"holds"}


def test_the_turn_across_traffic_is_the_left_one_there() -> None:
    names = ("never_turns_in_front_of_oncoming", "enters_empty_cells", "turns_at_the_junction")
    assert {r.verdict for r in verdicts("reactive", "left_turn", "de", names).values()} == {"holds"}
    # British rules ask for the gap before a right turn; for this one they ask for nothing
    assert verdicts("reactive", "left_turn", "uk", names[:1])[names[0]].verdict == "violated"


@pytest.mark.parametrize("agent", ["reactive", "must_only"])
def test_what_is_advice_in_one_law_is_an_order_in_another(agent: str) -> None:
    rows = verdicts(agent, "overtake_right", "de", catalogue=str(CASES / "keep_right.yaml"))
    assert {r.property: r.verdict for r in rows.values()} == dict.fromkeys(rows, "holds") and len(rows) == 4


def test_a_property_in_words_that_the_law_lacks_is_vacuous_with_the_reason() -> None:
    row = verdicts("reactive", "overtake", "de", ("keeps_left",))["keeps_left"]
    assert (row.verdict, row.expected) == ("vacuous", None)
    assert row.reason == "no rule advises should keep_left here"


# ---- rules swapped while a run goes on -------------------------------------------------------------------------------


def test_from_a_step_on_other_rules_advise() -> None:
    trace = drive("reactive", "overtake", 12, "published", "uk", None, None, [(3, "de"), (6, "uk")])
    steps = [s for s in trace["steps"] if "acts" in s]
    assert {s["step"]: s["rules"] for s in steps if "rules" in s} == {3: "de", 6: "uk"}
    bases = {name: {r.id for r in load_rule_base(name).rules} for name in ("uk", "de")}
    for step in steps:
        by = {rule for d in step["advice"] for rule in d["rules"]}
        assert by and by <= bases["de" if 3 <= step["step"] < 6 else "uk"]
    assert all(after["cars"] != before["cars"] for before, after in pairwise(steps))  # it drives on
    assert "-- from here on the rules are de --\nstep 3" in explain(trace, False)
    assert replay_trace(trace) is None


def test_rules_that_are_swapped_for_themselves_change_nothing() -> None:
    plain = drive("proactive", "traffic_light", 15, "published", "uk", None, None)
    swapped = drive("proactive", "traffic_light", 15, "published", "uk", None, None, [(8, "uk")])
    assert swapped["steps"][7].pop("rules") == "uk"
    assert swapped["steps"] == plain["steps"]


@pytest.mark.parametrize("given", [["de"], ["@3"], ["de@0"], ["de@3", "uk@3"], ["de@41"]])
def test_a_change_that_cannot_be_made_is_refused(given: list[str]) -> None:
    with pytest.raises(Rejected) as refused:
        read_changes(given, 40)
    assert [d.code for d in refused.value.diagnostics] == ["TR104"]
