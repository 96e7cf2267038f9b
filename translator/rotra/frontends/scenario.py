"""Load a scenario: the grid, its lights and cars, the task, the goal, and which of them may vary.

In: a YAML file or a shipped name.  Out: `Scenario`.  Left to others: how the world moves (model/README.md).
Errors: SC1xx and IO1xx, all that are found, as one `Rejected`.
"""

from __future__ import annotations

import difflib
import itertools
import json
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any, Generic, TypeVar

import jsonschema

from rotra.diagnostics import Diagnostic, Rejected, problem
from rotra.engines.places import PROJECT
from rotra.frontends.mirror import mirrored_term, other_side
from rotra.frontends.terms import parse_ground, show
from rotra.frontends.textworld import with_text_world
from rotra.frontends.yamlfile import Node, load_yaml
from rotra.origins import Origin

T = TypeVar("T")
Cell = tuple[int, int]
DEFAULT_CYCLE = (("red", 4), ("red_amber", 1), ("green", 4), ("amber", 1))
ROAD = frozenset("^vV<>+")
DEFAULT_RADIUS = 3


@dataclass(frozen=True, slots=True)
class Varied(Generic[T]):
    """What an instance may choose: the published value, and all that are declared (the published one among them)."""

    published: T
    all: tuple[T, ...]


@dataclass(frozen=True, slots=True)
class Light:
    name: str
    at: Cell
    stop_line: Cell
    faces: str
    cycle: tuple[tuple[str, int], ...]
    phase: Varied[int]
    origin: Origin


@dataclass(frozen=True, slots=True)
class ScriptedCar:
    """Traffic: drives straight ahead at its speed (cells a step); `hesitates.all` holds True where it may hesitate."""

    name: str
    at: Varied[Cell]
    heading: str
    speed: Varied[int]
    hesitates: Varied[bool]
    origin: Origin


@dataclass(frozen=True, slots=True)
class DriverCar:
    at: Varied[Cell]
    heading: str
    task: str
    origin: Origin
    name: str = "driver"


@dataclass(frozen=True, slots=True)
class InCells:
    cells: tuple[Cell, ...]


@dataclass(frozen=True, slots=True)
class Beyond:
    """`cells` cells past the stop line of the light, the way the traffic goes that it faces."""

    light: str
    cells: int


@dataclass(frozen=True, slots=True)
class Overtaken:
    """Has been beside the car on its offside, and then stands in its lane with it 1..within cells behind."""

    car: str
    within: int


Goal = InCells | Beyond | Overtaken


@dataclass(frozen=True, slots=True)
class Scenario:
    id: str
    source: str  # the shipped name or the path it was asked for by
    says: str
    drives: str
    radius: int
    limit: int
    top_speed: int
    rows: tuple[str, ...]
    lights: tuple[Light, ...]
    driver: DriverCar
    traffic: tuple[ScriptedCar, ...]
    goal: Goal | None
    percepts: tuple[str, ...]
    percept_exclusions: tuple[tuple[str, ...], ...]
    origin: Origin
    warnings: tuple[Diagnostic, ...] = ()
    mirrors: str = ""  # the scenario that this is in the mirror

    @property
    def is_open(self) -> bool:
        return not self.rows

    @property
    def width(self) -> int:
        return len(self.rows[0]) if self.rows else 0

    @property
    def height(self) -> int:
        return len(self.rows)


def shipped_folder() -> Path:
    return PROJECT / "model" / "scenarios"


def resolve_scenario(given: str, to_mirror: bool = False) -> Scenario:
    """A shipped name, of a mirrored world too, or the path of a file.  `to_mirror`: it is to be mirrored.  Errors: SC100."""
    shipped = {p.stem: p for folder in (shipped_folder() / "mirrored", shipped_folder()) for p in folder.glob("*.yaml")}
    if given in shipped:
        return load_scenario(shipped[given], given, to_mirror)
    if Path(given).is_file():
        return load_scenario(Path(given), given, to_mirror)
    names = sorted(shipped)
    near = difflib.get_close_matches(given, names, 1)
    hint = f"did you mean {near[0]}?" if near else f"shipped are {', '.join(names)}; or give the path of a file"
    raise Rejected([problem("SC100", Origin(given), f"there is no scenario {given!r}", hint)])


