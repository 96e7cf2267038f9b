"""Make a bundle of evidence of drivers in scenarios, and prove the verdicts of a bundle again from the inputs in it.

In: names or paths, a key or none.  Out: a folder (its layout: evidence/bundle.py).  Errors: `Rejected` for any input that is
refused; nothing is written then.  Left to others: judging what is in a folder (evidence/check.py).
No path of this machine gets into a bundle: an input is named by its place in the bundle, in traces and models too.
"""

from __future__ import annotations

import importlib.metadata
import os
import platform
import re
import shutil
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

from rotra.diagnostics import Rejected, problem
from rotra.engines import places
from rotra.engines.jvm import included_files
from rotra.evidence import bundle
from rotra.evidence.check import Fault, read_json
from rotra.evidence.statement import as_bytes, digest, envelope
from rotra.frontends.properties import Property, expected
from rotra.frontends.scenario import Scenario, instance, resolve_scenario
from rotra.frontends.yamlfile import load_yaml
from rotra.lowering.model import build_model
from rotra.origins import Origin, real_path, shown_path
from rotra.pipeline.campaign import Result, Wanted, applying, run_campaign, trace_document, wanted_properties
from rotra.pipeline.inputs import Driver, Law, check_driver, load_drivers, load_law, shipped_agents, shipped_scenarios
from rotra.pipeline.replay import replay_trace
from rotra.pipeline.silence import why_violated
from rotra.pipeline.verify import Record, Verdict, verify_model

# what every verdict rests on, and why it may
ALWAYS = (
    {"assumption": "The road is the grid world of the scenario: cells, headings and whole steps; nothing is said of a road outside it.", "why": "A finite world can be searched to its end."},
    {"assumption": "The driver sees what the world lets it see, without error.", "why": "The properties are about decisions, not about sensors."},
    {"assumption": "Other cars do what the scenario lets them do, and hesitate whenever they may.", "why": "All their choices are searched, so the verdicts hold for each of them."},
    {"assumption": "The translation and NuSMV are right.", "why": "Each counterexample and witness is driven in Jason; `rotra crosscheck` compares model and running system state by state."},
)
# the libraries whose answers shape a model
LIBRARIES = ("lark", "python-sat", "PyYAML")


@dataclass(slots=True)
class Inputs:
    """The files of the bundle's inputs, and by which name in it a path of this machine goes."""

    files: dict[str, bytes] = field(default_factory=dict)
    names: dict[str, str] = field(default_factory=dict)

    def put(self, path: Path, name: str) -> str:
        self.files[name] = path.read_bytes()
        for spelling in (str(path), str(path.resolve()), shown_path(str(path.resolve()))):
            self.names[spelling] = name
        return name

    def put_shipped(self, path: Path) -> str:
        return self.put(path, bundle.INPUTS + path.resolve().relative_to(places.PROJECT).as_posix())

    def named(self, document: Any) -> Any:
        """A document with every input named as in the bundle."""
        match document:
            case dict():
                return {key: self.names.get(value, value) if key == "file" and isinstance(value, str) else self.named(value) for key, value in document.items()}
            case list() | tuple():
                return [self.named(part) for part in document]
        return document

    def text(self, text: str) -> str:
        """A text of an engine or an emitter likewise; the longest path first, as one may begin another."""
        for path in sorted(self.names, key=len, reverse=True):
            if Path(path).is_absolute():
                text = text.replace(path, self.names[path])
        return text


def certify(wanted: Wanted, folder: Path, key: Ed25519PrivateKey | None, on_done: Callable[[str, int, int], None]) -> list[dict[str, Any]]:
    """Write the bundle; its verdicts, as verdicts.json has them."""
    if folder.exists() and not _replaceable(folder):
        raise Rejected([problem("IO104", Origin(str(folder)), "the output folder holds something else", "name an empty folder, or one that does not exist yet")])
    begun = time.monotonic()
    drivers = load_drivers(wanted.agents or shipped_agents())
    law = load_law(wanted.rules)
    declared = [resolve_scenario(s) for s in wanted.scenarios or shipped_scenarios()]
    properties = wanted_properties(wanted, law)
    for driver in drivers:
        for scenario in declared:
            check_driver(driver, instance(scenario, wanted.instance))
    inputs = Inputs()
    claim = _collect(inputs, drivers, declared, properties, law, wanted.instance)
    files: dict[str, bytes] = {}
    rows: list[dict[str, Any]] = []
    replays: dict[str, Any] = {}
    pairs = [(driver, scenario) for scenario in declared for driver in drivers]
    for number, (driver, scenario) in enumerate(pairs, start=1):
        rows += _prove(driver, instance(scenario, wanted.instance), law, properties, wanted, inputs, files, replays)
        on_done(f"{driver.title} in {scenario.id}", number, len(pairs))
    verdicts = {"claim": claim, "verdicts": rows}
    files |= inputs.files | bundle.derived(verdicts)
    files |= {bundle.VERDICTS: as_bytes(verdicts), bundle.REPLAYS: as_bytes(replays), bundle.TOOLS: as_bytes(_tools()), bundle.ASSUMPTIONS: as_bytes(_assumptions(properties, law, wanted.instance))}
    files[bundle.STATEMENT] = bundle.statement_of(files, verdicts)
    if key is not None:
        files[bundle.ENVELOPE] = as_bytes(envelope(files[bundle.STATEMENT], key))
    seconds = round(time.monotonic() - begun, 1)
    files[bundle.RUN] = as_bytes({"time": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()), "machine": platform.platform(), "python": platform.python_version(), "seconds": seconds})
    _write(folder, files)
    return rows


