"""Prove many drivers in many scenarios, side by side, and hold the verdicts against what was expected.

In: names or paths, as the command line gives them.  Out: `Result`; with an output folder, models, verdicts and traces.
Left to others: one proof (verify.py), printing (cli.py).
"""

from __future__ import annotations

import gc
import json
import re
import shutil
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from rotra.diagnostics import Rejected, problem
from rotra.frontends.mirror import mirrored_property
from rotra.frontends.properties import Property, expected, load_properties
from rotra.frontends.scenario import Scenario, instance, resolve_scenario
from rotra.lowering.model import build_model
from rotra.origins import Origin
from rotra.pipeline.inputs import Driver, Law, check_driver, load_drivers, load_law, shipped_agents, shipped_scenarios
from rotra.pipeline.silence import why_violated
from rotra.pipeline.verify import Verdict, verify_model


@dataclass(frozen=True, slots=True)
class Wanted:
    agents: tuple[str, ...]
    scenarios: tuple[str, ...]
    names: tuple[str, ...]
    catalogues: tuple[str, ...]
    instance: str
    rules: str
    output: Path | None
    jobs: int
    timeout: float


@dataclass(frozen=True, slots=True)
class Row:
    """One verdict as the JSON of `verify` has it; `as_expected` is None where nothing is expected."""

    agent: str
    scenario: str
    instance: str
    property: str
    verdict: str
    expected: str | None
    as_expected: bool | None
    reason: str
    seconds: float
    trace: str | None
    failed: bool

    def as_json(self) -> dict[str, Any]:
        return {k: getattr(self, k) for k in ("agent", "scenario", "instance", "property", "verdict", "expected", "as_expected", "reason", "seconds", "trace")}


@dataclass(slots=True)
class Result:
    rows: tuple[Row, ...] = ()
    timings: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()


def run_campaign(wanted: Wanted, on_done: Callable[[str, int, int], None]) -> Result:
    """Errors: `Rejected` for any input that is refused; nothing is written then."""
    begun = time.monotonic()
    drivers = load_drivers(wanted.agents or shipped_agents())
    law = load_law(wanted.rules)
    scenarios = tuple(instance(resolve_scenario(s), wanted.instance) for s in wanted.scenarios or shipped_scenarios())
    properties = wanted_properties(wanted, law)
    for driver in drivers:
        for scenario in scenarios:
            check_driver(driver, scenario)
    result = Result(timings={"load": time.monotonic() - begun})
    pairs = [(d, s) for s in scenarios for d in drivers]
    answers: dict[int, tuple[tuple[Verdict, ...], dict[str, float]]] = {}
    # models are trees without cycles: looking for cycles among their many nodes finds nothing and takes a tenth of the time
    with ProcessPoolExecutor(max_workers=min(wanted.jobs, len(pairs)), initializer=gc.disable) as pool:
        todo = {pool.submit(_prove, d, s, law, applying(properties, s, law), wanted.timeout, wanted.output is not None): n for n, (d, s) in _hardest_first(pairs)}
        for done, future in enumerate(as_completed(todo), start=1):
            number = todo[future]
            answers[number] = future.result()
            on_done(f"{pairs[number][0].title} in {pairs[number][1].id}", done, len(pairs))
    rows: list[Row] = []
    traces: dict[str, dict[str, Any]] = {}
    for number, (driver, scenario) in enumerate(pairs):
        verdicts, timings = answers[number]
        for phase, seconds in timings.items():
            result.timings[phase] = result.timings.get(phase, 0.0) + seconds
        for prop, verdict in zip(applying(properties, scenario, law), verdicts, strict=True):
            if verdict.verdict == "violated":
                verdict = replace(verdict, reason=why_violated(law.base, verdict.steps, verdict.loop))
            rows.append(_row(driver, scenario, wanted, prop, verdict, traces))
    result.rows = tuple(rows)
    result.timings["wall"] = time.monotonic() - begun
    if wanted.output is not None:
        _write(wanted.output, result, traces)
    return result