def instance(scenario: Scenario, which: str) -> Scenario:
    """`published`: every choice at its published value; `all`: everything that is declared."""
    if which == "all":
        return scenario

    def fixed(v: Varied[Any]) -> Varied[Any]:
        return Varied(v.published, (v.published,))

    return replace(
        scenario,
        lights=tuple(replace(x, phase=fixed(x.phase)) for x in scenario.lights),
        driver=replace(scenario.driver, at=fixed(scenario.driver.at)),
        traffic=tuple(replace(c, at=fixed(c.at), speed=fixed(c.speed), hesitates=fixed(c.hesitates)) for c in scenario.traffic),
    )


@lru_cache(maxsize=1)
def _schema() -> dict[str, Any]:
    loaded = json.loads((PROJECT / "model" / "schema" / "scenario.schema.json").read_text(encoding="utf-8"))
    assert isinstance(loaded, dict)
    return loaded


def load_scenario(path: Path, source: str | None = None, to_mirror: bool = False) -> Scenario:
    root = load_yaml(path)
    _check_shape(root)
    warnings: tuple[Diagnostic, ...] = ()
    if root.get("mirrors") is not None and to_mirror:
        raise Rejected([problem("SC112", root.at("mirrors").origin(), "a mirrored world is to be mirrored again", "mirror the world that this one names")])
    if root.get("mirrors") is not None:
        return _in_the_mirror(root, source or str(path))
    if root.get("text") is not None:
        root, warnings = with_text_world(root)
        _check_shape(root)
    return replace(_Reader(root, source or str(path)).scenario(), warnings=warnings)


def _in_the_mirror(root: Node, source: str) -> Scenario:
    """The world that `mirrors` names, with left and right swapped.  Errors: those of that world."""
    name = str(root.at("mirrors").value)
    beside = Path(root.file).parent / name
    world = resolve_scenario(str(beside) if beside.is_file() else name, to_mirror=True)
    said = root.get("says")
    return replace(mirrored_world(world), id=str(root.at("id").value), source=source, says=str(said.value) if said else world.says, origin=root.origin("scenario"), mirrors=world.id)


def mirrored_world(world: Scenario) -> Scenario:
    """The same world in a mirror that stands along the road: traffic drives on the other side, a right turn is a left turn."""

    def cell(at: Cell) -> Cell:
        return (world.width - 1 - at[0], at[1])

    def cells(at: Varied[Cell]) -> Varied[Cell]:
        return Varied(cell(at.published), tuple(map(cell, at.all))) if world.rows else at

    def percept(text: str) -> str:
        return show(mirrored_term(parse_ground(text)))

    swapped = str.maketrans("<>", "><")
    goal = InCells(tuple(map(cell, world.goal.cells))) if isinstance(world.goal, InCells) else world.goal
    return replace(
        world,
        drives=other_side(world.drives),
        rows=tuple(row[::-1].translate(swapped) for row in world.rows),
        lights=tuple(replace(x, at=cell(x.at), stop_line=cell(x.stop_line), faces=other_side(x.faces)) for x in world.lights),
        driver=replace(world.driver, at=cells(world.driver.at), heading=other_side(world.driver.heading), task=other_side(world.driver.task)),
        traffic=tuple(replace(c, at=cells(c.at), heading=other_side(c.heading)) for c in world.traffic),
        goal=goal,
        percepts=tuple(map(percept, world.percepts)),
        percept_exclusions=tuple(tuple(map(percept, group)) for group in world.percept_exclusions),
    )


def _check_shape(root: Node) -> None:
    """Errors: IO103 for what the schema refuses."""
    hint = "compare with the shipped scenarios; editors use model/schema/scenario.schema.json"
    found = jsonschema.Draft202012Validator(_schema()).iter_errors(root.plain())
    shape = []
    for e in found:
        path = list(e.absolute_path)
        node, where = _node_at(root, path), "/".join(map(str, path)) or "the file"
        surplus = [key for key, _ in node.items() if e.validator == "additionalProperties" and key not in e.schema.get("properties", {})]
        if surplus and isinstance(e.schema.get("additionalProperties"), bool):
            shape += [problem("IO103", node.at(key).origin(), f"{where}: there is no key {key!r} here", hint) for key in surplus]
        elif e.validator == "oneOf" and not path:
            if node.get("mirrors") is not None:
                shape.append(problem("IO103", node.origin(), "a mirrored scenario says `id`, `says` and `mirrors`, and takes all else from the one it mirrors", "change that one, or draw a world of its own with `grid`"))
            else:
                shape.append(problem("IO103", node.origin(), "a scenario has either `grid` or `text`", 'draw the grid, name a world text, or write grid: "" for an open scenario'))
        else:
            shape.append(problem("IO103", node.origin(), f"{where}: {e.message}", hint))
    if shape:
        raise Rejected(shape)