def _replaceable(folder: Path) -> bool:
    """Is the folder empty, or a bundle that an earlier run wrote?"""
    there = {p.name for p in folder.iterdir()} if folder.is_dir() else {""}
    return not there or (bundle.STATEMENT in there and there <= bundle.TOP)


def _collect(inputs: Inputs, drivers: tuple[Driver, ...], scenarios: list[Scenario], properties: tuple[Property, ...], law: Law, which: str) -> dict[str, Any]:
    """Take all inputs into the bundle; what the verdicts are a claim about, by the files in it."""
    agents, worlds = {}, {}
    for number, driver in enumerate(drivers, start=1):
        file = _take_driver(inputs, driver, number)
        agents[driver.name or file] = file
    for number, scenario in enumerate(scenarios, start=1):
        worlds[scenario.id] = _take(inputs, real_path(scenario.origin.file), "scenarios", number)
        if scenario.mirrors:
            _take(inputs, real_path(resolve_scenario(scenario.mirrors).origin.file), "scenarios", number)
    catalogues = [_take(inputs, real_path(file), "properties", n) for n, file in enumerate(dict.fromkeys(p.origin.file for p in properties), start=1)]
    root = real_path(law.base.folder).resolve()
    for path in sorted(p for p in root.rglob("*") if p.is_file()):
        inputs.put(path, f"{bundle.INPUTS}rules/{law.base.name}/{path.relative_to(root).as_posix()}")
    return {"agents": agents, "scenarios": worlds, "properties": catalogues, "rules": f"{bundle.INPUTS}rules/{law.base.name}", "instance": which}


def _take(inputs: Inputs, path: Path, kind: str, number: int) -> str:
    """A file that ships goes by its place in the project, one of the user's by its own name in a folder of its own."""
    return inputs.put_shipped(path) if path.resolve().is_relative_to(places.PROJECT) else inputs.put(path, f"{bundle.INPUTS}own/{kind}/{number}/{path.name}")


def _take_driver(inputs: Inputs, driver: Driver, number: int) -> str:
    """The driver and all that it includes, lying to each other as they did; what ships lies beside a driver of the user's."""
    files = included_files(driver.file)
    if driver.file.resolve().is_relative_to(places.AGENTS):
        return [inputs.put_shipped(path) for path in files][0]
    own = [path for path in files if not path.is_relative_to(places.AGENTS)]
    root = Path(os.path.commonpath([path.parent for path in own]))
    start = f"{bundle.INPUTS}own/agents/{number}/"
    name = start + driver.file.resolve().relative_to(root).as_posix()
    for path in files:
        inputs.put(path, start + path.relative_to(root).as_posix() if path in own else name.rpartition("/")[0] + "/" + path.name)
    inputs.names[str(driver.file)] = name
    return name


def _prove(driver: Driver, world: Scenario, law: Law, properties: tuple[Property, ...], wanted: Wanted, inputs: Inputs, files: dict[str, bytes], replays: dict[str, Any]) -> list[dict[str, Any]]:
    """The rows of one driver in one scenario; their models, logs and traces are added to the files."""
    asked, record = applying(properties, world, law), Record()
    verdicts = verify_model(build_model(driver.agent, law.advice, law.origins, world), asked, wanted.timeout, True, {}, record)
    agent = driver.name or inputs.names[str(driver.file)]
    place = f"{_plain(agent)}/{_plain(world.id)}"
    for number, text in enumerate(record.models, start=1):
        files[f"models/{place}/{number}.smv"] = inputs.text(text).encode()
    files[f"logs/{place}.log"] = inputs.text("".join(map(_without_times, record.logs))).encode()
    rows = []
    for prop, verdict, checks in zip(asked, verdicts, record.checks, strict=True):
        if verdict.verdict == "violated":
            verdict = replace(verdict, reason=why_violated(law.base, verdict.steps, verdict.loop))
        row: dict[str, Any] = {
            "agent": agent, "scenario": world.id, "instance": wanted.instance, "property": prop.id, "says": prop.says, "verdict": verdict.verdict, "reason": inputs.text(verdict.reason),
            "log": f"logs/{place}.log", "checks": checks, "trace": None, "witness": None, "expected": expected(prop, driver.name, world.mirrors or world.id),
            "places": _places(prop, verdict, law, inputs),
        }
        row["as_expected"] = None if row["expected"] is None else row["expected"] == row["verdict"]
        for kind, steps, loop in (("trace", verdict.steps, verdict.loop), ("witness", verdict.witness, verdict.witness_loop)):
            if steps:
                document = trace_document(driver, world, wanted.instance, wanted.rules, list(steps), loop, prop.id, prop.says, verdict.verdict)
                row[kind] = f"traces/{place}/{_plain(prop.id)}.{kind}.json"
                replays[row[kind]] = inputs.named(_replayed(document))
                source = inputs.names.get(world.source, world.source)
                files[row[kind]] = as_bytes(inputs.named({**document, "agent": agent, "scenario": source}))
        rows.append(row)
    return rows


