"""Make a starter project of the user's own: a driver, a road, a property, and how to check them.

In: a folder that is empty or does not exist.  Out: the files that were made.  Left to others: proving and running them.
Errors: IO104 for a folder that holds something or cannot be written; nothing is written then.
"""

from __future__ import annotations

import json
import shutil
import tempfile
from pathlib import Path

from rotra.diagnostics import Rejected, problem
from rotra.engines.places import PROJECT
from rotra.origins import Origin

TEMPLATES = Path(__file__).resolve().parents[1] / "starter"
# what the starter driver includes, so that the project stands on its own
PERCEPTION = PROJECT / "agents" / "perception.asl"
# schema -> the files of a project that it describes
SCHEMAS = {
    "scenario.schema.json": (PROJECT / "model" / "schema", ("*_road.yaml", "scenarios/*.yaml")),
    "properties.schema.json": (PROJECT / "properties" / "schema", ("*_properties.yaml", "properties/*.yaml")),
    "rules.schema.json": (PROJECT / "rules" / "schema", ("rules/*.yaml",)),
    "ontology.schema.json": (PROJECT / "rules" / "schema", ("rules/ontology.yaml",)),
    "directives.schema.json": (PROJECT / "rules" / "schema", ("rules/directives.yaml",)),
}


def make_project(folder: Path) -> tuple[Path, ...]:
    """The project, whole or not at all: it is made beside its place and then moved there."""
    if folder.is_symlink() or (folder.exists() and not folder.is_dir()):
        raise Rejected([problem("IO104", Origin(str(folder)), "there is a file of this name already", "name a folder that does not exist yet")])
    try:
        if folder.is_dir() and any(folder.iterdir()):
            raise Rejected([problem("IO104", Origin(str(folder)), "the folder is not empty", "name an empty folder, or one that does not exist yet")])
        target = folder.absolute()
        target.parent.mkdir(parents=True, exist_ok=True)
        made = Path(tempfile.mkdtemp(prefix=".rotra-init-", dir=target.parent))
        try:
            _fill(made)
            made.chmod(0o755)
            _move(made, target)
        finally:
            shutil.rmtree(made, ignore_errors=True)
    except OSError as error:
        raise Rejected([problem("IO104", Origin(str(folder)), f"cannot make the project: {error.strerror}", "choose a place that can be written")]) from error
    return tuple(sorted(p for p in folder.rglob("*") if p.is_file()))


def _move(made: Path, target: Path) -> None:
    """Into place; an empty folder that is there is kept, for it may be the one that the user stands in."""
    if not target.is_dir():
        made.replace(target)
        return
    moved: list[Path] = []
    try:
        for entry in sorted(made.iterdir()):
            moved.append(entry.replace(target / entry.name))
    except OSError:
        for entry in moved:
            shutil.rmtree(entry) if entry.is_dir() else entry.unlink(missing_ok=True)
        raise


def _fill(folder: Path) -> None:
    for template in sorted(TEMPLATES.iterdir()):
        if template.is_file():
            shutil.copyfile(template, folder / template.name)
    shutil.copyfile(PERCEPTION, folder / PERCEPTION.name)
    (folder / ".schemas").mkdir()
    wiring: dict[str, list[str]] = {}
    for name, (place, files) in SCHEMAS.items():
        if (place / name).is_file():
            shutil.copyfile(place / name, folder / ".schemas" / name)
            wiring[f"./.schemas/{name}"] = list(files)
    (folder / ".vscode").mkdir()
    settings = {"yaml.schemas": wiring, "files.associations": {"*.asl": "prolog"}}
    (folder / ".vscode" / "settings.json").write_text(json.dumps(settings, indent=2, sort_keys=True) + "\n", encoding="utf-8")
