"""Where a thing came from: the file and line that a message, a model line or a trace names.

In: nothing.  Out: `Origin`, carried by every node of every stage, and how its file is named.  Left to others: the messages (diagnostics.py).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True, slots=True, order=True)
class Origin:
    """A place in a user's file; `line` counts from 1, 0 where only the file is known; `what` names the thing there."""

    file: str
    line: int = 0
    what: str = ""

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}" if self.line else self.file
        return f"{self.what} <- {place}" if self.what else place


NOWHERE = Origin("")


@cache
def shown_path(file: str) -> str:
    """A path inside the project without the place where the project lies; any other as it was given."""
    path = Path(file)
    return str(path.relative_to(PROJECT)) if path.is_absolute() and path.is_relative_to(PROJECT) else file


def real_path(file: str) -> Path:
    """The file that such a path names: as it stands, else from the project's root."""
    path = Path(file)
    return path if path.is_absolute() or path.is_file() else PROJECT / path