def _replayed(document: Mapping[str, Any]) -> dict[str, Any]:
    """As `rotra replay` answers; a path without an act has nothing to drive."""
    if not any("acts" in step for step in document["steps"]):
        return {"happened": None, "divergence": None}
    divergence = replay_trace(document)
    return {"happened": divergence is None, "divergence": divergence}


def _places(prop: Property, verdict: Verdict, law: Law, inputs: Inputs) -> list[dict[str, Any]]:
    """Where the property stands, the rules that it cites, and the plans at the end of the counterexample."""
    cited = [(f"rule {r.id}", r.origin.file, r.origin.line) for r in law.base.rules if r.id in prop.cites]
    plans = [(f"plan {p['label']}", p["file"], p["line"]) for p in next((s["plans"] for s in reversed(verdict.steps) if s.get("plans")), ())]
    return [inputs.named({"what": what, "file": file, "line": line}) for what, file, line in [(f"property {prop.id}", prop.origin.file, prop.origin.line), *cited, *plans]]


def _plain(name: str) -> str:
    """A name as a file may have it; two names that would then be one keep apart."""
    plain = re.sub(r"[^A-Za-z0-9_-]+", "_", name)
    return plain if plain == name else f"{plain[:60]}-{digest(name.encode())[:8]}"


def _without_times(log: str) -> str:
    return re.sub(r"^(?:NuSMV > )?elapse: .*\n", "", log, flags=re.MULTILINE)


def _assumptions(properties: tuple[Property, ...], law: Law, which: str) -> dict[str, Any]:
    texts = {entry["id"]: entry for file in dict.fromkeys(p.origin.file for p in properties) for entry in (node.plain() for node in load_yaml(real_path(file))) if isinstance(entry, dict)}
    return {
        "always": list(ALWAYS),
        "instance": which,
        "properties": {p.id: {"says": p.says, "formula": texts[p.id]["formula"], "assuming": texts[p.id].get("assuming", []), "cites": list(p.cites)} for p in properties},
        "not_shown": {m.action: {"why": m.not_shown, "proxy": m.proxy or None} for m in law.base.meanings if m.not_shown},
    }


def _tools() -> dict[str, Any]:
    return {
        "rotra": importlib.metadata.version("rotra"),
        "NuSMV": digest(places.nusmv().read_bytes()) if places.nusmv().is_file() else None,
        "jars": {jar.name: digest(jar.read_bytes()) for jar in places.jars() if jar.is_file()},
        "libraries": {name: importlib.metadata.version(name) for name in LIBRARIES},
    }


def _write(folder: Path, files: Mapping[str, bytes]) -> None:
    if folder.exists():
        shutil.rmtree(folder)
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


def rerun(folder: Path, timeout: float, on_done: Callable[[str, int, int], None]) -> list[Fault]:
    """Prove what a bundle claims once more, from the inputs in it; call it only for a bundle that is whole."""
    document = read_json((folder / bundle.VERDICTS).read_bytes())
    claim, rows = document["claim"], document["verdicts"]
    agents = {str(folder / file): name for name, file in claim["agents"].items()}
    again = _again(folder, claim, tuple(dict.fromkeys(r["property"] for r in rows)), timeout, on_done)
    found = {(agents[r.agent], r.scenario, r.property): r.verdict for r in again.rows}
    claimed = {(r["agent"], r["scenario"], r["property"]): r["verdict"] for r in rows}
    return [
        Fault(bundle.VERDICTS, f"{bundle.title(dict(zip(('agent', 'scenario', 'property'), asked, strict=True)))} is called {claimed.get(asked, 'nothing')}, proved again it is {found.get(asked, 'nothing')}")
        for asked in sorted(found.keys() | claimed.keys()) if found.get(asked) != claimed.get(asked)
    ]


def _again(folder: Path, claim: Mapping[str, Any], names: tuple[str, ...], timeout: float, on_done: Callable[[str, int, int], None]) -> Result:
    def inside(files: Any) -> tuple[str, ...]:
        return tuple(str(folder / file) for file in files)

    (rules,) = inside([claim["rules"]])
    return run_campaign(Wanted(inside(claim["agents"].values()), inside(claim["scenarios"].values()), names, inside(claim["properties"]), claim["instance"], rules, None, 2, timeout), on_done)
