"""Draw one step of a trace over the grid of its scenario, as plain text.

In: the rows of the grid, a trace step, where the lights stand (as far as known).  Out: text.  Left to others: colours,
stepping, printing (cli.py).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import zip_longest
from typing import Any

from rotra.frontends.scenario import Scenario
from rotra.pipeline.explain import act_words

_FACING = {"north": "▲", "south": "▼", "east": "▶", "west": "◀"}
_LAMP = {"red": "R", "red_amber": "B", "green": "G", "amber": "A"}
_ROAD = frozenset("^vV<>+")


def light_cells(scenario: Scenario) -> dict[str, tuple[int, int]]:
    """Where the lights of a scenario stand, for `draw_step`."""
    return {light.name: light.at for light in scenario.lights}


def draw_step(rows: Sequence[str], step: Mapping[str, Any], lights: Mapping[str, tuple[int, int]] | None = None) -> str:
    """The grid with the cars, beside it what the driver is told and does.  The driver is an arrow, other cars the first
    letter of their name, a crash an X, a light R, B (red and amber), G or A."""
    left = _grid(rows, step, lights or {})
    right = _facts(step)
    width = max((len(r) for r in left), default=0)
    lines = (f"{a:<{width}}   {b}" if left else b for a, b in zip_longest(left, right, fillvalue=""))
    return "\n".join(line.rstrip() for line in lines)


def _grid(rows: Sequence[str], step: Mapping[str, Any], lights: Mapping[str, tuple[int, int]]) -> list[str]:
    cells = [[c if c in _ROAD else "." for c in row] for row in rows]

    def put(x: int, y: int, mark: str) -> None:
        if 0 <= y < len(cells) and 0 <= x < len(cells[y]):
            cells[y][x] = mark

    for name, (x, y) in lights.items():
        put(x, y, _LAMP.get(step.get("lights", {}).get(name, ""), "?"))
    cars = step.get("cars", {})
    for name, car in sorted(cars.items(), key=lambda item: item[0] == "driver"):
        mark = "X" if car["crashed"] else _FACING.get(car.get("heading", ""), "o") if name == "driver" else name[:1]
        put(car["x"], car["y"], mark)
    return [" ".join(row) for row in cells]


def _facts(step: Mapping[str, Any]) -> list[str]:
    car = step.get("cars", {}).get("driver", {})
    lines = [f"step {step['step']}" + ("  CRASHED" if car.get("crashed") else "") + ("  finished" if step.get("finished") else "")]
    if car:
        lines.append(f"at ({car['x']},{car['y']}) {car.get('heading', '')}, speed {car.get('speed', 0)}")
    if step.get("lights"):
        lines.append("lights " + ", ".join(f"{k} {v}" for k, v in step["lights"].items()))
    if step.get("situation", {}).get("intentions"):
        lines.append("intends " + ", ".join(step["situation"]["intentions"]))
    for label in dict.fromkeys(d["label"] for d in step.get("advice", [])):
        lines.append(f"{label} " + ", ".join(d["action"] for d in step["advice"] if d["label"] == label))
    if step.get("acts", {}).get("driver") and not car.get("crashed"):
        lines.append(act_words(step["acts"]["driver"]))
    if step.get("ignored"):
        lines.append("IGNORES " + ", ".join(f"{d['label']} {d['action']}" for d in step["ignored"]))
    return lines