def _node_at(root: Node, path: list[Any]) -> Node:
    node = root
    for key in path:
        following = node.get(str(key)) if isinstance(node.value, dict) else list(node)[key] if isinstance(key, int) and isinstance(node.value, tuple) and key < len(node.value) else None
        if following is None:
            return node
        node = following
    return node


class _Reader:
    """One file on its way to a Scenario; collects every complaint."""

    def __init__(self, root: Node, source: str) -> None:
        self.root, self.source = root, source
        self.found: list[Diagnostic] = []

    def refuse(self, code: str, node: Node, message: str, hint: str) -> None:
        self.found.append(problem(code, node.origin(), message, hint))

    def value(self, key: str, otherwise: Any) -> Any:
        node = self.root.get(key)
        return otherwise if node is None else node.plain()

    def scenario(self) -> Scenario:
        rows = self.rows()
        radius, limit = self.value("radius", DEFAULT_RADIUS), self.value("limit", 1)
        if limit > radius:
            self.refuse("SC104", self.root.get("limit") or self.root, f"the limit {limit} is larger than the radius {radius}: the car could drive further than it sees", "make the radius at least the limit")
        top = self.value("top_speed", limit + 1)
        lights = tuple(self.light(n, rows) for n in self.root.get("lights") or ())
        traffic = tuple(self.car(n, rows, top) for n in self.root.get("traffic") or ())
        driver_node = self.root.at("driver")
        driver = DriverCar(self.varied(driver_node, "at", _cell, (0, 0)), _plain(driver_node, "heading", "north"), _plain(driver_node, "task", "straight_on"), driver_node.origin("driver"))
        self.places(rows, lights, driver, driver_node, traffic)
        goal = self.goal(rows, lights, traffic)
        percepts, exclusions = self.percepts(rows, radius, limit, top)
        if self.found:
            raise Rejected(self.found)
        return Scenario(
            self.value("id", ""), self.source, self.value("says", ""), self.value("drives", "left"), radius, limit, top, rows,
            lights, driver, traffic, goal, percepts, exclusions, self.root.origin("scenario"),
        )

    def rows(self) -> tuple[str, ...]:
        node = self.root.at("grid")
        rows = tuple(r.rstrip("\r") for r in str(node.value or "").splitlines() if r.strip())
        for n, row in enumerate(rows):
            if len(row) != len(rows[0]):
                place = Origin(node.file, node.line + n + 1)
                self.found.append(problem("SC102", place, f"row {n} of the grid has {len(row)} cells, the first has {len(rows[0])}", "make all rows as long as the first; any other letter is no road"))
        return rows

    def varied(self, node: Node, key: str, convert: Callable[[Any], Any], otherwise: Any) -> Varied[Any]:
        given = node.get(key)
        if given is None:
            return Varied(otherwise, (otherwise,))
        if not isinstance(given.value, dict):
            value = convert(given.plain())
            return Varied(value, (value,))
        published = convert(given.at("published").plain())
        declared = given.get("all")
        values = [published] if declared is None else [convert(n.plain()) for n in declared] if isinstance(declared.value, tuple) else [convert(declared.plain())]
        return Varied(published, tuple(dict.fromkeys([published, *values])))

    def light(self, node: Node, rows: tuple[str, ...]) -> Light:
        cycle_node = node.get("cycle")
        cycle = tuple((c, int(n.value)) for c, n in cycle_node.items()) if cycle_node else DEFAULT_CYCLE  # type: ignore[call-overload]
        length = sum(n for _, n in cycle)
        phase_node = node.get("phase")
        everything = phase_node is not None and phase_node.get("all") is not None and phase_node.at("all").value == "any"
        if everything and phase_node is not None:
            published = int(phase_node.at("published").value)  # type: ignore[call-overload]
            phase = Varied(published, tuple(range(length)))
        else:
            phase = self.varied(node, "phase", int, 0)
        if any(not 0 <= p < length for p in phase.all):
            self.refuse("SC106", phase_node or node, f"a phase lies outside the cycle of {length} steps", f"use 0 to {length - 1}")
        light = Light(str(node.at("name").value), _cell(node.at("at").plain()), _cell(node.at("stop_line").plain()), str(node.at("faces").value), cycle, phase, node.origin(f"light {node.at('name').value}"))
        if not _inside(rows, light.at):
            self.refuse("SC106", node, f"light {light.name} stands outside the grid", "x counts from 0 to the east, y to the south")
        if not _is_road(rows, light.stop_line):
            self.refuse("SC106", node, f"the stop line of light {light.name} is not on the road", "put it on a road cell")
        return light

    def car(self, node: Node, rows: tuple[str, ...], top: int) -> ScriptedCar:
        name = str(node.at("name").value)
        speed = self.varied(node, "speed", int, 1)
        hesitates = self.varied(node, "hesitates", bool, False)
        if hesitates.published is False and True in hesitates.all or hesitates.published is True:
            hesitates = Varied(hesitates.published, (False, True))
        return ScriptedCar(name, self.varied(node, "at", _cell, (0, 0)), _plain(node, "heading", "north"), speed, hesitates, node.origin(f"car {name}"))

    def places(self, rows: tuple[str, ...], lights: tuple[Light, ...], driver: DriverCar, driver_node: Node, traffic: tuple[ScriptedCar, ...]) -> None:
        if not rows:
            for key in ("lights", "traffic", "goal"):
                if self.root.get(key) is not None:
                    self.refuse("SC107", self.root.at(key), f"`{key}` makes no sense without a grid", "leave it out, or draw the grid")
            return
        blocked = {x.at for x in lights}
        nodes = list(self.root.get("traffic") or ())
        cars = [("the driver", driver.at, driver_node), *((f"car {c.name}", c.at, n) for c, n in zip(traffic, nodes, strict=True))]
        for what, at, node in cars:
            for cell in at.all:
                if not _is_road(rows, cell) or cell in blocked:
                    self.refuse("SC101", node.get("at") or node, f"{what} starts off the road, at {list(cell)}", "put it on one of the cells ^ v < > +")
        for i, (what, at, _) in enumerate(cars):
            for other, place, node in cars[i + 1 :]:
                if at.published == place.published:
                    self.refuse("SC103", node.get("at") or node, f"{what} and {other} both start on {list(place.published)}", "move one of them")
        names = [*(x.name for x in lights), *(c.name for c in traffic), "driver"]
        for name in sorted({n for n in names if names.count(n) > 1}):
            self.refuse("SC108", self.root, f"the name {name} is used twice", "give every light and car a name of its own; `driver` is taken")

    def goal(self, rows: tuple[str, ...], lights: tuple[Light, ...], traffic: tuple[ScriptedCar, ...]) -> Goal | None:
        node = self.root.get("goal")
        if node is None:
            return None
        if node.get("in") is not None:
            cells = tuple(_cell(c) for c in node.at("in").plain())  # type: ignore[attr-defined]
            for cell in cells:
                if not _is_road(rows, cell):
                    self.refuse("SC105", node, f"the goal {list(cell)} is off the road", "choose road cells")
            return InCells(cells)
        if node.get("beyond") is not None:
            name = str(node.at("beyond").at("light").value)
            if name not in {x.name for x in lights}:
                self.refuse("SC105", node, f"the goal names a light {name} that is not there", "name one of the lights")
            return Beyond(name, int(node.at("beyond").at("cells").value))  # type: ignore[call-overload]
        name = str(node.at("overtaken").at("car").value)
        if name not in {c.name for c in traffic}:
            self.refuse("SC105", node, f"the goal names a car {name} that is not there", "name one of the traffic")
        within = node.at("overtaken").get("within")
        return Overtaken(name, 3 if within is None else int(within.value))  # type: ignore[call-overload]

    def percepts(self, rows: tuple[str, ...], radius: int, limit: int, top: int) -> tuple[tuple[str, ...], tuple[tuple[str, ...], ...]]:
        """The declared percepts and what excludes what, patterns written out."""
        words = _words(radius, limit, top)
        found: list[str] = []
        for node in self.root.get("percepts") or ():
            matching = _matching(str(node.value), words)
            if not matching:
                self.refuse("SC109", node, f"{str(node.value)!r} is no percept", "write one of section `Percepts` of model/README.md that the radius and the speeds allow, as in light(0,1,red) or light(0,1,_)")
            found += matching
        declared = dict.fromkeys(found)
        exclusions = []
        for node in self.root.get("percept_exclusions") or ():
            group: list[str] = []
            for pattern in node:
                matching = _matching(str(pattern.value), words)
                among = [t for t in matching if t in declared or rows]
                if not among:
                    self.refuse("SC109", pattern, f"{pattern.value} is excluded but is not among the percepts", "name it under percepts")
                group += among
            exclusions.append(tuple(dict.fromkeys(group)))
        return tuple(declared), tuple(exclusions)


