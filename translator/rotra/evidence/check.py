"""Judge a bundle of evidence: is it whole, whose is it, and do its logs and traces support what it says?

In: the folder of a bundle, a public key or none.  Out: `Judgement`.  Errors: EV103 where there is no bundle.  Left to
others: proving again (pipeline/certify.py).  Nothing that made the verdicts is used here: no lowering, no emitter.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey

from rotra.diagnostics import Rejected, problem
from rotra.engines.nusmv import log_says
from rotra.evidence import bundle
from rotra.evidence.statement import digest, signature_fault
from rotra.origins import Origin


@dataclass(frozen=True, slots=True, order=True)
class Fault:
    file: str
    fault: str

    def as_json(self) -> dict[str, str]:
        return {"file": self.file, "fault": self.fault}


@dataclass(frozen=True, slots=True)
class Judgement:
    """signature: "unsigned", "not checked" (no key was given), "good" or "bad"."""

    faults: tuple[Fault, ...]
    signature: str

    @property
    def accepted(self) -> bool:
        return not self.faults

    def as_json(self) -> dict[str, Any]:
        return {"accepted": self.accepted, "faults": [f.as_json() for f in self.faults], "signature": self.signature}


def check_bundle(folder: Path, key: Ed25519PublicKey | None) -> Judgement:
    files, faults = _read(folder)
    if not files.keys() & {bundle.STATEMENT, bundle.VERDICTS}:
        raise Rejected([problem("EV103", Origin(str(folder)), "there is no bundle of evidence here", "rotra certify -o DIR makes one")])
    faults += _shaped(bundle.STATEMENT, lambda: _whole(files))
    by, signature = _signed(files, key)
    faults += by
    faults += _shaped(bundle.VERDICTS, lambda: _follows(files))
    if bundle.VERDICTS in files:
        faults += _shaped(bundle.VERDICTS, lambda: _supported(files))
    return Judgement(tuple(sorted(set(faults))), signature)


def read_json(content: bytes) -> Any:
    return json.loads(content.decode("utf-8"))


def _shaped(file: str, judge: Callable[[], Iterator[Fault]]) -> list[Fault]:
    """The faults found; a document of another shape than ours is one."""
    try:
        return list(judge())
    except (ValueError, KeyError, IndexError, TypeError, AttributeError, RecursionError):
        return [Fault(file, "is not of the shape that a bundle has, or is missing")]


def _read(folder: Path) -> tuple[dict[str, bytes], list[Fault]]:
    """All files by their names in the bundle; links are never followed."""
    files: dict[str, bytes] = {}
    faults: list[Fault] = []
    for place, folders, names in os.walk(folder, followlinks=False):
        for name in (*folders, *names):
            path = Path(place) / name
            shown = path.relative_to(folder).as_posix()
            if path.is_symlink() or not (path.is_dir() or path.is_file()):
                faults.append(Fault(shown, "is not a plain file"))
            elif path.is_file():
                try:
                    files[shown] = path.read_bytes()
                except OSError as error:
                    faults.append(Fault(shown, f"cannot be read: {error.strerror}"))
    return files, faults


def _whole(files: Mapping[str, bytes]) -> Iterator[Fault]:
    """Is every file the one that the statement binds, and none there beside?"""
    for name in sorted(bundle.NEEDED | {bundle.STATEMENT}):
        if name not in files:
            yield Fault(name, "is missing")
    bound = {s["name"]: s["digest"]["sha256"] for s in read_json(files[bundle.STATEMENT])["subject"]}
    for name, sha256 in bound.items():
        if name not in files:
            yield Fault(name, "is missing")
        elif digest(files[name]) != sha256:
            yield Fault(name, "was changed")
    for name in sorted(files.keys() - bound.keys() - bundle.UNBOUND):
        yield Fault(name, "was added")


def _signed(files: Mapping[str, bytes], key: Ed25519PublicKey | None) -> tuple[list[Fault], str]:
    if bundle.ENVELOPE not in files:
        return ([] if key is None else [Fault(bundle.ENVELOPE, "is missing: the bundle is unsigned")]), "unsigned"
    try:
        document = read_json(files[bundle.ENVELOPE])
    except (ValueError, RecursionError):
        document = None
    fault = signature_fault(document, files.get(bundle.STATEMENT, b""), key)
    if fault:
        return [Fault(bundle.ENVELOPE, fault)], "bad"
    return [], "not checked" if key is None else "good"


def _follows(files: Mapping[str, bytes]) -> Iterator[Fault]:
    """Do the files that repeat the verdicts say the same?"""
    verdicts = read_json(files[bundle.VERDICTS])
    for name, content in {**bundle.derived(verdicts), bundle.STATEMENT: bundle.statement_of(files, verdicts)}.items():
        if files.get(name) != content:
            yield Fault(name, "does not follow from the other files")


def _supported(files: Mapping[str, bytes]) -> Iterator[Fault]:
    """Does the log say of each property what its verdict says, and is each counterexample there and seen in Jason?"""
    document, replays = read_json(files[bundle.VERDICTS]), read_json(files[bundle.REPLAYS])
    claim, rows = document["claim"], document["verdicts"]
    for file in (*claim["agents"].values(), *claim["scenarios"].values(), *claim["properties"]):
        if file not in files:
            yield Fault(file, "is an input of the claim, but missing")
    if not any(name.startswith(f"{claim['rules']}/") for name in files):
        yield Fault(claim["rules"], "is an input of the claim, but missing")
    asked = [bundle.title(r) for r in rows]
    for twice in sorted({t for t in asked if asked.count(t) > 1}):
        yield Fault(bundle.VERDICTS, f"{twice} stands twice")
    said = {name: log_says(content.decode("utf-8")) for name, content in files.items() if name.startswith("logs/")}
    for row in rows:
        if row["agent"] not in claim["agents"] or row["scenario"] not in claim["scenarios"]:
            yield Fault(bundle.VERDICTS, f"{bundle.title(row)} is not of the claim")
        if row["log"] not in said:
            yield Fault(row["log"], "is missing")
        elif (answered := _verdict(row["checks"], *said[row["log"]])) != row["verdict"]:
            yield Fault(bundle.VERDICTS, f"{bundle.title(row)} is called {row['verdict']}, but {row['log']} says {answered}")
        if row["as_expected"] is not (None if row["expected"] is None else row["expected"] == row["verdict"]):
            yield Fault(bundle.VERDICTS, f"{bundle.title(row)} is wrong about being as expected")
        if row["verdict"] == "violated" and row["trace"] is None:
            yield Fault(bundle.VERDICTS, f"{bundle.title(row)} is called violated, but has no counterexample")
        for name in (n for n in (row["trace"], row["witness"]) if n is not None):
            yield from _traced(row, name, files, replays)
    kept = {n for r in rows for n in (r["trace"], r["witness"]) if n is not None}
    for name in sorted({n for n in files if n.startswith("traces/")} - kept):
        yield Fault(name, "belongs to no verdict")
    for name in sorted(replays.keys() - kept):
        yield Fault(bundle.REPLAYS, f"{name} belongs to no verdict")


def _traced(row: Mapping[str, Any], name: str, files: Mapping[str, bytes], replays: Mapping[str, Any]) -> Iterator[Fault]:
    if name not in files:
        yield Fault(name, "is missing")
        return
    trace = read_json(files[name])
    if not trace["steps"] or any(trace[key] != row[key] for key in ("instance", "property", "verdict", "says")):
        yield Fault(name, f"is no trace of {bundle.title(row)}")
    if name not in replays:
        yield Fault(bundle.REPLAYS, f"{name} was not driven in Jason")
    elif replays[name]["happened"] is not (True if any("acts" in step for step in trace["steps"]) else None):
        yield Fault(name, "did not happen in Jason")


def _verdict(checks: Mapping[str, Any], said: Mapping[str, bool], sound: bool | None) -> str:
    """What the answers of the engine amount to (design, section 7); a property that was not asked is vacuous."""
    if not checks:
        return "vacuous"
    main = True if any(said.get(name) for name in checks["enough"]) else said.get(checks["main"])
    if main is None or sound is False:
        return "unknown"
    if not main:
        return "violated"
    if sound is None:
        return "unknown"
    worth = [(name, True) for name in checks["fair"]] + [(name, False) for name in checks["hollow"]] + [(name, False) for name in (checks["witness"],) if name]
    for name, wanted in worth:
        if name not in said:
            return "unknown"
        if said[name] is not wanted:
            return "vacuous"
    return "holds"
