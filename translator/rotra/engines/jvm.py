"""Ask the Java side: parse AgentSpeak with Jason's own parser, run a driver in its world.

In: a command and a JSON job.  Out: the JSON answer.  Errors: `EngineError` where the JVM gives none.  Left to others: what
jobs and answers mean (frontends, pipeline).  Parsed files are kept by the hash of what was parsed.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from rotra.diagnostics import Rejected, problem
from rotra.engines import places
from rotra.engines.process import run
from rotra.frontends.agent import Agent, read_agent
from rotra.origins import Origin, shown_path

_INCLUDE = re.compile(r'include\(\s*"([^"]*)"')


class EngineError(Exception):
    """An engine gave no answer; the command ends with status 3."""


def ask_java(command: str, job: Mapping[str, Any], timeout: float, on_line: Callable[[str], None] | None = None) -> Any:
    """The JSON that `rotra.jason.Main <command>` answers; with `on_line`, each line as it comes, and None."""
    listing = places.classpath_file()
    if not listing.is_file():
        raise EngineError("the Java side is not built: run `make setup`")
    classes = ":".join((*map(str, places.classes()), listing.read_text().strip()))
    options = ["-XX:+UseSerialGC", "-XX:TieredStopAtLevel=1", "-Xshare:auto", f"-Drotra.agents={places.AGENTS}"]
    outcome = run([places.java(), *options, "-cp", classes, "rotra.jason.Main", command], stdin=json.dumps(job), timeout=timeout, on_line=on_line)
    if not outcome.ok:
        raise EngineError(outcome.why())
    if on_line is not None:
        return None
    try:
        return json.loads(outcome.stdout)
    except ValueError as error:
        raise EngineError(f"the Java side did not answer with JSON: {outcome.stdout[:200]!r}") from error


def parse_agents(files: Sequence[Path], timeout: float = 60) -> tuple[Agent, ...]:
    """The files' agents, in order.  Errors: AG100 for what Jason's parser refuses."""
    missing = [f for f in files if not f.is_file()]
    if missing:
        raise Rejected([problem("AG100", Origin(str(f)), "there is no such agent file", "check the path") for f in missing])
    stored = {f: _stored(f) for f in files}
    todo = [f for f in files if not stored[f].is_file()]
    if todo:
        answer = ask_java("parse", {"files": [str(f.resolve()) for f in todo]}, timeout)
        wrong = []
        for file, entry in zip(todo, answer["agents"], strict=True):
            if entry.get("error"):
                e = entry["error"]
                wrong.append(problem("AG100", Origin(e.get("file") or str(file), max(0, e.get("line") or 0)), f"Jason's parser refuses this: {_short(e['message'])}", "mend the syntax"))
            else:
                stored[file].parent.mkdir(parents=True, exist_ok=True)
                fresh = stored[file].with_suffix(f".{os.getpid()}")
                fresh.write_text(json.dumps(placed(entry["ast"])))
                fresh.replace(stored[file])
        if wrong:
            raise Rejected(wrong)
    return tuple(read_agent(str(f), json.loads(stored[f].read_text())) for f in files)


def placed(ast: Any) -> Any:
    """What Java says (an AST, a trace), with every file named as a person would: from the project's root, else from the root of the disk."""
    if isinstance(ast, list):
        return [placed(part) for part in ast]
    if not isinstance(ast, dict):
        return ast
    return {key: _shown(value) if key == "file" and isinstance(value, str) else placed(value) for key, value in ast.items()}


def _shown(file: str) -> str:
    return shown_path(str(Path("/") / file.removeprefix("file:")))


def _short(message: str) -> str:
    return re.sub(r"\s+", " ", message).strip()[:300]


def included_files(file: Path) -> tuple[Path, ...]:
    """The file and all that it includes, directly or not, as absolute paths; a file that is not there is left out."""
    seen: dict[Path, None] = {}
    todo = [file.resolve()]
    while todo:
        path = todo.pop()
        if path not in seen and path.is_file():
            seen[path] = None
            todo += [_included(name, path) for name in _INCLUDE.findall(path.read_text(encoding="utf-8", errors="replace"))]
    return tuple(seen)


def _included(name: str, by: Path) -> Path:
    """Beside the file that includes it, else among the shipped agent files (as rotra.jason.Includes has it)."""
    beside = (by.parent / name).resolve()
    shipped = (places.AGENTS / name).resolve()
    return shipped if not beside.is_file() and shipped.is_file() else beside


def _stored(file: Path) -> Path:
    """Where the AST of a file is kept: named by its path, its text and the text of all it includes."""
    digest = hashlib.sha256()
    for path in included_files(file):
        text = path.read_text(encoding="utf-8", errors="replace")
        digest.update(f"{path}\0{text}\0".encode())
    for exporter in places.classes()[0].glob("rotra/jason/Parser*.class"):
        digest.update(exporter.read_bytes())
    digest.update(f"{file}\0{Path(__file__).read_text()}".encode())
    return places.PROJECT / ".build" / "ast" / f"{digest.hexdigest()[:32]}.json"
