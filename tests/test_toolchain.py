"""The tool chain: what `make setup` installs works, and its recipe refuses what is not what it says."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from rotra.engines import places
from rotra.engines.process import End, Outcome
from rotra.toolchain import nusmv

ROOT = places.PROJECT


def test_nusmv_answers_as_known() -> None:
    if not places.nusmv().is_file():
        pytest.skip("NuSMV is not built")
    assert nusmv.smoke(places.nusmv()) == ""


def answer(text: str, end: End = End.EXITED, status: int | None = 0) -> Outcome:
    return Outcome(("NuSMV",), end, status, text, "", 0.1)


def test_a_smoke_test_is_not_fooled() -> None:
    assert "2.5.4" in nusmv.smoke_fault(answer(""))
    assert "2.5.4" in nusmv.smoke_fault(answer("This is NuSMV 2.6.0"))
    assert "does not say" in nusmv.smoke_fault(answer("This is NuSMV 2.5.4"))
    said = "This is NuSMV 2.5.4\n" + "\n".join(nusmv.SMOKE_ANSWERS)
    assert "verdicts" in nusmv.smoke_fault(answer(said))
    assert "stopped" in nusmv.smoke_fault(answer(said, End.TIMED_OUT, None))


def test_a_cached_build_is_taken_and_a_broken_one_is_not(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "a cache"))
    monkeypatch.setattr(nusmv, "smoke", lambda program: "" if program.read_text() == "good" else "it is bad")
    built: list[Path] = []

    def build(workshop: Path, log: Path) -> Path:
        built.append(workshop)
        return folder(workshop / "built", "good")

    def folder(path: Path, text: str) -> Path:
        (path / "bin").mkdir(parents=True, exist_ok=True)
        (path / "bin" / "NuSMV").write_text(text)
        (path / "key").write_text(nusmv.key())
        return path

    monkeypatch.setattr(nusmv, "_build", build)
    target, cached = tmp_path / "one clone" / "nusmv", nusmv.cache_folder() / f"nusmv-{nusmv.VERSION}-{nusmv.key()}"

    nusmv.install(target)
    assert len(built) == 1 and (target / "bin" / "NuSMV").read_text() == "good" and (cached / "bin" / "NuSMV").read_text() == "good"
    nusmv.install(target)
    nusmv.install(tmp_path / "another clone" / "nusmv")
    assert len(built) == 1, "both are served without a build"
    folder(target, "bad")
    nusmv.install(target)
    assert len(built) == 1 and (target / "bin" / "NuSMV").read_text() == "good", "mended from the cache"
    folder(target, "bad")
    folder(cached, "bad")
    nusmv.install(target)
    assert len(built) == 2 and (cached / "bin" / "NuSMV").read_text() == "good"
    assert not [path for path in target.parent.iterdir() if path.name.startswith(".")]


def test_the_cache_may_be_unwritable(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(blocked))
    monkeypatch.setattr(nusmv, "smoke", lambda program: "")

    def build(workshop: Path, log: Path) -> Path:
        (workshop / "built" / "bin").mkdir(parents=True)
        (workshop / "built" / "bin" / "NuSMV").write_text("good")
        return workshop / "built"

    monkeypatch.setattr(nusmv, "_build", build)
    nusmv.install(tmp_path / "nusmv")
    assert (tmp_path / "nusmv" / "bin" / "NuSMV").is_file()


def test_every_python_version_is_pinned_once() -> None:
    lines = [line for line in (ROOT / "requirements.txt").read_text().splitlines() if line and not line.startswith("#")]
    names = [re.sub(r"[-_.]+", "-", line.split("==")[0]).lower() for line in lines]
    assert all(re.fullmatch(r"[A-Za-z0-9_.-]+==[A-Za-z0-9.]+", line) for line in lines) and len(names) == len(set(names))
    import tomllib

    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert {re.sub(r"[-_.]+", "-", name).lower() for name in project["dependencies"]} <= set(names)


def test_every_java_version_is_pinned_in_one_place() -> None:
    for pom in (ROOT / "model" / "java" / "pom.xml", ROOT / "agents" / "java" / "pom.xml"):
        if pom.is_file():
            text = re.sub(r"<parent>.*?</parent>", "", pom.read_text(), flags=re.DOTALL)
            dependencies = re.findall(r"<dependency>(.*?)</dependency>", text, re.DOTALL)
            assert not [d for d in dependencies if "<version>" in d], f"{pom}: versions belong into the root pom.xml"


def packages(tmp_path: Path, *hidden: str) -> subprocess.CompletedProcess[str]:
    """Run packages.sh as an ordinary user on a machine without the programs `hidden`."""
    tools = tmp_path / "tools"
    tools.mkdir()
    for folder in os.environ["PATH"].split(":"):
        for program in sorted(Path(folder).iterdir()) if Path(folder).is_dir() else ():
            if program.name not in hidden and not (tools / program.name).is_symlink():
                (tools / program.name).symlink_to(program)
    (tools / "id").unlink()
    (tools / "id").write_text("#!/bin/sh\necho 1000\n")
    (tools / "id").chmod(0o755)
    return subprocess.run(
        ["/bin/sh", str(ROOT / "translator/rotra/toolchain/packages.sh")],
        cwd=tmp_path, env={"PATH": str(tools), "HOME": str(tmp_path), "PYTHON": sys.executable}, capture_output=True, text=True,
    )  # fmt: skip


def test_without_root_one_line_names_the_packages(tmp_path: Path) -> None:
    answer = packages(tmp_path, "flex", "bison", "mvn")
    assert answer.returncode == 1 and answer.stdout == ""
    (line,) = answer.stderr.splitlines()
    assert "apt-get install -y" in line and {"bison", "flex", "maven"} <= set(line.split())


def test_compilers_are_not_asked_for_once_nusmv_is_built(tmp_path: Path) -> None:
    binary = tmp_path / ".cache" / "rotra" / "nusmv-2.5.4-x" / "bin" / "NuSMV"
    binary.parent.mkdir(parents=True)
    binary.write_text("")
    binary.chmod(0o755)
    assert packages(tmp_path, "flex", "bison").returncode == 0


SKIPPING = "import pytest\n\ndef test_it():\n    pytest.skip('no such engine')\n"


@pytest.mark.parametrize(("required", "status"), [("1", 1), ("", 0)])
@pytest.mark.parametrize("text", [SKIPPING, "import pytest\npytest.skip('no such engine', allow_module_level=True)\n"])
def test_a_skip_fails_where_engines_are_required(tmp_path: Path, required: str, status: int, text: str) -> None:
    (tmp_path / "conftest.py").write_text((ROOT / "tests" / "conftest.py").read_text())
    (tmp_path / "test_case.py").write_text(text)
    answer = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(tmp_path)],
        cwd=tmp_path, env={**os.environ, "ROTRA_REQUIRE_ENGINES": required}, capture_output=True, text=True,
    )  # fmt: skip
    # Without the rule a module that skips itself leaves no test at all, which pytest calls 5.
    assert answer.returncode in ({status} if status else {0, 5}) or (status and answer.returncode == 2), answer.stdout
