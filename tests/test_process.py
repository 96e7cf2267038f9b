"""engines/process.py: every way a program can end, and that nothing outlives a call."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

import pytest

from rotra.engines.process import End, run

PYTHON = sys.executable


def python(text: str, **options):  # type: ignore[no-untyped-def]
    return run([PYTHON, "-c", text], **options)


def alive(pid: int) -> bool:
    """Is there a process `pid` that is not a corpse?"""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def gone(pid: int) -> bool:
    deadline = time.monotonic() + 3
    while alive(pid) and time.monotonic() < deadline:
        time.sleep(0.02)
    return not alive(pid)


def test_output_errors_and_status_are_kept() -> None:
    outcome = python("import sys; print('out'); print('err', file=sys.stderr); sys.exit(3)")
    assert (outcome.end, outcome.status, outcome.stdout, outcome.stderr) == (End.EXITED, 3, "out\n", "err\n")
    assert not outcome.ok
    assert outcome.why().endswith("exit status 3: err")


def test_success() -> None:
    outcome = python("print(input())", stdin="grüße\n", environment={"PYTHONUTF8": "1"})
    assert outcome.ok and outcome.stdout == "grüße\n" and outcome.command[0] == PYTHON


def test_large_input_and_output_do_not_block() -> None:
    text = "x" * 3_000_000
    outcome = python("import sys; t = sys.stdin.read(); sys.stderr.write(t); sys.stdout.write(t)", stdin=text, timeout=30)
    assert outcome.ok and outcome.stdout == text and outcome.stderr == text


def test_unwanted_input_is_no_fault() -> None:
    assert python("pass", stdin="x" * 3_000_000, timeout=30).ok


def test_arguments_are_not_read_by_a_shell(tmp_path: Path) -> None:
    outcome = run([PYTHON, "-c", "import sys; print(sys.argv[1])", "$(touch x); *"], cwd=tmp_path)
    assert outcome.stdout == "$(touch x); *\n" and not list(tmp_path.iterdir())


def test_missing_program() -> None:
    outcome = run(["/no/such/program"])
    assert outcome.end is End.NOT_STARTED and outcome.status is None and "No such file" in outcome.stderr
    assert outcome.why().startswith("program: could not be started")


def test_killed_by_a_signal() -> None:
    outcome = python("import os; os.kill(os.getpid(), 9)")
    assert outcome.end is End.KILLED and outcome.status == 9 and "SIGKILL" in outcome.why()


def test_timeout_kills_the_whole_group_and_keeps_the_output() -> None:
    outcome = python(
        "import subprocess, sys, time\n"
        "child = subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(60)'])\n"
        "print(child.pid, flush=True)\n"
        "time.sleep(60)",
        timeout=1.0,
    )
    assert outcome.timed_out and not outcome.ok and outcome.status is None and outcome.seconds < 10
    assert gone(int(outcome.stdout))


def test_a_child_left_behind_is_killed() -> None:
    outcome = python(
        "import subprocess, sys\nchild = subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(60)'])\nprint(child.pid, flush=True)",
        timeout=1.0,
    )
    assert outcome.end is End.EXITED and outcome.seconds < 10
    assert gone(int(outcome.stdout))


def test_lines_are_handed_over_as_they_come() -> None:
    seen: list[tuple[str, float]] = []
    outcome = python(
        "import time\nprint('a', flush=True)\ntime.sleep(0.5)\nprint('b')",
        on_line=lambda line: seen.append((line, time.monotonic())),
    )
    assert [line for line, _ in seen] == ["a", "b"] and seen[1][1] - seen[0][1] > 0.3
    assert outcome.stdout == "a\nb\n"


def test_a_listener_that_fails_stops_the_program() -> None:
    def listener(line: str) -> None:
        raise RuntimeError(line)

    started = time.monotonic()
    with pytest.raises(RuntimeError, match="first"):
        python("import time\nprint('first', flush=True)\ntime.sleep(60)", on_line=listener)
    assert time.monotonic() - started < 10


def test_an_interrupt_kills_the_program(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    import subprocess

    note = tmp_path / "pid"
    real = subprocess.Popen.wait
    calls = iter([True])

    def interrupted(self: subprocess.Popen, timeout: float | None = None) -> int:  # type: ignore[type-arg]
        if next(calls, False):
            while not note.exists() or not note.read_text().endswith("\n"):
                time.sleep(0.02)
            raise KeyboardInterrupt
        return real(self, timeout)

    monkeypatch.setattr(subprocess.Popen, "wait", interrupted)
    with pytest.raises(KeyboardInterrupt):
        python("import os, time\nopen(os.environ['NOTE'], 'w').write(f'{os.getpid()}\\n')\ntime.sleep(60)", environment={"NOTE": str(note)})
    assert gone(int(note.read_text()))


def test_bytes_that_are_not_text() -> None:
    assert python("import os; os.write(1, b'a\\xffb')").stdout == "a\ufffdb"


def test_the_environment_is_added_to() -> None:
    outcome = python("import os; print(os.environ['MORE'], 'PATH' in os.environ)", environment={"MORE": "yes"})
    assert outcome.stdout == "yes True\n" and "MORE" not in os.environ
