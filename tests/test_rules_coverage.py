"""The table of paragraphs: how it is read and refused, and that of the shipped base: complete, and as its README shows it.

A case under cases/rules_coverage/ is a folder of files that join those of cases/rules/base.  `small` is the one that is
read; the others are refused by the code that they are named after.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
import yaml

from reference import reference
from rotra.diagnostics import Rejected
from rotra.frontends.rules import PROJECT, load_rule_base
from rotra.pipeline.rules_coverage import DISPOSITIONS, IMPLEMENTED, MISSING, as_markdown, coverage, paragraphs

CASES = Path(__file__).parent / "cases" / "rules_coverage"
UK = PROJECT / "rules" / "uk"
BEGIN, END = "<!-- coverage -->\n", "<!-- end of coverage -->\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return Path(shutil.copytree(CASES.parent / "rules" / "base", tmp_path / "tiny"))


@pytest.fixture
def small(folder: Path) -> Path:
    (folder / "lights.yaml").unlink()
    for file in (CASES / "small").glob("*.yaml"):
        shutil.copy(file, folder / file.name)
    return folder


def test_small_table(small: Path, expected: Callable[[Path, str], None]) -> None:
    found = coverage(str(small))
    assert [p.paragraph for p in found] == ["H1", "H2", "1", "2", "3", "4", "5", "6", "10a"]
    assert [p.disposition for p in found if p.paragraph in ("2", "6")] == [IMPLEMENTED, MISSING]
    assert json.loads(json.dumps(found[0].as_json())) == {"paragraph": "H1", "disposition": IMPLEMENTED, "rules": ["t1"], "reason": ""}
    expected(CASES / "small" / "expected.md", as_markdown(found))


def test_without_a_table_there_are_the_paragraphs_of_the_rules(small: Path) -> None:
    (small / "coverage.yaml").unlink()
    assert [(p.paragraph, p.rules) for p in coverage(str(small))] == [("H1", ("t1",)), ("2", ("t1", "t2")), ("10a", ("t10",))]


@pytest.mark.parametrize("case", sorted(p.name for p in CASES.iterdir() if p.name != "small"))
def test_refusals(case: str, folder: Path, expected: Callable[[Path, str], None]) -> None:
    shutil.copy(CASES / case / "coverage.yaml", folder)
    with pytest.raises(Rejected) as refusal:
        coverage(str(folder))
    assert {d.code for d in refusal.value.diagnostics} == {case.split("-")[0]}
    expected(CASES / case / "expected.txt", str(refusal.value).replace(f"{folder}/", "") + "\n")


@pytest.mark.parametrize(
    ("text", "names"),
    [("176", ["176"]), ("113, 226", ["113", "226"]), ("H1-H3, 7", ["H1", "H2", "H3", "7"]), ("8-8", ["8"]), ("5-4", []), ("240a", ["240a"])],
)
def test_paragraphs_that_a_text_names(text: str, names: list[str]) -> None:
    assert list(paragraphs(text)) == names


# ---- the shipped base ------------------------------------------------------------------------------------------------


def test_every_paragraph_of_the_code_is_disposed_of() -> None:
    found = coverage("uk")
    assert [p.paragraph for p in found] == list(paragraphs("H1-H3, 1-307"))
    assert {p.disposition for p in found} <= {IMPLEMENTED, *DISPOSITIONS}
    assert all(bool(p.rules) != bool(p.reason) for p in found)
    assert len(load_rule_base("uk").rules) >= 313


def test_readme_shows_the_table(expected: Callable[[Path, str], None]) -> None:
    head, rest = (UK / "README.md").read_text(encoding="utf-8").split(BEGIN)
    expected(UK / "README.md", f"{head}{BEGIN}\n{as_markdown(coverage('uk'))}\n{END}{rest.split(END)[1]}")


def test_every_paragraph_of_the_published_base_has_rules() -> None:
    published = json.loads(reference("published_rules.json").read_text(encoding="utf-8"))
    wanted = {"".join(c for c in rule["name"][1:] if c.isdigit()) for rule in published}
    assert wanted <= {p.paragraph for p in coverage("uk") if p.rules}


def test_every_published_word_is_an_alias_or_dropped_with_a_reason() -> None:
    published = json.loads(reference("published_rules.json").read_text(encoding="utf-8"))
    dropped = yaml.safe_load((UK / "dropped.yaml").read_text(encoding="utf-8"))
    ontology = load_rule_base("uk").ontology
    words = {("belief", w) for r in published for w in r["beliefs"]} | {("intention", w) for r in published for w in r["intentions"]}
    words |= {("action", a.split("-", 1)[1]) for r in published for a in r["actions"]}
    assert sorted((k, w) for k, w in words if ontology.canonical(k, w) is None and not dropped[f"{k}s"].get(w)) == []


def test_dropped_words_are_words_of_ours_in_no_way() -> None:
    dropped = yaml.safe_load((UK / "dropped.yaml").read_text(encoding="utf-8"))
    ontology = load_rule_base("uk").ontology
    assert [(k, w) for k in ("belief", "intention", "action") for w in dropped[f"{k}s"] if ontology.canonical(k, w)] == []


def test_no_term_is_two_kinds_or_the_word_for_what_is_not() -> None:
    ontology = load_rule_base("uk").ontology
    beliefs, intentions, actions = ontology.beliefs, ontology.intentions, ontology.actions
    assert not (set(beliefs) & set(intentions) | set(beliefs) & set(actions) | set(intentions) & set(actions))
    assert [w for w in (*beliefs, *intentions) if w.startswith("not_") or "_not_" in w or w != w.lower()] == []


def test_every_action_says_what_it_means_in_the_grid() -> None:
    base = load_rule_base("uk")
    assert set(base.ontology.actions) == {m.action for m in base.meanings}
