"""A driver in its world as a Jason project, that stock Jason runs from the project's own folder.

    driver.mas2j  job.json  logging.properties  README.md  src/agt/*.asl  src/agt/advice.asl  lib/*.jar

In: the agent's sources, the advice, the run that is asked for.  Out: the text of each file by its path.  Errors: IO105 a file name
that a .mas2j file cannot hold.  Left to others: writing files and copying jars (pipeline/translate.py), running
(`rotra.jason.StockDriverArch`).
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import PurePosixPath
from typing import Any

from rotra.diagnostics import Rejected, problem
from rotra.origins import Origin

SOURCES = "src/agt"
ADVICE = f"{SOURCES}/advice.asl"
COMMAND = "java -cp 'lib/*' jason.infra.local.RunLocalMAS driver.mas2j --no-net --log-conf logging.properties"

_PLAIN_PATH = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]*(/[A-Za-z0-9_][A-Za-z0-9_.-]*)*")

_PROJECT = """\
// One car and its adviser, made by the translator.  Run it from this folder:
//     {command}
MAS driver {{
    infrastructure: Local
    agents:
        driver {main} [rules="{advice}", job="job.json", trace="trace.json"]
            agentArchClass rotra.jason.StockDriverArch
            agentClass rotra.jason.DriverAgent
            beliefBaseClass rotra.jason.IndexedBeliefBase;
    aslSourcePath: "{sources}";
}}
"""

_LOGGING = """\
handlers = java.util.logging.ConsoleHandler
java.util.logging.ConsoleHandler.level = INFO
java.util.logging.ConsoleHandler.formatter = jason.runtime.MASConsoleLogFormatter
.level = INFO
"""

_README = """\
# {title}
A driver, the rule base it asks (`src/agt/advice.asl`) and its world (`job.json`), as a project for Jason 3.2.1. From this folder:

    {command}

It drives {steps} steps and writes what happened in each to `trace.json`. `lib/` holds Jason as it is published, and the grid world and the car's
architecture (`rotra.jason.StockDriverArch`), which the project names.
"""


def emit_project(sources: Mapping[PurePosixPath, str], main: PurePosixPath, advice: str, job: Mapping[str, Any], title: str) -> dict[str, str]:
    """Path -> text.  `sources`: the agent's files by their path among the sources; `main` is one of them; `job`: see rotra.jason.Job."""
    wrong = [path for path in sources if not _PLAIN_PATH.fullmatch(str(path)) or str(path) == PurePosixPath(ADVICE).name]
    if wrong:
        raise Rejected([problem("IO105", Origin(str(path)), f"the file name {str(path)!r} cannot stand in a Jason project", "rename it: letters, digits, `_`, `-` and `.`, and not advice.asl") for path in wrong])
    files = {f"{SOURCES}/{path}": text for path, text in sources.items()}
    files[ADVICE] = advice
    files["driver.mas2j"] = _PROJECT.format(command=COMMAND, main=main, advice=ADVICE, sources=SOURCES)
    files["job.json"] = json.dumps({**job, "agent": f"{SOURCES}/{main}", "rules": ADVICE}, indent=1, sort_keys=True) + "\n"
    files["logging.properties"] = _LOGGING
    files["README.md"] = _README.format(title=title, command=COMMAND, steps=job["steps"])
    return files
