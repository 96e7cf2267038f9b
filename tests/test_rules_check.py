"""What `rotra rules check` finds: each code by a small case, every answer against all situations, the published base.

A case under cases/rules_check/ is a rule base; expected.txt holds its findings.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from itertools import product
from pathlib import Path

import pytest
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st

from reference import reference
from rotra.advice import compile
from rotra.cli import main
from rotra.diagnostics import Rejected
from rotra.frontends.rules import Directive, Ontology, Rule, RuleBase, Term, load_rule_base
from rotra.origins import NOWHERE
from rotra.pipeline.advise import advise_one
from rotra.pipeline.rules_check import CODES, Finding, check_rules, find
from rotra.pipeline.rules_import import import_rules

CASES = Path(__file__).parent / "cases"


@pytest.mark.parametrize("case", sorted(p.name for p in (CASES / "rules_check").iterdir()))
def test_cases(case: str, expected: Callable[[Path, str], None]) -> None:
    folder = CASES / "rules_check" / case
    try:
        said = "".join(json.dumps(f.as_json()) + "\n" for f in check_rules(str(folder)))
    except Rejected as refusal:
        said = f"{refusal}\n"
    expected(folder / "expected.txt", said.replace("tests/cases/rules_check/", "").replace(f"{CASES / 'rules_check'}/", ""))


def test_every_code_has_a_case(tmp_path: Path) -> None:
    import_rules(CASES / "import" / "kept-and-repaired" / "rules.pl", tmp_path / "imported")
    bases = [CASES / "rules_check" / "every-finding", CASES / "rules_check" / "accepted", tmp_path / "imported"]
    assert {f.code for base in bases for f in check_rules(str(base))} == set(CODES)


@pytest.mark.parametrize(("case", "status"), [("accepted", 0), ("every-finding", 1), ("RB126-stale", 2)])
def test_exit_status(case: str, status: int) -> None:
    answer = CliRunner().invoke(main, ["rules", "check", "--rules", str(CASES / "rules_check" / case), "--json"])
    assert answer.exit_code == status
    assert status == 2 or {"code", "rules", "situation", "accepted"} <= json.loads(answer.output)["findings"][0].keys()


def test_advice_marks_what_a_higher_authority_outranks() -> None:
    def asked(*beliefs: str, intends: tuple[str, ...] = ()) -> dict[str, object]:
        answer = advise_one(str(CASES / "rules_check" / "accepted"), "standard", beliefs, intends)
        return {d["action"]: d.get("outranked_by") for d in answer["directives"]}

    assert asked("red", "waved_on") == {"stop": ["wave"], "go": None}
    assert asked("red", intends=("turn",)) == {"stop": None, "go": None}
    assert asked("waved_on") == {"go": None}


# ---- against all situations of a small world -------------------------------------------------------------------------

WORDS = ("a", "b", "c")
words = st.lists(st.sampled_from(WORDS), max_size=2, unique=True).map(tuple)
directives = st.lists(st.sampled_from([Directive(label, action) for label in ("must", "should") for action in ("stop", "go")]), min_size=1, max_size=2, unique=True).map(tuple)
rules = st.tuples(st.sampled_from(["standard", "emergency"]), words, words, words, directives)


def small_base(parts: list[tuple], excluded: bool) -> RuleBase:
    beliefs = {w: Term(w, "belief", w, excludes=("b",) if w == "a" and excluded else ()) for w in WORDS}
    actions = {"stop": Term("stop", "action", "x", opposites=("go",)), "go": Term("go", "action", "x")}
    names = {("belief", w): w for w in WORDS} | {("intention", w): w for w in WORDS} | {("action", a): a for a in actions}
    intentions = {w: Term(w, "intention", w) for w in WORDS}
    ontology = Ontology({"standard": "", "emergency": ""}, {"must": "", "should": ""}, beliefs, intentions, actions, names)
    made = [Rule(f"r{n}", "1", "x", c, b, i, u, (), d, (), "", "S", NOWHERE) for n, (c, b, i, u, d) in enumerate(parts)]
    return RuleBase("small", "", ontology, tuple(made), ())


def every_situation(excluded: bool) -> Iterator[tuple[str, frozenset[str], frozenset[str]]]:
    for context, *held in product(["standard", "emergency"], *[[False, True]] * 6):
        beliefs = frozenset(w for w, h in zip(WORDS, held[:3], strict=True) if h)
        if not (excluded and {"a", "b"} <= beliefs):
            yield context, beliefs, frozenset(w for w, h in zip(WORDS, held[3:], strict=True) if h)


def applies(rule: Rule, situation: tuple[str, frozenset[str], frozenset[str]]) -> bool:
    context, beliefs, intentions = situation
    return rule.context == context and set(rule.beliefs) <= beliefs and set(rule.intentions) <= intentions and not set(rule.unless_beliefs) & beliefs


@settings(deadline=None, max_examples=150)
@given(st.lists(rules, min_size=1, max_size=5), st.booleans())
def test_findings_are_what_all_situations_show(parts: list[tuple], excluded: bool) -> None:
    base = small_base(parts, excluded)
    where = {r.id: {s for s in every_situation(excluded) if applies(r, s)} for r in base.rules}
    asked = {r.id: set(r.directives) for r in base.rules}
    found = find(base)

    def of(code: str) -> list[Finding]:
        return [f for f in found if f.code == code]

    assert {f.rules[0] for f in of("never-applicable")} == {r for r in where if not where[r]}
    pairs = [(a.id, b.id) for n, a in enumerate(base.rules) for b in base.rules[n + 1 :] if where[a.id]]
    assert {f.rules for f in of("identical")} == {(a, b) for a, b in pairs if where[a] == where[b] and asked[a] == asked[b]}
    given = {(s, d) for r in where for s in where[r] for d in asked[r]}
    for finding in of("subsumed"):
        first, *others = finding.rules
        assert {(s, d) for s in where[first] for d in asked[first]} <= {(s, d) for r in others for s in where[r] for d in asked[r]}
    for rule in where:
        needless = where[rule] and given == {(s, d) for r in where if r != rule for s in where[r] for d in asked[r]}
        assert bool(needless) == any(rule == f.rules[0] if f.code == "subsumed" else rule in f.rules for f in found if f.code in ("identical", "subsumed"))
    clashes = {
        (frozenset((a, b)), frozenset((str(x), str(y))))
        for a in where for b in where if where[a] & where[b]
        for x in asked[a] for y in asked[b] if (x.action, y.action) == ("stop", "go")
    }  # fmt: skip
    assert {(frozenset(f.rules), frozenset(f.words)) for f in of("conflict")} == clashes
    both = {x.action for a in where for b in where if where[a] & where[b] for x in asked[a] for y in asked[b] if x.action == y.action and x.label != y.label}
    assert {f.words[0] for f in of("must-and-should")} == both
    for finding in (*of("conflict"), *of("must-and-should")):
        assert finding.situation is not None
        least = (finding.situation.context, frozenset(finding.situation.beliefs), frozenset(finding.situation.intentions))
        shared = set.intersection(*(where[r] for r in finding.rules))
        assert least in shared and not any(b <= least[1] and i <= least[2] and (b, i) != least[1:] for _, b, i in shared)
    assert {f.words[0] for f in of("empty-context")} == {c for c in base.ontology.contexts if not any(where[r.id] and r.context == c for r in base.rules)}


# ---- the published base ----------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def published(tmp_path_factory: pytest.TempPathFactory) -> RuleBase:
    folder = tmp_path_factory.mktemp("published") / "base"
    import_rules(reference("published_rules.pl"), folder, CASES / "import" / "published_overlay.yaml")
    return load_rule_base(folder)


def test_published_base_repeats_itself(published: RuleBase) -> None:
    found = find(published)

    def rules_of(code: str) -> set[tuple[str, ...]]:
        return {f.rules for f in found if f.code == code}

    assert rules_of("duplicate-name") == {(n, f"{n}#2") for n in ("r135", "r176", "r208", "r242", "r244", "r258", "r289", "r296")}
    assert rules_of("never-applicable") == {("r115b",), ("r196",)}
    assert rules_of("identical") == {("r226b", "r236"), ("r118", "r120")}
    assert rules_of("subsumed") == {
        ("r166c", "r166a"), ("r166c", "r166b"), ("r127b", "r127a"), ("r127c", "r127a"), ("r198", "r170"), ("r206b", "r218a"), ("r206c", "r218b"),
    }  # fmt: skip


# Two directives that the published base gives together, the rules that do, and the words of the smallest situation.
CONFLICTS = [
    ("must stop_at_white_line", "must avoid_stopping", "r293a r291c", "controlledCrossing flashingRed levelCrossing"),
    ("must safe_pull_over_and_stop", "must avoid_stopping", "r106 r271a", "motorway notDirectedByPoliceOfficer policeAttentionActive policeDirectingLeft"),
    ("must safe_pull_over_and_stop", "must avoid_hard_shoulder", "r106 r269a", "motorway notDirectedByPoliceOfficer policeAttentionActive policeDirectingLeft"),
    ("must safe_pull_over_and_stop", "must avoid_hard_shoulder", "r106 r269b", "motorway noSpeedlimitForHardShoulder policeAttentionActive policeDirectingLeft"),
    ("must safe_pull_over_and_stop", "must avoid_emergency_area", "r106 r270", "motorway policeAttentionActive policeDirectingLeft"),
    ("must safe_pull_over_and_stop", "must avoid_stopping", "r107b r271a", "motorway notDirectedByPoliceOfficer dvsaAttentionActive dvsapullOverSignal"),
    ("must safe_pull_over_and_stop", "must avoid_stopping", "r108 r271a", "motorway notDirectedByPoliceOfficer toAttentionActive toDirectingLeft"),
    ("must stop", "must avoid_stopping", "r286 r271a", "inIncident damagedOrInjury motorway notDirectedByPoliceOfficer"),
    ("must next_safe_stop", "must avoid_stopping", "r89 r271a", "vehicleUnsafe motorway notDirectedByPoliceOfficer"),
    ("must next_safe_stop", "must avoid_stopping", "r92 r271a", "cantReadNumberPlate motorway notDirectedByPoliceOfficer"),
    ("must stop_at_sign", "must avoid_stopping", "r258#2 r271a", "motorway signFlashingRedX laneNotAvailiable notDirectedByPoliceOfficer"),
    ("must stop_at_white_line", "must do_not_stop", "r175a r293b", "controlledCrossing amber lightRed approachingTrafficLight"),
    ("must follow_dvsa_until_stopped", "must safe_pull_over_and_stop", "r107a r107b", "dvsaAttentionActive dvsafollowRequest dvsapullOverSignal"),
    ("must avoid_hard_shoulder", "should pull_into_hard_shoulder", "r269a r277", "brokendown motorway notDirectedByPoliceOfficer"),
    ("must avoid_emergency_area", "should pull_into_emergency_area", "r270 r277", "brokendown motorway"),
    ("must avoid_hard_shoulder", "should buildup_speed_on_hard_shoulder", "r269a r278", "motorway hardshoulder notDirectedByPoliceOfficer joinMotorway"),
    ("must fog_lights_off", "should fog_lights_on", "r226b r235", "fog visibilityClear"),
    ("must fog_lights_off", "should fog_lights_on", "r236 r226a", "visibilityClear visibilitySeriouslyReduced"),
    ("must turn_foglights_off", "should fog_lights_on", "r114a r235", "fog fogLightsOn visibilityFine"),
    ("must cancel_overtaking", "should move_quickly_past", "r165a r163a", "noOvertakingSign overtake"),
    ("must cancel_overtaking", "should overtake_on_right", "r165a r267", "noOvertakingSign motorway overtake"),
    ("must avoidRightHandLane", "should position_right_turn", "r135#2 r179", "singleCarriageWay turnRight"),
    ("must wait_at_white_line", "should allowed_to_proceed", "r176 r177", "atTrafficLight lightNotGreen greenFilterLightForExit setOff"),
    ("should keep_left_lane", "should overtake_on_right", "r264a r267", "motorway hardshoulderNotUsed overtake"),
    ("should cancel_overtaking", "should move_quickly_past", "r162a r163a", "roadAheadNotClear overtake"),
    ("should signal_right", "should approach_left_hand_lane", "r186b", "rightExitRoundabout"),
    ("should get_into_lane", "should avoid_lane_switching", "r288", "roadWorksAhead"),
    ("should merge_in_turn", "should avoid_lane_switching", "r288", "roadWorksAhead"),
    ("should reduce_distance_between_front_vehicle", "should increase_distance_to_car_infront", "r151 r126", "slowMovingTraffic cantStopBeforeCarInFrontStops"),
    ("should reduce_distance_between_front_vehicle", "should increase_distance_to_car_infront", "r151 r227", "slowMovingTraffic wetWeather"),
    ("should reduce_distance_between_front_vehicle", "should increase_distance_to_car_infront", "r151 r290", "slowMovingTraffic roadWorks contraflow"),
    ("should use_hazard_lights", "should set_hazards_off", "r283 r116a", "inIncident notTempObstructingTraffic setHazardsOn"),
]  # fmt: skip


def test_published_base_contradicts_itself(published: RuleBase) -> None:
    found = {
        (frozenset(f.words), frozenset(f.rules), frozenset((*f.situation.beliefs, *f.situation.intentions)))
        for f in find(published)
        if f.code == "conflict" and f.situation
    }
    assert [c for c in CONFLICTS if (frozenset(c[:2]), frozenset(c[2].split()), frozenset(c[3].split())) not in found] == []


def test_the_advice_in_each_situation_shows_the_conflict(published: RuleBase) -> None:
    adviser = compile(published)
    for finding in find(published):
        if finding.code == "conflict" and finding.situation:
            s = finding.situation
            given = {f"{d.label} {d.action}" for d in adviser.advise(s.context, s.beliefs, s.intentions).directives}
            assert set(finding.words) <= given