def _words(radius: int, limit: int, top: int) -> dict[str, tuple[tuple[str, ...], ...]]:
    """What may stand at each place of each percept."""
    near = tuple(str(n) for n in range(-radius, radius + 1))
    return {
        "road": (near, near, ("ahead", "right", "back", "left")), "car": (near, near), "light": (near, near, ("red", "red_amber", "green", "amber")), "stop_line": (near, near),
        "speed": (tuple(str(n) for n in range(top + 1)),), "limit": (tuple(str(n) for n in range(1, limit + 1)),), "heading": (("north", "east", "south", "west"),),
        "drives": (("left", "right"),), "task": (("straight_on", "overtake", "turn_left", "turn_right"),),
    }  # fmt: skip


def _matching(pattern: str, words: dict[str, tuple[tuple[str, ...], ...]]) -> list[str]:
    """The percepts that the pattern stands for: `_` is anything.  None for what is no percept."""
    shape = re.fullmatch(r"(\w+)\(([^()]*)\)", re.sub(r"\s+", "", pattern))
    places = words.get(shape[1]) if shape else None
    given = shape[2].split(",") if shape else []
    if shape is None or places is None or len(places) != len(given):
        return []
    # a speed or a limit may be named that this scenario's own car never reaches
    free = re.fullmatch(r"0|[1-9]\d?", given[0]) is not None and shape[1] in ("speed", "limit")
    chosen = [place if g == "_" else (g,) if free or g in place else () for place, g in zip(places, given, strict=True)]
    return [f"{shape[1]}({','.join(c)})" for c in itertools.product(*chosen)]


