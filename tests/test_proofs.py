"""The shipped drivers are proved in the light's scenario, and drivers that are broken turn red there."""

from __future__ import annotations

from pathlib import Path

import pytest

from rotra.engines import places
from rotra.pipeline.campaign import Result, Wanted, run_campaign

AGENTS = places.PROJECT / "agents"

pytestmark = pytest.mark.skipif(not (places.nusmv().is_file() and places.classpath_file().is_file()), reason="NuSMV or the Java side is not built")

# each breaks one thing in the shared plans, and names a property that must notice
MUTANTS = {
    "the line no longer holds": ("held(A) :- stop_line(0, A) & A >= 0 & heeded(stop_at_white_line).", "held(A) :- stop_line(0, A) & A > 9 & heeded(stop_at_white_line).", "held(A) :- stop_line(0, A) & A >= 0 & heeded(wait_at_white_line).", "never_crosses_on_red"),
    "it waits for ever": ("+!proceed : pace(N) <- forward(N).", "+!proceed : pace(N) <- wait.", "", "finishes"),
    "it drives too fast": ("pace(N) :- cells(N) & limit(L) & N <= L &", "pace(N) :- cells(N) & limit(L) & N <= L + 1 &", "", "never_speeds"),
    "it stops driving": ("+!drive <- !travel; !drive.", "+!drive <- !travel.", "", "main_goal_survives"),
}


def prove(agent: str, *names: str) -> Result:
    return run_campaign(Wanted((agent,), ("traffic_light",), names, (), "all", "uk", None, 1, 100.0), lambda *_: None)


@pytest.mark.parametrize("agent", ["reactive", "must_only", "proactive"])
def test_shipped_drivers_are_proved(agent: str) -> None:
    result = prove(agent)
    assert len(result.rows) >= 25
    assert [r.property for r in result.rows if r.as_expected is False] == []


@pytest.mark.parametrize("name", MUTANTS)
def test_a_broken_driver_turns_red(name: str, tmp_path: Path) -> None:
    old, new, gone, noticed_by = MUTANTS[name]
    for file in AGENTS.glob("*.asl"):
        text = file.read_text(encoding="utf-8")
        if file.name == "driving.asl":
            assert old in text
            text = text.replace(old, new).replace(gone, "") if gone else text.replace(old, new)
        (tmp_path / file.name).write_text(text, encoding="utf-8")
    (row,) = prove(str(tmp_path / "reactive.asl"), noticed_by).rows
    assert row.verdict == "violated", row.reason
