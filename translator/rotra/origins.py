"""Where a thing came from: the file and line that a message, a model line or a trace names.

In: nothing.  Out: `Origin`, carried by every node of every stage.  Left to others: the messages (diagnostics.py).
"""

from __future__ import annotations

from dataclasses import dataclass


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
