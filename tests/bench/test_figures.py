"""What it costs: all proofs, warm, on this machine; a driver's steps in Jason.  Run by `make bench`.

Out: figures.json beside this file, rewritten by each run, so that a change of the figures shows in a diff.  Nothing fails for
being slow: a busy machine is no fault of the program.
"""

from __future__ import annotations

import json
import statistics
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from bench.keeping import keep
from rotra.engines import places

pytestmark = pytest.mark.bench
ROTRA = Path(sys.executable).with_name("rotra")


def descendants(pid: int) -> list[int]:
    """The process and all that it started, also those in process groups of their own."""
    parents: dict[int, list[int]] = {}
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                parent = int((entry / "stat").read_text().rsplit(")", 1)[1].split()[1])
            except (OSError, IndexError):
                continue
            parents.setdefault(parent, []).append(int(entry.name))
    found, todo = [], [pid]
    while todo:
        found.append(todo.pop())
        todo += parents.get(found[-1], [])
    return found


def megabytes(pid: int) -> float:
    """What one process holds, shared pages counted by their share."""
    try:
        for line in Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines():
            if line.startswith("Pss:"):
                return int(line.split()[1]) / 1024
    except OSError:
        pass
    return 0.0


def measured(command: list[str | Path]) -> tuple[int, str, float, float]:
    """Exit status, output (of a failure also the errors), seconds, and the most memory that the program and its children held at one moment."""
    started = time.monotonic()
    child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=places.PROJECT)
    peak = 0.0
    over = threading.Event()

    def watch() -> None:
        nonlocal peak
        while not over.wait(0.05):
            peak = max(peak, sum(megabytes(pid) for pid in descendants(child.pid)))

    watcher = threading.Thread(target=watch)
    watcher.start()
    try:
        output, errors = child.communicate(timeout=600)
    finally:
        over.set()
        watcher.join()
        if child.poll() is None:
            child.kill()
    return child.returncode, output or errors, time.monotonic() - started, peak


def test_all_proofs_warm() -> None:
    if not places.nusmv().is_file():
        pytest.skip("NuSMV is not built")
    command: list[str | Path] = [ROTRA, "verify", "--json", "--timings"]
    measured(command)  # warms the caches
    status, output, seconds, memory = measured(command)
    assert status in (0, 1), output
    answer = json.loads(output)
    keep(
        "verify",
        {
            "seconds": round(seconds, 2),
            "megabytes": round(memory),
            "verdicts": len(answer["verdicts"]),
            **{f"phase {name}": round(float(took), 2) for name, took in answer.get("timings", {}).items()},
        },
    )
    print(f"\nverify: {len(answer['verdicts'])} verdicts in {seconds:.1f} s, {memory:.0f} MB")


def test_doctor() -> None:
    _, _, seconds, memory = measured([ROTRA, "doctor"])
    print(f"\ndoctor: {seconds:.1f} s, {memory:.0f} MB")
    keep("doctor", {"seconds": round(seconds, 2), "megabytes": round(memory)})


@pytest.mark.parametrize("scenario", ["traffic_light", "overtake", "right_turn"])
def test_steps_a_second(scenario: str, tmp_path: Path) -> None:
    if not places.classpath_file().is_file():
        pytest.skip("the Java side is not built")
    from rotra.engines.jvm import ask_java
    from rotra.frontends.scenario import instance, resolve_scenario, scenario_json
    from rotra.pipeline.inputs import load_drivers, load_law

    (driver,) = load_drivers(["reactive"])
    advice = tmp_path / "advice.asl"
    advice.write_text(load_law("uk").text, encoding="utf-8")
    world = scenario_json(instance(resolve_scenario(scenario), "published"))
    job = {
        "runs": 3,
        "agent": str(driver.file),
        "rules": str(advice),
        "world": world,
        "start": None,
        "seed": None,
        "choices": None,
        "percepts": None,
        "steps": 5_000,
        "until": None,
        "trace": False,
        "cap": 500,
    }
    rate = statistics.median(ask_java("bench", job, timeout=300)["steps_per_second"])
    keep(f"run {scenario}", {"steps a second": round(rate)})
    print(f"\nrun {scenario}: {rate:.0f} steps a second")
