"""Whatever is refused, the command ends with 2, shows no stack trace and writes nothing."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner

from rotra.cli import main
from rotra.diagnostics import CODES

CASES = Path(__file__).parent / "cases"

FILES = CASES / "files"

REFUSED = {
    "IO101": ["verify", "--agent", "reactive", "--scenario", str(FILES / "not_yaml.yaml"), "-o", "out"],
    "IO102": ["verify", "--agent", "reactive", "--scenario", str(FILES / "key_twice.yaml"), "-o", "out"],
    "IO104": ["translate", "--agent", "reactive", "--scenario", "traffic_light", "-o", str(FILES)],
    "IO105": ["translate", "--agent", str(FILES / "my driver.asl"), "--scenario", "traffic_light", "-o", "out"],
    "PR110": ["verify", "--agent", "reactive", "--scenario", "traffic_light", "--property", "never_crash", "-o", "out"],
    "EV101": ["certify", "--agent", "reactive", "--scenario", "traffic_light", "-o", "out", "--key", str(FILES / "no_trace.json")],
    "EV102": ["certify", "--new-key", "--key", str(FILES / "no_trace.json")],
    "EV103": ["evidence", "verify", str(FILES)],
    "TR101": ["explain", str(FILES / "no_trace.json")],
    "TR102": ["explain", str(FILES / "steps_missing.json")],
    "TR103": ["replay", str(FILES / "no_act.json")],
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


def test_every_code_that_a_command_can_answer_is_tried() -> None:
    """The codes of agents, rules, scenarios and properties have case files of their own; these are of files, names and traces."""
    named = {c for c in CODES if c.startswith(("IO", "EV")) or c in ("AG116", "SC100", "PR110", "TR101", "TR102", "TR103")}
    elsewhere = {"IO103"}  # cases/rules, cases/scenarios, cases/properties
    assert named - elsewhere <= set(REFUSED)
