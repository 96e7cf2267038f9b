"""Where the figures are kept.  Out: figures.json beside this file, with the command that makes them; a change shows in a diff."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path

FIGURES = Path(__file__).with_name("figures.json")


def keep(name: str, figures: Mapping[str, float | int]) -> None:
    """Write one part of the figures; the others stay."""
    kept = json.loads(FIGURES.read_text()) if FIGURES.is_file() else {}
    kept["command"] = "make bench"
    kept[name] = {**figures, "cores": os.cpu_count()}
    FIGURES.write_text(json.dumps(kept, indent=2, sort_keys=True) + "\n")
