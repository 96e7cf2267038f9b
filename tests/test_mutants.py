"""Faults in drivers and rules turn the property red that is about them, and what is shown happens in Jason.

`cases/mutants/*.yaml` hold the faults and what must notice; a fault that nothing can notice is proved to change no act.
"""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
import yaml

from rotra.engines import places
from rotra.pipeline.campaign import Wanted, run_campaign
from rotra.pipeline.compare import compare_drivers
from rotra.pipeline.replay import replay_trace

CASES = Path(__file__).parent / "cases" / "mutants"
Case = dict[str, Any]


def cases(name: str, **wanted: bool) -> list[Any]:
    every: list[Case] = yaml.safe_load((CASES / name).read_text(encoding="utf-8"))
    return [pytest.param(c, id=c["id"]) for c in every if all((key in c) == there for key, there in wanted.items())]


def broken_driver(case: Case, folder: Path) -> Path:
    """Our agent files with the fault put in; the driver to prove."""
    for file in (places.PROJECT / "agents").glob("*.asl"):
        shutil.copy(file, folder)
    file = folder / case["file"]
    text = file.read_text(encoding="utf-8")
    assert text.count(case["old"]) == 1, case["old"]
    file.write_text(text.replace(case["old"], case["new"].replace(". +", ".\n+")), encoding="utf-8")
    return folder / f"{case.get('driver', 'reactive')}.asl"


def broken_rules(case: Case, folder: Path) -> Path:
    """The UK rule base with the fault put in."""
    base = folder / "uk"
    shutil.copytree(places.PROJECT / "rules" / "uk", base)
    for file in base.glob("*.yaml"):
        section = yaml.safe_load(file.read_text(encoding="utf-8"))
        if not isinstance(section, dict) or case["rule"] not in [r.get("id") for r in section.get("rules") or ()]:
            continue
        kept = [{**r, **(case.get("set") or {})} if r["id"] == case["rule"] else r for r in section["rules"] if r["id"] != case["rule"] or "set" in case]
        file.write_text(yaml.safe_dump({**section, "rules": kept}, sort_keys=False), encoding="utf-8")
        return base
    raise AssertionError(f"no rule {case['rule']}")


def must_be_red(agent: str, case: Case, rules: str, folder: Path) -> None:
    out = folder / "out"
    (row,) = run_campaign(Wanted((agent,), (case["scenario"],), (case["red"],), (), "all", rules, out, 1, 300.0), lambda *_: None).rows
    assert row.verdict == "violated", row.reason
    assert row.trace is not None
    trace = json.loads((out / row.trace).read_text(encoding="utf-8"))
    assert replay_trace(trace) is None


@pytest.mark.parametrize("case", cases("drivers.yaml", red=True))
def test_a_fault_in_a_driver_turns_red_and_happens(case: Case, tmp_path: Path) -> None:
    must_be_red(str(broken_driver(case, tmp_path)), case, "uk", tmp_path)


@pytest.mark.parametrize("case", cases("rules.yaml", red=True))
def test_a_fault_in_a_rule_turns_red_and_happens(case: Case, tmp_path: Path) -> None:
    must_be_red(case.get("driver", "reactive"), case, str(broken_rules(case, tmp_path)), tmp_path)


@pytest.mark.parametrize("case", cases("drivers.yaml", same=True))
def test_a_fault_that_nothing_shows_changes_no_act(case: Case, tmp_path: Path) -> None:
    changed = broken_driver(case, tmp_path)
    (answer,) = compare_drivers(changed.stem, str(changed), [case["scenario"]], "all", "uk", 300.0)
    assert answer["equal"] is True


def test_there_are_enough_of_them() -> None:
    assert len(cases("drivers.yaml")) + len(cases("rules.yaml")) >= 25
