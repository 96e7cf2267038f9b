"""Run one program and give back what it said: the only place that starts processes.

In: an argument list (never a shell line), text for its input, a time limit.  Out: an `Outcome` that says how it ended and
keeps the raw output, also of a program that was stopped half way.  Left to others: what the output means (nusmv.py, jvm.py).

The program gets a process group of its own, and the whole group is killed when the time is up, when the caller is
interrupted, and when the program ends but leaves children behind.  So nothing outlives a call.
"""

from __future__ import annotations

import os
import signal
import subprocess
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import IO

# What readers are given to finish once the group is dead; only a child that left the group can make them need it.
_DRAIN_SECONDS = 2.0


class End(Enum):
    """How a program ended."""

    EXITED = "exited"
    KILLED = "killed by a signal"
    TIMED_OUT = "ran out of time"
    NOT_STARTED = "could not be started"


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of one run.  `status` is the exit status, the signal's number, or None where there is neither."""

    command: tuple[str, ...]
    end: End
    status: int | None
    stdout: str
    stderr: str
    seconds: float

    @property
    def ok(self) -> bool:
        """Did it end by itself with exit status 0?"""
        return self.end is End.EXITED and self.status == 0

    @property
    def timed_out(self) -> bool:
        return self.end is End.TIMED_OUT

    def why(self) -> str:
        """One line for a person: the program, how it ended and the last thing it said."""
        program = Path(self.command[0]).name
        match self.end:
            case End.EXITED:
                ending = f"exit status {self.status}"
            case End.KILLED:
                ending = f"killed by {_signal_name(self.status)}"
            case End.TIMED_OUT:
                ending = f"stopped after {self.seconds:.0f} s"
            case End.NOT_STARTED:
                ending = "could not be started"
        said = [line.strip() for line in (self.stderr or self.stdout).splitlines() if line.strip()]
        return f"{program}: {ending}" + (f": {said[-1]}" if said else "")


def run(
    command: Sequence[str | Path],
    *,
    stdin: str = "",
    timeout: float | None = None,
    cwd: Path | None = None,
    environment: Mapping[str, str] | None = None,
    on_line: Callable[[str], None] | None = None,
) -> Outcome:
    """Run `command` to its end, or to the end of `timeout` seconds, and say what happened.

    `environment` is added to the present one.  `on_line` is called with each line of the output as it comes (without
    its line end), for a run that is watched; the output is kept all the same.  Its exceptions stop the program.
    """
    arguments = tuple(str(part) for part in command)
    started = time.monotonic()
    try:
        child = subprocess.Popen(
            arguments,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            cwd=cwd,
            env={**os.environ, **(environment or {})},
            start_new_session=True,
        )
    except (OSError, ValueError) as reason:
        return Outcome(arguments, End.NOT_STARTED, None, "", str(reason), time.monotonic() - started)

    assert child.stdin and child.stdout and child.stderr
    output = _Reader(child.stdout, on_line, lambda: _kill_group(child.pid))
    errors = _Reader(child.stderr)
    writer = threading.Thread(target=_write, args=(child.stdin, stdin), daemon=True)
    writer.start()
    timed_out = False
    try:
        try:
            child.wait(timeout)
        except subprocess.TimeoutExpired:
            timed_out = True
        # A child left behind may hold the pipes open: it has what is left of the time, then the group goes.
        if not timed_out:
            rest = _DRAIN_SECONDS if timeout is None else max(0.0, started + timeout - time.monotonic())
            output.finish(min(rest, _DRAIN_SECONDS))
            errors.finish(min(rest, _DRAIN_SECONDS))
    finally:
        if timed_out or child.returncode is None or output.running or errors.running:
            _kill_group(child.pid)
            child.wait()
        output.finish(_DRAIN_SECONDS)
        errors.finish(_DRAIN_SECONDS)
    seconds = time.monotonic() - started
    if output.failure is not None:
        raise output.failure
    if timed_out:
        return Outcome(arguments, End.TIMED_OUT, None, output.text(), errors.text(), seconds)
    status = child.returncode
    end = End.EXITED if status >= 0 else End.KILLED
    return Outcome(arguments, end, abs(status), output.text(), errors.text(), seconds)


class _Reader:
    """Collects one stream in a thread of its own, so that a full pipe never blocks the program."""

    def __init__(self, stream: IO[bytes], on_line: Callable[[str], None] | None = None, stop: Callable[[], None] | None = None) -> None:
        self.failure: BaseException | None = None
        self._stream = stream
        self._on_line = on_line
        self._stop = stop
        self._chunks: list[bytes] = []
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    @property
    def running(self) -> bool:
        return self._thread.is_alive()

    def finish(self, seconds: float) -> None:
        self._thread.join(seconds)

    def text(self) -> str:
        return b"".join(tuple(self._chunks)).decode("utf-8", errors="replace")

    def _read(self) -> None:
        with self._stream:
            if self._on_line is None:
                while chunk := os.read(self._stream.fileno(), 65536):
                    self._chunks.append(chunk)
                return
            for line in self._stream:
                self._chunks.append(line)
                if self.failure is None:
                    try:
                        self._on_line(line.decode("utf-8", errors="replace").rstrip("\r\n"))
                    except BaseException as failure:  # handed to the caller's thread, which raises it again
                        self.failure = failure
                        if self._stop is not None:
                            self._stop()


def _write(stream: IO[bytes], text: str) -> None:
    try:
        with stream:
            stream.write(text.encode("utf-8"))
    except (BrokenPipeError, ConnectionResetError):
        pass  # the program did not want its input; its exit status tells whether that is right


def _kill_group(group: int) -> None:
    try:
        os.killpg(group, signal.SIGKILL)
    except (ProcessLookupError, PermissionError):
        pass  # already gone


def _signal_name(number: int | None) -> str:
    try:
        return signal.Signals(number or 0).name
    except ValueError:
        return f"signal {number}"
