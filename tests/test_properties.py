"""The property language: what is refused and how it is said (a case file each), how formulas group, what is expected."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

from rotra.diagnostics import CODES, Rejected
from rotra.engines.places import PROJECT
from rotra.frontends.properties import WORDS, Property, load_properties
from rotra.frontends.properties import expected as expected_verdict
from rotra.frontends.rules import RuleBase, load_rule_base
from rotra.lowering.atoms import text

CASES = Path(__file__).parent / "cases" / "properties"


@cache
def uk() -> RuleBase:
    return load_rule_base("uk")


def one(folder: Path, formula: str, more: str = "") -> Property:
    file = folder / "own.yaml"
    file.write_text(f"- id: own\n  says: Something.\n  formula: '{formula}'\n{more}", encoding="utf-8")
    (loaded,) = load_properties(file, uk())
    return loaded


@pytest.mark.parametrize("file", sorted(CASES.glob("*.yaml")), ids=lambda f: f.stem)
def test_case(file: Path, expected: Callable[[Path, str], None]) -> None:
    with pytest.raises(Rejected) as refused:
        load_properties(file, uk())
    assert file.stem.split("-")[0] in {d.code for d in refused.value.diagnostics}
    expected(file.with_suffix(".expected"), "".join(d.text().replace(f"{CASES}/", "") + "\n" for d in refused.value.diagnostics))


def test_every_code_has_a_case() -> None:
    said = "".join(f.read_text(encoding="utf-8") for f in CASES.glob("*.expected"))
    # PR110 is about the command line: --property asks for one that is not in the catalogue
    assert [c for c in CODES if c.startswith("PR") and c not in said and c != "PR110"] == []


@pytest.mark.parametrize(
    ("written", "means"),
    [
        ("always crashed or finished", "(always crashed) or finished"),
        ("always not crashed", "always not crashed"),
        ("not busy and restless", "not busy and restless"),
        ("busy or crashed and finished", "busy or (crashed and finished)"),
        ("busy and crashed until finished", "busy and (crashed until finished)"),
        ("busy implies crashed implies finished", "busy implies (crashed implies finished)"),
        ("busy iff crashed implies finished", "busy iff (crashed implies finished)"),
        ("always speed <= limit + 1", "always (speed <= (limit + 1))"),
        ("x - 1 - y > -2", "((x - 1) - y) > -2"),
        ("always forall N in -1..1: busy or x = N", "always (forall N in {-1, 0, 1}: busy or (x = N))"),
    ],
)
def test_binding(written: str, means: str, tmp_path: Path) -> None:
    assert text(one(tmp_path, written).formula) == means


@pytest.mark.parametrize("written", ["always (busy orcrashed)", "notcrashed", "always busyand crashed"])
def test_operators_are_whole_words(written: str, tmp_path: Path) -> None:
    with pytest.raises(Rejected):
        one(tmp_path, written)


def test_expectations_by_driver_and_scenario(tmp_path: Path) -> None:
    own = one(tmp_path, "always not crashed", "  requirement: true\n  expect: {a: holds, b: {_: holds, overtake: violated}, c: {overtake: vacuous}}\n")
    assert [expected_verdict(own, driver, "overtake") for driver in ("a", "b", "c", "d", None)] == ["holds", "violated", "vacuous", None, "holds"]
    assert [expected_verdict(own, driver, "open") for driver in ("a", "b", "c")] == ["holds", "holds", None]


def test_a_path_to_a_driver_inherits_nothing(tmp_path: Path) -> None:
    own = one(tmp_path, "always not crashed", "  expect: {a: violated}\n")
    assert expected_verdict(own, None, "overtake") is None


def test_part_of_the_catalogue_by_name() -> None:
    whole = load_properties(None, uk())
    assert load_properties("general", uk()) == tuple(p for p in whole if Path(p.origin.file).stem == "general") != ()


def test_readme_names_every_word() -> None:
    said = (PROJECT / "properties" / "README.md").read_text(encoding="utf-8")
    code = " ".join(re.findall(r"`([^`\n]+)`", said))
    assert [w for w in (*WORDS, "speed", "limit", "forall", "since", "previously") if not re.search(rf"\b{w}\b", code)] == []
