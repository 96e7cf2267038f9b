"""Find and load what a command was given: shipped names or paths to the user's own files.

In: names or paths.  Out: loaded, checked inputs.  Errors: `Rejected` with a code for each thing not found or not right.
"""

from __future__ import annotations

import difflib
import hashlib
import os
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from rotra.diagnostics import Rejected, problem
from rotra.emitters.agentspeak import emit_advice
from rotra.engines import places
from rotra.engines.jvm import parse_agents
from rotra.frontends.agent import Agent, Rule
from rotra.frontends.fragment import check_fragment
from rotra.frontends.rules import RuleBase, load_rule_base
from rotra.frontends.scenario import Scenario
from rotra.origins import Origin


@dataclass(frozen=True, slots=True)
class Driver:
    """A driver: `name` is the shipped name, None for a user's own file; `title` is what tables show."""

    name: str | None
    title: str
    file: Path
    agent: Agent


@dataclass(frozen=True, slots=True)
class Law:
    """A rule base, its advice as AgentSpeak text and as parsed rules, and where each rule stands."""

    base: RuleBase
    text: str
    advice: tuple[Rule, ...]
    origins: dict[str, Origin]


def shipped_agents() -> tuple[str, ...]:
    """The drivers that ship: the agent files that no other one includes."""
    files = {p.name: p.read_text(encoding="utf-8") for p in (places.PROJECT / "agents").glob("*.asl")}
    included = {name for text in files.values() for name in re.findall(r'include\(\s*"([^"]+)"', text)}
    return tuple(sorted(Path(name).stem for name in files if name not in included))


def shipped_scenarios() -> tuple[str, ...]:
    return tuple(sorted(p.stem for p in (places.PROJECT / "model" / "scenarios").glob("*.yaml")))


def agent_file(given: str) -> tuple[str | None, Path]:
    """The shipped name (None for a path) and the file.  Errors: AG116."""
    if given in shipped_agents():
        return given, places.PROJECT / "agents" / f"{given}.asl"
    path = Path(given)
    if path.is_file():
        return None, path
    near = difflib.get_close_matches(given, shipped_agents(), 1)
    hint = f"did you mean {near[0]}?" if near else f"shipped are {', '.join(shipped_agents())}; or give the path of an .asl file"
    raise Rejected([problem("AG116", Origin(given), f"there is no agent {given!r}", hint)])


def load_drivers(given: Sequence[str]) -> tuple[Driver, ...]:
    found = [agent_file(g) for g in given]
    agents = parse_agents([file for _, file in found])
    return tuple(Driver(name, name or str(file), file, agent) for (name, file), agent in zip(found, agents, strict=True))


def load_law(given: str) -> Law:
    base = load_rule_base(given)
    text = emit_advice(base)
    folder = places.PROJECT / ".build" / "advice"
    folder.mkdir(parents=True, exist_ok=True)
    # named by what it holds: two commands at once may ask for two versions of one base
    file = folder / f"{hashlib.sha256(text.encode()).hexdigest()[:32]}.asl"
    if not file.is_file():
        fresh = file.with_suffix(f".{os.getpid()}")
        fresh.write_text(text, encoding="utf-8")
        fresh.replace(file)
    (parsed,) = parse_agents([file])
    lines = text.splitlines()
    advice = tuple(replace(rule, origin=_written_in(lines, rule.origin)) for rule in parsed.knowledge)
    return Law(base, text, advice, {rule.id: rule.origin for rule in base.rules})


def _written_in(lines: list[str], origin: Origin) -> Origin:
    """The place in the rule base that a line of the advice names in its comment."""
    comment = re.search(r"// (?:(\S+) <- )?(\S+):(\d+)$", lines[origin.line - 1]) if 0 < origin.line <= len(lines) else None
    return Origin(comment.group(2), int(comment.group(3)), comment.group(1) or "") if comment else origin


def check_driver(driver: Driver, scenario: Scenario) -> None:
    check_fragment(driver.agent, scenario.top_speed)
