"""Scenario files: what is refused and how it is said (a case file each), and what the shipped ones hold."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from rotra.diagnostics import CODES, Rejected
from rotra.frontends.scenario import instance, load_scenario, resolve_scenario, scenario_json, shipped_folder

CASES = Path(__file__).parent / "cases" / "scenarios"


def answer(file: Path) -> str:
    """All that is said of a scenario file, with paths from the folder of the cases."""
    try:
        found = load_scenario(file).warnings
    except Rejected as refused:
        found = refused.diagnostics
    return "".join(d.text().replace(f"{CASES}/", "") + "\n" for d in found)


@pytest.mark.parametrize("file", sorted(CASES.glob("*.yaml")), ids=lambda f: f.stem)
def test_case(file: Path, expected: Callable[[Path, str], None]) -> None:
    expected(file.with_suffix(".expected"), answer(file))


def test_every_code_has_a_case() -> None:
    said = "".join(f.read_text() for f in CASES.glob("*.expected"))
    assert [c for c in CODES if c.startswith("SC") and c not in said and c != "SC100"] == []


def test_unknown_scenario_names_the_nearest() -> None:
    with pytest.raises(Rejected) as refused:
        resolve_scenario("right_tunr")
    assert "SC100" in str(refused.value) and "did you mean right_turn?" in str(refused.value)


@pytest.mark.parametrize(("ours", "published"), [("traffic_light", "traffic_light"), ("overtake", "overtaking"), ("right_turn", "turn_right")])
def test_published_instance_is_the_published_world(ours: str, published: str) -> None:
    """Save that our side road has no dead end, and that the published traffic is all called slow."""
    a = scenario_json(instance(resolve_scenario(ours), "published"))
    b = scenario_json(instance(load_scenario(shipped_folder() / "published" / f"{published}.yaml"), "published"))
    for key in ("limit", "lights", "driver"):
        assert a[key] == b[key]
    # column 7 of the turn's world is a wall in the published text
    assert [r.upper()[:7] for r in a["rows"]] == [r.upper()[:7] for r in b["rows"]]
    assert [(c["at"], c["heading"], c["speed"], c["hesitates"]) for c in a["traffic"]] == [(c["at"], c["heading"], c["speed"], c["hesitates"]) for c in b["traffic"]]


def test_published_instance_fixes_every_choice() -> None:
    for name in ("traffic_light", "overtake", "right_turn"):
        s = instance(resolve_scenario(name), "published")
        choices = [s.driver.at, *(x.phase for x in s.lights), *(v for c in s.traffic for v in (c.at, c.speed, c.hesitates))]
        assert all(v.all == (v.published,) for v in choices)
