"""Where `make setup` put the engines.

In: the environment.  Out: paths; none is promised to exist (doctor.py says what is missing).  Left to others: running them.
"""

from __future__ import annotations

import os
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[3]
AGENTS = PROJECT / "agents"


def nusmv() -> Path:
    """The NuSMV binary: the one that ROTRA_NUSMV names, else the one built by `make setup`."""
    named = os.environ.get("ROTRA_NUSMV")
    return Path(named) if named else PROJECT / ".build" / "nusmv" / "bin" / "NuSMV"


def java() -> str:
    """The Java launcher: that of JAVA_HOME where it is set, else the first on the path."""
    home = os.environ.get("JAVA_HOME")
    launcher = Path(home) / "bin" / "java" if home else None
    return str(launcher) if launcher and launcher.exists() else "java"


def classpath_file() -> Path:
    """The file in which Maven wrote the class path of the Jason side (without the project's own classes)."""
    return PROJECT / "agents" / "java" / "target" / "classpath.txt"


def classes() -> tuple[Path, ...]:
    """The project's own compiled classes: the Jason side, then the world."""
    return (PROJECT / "agents" / "java" / "target" / "classes", PROJECT / "model" / "java" / "target" / "classes")


def jars() -> tuple[Path, ...]:
    """All that a run in Jason needs, as jars: ours, then the libraries, Jason's own among them."""
    listing = classpath_file()
    own = [jar for side in ("agents", "model") for jar in sorted((PROJECT / side / "java" / "target").glob("rotra-*.jar"))]
    return (*own, *(Path(entry) for entry in listing.read_text().strip().split(":"))) if listing.is_file() else tuple(own)
