"""The starter project and the list of what ships."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from rotra.diagnostics import Rejected
from rotra.frontends.scenario import load_scenario
from rotra.pipeline import starter
from rotra.pipeline.listing import first_comment, shipped
from rotra.pipeline.starter import make_project


def test_makes_a_whole_project(tmp_path: Path) -> None:
    folder = tmp_path / "new" / "mine"
    made = make_project(folder)
    assert {p.name for p in made} >= {"my_driver.asl", "my_road.yaml", "my_properties.yaml", "perception.asl", "README.md", "settings.json"}
    assert all(p.is_file() for p in made)
    assert [p.name for p in folder.parent.iterdir()] == ["mine"]
    assert len((folder / "README.md").read_text().splitlines()) == 10


def test_the_road_is_a_scenario(tmp_path: Path) -> None:
    make_project(tmp_path / "mine")
    assert load_scenario(tmp_path / "mine" / "my_road.yaml").id == "my_road"


def test_editors_find_the_schemas(tmp_path: Path) -> None:
    make_project(tmp_path / "mine")
    settings = json.loads((tmp_path / "mine" / ".vscode" / "settings.json").read_text())
    assert settings["yaml.schemas"]
    for schema in settings["yaml.schemas"]:
        assert (tmp_path / "mine" / schema).is_file()


def test_fills_the_empty_folder_one_stands_in(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "here"
    folder.mkdir()
    monkeypatch.chdir(folder)
    make_project(Path("."))
    assert Path("my_driver.asl").is_file()
    assert [p.name for p in tmp_path.iterdir()] == ["here"]


def test_refuses_a_folder_that_holds_something(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    for folder in (tmp_path, tmp_path / "mine.txt", tmp_path / "mine.txt" / "below"):
        with pytest.raises(Rejected) as caught:
            make_project(folder)
        assert [d.code for d in caught.value.diagnostics] == ["IO104"]
    assert [p.name for p in tmp_path.iterdir()] == ["mine.txt"]


def test_leaves_nothing_half_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(starter, "PERCEPTION", tmp_path / "gone.asl")
    with pytest.raises(Rejected):
        make_project(tmp_path / "mine")
    assert list(tmp_path.iterdir()) == []


def test_lists_what_ships() -> None:
    found = shipped()
    assert list(found) == ["agents", "scenarios", "mirrored scenarios", "rules", "properties"]
    for kind, entries in found.items():
        assert entries, kind
        assert all(about for about in entries.values()), kind


def test_first_comment(tmp_path: Path) -> None:
    file = tmp_path / "a.asl"
    file.write_text("\n// Says it.\n// More.\n!go.\n")
    assert first_comment(file) == "Says it."
    file.write_text("!go.\n// late\n")
    assert first_comment(file) == ""


def test_what_its_readme_says_works(tmp_path: Path) -> None:
    make_project(tmp_path / "mine")
    commands = [line.strip().split() for line in (tmp_path / "mine" / "README.md").read_text(encoding="utf-8").splitlines() if line.startswith("    rotra ")]
    assert [c[1] for c in commands] == ["check", "verify", "run", "explain"]
    for command in commands:
        ended = subprocess.run([str(Path(sys.executable).with_name("rotra")), *command[1:]], cwd=tmp_path / "mine", capture_output=True, text=True, timeout=120)
        assert ended.returncode == 0, ended.stdout + ended.stderr
    driver = tmp_path / "mine" / "my_driver.asl"
    text = driver.read_text(encoding="utf-8")
    assert "held(Line)" in text
    driver.write_text("\n".join(line for line in text.splitlines() if not ("closed" in line and "held(Line)" in line)), encoding="utf-8")
    ended = subprocess.run([str(Path(sys.executable).with_name("rotra")), *commands[1][1:]], cwd=tmp_path / "mine", capture_output=True, text=True, timeout=120)
    assert ended.returncode == 1, ended.stdout + ended.stderr
    assert list((tmp_path / "mine" / "out" / "traces").glob("**/*.trace.json"))
