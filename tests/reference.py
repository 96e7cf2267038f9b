"""The published rule base and its data, which are no part of the project: where they are, or why a test is skipped."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from rotra.frontends.rules import PROJECT


def reference(name: str) -> Path:
    """A file of the reference folder: ROTRA_REFERENCE says where, else it is looked for beside the project."""
    folder = Path(os.environ.get("ROTRA_REFERENCE") or PROJECT.parent / "shared" / "reference")
    if not (folder / name).is_file():
        pytest.skip(f"no {name}: set ROTRA_REFERENCE to the folder of the published rule base")
    return folder / name
