"""What ships: drivers, scenarios, rule bases and properties, each with a line that says what it is.

In: the folders of the project.  Out: kind -> name -> words.  Left to others: showing it (cli.py), loading it (frontends/).
A file that does not load is listed without words; the command that loads it says what is wrong.
"""

from __future__ import annotations

from pathlib import Path

from rotra.diagnostics import Rejected
from rotra.engines.places import PROJECT
from rotra.frontends.yamlfile import Node, load_yaml
from rotra.pipeline.inputs import shipped_agents, shipped_scenarios


def shipped() -> dict[str, dict[str, str]]:
    """The names that --agent, --scenario, --rules and --property take."""
    return {
        "agents": {name: first_comment(PROJECT / "agents" / f"{name}.asl") for name in shipped_agents()},
        "scenarios": {name: _says(PROJECT / "model" / "scenarios" / f"{name}.yaml") for name in shipped_scenarios()},
        "mirrored scenarios": {file.stem: _says(file) for file in sorted((PROJECT / "model" / "scenarios" / "mirrored").glob("*.yaml"))},
        "rules": {folder.name: _rule_base(folder) for folder in _rule_bases()},
        "properties": _properties(),
    }


def first_comment(path: Path) -> str:
    """The text of the first comment line of a .asl or .yaml file, "" where there is none before the first other line."""
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return ""
    for line in lines:
        text = line.strip()
        if text.startswith("# yaml-language-server"):
            continue
        for mark in ("//", "#"):
            if text.startswith(mark):
                return text.removeprefix(mark).strip()
        if text:
            return ""
    return ""


def _root(path: Path) -> Node | None:
    try:
        return load_yaml(path)
    except Rejected:
        return None


def _text(node: Node | None, key: str) -> str:
    found = node.get(key) if node is not None else None
    return " ".join(str(found.value).split()) if found is not None and found.value is not None else ""


def _says(path: Path) -> str:
    return _text(_root(path), "says") or first_comment(path)


def _rule_bases() -> list[Path]:
    return sorted(p.parent for p in (PROJECT / "rules").glob("*/ontology.yaml"))


def _rule_base(folder: Path) -> str:
    """What the ontology says of itself; else how many rules there are in how many files."""
    if says := _text(_root(folder / "ontology.yaml"), "says"):
        return says
    counts = [n for p in folder.glob("*.yaml") if (n := _count_rules(_root(p)))]
    return f"{sum(counts)} rules in {len(counts)} files"


def _count_rules(node: Node | None) -> int:
    """Rules are the entries that have an id and directives; they stand in a list, or in one under a key."""
    if node is None:
        return 0
    lists = [node, *(inner for _, inner in node.items())]
    return sum(1 for entries in lists for entry in entries if entry.get("id") and entry.get("directives"))


def _properties() -> dict[str, str]:
    found: dict[str, str] = {}
    for path in sorted((PROJECT / "properties").glob("*.yaml")):
        for entry in _root(path) or ():
            if name := _text(entry, "id"):
                found[name] = _text(entry, "says")
    return found