def _cell(value: Any) -> Cell:
    return (int(value[0]), int(value[1]))


def _plain(node: Node, key: str, otherwise: str) -> str:
    found = node.get(key)
    return otherwise if found is None else str(found.value)


def _inside(rows: tuple[str, ...], cell: Cell) -> bool:
    return 0 <= cell[1] < len(rows) and 0 <= cell[0] < len(rows[cell[1]])


def _is_road(rows: tuple[str, ...], cell: Cell) -> bool:
    return _inside(rows, cell) and rows[cell[1]][cell[0]] in ROAD


def scenario_json(scenario: Scenario) -> dict[str, Any]:
    """The resolved scenario as the Java world reads it."""

    def varied(v: Varied[Any]) -> dict[str, Any]:
        def plain(x: Any) -> Any:
            return list(x) if isinstance(x, tuple) else x

        return {"published": plain(v.published), "all": [plain(x) for x in v.all]}

    goal: dict[str, Any] | None
    match scenario.goal:
        case InCells(cells):
            goal = {"in": [list(c) for c in cells]}
        case Beyond(light, cells_beyond):
            goal = {"beyond": {"light": light, "cells": cells_beyond}}
        case Overtaken(car, within):
            goal = {"overtaken": {"car": car, "within": within}}
        case None:
            goal = None
    return {
        "id": scenario.id, "drives": scenario.drives, "radius": scenario.radius, "limit": scenario.limit, "top_speed": scenario.top_speed, "rows": list(scenario.rows),
        "lights": [{"name": x.name, "at": list(x.at), "stop_line": list(x.stop_line), "faces": x.faces, "cycle": [[c, n] for c, n in x.cycle], "phase": varied(x.phase)} for x in scenario.lights],
        "driver": {"name": scenario.driver.name, "at": varied(scenario.driver.at), "heading": scenario.driver.heading, "task": scenario.driver.task},
        "traffic": [{"name": c.name, "at": varied(c.at), "heading": c.heading, "speed": varied(c.speed), "hesitates": varied(c.hesitates)} for c in scenario.traffic],
        "goal": goal, "percepts": list(scenario.percepts), "percept_exclusions": [list(g) for g in scenario.percept_exclusions],
    }
