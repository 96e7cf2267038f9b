"""What a driver outside the fragment is told: a folder of cases/agents each, its driver.asl beside what `rotra check` says of it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from rotra.diagnostics import CODES, Diagnostic, Rejected
from rotra.engines import places
from rotra.pipeline.check import check_agent

CASES = Path(__file__).parent / "cases" / "agents"

needs_java = pytest.mark.skipif(not places.classpath_file().is_file(), reason="java: the Java side is not built")


def findings(driver: Path) -> tuple[Diagnostic, ...]:
    try:
        return check_agent(str(driver), "uk")
    except Rejected as refused:
        return refused.diagnostics


@needs_java
@pytest.mark.parametrize("case", sorted(p for p in CASES.iterdir()), ids=lambda p: p.name)
def test_case(case: Path, expected: Callable[[Path, str], None]) -> None:
    found = findings(case / "driver.asl")
    assert case.name.split("-")[0] in {d.code for d in found}
    assert all(d.hint and d.origin.line and d.source_line for d in found)
    said = "".join(d.text() + "\n" for d in found)
    expected(case / "expected.txt", said.replace(f"{case}/", "").replace(f"tests/cases/agents/{case.name}/", ""))


def test_every_code_has_a_case() -> None:
    elsewhere = {"AG116"}  # by a name that is no file (test_cases_cli.py)
    assert {c for c in CODES if c.startswith("AG")} - elsewhere == {p.name.split("-")[0] for p in CASES.iterdir()}
