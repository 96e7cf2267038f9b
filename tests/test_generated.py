"""What is written by a command and kept in the repository is what the command writes today.

`model/generated`: the SMV models of the shipped drivers on the shipped roads.  README.md: each block between
`<!-- made by: NAME -->` and `<!-- end -->`.  `pytest --update-expected tests/test_generated.py` writes both anew.
"""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from rotra.engines import places
from rotra.pipeline.inputs import shipped_agents, shipped_scenarios
from rotra.pipeline.translate import translate_to

GENERATED = places.PROJECT / "model" / "generated"
README = places.PROJECT / "README.md"
ROTRA = Path(sys.executable).with_name("rotra")
ROADS = [s for s in shipped_scenarios() if s != "open"]
Expected = Callable[[Path, str], None]


@pytest.mark.parametrize("scenario", ROADS)
@pytest.mark.parametrize("agent", shipped_agents())
def test_the_models_are_fresh(agent: str, scenario: str, tmp_path: Path, expected: Expected) -> None:
    translate_to(agent, scenario, "all", "uk", tmp_path / "out")
    expected(GENERATED / f"{agent}_{scenario}.smv", (tmp_path / "out" / "model.smv").read_text(encoding="utf-8"))


def rotra(*arguments: str) -> str:
    ended = subprocess.run([str(ROTRA), *arguments], cwd=places.PROJECT, capture_output=True, text=True, timeout=600)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    return "\n".join(line.rstrip() for line in ended.stdout.strip().splitlines())


def matrix(_: Path) -> str:
    return rotra("verify")


def run(_: Path) -> str:
    return rotra("run", "--agent", "reactive", "--scenario", "traffic_light", "--steps", "8")


def counterexample(folder: Path) -> str:
    rotra("verify", "--agent", "must_only", "--scenario", "overtake", "--property", "moves_left", "-o", str(folder))
    trace = str(folder / "traces" / "must_only" / "overtake" / "moves_left.trace.json")
    return rotra("explain", trace) + "\n\n" + rotra("replay", trace)


def smv(_: Path) -> str:
    """A percept, a belief, a rule, a plan and the act, as they stand in the model of reactive at the traffic light."""
    lines = (GENERATED / "reactive_traffic_light.smv").read_text(encoding="utf-8").splitlines()
    shown = ("  p_light_m1_0_red :=", "  q_believes_light_red :=", "  rule_r176 :=", "  advised_must_wait_at_white_line :=", "  take_5 :=", "  take_6 :=")
    return "\n".join(line.strip() for start in shown for line in lines if line.startswith(start))


BLOCKS: dict[str, Callable[[Path], str]] = {"matrix": matrix, "run": run, "counterexample": counterexample, "smv": smv}


@pytest.mark.parametrize("name", BLOCKS)
def test_the_readme_shows_what_is_printed(name: str, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    text = README.read_text(encoding="utf-8")
    block = re.compile(rf"(<!-- made by: {name} -->\n```\n).*?(\n```\n<!-- end -->)", re.DOTALL)
    assert len(block.findall(text)) == 1
    fresh = block.sub(lambda m: m.group(1) + BLOCKS[name](tmp_path) + m.group(2), text)
    if request.config.getoption("--update-expected"):
        README.write_text(fresh, encoding="utf-8")
    else:
        assert fresh == text
