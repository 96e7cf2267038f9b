"""pipeline/doctor.py: a thing that is there, missing, too old, of another version or broken is told apart."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from rotra.pipeline import doctor
from rotra.pipeline.doctor import Finding, Program, examine, healthy

PYTHON = sys.executable


def script(path: Path, text: str) -> Path:
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)
    return path


def test_everything_has_a_finding_and_a_way_out() -> None:
    findings = examine()
    names = [finding.name for finding in findings]
    assert len(names) == len(set(names))
    assert {"Python", "PyYAML", "Java", "Maven", "Jason", "NuSMV", "flex", "expat headers"} <= set(names)
    assert all(finding.install for finding in findings)
    assert all(set(finding.as_json()) == {"name", "found", "wanted", "needed", "ok", "install", "remark"} for finding in findings)


@pytest.mark.parametrize(("version", "ok"), [((3, 11, 0), True), ((3, 13, 1), True), ((3, 10, 9), False)])
def test_python(version: tuple[int, int, int], ok: bool) -> None:
    assert doctor.examine_python(version).ok is ok


def test_a_program_that_is_there(tmp_path: Path) -> None:
    tool = script(tmp_path / "tool", "echo 'tool version \"17.0.2\"' >&2")
    finding = doctor.examine_program(Program("tool", (str(tool),), (17,), "toolpack"), needed=True)
    assert finding.ok and finding.found == "17.0.2"


def test_a_program_that_is_too_old(tmp_path: Path) -> None:
    tool = script(tmp_path / "tool", "echo tool 11.0.2")
    finding = doctor.examine_program(Program("tool", (str(tool),), (17,), "toolpack"), needed=True)
    assert not finding.ok and finding.found == "11.0.2" and "too old" in finding.text() and "toolpack" in finding.install


def test_a_program_that_is_missing_or_broken(tmp_path: Path) -> None:
    for command in ("/no/such/tool", str(script(tmp_path / "tool", "echo 1.2; exit 1"))):
        finding = doctor.examine_program(Program("tool", (command,), (), "toolpack"), needed=True)
        assert finding.found is None and finding.text().startswith("MISSING tool") and "install -y toolpack" in finding.text()


def test_libraries_against_the_lock(tmp_path: Path) -> None:
    lock = tmp_path / "requirements.txt"
    lock.write_text("# a lock\nclick==0.0.1\nno-such-library==1.0\n")
    click, others = doctor.examine_libraries(lock)
    assert (click.name, click.wanted, click.remark) == ("click", "0.0.1", "is another version") and not click.ok
    assert others.remark == "not as locked: no-such-library" and not others.needed
    (gone,) = doctor.examine_libraries(tmp_path / "none")
    assert gone.found is None


def test_nusmv(tmp_path: Path) -> None:
    assert doctor.examine_nusmv(tmp_path / "NuSMV").found is None
    right = script(tmp_path / "right", "echo '*** This is NuSMV 2.5.4 (compiled)'")
    assert doctor.examine_nusmv(right).ok
    other = script(tmp_path / "other", "echo '*** This is NuSMV 2.6.0 (compiled)'")
    assert doctor.examine_nusmv(other).found == "2.6.0" and not doctor.examine_nusmv(other).ok
    broken = script(tmp_path / "broken", "echo 'libreadline.so.8: cannot open' >&2; exit 127")
    assert doctor.examine_nusmv(broken).found is None and "libreadline" in doctor.examine_nusmv(broken).remark


def test_java_side(tmp_path: Path) -> None:
    classes = tmp_path / "classes"
    jar = tmp_path / "jason-interpreter-3.2.1.jar"
    listing = tmp_path / "classpath.txt"
    assert [f.found for f in doctor.examine_java_side(listing, (classes,))] == [None, None]
    listing.write_text(f"{jar}:{tmp_path}/javax.json-1.1.4.jar\n")
    jason, side = doctor.examine_java_side(listing, (classes,))
    assert "no longer" in jason.remark and side.found is None
    jar.touch()
    (classes / "rotra").mkdir(parents=True)
    (classes / "rotra" / "Main.class").touch()
    jason, side = doctor.examine_java_side(listing, (classes,))
    assert jason.ok and jason.found == "3.2.1" and side.ok


def test_only_what_is_needed_makes_it_ill() -> None:
    there = Finding("a", "1", "", True, "get a")
    absent = Finding("b", None, "", False, "get b")
    missing = Finding("c", None, "", True, "get c")
    assert healthy((there, absent)) and not healthy((there, absent, missing))
    assert absent.text().startswith("absent") and absent.text().endswith("-> get b")
    assert there.as_json()["install"] is None and missing.as_json()["install"] == "get c"
