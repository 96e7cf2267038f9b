"""Whatever is refused, the command ends with 2, shows no stack trace and writes nothing."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner

from rotra.cli import main
from rotra.diagnostics import CODES

CASES = Path(__file__).parent / "cases"

REFUSED = {
    "AG116": ["check", "reactiv"],
    "SC100": ["translate", "--agent", "reactive", "--scenario", "right_tunr", "-o", "out"],
    "IO100": ["explain", "nowhere.json"],
    "SC102": ["translate", "--agent", "reactive", "--scenario", str(CASES / "scenarios" / "short_row.yaml"), "-o", "out"],
    "SC103": ["verify", "--agent", "reactive", "--scenario", str(CASES / "scenarios" / "two_cars_on_one_cell.yaml"), "-o", "out"],
    "AG102": ["translate", "--agent", str(CASES / "agents" / "AG102-message" / "driver.asl"), "--scenario", "traffic_light", "-o", "out"],
    "AG113": ["verify", "--agent", str(CASES / "agents" / "AG113-for" / "driver.asl"), "--scenario", "traffic_light", "-o", "out"],
    "AG114": ["verify", "--agent", str(CASES / "agents" / "AG114-annotated-addition" / "driver.asl"), "--scenario", "traffic_light", "-o", "out"],
}


@pytest.mark.parametrize("code", sorted(REFUSED))
def test_refused(code: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    answer = CliRunner().invoke(main, REFUSED[code])
    assert isinstance(answer.exception, SystemExit), answer.exception
    assert answer.exit_code == 2
    assert code in CODES and code in answer.output
    assert "Traceback" not in answer.output
    assert list(tmp_path.iterdir()) == []
