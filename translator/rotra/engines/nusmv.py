"""Run NuSMV on one model and say, check by check, what it answered.

In: an SMV text whose specifications have names, the list of checks.  Out: `Answers`; each check is `Holds`, `Violated`
(with the states of the trace), `Unknown` or `EngineFailed`.  Left to others: what a state means (pipeline/verify.py).
Silence is never `Holds`: a check whose marker or verdict line is missing is `EngineFailed` (style: engines).
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from rotra.engines.process import run

_KIND = {"invariant": "check_invar", "ltl": "check_ltlspec", "ctl": "check_ctlspec"}
_VERDICT = re.compile(r"^-- (?:invariant|specification) .* is (true|false)\s*$", re.MULTILINE)
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*\Z")


@dataclass(frozen=True, slots=True)
class Check:
    """One named specification to check; `trace`: is a counterexample wanted?"""

    name: str
    kind: str
    trace: bool


@dataclass(frozen=True, slots=True)
class Holds:
    pass


@dataclass(frozen=True, slots=True)
class Violated:
    """`states`: qualified SMV variable -> text, one mapping a state; `loop`: index the last state returns to, or None."""

    states: tuple[Mapping[str, str], ...] = ()
    loop: int | None = None


@dataclass(frozen=True, slots=True)
class Unknown:
    why: str


@dataclass(frozen=True, slots=True)
class EngineFailed:
    why: str


Answer = Holds | Violated | Unknown | EngineFailed


@dataclass(frozen=True, slots=True)
class Answers:
    """`initial`: are there initial states; `total`: has every reachable state a successor; `states`: how many reachable."""

    checks: Mapping[str, Answer]
    initial: bool | None
    total: bool | None
    states: int | None
    seconds: Mapping[str, float]
    log: str


def check_model(nusmv: Path, model: Path, checks: Sequence[Check], timeout: float) -> Answers:
    """One process for all checks.  `timeout` in seconds is for the whole; what was not answered in time is `Unknown`."""
    assert all(_NAME.match(c.name) for c in checks)
    result = run([nusmv, "-int", model], timeout=timeout, stdin=_script(checks))
    output, log = result.stdout.replace("NuSMV > ", ""), result.stdout + result.stderr
    blocks = _blocks(output)
    answers: dict[str, Answer] = {}
    for check in checks:
        if check.name in blocks:
            answers[check.name] = _answer(blocks[check.name], check)
        elif result.timed_out:
            answers[check.name] = Unknown(f"no answer within {timeout:g} s")
        else:
            answers[check.name] = EngineFailed(_complaint(log))
    total = _total(blocks)
    states = re.search(r"reachable states: ([0-9.e+]+)", blocks.get("reachable", ""))
    initial = blocks.get("initial")
    seconds = {name: float(took.group(1)) for name, block in blocks.items() if (took := re.search(r"^elapse: ([0-9.]+) seconds", block, re.MULTILINE))}
    return Answers(answers, None if initial is None else not _no_start(log), total, int(float(states.group(1))) if states else None, seconds, log)


def log_says(log: str) -> tuple[dict[str, bool], bool | None]:
    """Of a log that was kept: what it says of each check that it answers, and whether anything can be concluded from the model:
    is there an initial state, and has every reachable one a successor?"""
    blocks = _blocks(log.replace("NuSMV > ", ""))
    found = {name: _VERDICT.search(block) for name, block in blocks.items()}
    return {name: verdict.group(1) == "true" for name, verdict in found.items() if verdict is not None}, False if _no_start(log) else _total(blocks)


def _blocks(output: str) -> dict[str, str]:
    """What was printed for each check."""
    return dict(re.findall(r"^@@begin (\S+) *\n(.*?)^@@end \1 *$", output, re.MULTILINE | re.DOTALL))


def _no_start(log: str) -> bool:
    return "set of initial states is EMPTY" in log or "initial states set is empty" in log.lower()


def _total(blocks: Mapping[str, str]) -> bool | None:
    fsm = blocks.get("fsm", "")
    return True if "is total" in fsm and "not total" not in fsm else False if fsm else None


def _script(checks: Sequence[Check]) -> str:
    # the order of the declarations, one variable after the other: many times faster here than bits of all numbers interleaved
    # clusters twenty times the default: a few large relations, where the default makes many small steps of every image
    lines = ["set partition_method Iwls95CP", "set image_cluster_size 20000", "set vars_order_type inputs_before", "unset traces_show_defines", "unset traces_show_defines_with_next", "go"]

    def block(name: str, *commands: str) -> None:
        lines.extend([f'echo "@@begin {name}"', *commands, f'echo "@@end {name}"'])

    block("initial")
    block("fsm", "check_fsm")
    block("reachable", "compute_reachable", "print_reachable_states")
    for check in checks:
        lines.append(("set" if check.trace else "unset") + " counter_examples")
        block(check.name, f"{_KIND[check.kind]} -P {check.name}", "time")
    return "\n".join([*lines, "quit"]) + "\n"


def _complaint(log: str) -> str:
    lines = [line for line in log.splitlines() if line.strip() and not line.startswith(("***", "NuSMV >", "@@"))]
    wrong = [line for line in lines if "rror" in line or "ndefined" in line or "line " in line]
    return "NuSMV gave no verdict: " + " / ".join((wrong or lines)[-3:])


def _answer(block: str, check: Check) -> Answer:
    verdict = _VERDICT.search(block)
    if verdict is None:
        return EngineFailed(_complaint(block))
    if verdict.group(1) == "true":
        return Holds()
    states, loop = read_trace(block) if check.trace else ((), None)
    return Violated(states, loop)


def read_trace(text: str) -> tuple[tuple[dict[str, str], ...], int | None]:
    """The states of a printed trace, each complete (NuSMV prints only what changed), and where it loops back."""
    states: list[dict[str, str]] = []
    loop: int | None = None
    current: dict[str, str] = {}
    for line in text.splitlines():
        line = line.strip()
        if line.startswith("-- Loop starts here"):
            loop = len(states)
        elif line.startswith("-> State:"):
            current = dict(states[-1]) if states else {}
            states.append(current)
        elif states and " = " in line and not line.startswith(("--", "->", "@@")):
            name, value = line.split(" = ", 1)
            current[name.strip()] = value.strip()
    if loop is not None and len(states) > 1 and loop < len(states) - 1 and states[-1] == states[loop]:
        states.pop()  # NuSMV prints the state of the loop's start once more
    return tuple(states), loop