def _hardest_first(pairs: list[tuple[Driver, Scenario]]) -> list[tuple[int, tuple[Driver, Scenario]]]:
    """So that at the end no worker waits for a long proof that another one has just begun."""
    return sorted(enumerate(pairs), key=lambda pair: (-len(pair[1][1].traffic), -len(pair[1][1].percepts)))


def wanted_properties(wanted: Wanted, law: Law) -> tuple[Property, ...]:
    loaded = [p for c in wanted.catalogues or ("",) for p in load_properties(c or None, law.base)]
    if wanted.names:
        known = {p.id for p in loaded}
        wrong = [n for n in wanted.names if n not in known]
        if wrong:
            raise Rejected([problem("PR110", Origin(n), f"there is no property {n!r}", "rotra list names them") for n in wrong])
        loaded = [p for p in loaded if p.id in wanted.names]
    return tuple(loaded)


def applying(properties: tuple[Property, ...], scenario: Scenario, law: Law) -> tuple[Property, ...]:
    """The properties asked in a scenario; in a mirrored world those of the world that it mirrors, mirrored too."""
    return tuple(asked for p in properties if (asked := _asked(p, scenario, law)) is not None)


def _asked(wanted: Property, scenario: Scenario, law: Law) -> Property | None:
    if scenario.id in wanted.scenarios or not (wanted.scenarios or scenario.mirrors):
        return wanted
    if scenario.mirrors and (not wanted.scenarios or scenario.mirrors in wanted.scenarios):
        return mirrored_property(wanted, law.base, scenario.width)
    return None


def _prove(driver: Driver, scenario: Scenario, law: Law, properties: tuple[Property, ...], timeout: float, witnesses: bool) -> tuple[tuple[Verdict, ...], dict[str, float]]:
    timings: dict[str, float] = {}
    begun = time.monotonic()
    model = build_model(driver.agent, law.advice, law.origins, scenario)
    timings["lower"] = time.monotonic() - begun
    return verify_model(model, properties, timeout, witnesses, timings), timings


def _row(driver: Driver, scenario: Scenario, wanted: Wanted, prop: Property, verdict: Verdict, traces: dict[str, dict[str, Any]]) -> Row:
    want = expected(prop, driver.name, scenario.mirrors or scenario.id)
    name: str | None = None
    base = "/".join(re.sub(r"[^A-Za-z0-9_-]+", "_", part) for part in (driver.title, scenario.id, prop.id))
    for kind, steps, loop in (("trace", verdict.steps, verdict.loop), ("witness", verdict.witness, verdict.witness_loop)):
        if steps and wanted.output is not None:
            file = f"traces/{base}.{kind}.json"
            traces[file] = trace_document(driver, scenario, wanted.instance, wanted.rules, list(steps), loop, prop.id, prop.says, verdict.verdict)
            name = file if kind == "trace" else name
    as_expected = None if want is None else want == verdict.verdict
    return Row(driver.title, scenario.id, wanted.instance, prop.id, verdict.verdict, want, as_expected, verdict.reason, round(verdict.seconds, 4), name, verdict.failed)


def trace_document(driver: Driver, scenario: Scenario, which: str, rules: str, steps: list[Any], loop: int | None, prop: str | None, says: str | None, verdict: str | None) -> dict[str, Any]:
    """A trace with all that `explain` and `replay` need to know about it."""
    return {
        "agent": driver.name or str(driver.file), "scenario": scenario.source, "instance": which, "rules": rules,
        "property": prop, "says": says, "verdict": verdict, "rows": list(scenario.rows),
        "lights": {light.name: list(light.at) for light in scenario.lights}, "loop": loop, "steps": steps,
    }


def _write(folder: Path, result: Result, traces: dict[str, dict[str, Any]]) -> None:
    """verdicts.json and the traces; only files of an earlier run are replaced."""
    folder.mkdir(parents=True, exist_ok=True)
    stale = folder / "traces"
    if stale.is_dir():
        shutil.rmtree(stale)
    for name, document in traces.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(document, indent=1, sort_keys=True) + "\n", encoding="utf-8")
    verdicts = {"verdicts": [row.as_json() for row in result.rows]}
    (folder / "verdicts.json").write_text(json.dumps(verdicts, indent=1, sort_keys=True) + "\n", encoding="utf-8")
