"""Importing the published Prolog form: what is kept, repaired, refused; the published base against its own answers.

A case under cases/import/ is a folder with rules.pl and, where it needs one, overlay.yaml; expected.txt holds what is said
and, where the import is taken, what is written.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from reference import reference
from rotra.advice import Adviser, compile
from rotra.cli import main
from rotra.diagnostics import Rejected
from rotra.frontends.rules import RuleBase, load_rule_base
from rotra.pipeline.rules_import import import_rules

CASES = Path(__file__).parent / "cases" / "import"
OVERLAY = CASES / "published_overlay.yaml"


def of_case(case: str, folder: Path) -> str:
    overlay = CASES / case / "overlay.yaml"
    try:
        made = import_rules(CASES / case / "rules.pl", folder, overlay if overlay.is_file() else None)
        said = [d.text() for d in made.remarks]
    except Rejected as refusal:
        return f"{refusal}\n".replace(f"{CASES / case}/", "")
    written = [f"--- {p.name}\n{p.read_text(encoding='utf-8')}" for p in made.files]
    return "\n".join([*said, *written]).replace(f"{CASES / case}/", "")


@pytest.mark.parametrize("case", sorted(p.name for p in CASES.iterdir() if p.is_dir()))
def test_cases(case: str, tmp_path: Path, expected: Callable[[Path, str], None]) -> None:
    said = of_case(case, tmp_path / "made")
    code = case.split("-")[0]
    assert (code in said and not (tmp_path / "made").exists()) or not code[-1].isdigit()
    expected(CASES / case / "expected.txt", said)


def test_a_folder_of_others_is_left_alone(tmp_path: Path) -> None:
    source = CASES / "RB125-overlay" / "rules.pl"
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "rules.yaml").write_text("mine\n")
    with pytest.raises(Rejected, match="IO104"):
        import_rules(source, tmp_path / "mine")
    import_rules(source, tmp_path / "made")
    import_rules(CASES / "RB107-shared-alias" / "rules.pl", tmp_path / "made")
    assert load_rule_base(tmp_path / "made").ontology.canonical("belief", "redLight") == "redLight"


def test_the_commands(tmp_path: Path) -> None:
    def rotra(*arguments: str) -> Result:
        return CliRunner().invoke(main, ["rules", *arguments])

    made = rotra("import", str(CASES / "kept-and-repaired" / "rules.pl"), "-o", str(tmp_path / "made"), "--json")
    assert made.exit_code == 0 and json.loads(made.output)["rules"] == 4
    refused = rotra("import", str(CASES / "RB122-no-label" / "rules.pl"), "-o", str(tmp_path / "none"), "--json")
    assert refused.exit_code == 2 and {d["code"] for d in json.loads(refused.output)["error"]} == {"RB122"}
    text = rotra("export", "--rules", str(tmp_path / "made"), "--format", "prolog")
    assert text.exit_code == 0 and "rule('r1#2', standard, [lightRed], [], " in text.output
    (tmp_path / "latin.pl").write_bytes(b"% caf\xe9\n")
    assert "IO100" in rotra("import", str(tmp_path / "latin.pl"), "-o", str(tmp_path / "none")).output


def test_a_missing_file_is_said(tmp_path: Path) -> None:
    with pytest.raises(Rejected, match="IO100"):
        import_rules(tmp_path / "absent.pl", tmp_path / "made")


@settings(deadline=None, max_examples=100, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.tuples(st.integers(0, 400), st.sampled_from([*"()[],.-'\"\\%/*:|é\x00", "rule(", "X", "9", "\\xD800\\", "''", "'a-b'", " "])), max_size=4))
def test_no_text_is_a_crash(tmp_path: Path, changes: list[tuple[int, str]]) -> None:
    text = (CASES / "kept-and-repaired" / "rules.pl").read_text(encoding="utf-8")[150:]
    for place, piece in changes:
        text = text[:place] + piece + text[place:]
    (tmp_path / "rules.pl").write_text(text, encoding="utf-8")
    try:
        import_rules(tmp_path / "rules.pl", tmp_path / "made")
    except Rejected as refusal:
        assert all(d.code in ("RB121", "RB122") for d in refusal.diagnostics)


@pytest.mark.parametrize("text", ["rule(r, c, [" + "(" * 100_000 + "a", "rule(r" + "9" * 5000 + ", c, [], [], [must-stop]).", "rule(r, c, ['\\xD800\\'], [], [must-stop]).", ""])
def test_odd_files(text: str, tmp_path: Path) -> None:
    (tmp_path / "rules.pl").write_text(text, encoding="utf-8")
    try:
        assert import_rules(tmp_path / "rules.pl", tmp_path / "made").rules == 1
    except Rejected as refusal:
        assert {d.code for d in refusal.diagnostics} == {"RB121"}


@pytest.fixture(scope="module")
def published(tmp_path_factory: pytest.TempPathFactory) -> RuleBase:
    folder = tmp_path_factory.mktemp("published") / "base"
    import_rules(reference("published_rules.pl"), folder, OVERLAY)
    return load_rule_base(folder)


def answers(adviser: Adviser, situation: dict) -> set[str]:
    advice = adviser.advise(situation["context"], situation["beliefs"], situation["intentions"])
    return {f"{d.label}-{d.action}" for d in advice.directives}


def situations() -> list[dict]:
    return [json.loads(line) for line in reference("advice_situations.jsonl").read_text(encoding="utf-8").splitlines()]


def test_published_answers_are_the_definition(published: RuleBase) -> None:
    adviser = compile(published)
    assert [s["id"] for s in situations() if answers(adviser, s) != set(s["by_definition"])] == []


def test_the_published_program_differs_by_the_names_that_stand_twice(published: RuleBase) -> None:
    second = {r.id for r in published.rules if r.id != r.published_name}
    assert len(published.rules) == 313 and len(second) == 8 and all("#2" in name for name in second)
    first_of_a_name = compile(replace(published, rules=tuple(r for r in published.rules if r.id not in second)))
    assert [s["id"] for s in situations() if answers(first_of_a_name, s) != set(s["by_program"])] == []


@pytest.mark.parametrize(
    ("beliefs", "intentions", "asked"),
    [
        (["fogLightsOn", "visibilityClear", "driving", "headlightsOn"], [], "must-fog_lights_off"),
        (["lightRed", "driving", "vehicleSafe", "roadAheadClear"], ["approachingTrafficLight"], "must-stop_at_white_line"),
    ],
    ids=["fog lights left on", "approaching a red light"],
)
def test_queries_of_the_paper(published: RuleBase, beliefs: list[str], intentions: list[str], asked: str) -> None:
    always = {"must-consideration_others", "must-drive_care_attention", "must-not_drive_dangerously"}
    assert answers(compile(published), {"context": "standard", "beliefs": beliefs, "intentions": intentions}) == always | {asked}


def test_the_overlay_gives_our_words_to_what_they_mean(published: RuleBase) -> None:
    ours = load_rule_base("uk").ontology
    for kind in ("belief", "intention", "action"):
        for term in published.ontology.terms(kind).values():
            named = {ours.canonical(kind, alias) for alias in term.aliases} - {None}
            assert named <= {ours.canonical(kind, term.name), *(ours.canonical(kind, a) for a in term.aliases)}


def test_the_paper_s_own_spelling_is_answered_by_our_base() -> None:
    ours = load_rule_base("uk")
    said = answers(compile(ours), {"context": "standard", "beliefs": ["fog_lights_on", "visibility_clear", "driving", "headlights_on"], "intentions": []})
    assert f"must-{ours.ontology.canonical('action', 'fog_lights_off')}" in said


def test_words_may_take_the_names_of_another_base(tmp_path: Path) -> None:
    source = tmp_path / "rules.pl"
    source.write_text("rule(r1, c, [lightRed, amber], [overtake], [must-stop]).\nrule(r2, c, [red, lightRed], [lightRed], [must-stop, must-halt]).\n", encoding="utf-8")
    ours = tmp_path / "ours"
    shutil.copytree(CASES / ".." / "rules" / "base", ours)
    ontology = (ours / "ontology.yaml").read_text(encoding="utf-8")
    (ours / "ontology.yaml").write_text(ontology.replace("aliases: [lightRed]", "aliases: [lightRed, red]").replace("{means: Stop.,", "{means: Stop., aliases: [halt],"), encoding="utf-8")
    import_rules(source, tmp_path / "made", None, str(ours))
    base = load_rule_base(tmp_path / "made")
    assert [(r.beliefs, r.intentions, tuple(map(str, r.directives))) for r in base.rules] == [
        (("light_red", "amber"), ("overtake",), ("must stop",)),
        (("light_red",), ("lightRed",), ("must stop",)),
    ]
    assert base.ontology.beliefs["light_red"].aliases == ("lightRed", "red")


def test_our_drivers_understand_an_import_with_our_words(tmp_path: Path) -> None:
    import_rules(reference("published_rules.pl"), tmp_path / "made", OVERLAY, "uk")
    adviser = compile(load_rule_base(tmp_path / "made"))
    assert ("must", "stop_at_white_line", ("r175a",)) in adviser.advise("standard", ["light_red"], ["approaching_traffic_light"]).directives
