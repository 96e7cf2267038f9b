"""The world's module of the model: lights, cars, moves, crashes, percepts; exactly what model/README.md states.

    forward(2) with a car two cells ahead   ->   sub-step 1 moves, sub-step 2 enters its cell: both crashed

In: a Scenario with its instance applied, the percepts that are asked for, the acts that can be done.  Out: the Part
"world".  Left to others: who decides the acts (mind.py).  Symbolic: a variable a coordinate, never a list of states.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache

from rotra.frontends.scenario import Beyond, InCells, Overtaken, Scenario, ScriptedCar
from rotra.frontends.terms import Struct, order, parse_ground, show
from rotra.origins import NOWHERE, Origin
from rotra.system.expr import FALSE, TRUE, Expr, among, arithmetic, choose, conj, const, disj, eq, negate, ref, var
from rotra.system.transition import Definition, Part, Variable

HEADINGS = ("north", "east", "south", "west")
STEP = {"north": (0, -1), "east": (1, 0), "south": (0, 1), "west": (-1, 0)}
FLOWS = {"^": ("north",), ">": ("east",), "v": ("south",), "V": ("south",), "<": ("west",), "+": HEADINGS}
RELATIVE = ("ahead", "right", "back", "left")
Cell = tuple[int, int]


def turned(heading: str, side: str) -> str:
    return HEADINGS[(HEADINGS.index(heading) + (1 if side == "right" else -1)) % 4]


def opposite(heading: str) -> str:
    return HEADINGS[(HEADINGS.index(heading) + 2) % 4]


def roads(scenario: Scenario) -> dict[Cell, tuple[str, ...]]:
    """The drivable cells and the directions permitted there; a light's own cell is no road."""
    lights = {light.at for light in scenario.lights}
    return {
        (x, y): FLOWS[symbol]
        for y, row in enumerate(scenario.rows)
        for x, symbol in enumerate(row)
        if symbol in FLOWS and (x, y) not in lights
    }


def _offset(scenario: Scenario, cell: Cell, heading: str, right: int, ahead: int) -> Cell:
    (ax, ay), (rx, ry) = STEP[heading], STEP[turned(heading, "right")]
    return ((cell[0] + right * rx + ahead * ax) % scenario.width, (cell[1] + right * ry + ahead * ay) % scenario.height)


def _window(scenario: Scenario) -> list[Cell]:
    span = range(-scenario.radius, scenario.radius + 1)
    return [(r, a) for r in span for a in span]


def possible_percepts(scenario: Scenario) -> tuple[str, ...]:
    """Every percept that can ever hold, as text, sorted (functor, then arguments)."""
    if scenario.is_open:
        found = set(scenario.percepts)
    else:
        found = {f"speed({n})" for n in range(scenario.top_speed + 1)} | {f"heading({h})" for h in HEADINGS}
        found |= {f"limit({scenario.limit})", f"drives({scenario.drives})", f"task({scenario.driver.task})"}
        found |= {f"car({r},{a})" for r, a in _window(scenario) if scenario.traffic}
        colours = {light.name: {colour for colour, _ in light.cycle} for light in scenario.lights}
        for text in frozenset().union(*views(scenario)):
            place, _, light = text.removesuffix(")").rpartition(",")
            found |= {f"{place},{colour})" for colour in colours[light]} if text.startswith("light(") else {text}
    return tuple(sorted(found, key=lambda t: (parse_ground(t).name, order(parse_ground(t)))))


@cache
def views(scenario: Scenario) -> tuple[frozenset[str], ...]:
    """What the place of a car alone decides: for each cell and heading the percepts of road and lines, and `light(R,A,Name)`
    for the places of lights.  No two of them are seen at once; an open scenario has none."""
    road = roads(scenario)
    found: dict[frozenset[str], None] = {}
    for cell in road:
        for heading in HEADINGS:
            seen = set()
            for r, a in _window(scenario):
                there = _offset(scenario, cell, heading, r, a)
                quarters = {flow: turned(heading, flow) if flow in ("left", "right") else heading if flow == "ahead" else opposite(heading) for flow in RELATIVE}
                seen |= {f"road({r},{a},{flow})" for flow, way in quarters.items() if way in road.get(there, ())}
                for light in scenario.lights:
                    if light.faces == opposite(heading):
                        seen |= {f"light({r},{a},{light.name})"} if light.at == there else set()
                        seen |= {f"stop_line({r},{a})"} if light.stop_line == there else set()
            found[frozenset(seen)] = None
    return tuple(found)


class _World:
    """The definitions and variables of one world, as they are written down."""

    def __init__(self, scenario: Scenario, acts: tuple[str, ...]) -> None:
        self.scenario = scenario
        self.acts = [parse_ground(a) for a in acts]
        self.road = roads(scenario)
        self.variables: list[Variable] = []
        self.definitions: dict[str, Definition] = {}
        self.turns = any(a.name == "turn" for a in self.acts)
        self.headings = HEADINGS if self.turns else (scenario.driver.heading,)
        self.file = scenario.origin

    def define(self, name: str, expr: Expr, origin: Origin = NOWHERE) -> Expr:
        if name not in self.definitions:
            self.definitions[name] = Definition(name, expr, origin)
        return ref(name)

    def heading(self) -> Expr:
        return var("heading") if self.turns else const(self.scenario.driver.heading)

    def facing(self, heading: str) -> Expr:
        return eq(self.heading(), const(heading))

    def done(self, *wanted: Struct) -> Expr:
        return disj(*(eq(ref("act"), const(show(a))) for a in wanted))

    # ---- where things are -----------------------------------------------------------------------------------------

    def at(self, cells: Iterable[Cell], x: Expr, y: Expr) -> Expr:
        """The position is one of the cells: rows with the same columns are one term."""
        by_row: dict[int, set[int]] = {}
        for cx, cy in cells:
            by_row.setdefault(cy, set()).add(cx)
        by_columns: dict[frozenset[int], set[int]] = {}
        for cy, columns in by_row.items():
            by_columns.setdefault(frozenset(columns), set()).add(cy)
        width, height = set(range(self.scenario.width)), set(range(self.scenario.height))
        terms = []
        for across, down in sorted(by_columns.items(), key=lambda i: sorted(i[1])):
            terms.append(conj(TRUE if across == width else among(x, across), TRUE if down == height else among(y, down)))
        return disj(*terms)

    def driver_at(self, cells: Iterable[Cell]) -> Expr:
        return self.at(cells, var("x"), var("y"))

    def shifted(self, value: Expr, by: int, size: int) -> Expr:
        return value if by % size == 0 else arithmetic("mod", arithmetic("add", value, const(by % size)), const(size))

    # ---- percepts -------------------------------------------------------------------------------------------------

    def percept(self, percept: Struct) -> Expr:
        s = self.scenario
        match percept.name, percept.args:
            case "road", (int(r), int(a), Struct(flow, ())):
                return self.by_heading(lambda h: [c for c in self.everywhere() if self.flows(_offset(s, c, h, r, a), h, flow)])
            case "car", (int(r), int(a)):
                if r % s.width == 0 and a % s.height == 0 and self.straight(r, a):
                    return FALSE
                return disj(*(self.sees_car(car, r, a) for car in s.traffic))
            case "light", (int(r), int(a), Struct(colour, ())):
                found = []
                for light in s.lights:
                    h = opposite(light.faces)
                    if h in self.headings:
                        here = [c for c in self.everywhere() if _offset(s, c, h, r, a) == light.at]
                        found.append(conj(self.facing(h), self.driver_at(here), eq(ref(f"light_{light.name}"), const(colour))))
                return disj(*found)
            case "stop_line", (int(r), int(a)):
                found = []
                for light in s.lights:
                    h = opposite(light.faces)
                    if h in self.headings:
                        found.append(conj(self.facing(h), self.driver_at([c for c in self.everywhere() if _offset(s, c, h, r, a) == light.stop_line])))
                return disj(*found)
            case "speed", (int(n),):
                return eq(var("speed"), const(n))
            case "limit", (int(n),):
                return TRUE if n == s.limit else FALSE
            case "heading", (Struct(h, ()),):
                return self.facing(h)
            case "drives", (Struct(side, ()),):
                return TRUE if side == s.drives else FALSE
            case "task", (Struct(task, ()),):
                return TRUE if task == s.driver.task else FALSE
        return FALSE

    def straight(self, r: int, a: int) -> bool:
        """Is the offset the own cell in every heading?  (In a world that is not square it may be so in some only.)"""
        return all(_offset(self.scenario, (0, 0), h, r, a) == (0, 0) for h in self.headings)

    def everywhere(self) -> Iterable[Cell]:
        """Where a driver is that perceives anything: off the road it has crashed."""
        return self.road

    def flows(self, cell: Cell, heading: str, flow: str) -> bool:
        absolute = {"ahead": heading, "back": opposite(heading), "right": turned(heading, "right"), "left": turned(heading, "left")}[flow]
        return absolute in self.road.get(cell, ())

    def by_heading(self, cells: object) -> Expr:
        return disj(*(conj(self.facing(h), self.driver_at(cells(h))) for h in self.headings))  # type: ignore[operator]

    def sees_car(self, car: ScriptedCar, r: int, a: int) -> Expr:
        found = []
        for h in self.headings:
            dx, dy = _offset(self.scenario, (0, 0), h, r, a)
            x, y = self.place(car)
            same_x = eq(self.shifted(var("x"), dx, self.scenario.width), x)
            same_y = eq(self.shifted(var("y"), dy, self.scenario.height), y)
            found.append(conj(self.facing(h), same_x, same_y))
        return disj(*found)

    # ---- moves ----------------------------------------------------------------------------------------------------

    def directions(self, k: int) -> dict[str, Expr]:
        """Which way the driver's act takes it in sub-step k (from 1), where it takes it anywhere."""
        found: dict[str, list[Expr]] = {h: [] for h in HEADINGS}
        for act in self.acts:
            if act.name == "wait" or act.args[-1] < k:  # type: ignore[operator]
                continue
            side = act.args[0].name if len(act.args) == 2 else None  # type: ignore[union-attr]
            for h in self.headings:
                way = turned(h, side) if side and (k == 1 or act.name == "turn") else h
                found[way].append(conj(self.done(act), self.facing(h)))
        return {h: disj(*parts) for h, parts in found.items()}

    def moved(self, x: Expr, y: Expr, ways: dict[str, Expr]) -> tuple[Expr, Expr]:
        w, h = self.scenario.width, self.scenario.height
        nx = choose((ways["east"], self.shifted(x, 1, w)), (ways["west"], self.shifted(x, -1, w)), (TRUE, x))
        ny = choose((ways["south"], self.shifted(y, 1, h)), (ways["north"], self.shifted(y, -1, h)), (TRUE, y))
        return nx, ny

    def drive(self) -> None:
        """All moves of a step as a chain of sub-steps, then the next values of every variable."""
        s = self.scenario
        n = 1 + len(s.traffic)
        where: list[tuple[Expr, Expr]] = [(var("x"), var("y")), *(self.place(c) for c in s.traffic)]
        crashed: list[Expr] = [var("crashed")] + [var(f"car_{c.name}_crashed") for c in s.traffic]
        names = ["driver", *(c.name for c in s.traffic)]
        longest = max((int(n) for a in self.acts for n in a.args[-1:] if isinstance(n, int)), default=0)
        last = max([longest, *(v for c in s.traffic for v in c.speed.all)])
        covered: list[Expr] = []
        for k in range(1, last + 1):
            ways = [self.directions(k)]
            wants = [conj(negate(crashed[0]), disj(*ways[0].values()))]
            for i, car in enumerate(s.traffic, start=1):
                speed = disj(*(self.car_speed(car, v) for v in car.speed.all if v >= k))
                wants.append(conj(negate(crashed[i]), negate(self.hesitates(car)), speed))
                ways.append({h: TRUE if h == car.heading else FALSE for h in HEADINGS})
            target = [self.moved(*where[i], ways[i]) for i in range(n)]
            moves = list(wants)
            for _ in s.traffic:
                moves = [moves[0], *(conj(wants[i], negate(disj(*(conj(self.same(target[i], where[j]), negate(moves[j])) for j in range(n) if j != i)))) for i in range(1, n))]
            moves = [self.define(f"sub{k}:{names[i]}:moves", m) if i else m for i, m in enumerate(moves)]
            after: list[tuple[Expr, Expr]] = []
            swapped: list[Expr] = []
            for i in range(n):
                pairs = (conj(moves[i], moves[j], self.same(target[i], where[j]), self.same(target[j], where[i])) for j in range(n) if j != i and self.may_swap(i, j))
                swapped.append(disj(*pairs))
                goes = conj(moves[i], negate(swapped[i]))
                nx, ny = (choose((goes, target[i][a]), (TRUE, where[i][a])) for a in (0, 1))
                nx = nx if nx is where[i][0] else self.define(f"sub{k}:{names[i]}:x", nx)
                ny = ny if ny is where[i][1] else self.define(f"sub{k}:{names[i]}:y", ny)
                after.append((nx, ny))
                if i == 0:
                    covered.append(goes)
            crashed = [
                self.define(f"sub{k}:{names[i]}:crashed", disj(crashed[i], swapped[i], *(conj(self.same(after[i], after[j]), disj(swapped[i], swapped[j]) if self.queues(i, j) else TRUE) for j in range(n) if j != i), conj(moves[i], negate(self.on_road(i, after[i])))))
                for i in range(n)
            ]
            where = after
        self.finish(where, crashed, covered)

    def lane(self, i: int) -> tuple[str, Expr] | None:
        """Heading and constant coordinate of a scripted car that can only drive along one lane."""
        car = self.scenario.traffic[i - 1] if i else None
        if car is None:
            return None
        across = self.place(car)[1 if STEP[car.heading][0] else 0]
        return (car.heading, across) if across.op == "const" else None

    def queues(self, i: int, j: int) -> bool:
        """Two scripted cars of one lane meet only where a swap puts one of them back: else the one behind waits for the one ahead."""
        return i > 0 and j > 0 and self.lane(i) is not None and self.lane(i) == self.lane(j)

    def on_road(self, i: int, place: tuple[Expr, Expr]) -> Expr:
        lane = self.lane(i)
        if lane is not None:
            fixed = lane[1].args[0]
            cells = {(x, fixed) for x in range(self.scenario.width)} if STEP[lane[0]][0] else {(fixed, y) for y in range(self.scenario.height)}
            if cells <= self.road.keys():
                return TRUE
        return self.at(self.road, *place)

    def place(self, car: ScriptedCar) -> tuple[Expr, Expr]:
        """Where a scripted car is; the coordinate across its way is a constant where all its starts agree."""
        columns, rows = ({c[axis] for c in car.at.all} for axis in (0, 1))
        along_x = STEP[car.heading][0] != 0
        x = var(f"car_{car.name}_x") if along_x or len(columns) > 1 else const(next(iter(columns)))
        y = var(f"car_{car.name}_y") if not along_x or len(rows) > 1 else const(next(iter(rows)))
        return x, y

    def same(self, a: tuple[Expr, Expr], b: tuple[Expr, Expr]) -> Expr:
        return conj(eq(a[0], b[0]), eq(a[1], b[1]))

    def may_swap(self, i: int, j: int) -> bool:
        if 0 in (i, j):
            return True
        a, b = self.scenario.traffic[i - 1].heading, self.scenario.traffic[j - 1].heading
        return a != b or 2 in (self.scenario.width, self.scenario.height)

    def hesitates(self, car: ScriptedCar) -> Expr:
        return var(f"hesitates_{car.name}") if any(car.hesitates.all) else FALSE

    def car_speed(self, car: ScriptedCar, value: int) -> Expr:
        return eq(var(f"car_{car.name}_speed"), const(value)) if len(car.speed.all) > 1 else TRUE

    # ---- the end of a step ----------------------------------------------------------------------------------------

    def finish(self, where: list[tuple[Expr, Expr]], crashed: list[Expr], covered: list[Expr]) -> None:
        s = self.scenario
        whole = (tuple(range(s.width)), tuple(range(s.height)))
        starts = s.driver.at.all

        def add(name: str, domain: Iterable[object], initial: Iterable[object], following: Expr | None, origin: Origin) -> None:
            self.variables.append(Variable(name, tuple(domain), tuple(dict.fromkeys(initial)), following, origin))  # type: ignore[arg-type]

        origin = s.driver.origin
        add("x", whole[0], (c[0] for c in starts), where[0][0], origin)
        add("y", whole[1], (c[1] for c in starts), where[0][1], origin)
        # NuSMV reads the declarations as the order of its BDDs: places side by side, what depends on all of them after them
        for i, car in enumerate(s.traffic, start=1):
            for axis, name in enumerate((f"car_{car.name}_x", f"car_{car.name}_y")):
                place = self.place(car)[axis]
                if place.op == "const":
                    self.define(name, place, car.origin)
                else:
                    add(name, whole[axis], (c[axis] for c in car.at.all), where[i][axis], car.origin)
            add(f"car_{car.name}_crashed", (False, True), (False,), crashed[i], car.origin)
            if len(car.speed.all) > 1:
                self.variables.append(Variable(f"car_{car.name}_speed", tuple(car.speed.all), tuple(car.speed.all), None, car.origin, frozen=True))
            if any(car.hesitates.all):
                add(f"hesitates_{car.name}", (False, True), (False, True), None, car.origin)
        if self.turns:
            turning = {h: disj(*(conj(self.done(a), self.facing(old)) for a in self.acts if a.name == "turn" for old in HEADINGS if turned(old, a.args[0].name) == h)) for h in HEADINGS}  # type: ignore[union-attr]
            heading = choose((var("crashed"), var("heading")), *((turning[h], const(h)) for h in HEADINGS), (TRUE, var("heading")))
            add("heading", HEADINGS, (s.driver.heading,), heading, origin)
        else:
            heading = const(s.driver.heading)
            self.define("heading", const(s.driver.heading), origin)
        count: Expr = const(0)
        for k, goes in enumerate(covered, start=1):
            count = choose((goes, const(k)), (TRUE, count))
        add("speed", range(s.top_speed + 1), (0,), choose((var("crashed"), const(0)), (TRUE, count)), origin)
        add("crashed", (False, True), (False,), crashed[0], origin)
        self.reach_goal(where, crashed, heading)

    def reach_goal(self, where: list[tuple[Expr, Expr]], crashed: list[Expr], heading: Expr) -> None:
        s = self.scenario
        reached: Expr
        match s.goal:
            case None:
                return
            case InCells(cells):
                reached = self.at(cells, *where[0])
            case Beyond(name, cells):
                light = next(x for x in s.lights if x.name == name)
                reached = self.at([_offset(s, light.stop_line, opposite(light.faces), 0, cells)], *where[0])
            case Overtaken(name, within):
                i = next(i for i, c in enumerate(s.traffic, start=1) if c.name == name)
                side = 1 if s.drives == "left" else -1
                car = s.traffic[i - 1]

                def relative(right: int, ahead: int) -> Expr:
                    dx, dy = _offset(s, (0, 0), car.heading, right, ahead)
                    return self.same(where[0], (self.shifted(where[i][0], dx, s.width), self.shifted(where[i][1], dy, s.height)))

                beside = conj(eq(heading, const(car.heading)), relative(side, 0), negate(crashed[0]))
                self.variables.append(Variable("beside", (False, True), (False,), disj(var("beside"), beside), s.origin))
                reached = conj(var("beside"), disj(*(relative(0, n) for n in range(1, within + 1))))
        self.variables.append(Variable("finished", (False, True), (False,), disj(var("finished"), conj(reached, negate(crashed[0]))), s.origin))

    def lights(self) -> None:
        for light in self.scenario.lights:
            colours = [colour for colour, steps in light.cycle for _ in range(steps)]
            name = f"phase_{light.name}"
            following = arithmetic("mod", arithmetic("add", var(name), const(1)), const(len(colours)))
            self.variables.append(Variable(name, tuple(range(len(colours))), tuple(light.phase.all), following, light.origin))
            by_colour = {c: among(var(name), [i for i, shown in enumerate(colours) if shown == c]) for c in dict.fromkeys(colours)}
            self.define(f"light_{light.name}", choose(*((when, const(c)) for c, when in by_colour.items())), light.origin)


def lower_world(scenario: Scenario, percepts: Iterable[str], acts: tuple[str, ...]) -> Part:
    """The Part "world": the driver's act is `ref("act")`, one of `acts`; percept definitions are `p:<text>`."""
    if scenario.is_open:
        return _open(scenario, percepts)
    world = _World(scenario, acts)
    world.lights()
    world.drive()
    world.define("limit", const(scenario.limit), scenario.origin)
    sees = negate(var("crashed"))
    for text in percepts:
        world.define(f"p:{text}", conj(sees, world.percept(parse_ground(text))))
    # one place and one start cell belong together
    starts = disj(*(conj(eq(var("x"), const(x)), eq(var("y"), const(y))) for x, y in scenario.driver.at.all))
    apart = [disj(*(conj(eq(var(f"car_{c.name}_x"), const(x)), eq(var(f"car_{c.name}_y"), const(y))) for x, y in c.at.all)) for c in scenario.traffic if len(c.at.all) > 1]
    cars = [("x", "y"), *((f"car_{c.name}_x", f"car_{c.name}_y") for c in scenario.traffic)]
    clear = [negate(conj(eq(var(a[0]), var(b[0])), eq(var(a[1]), var(b[1])))) for i, a in enumerate(cars) for b in cars[i + 1 :]]
    several = len(scenario.driver.at.all) > 1 or any(len(c.at.all) > 1 for c in scenario.traffic)
    return Part("world", tuple(world.variables), tuple(world.definitions.values()), (), (starts, *apart, *clear) if several else ())


def _open(scenario: Scenario, percepts: Iterable[str]) -> Part:
    """No road: every percept is free at every step, within the exclusions; of speed, limit and the like there is one each."""
    variables, definitions, invariant = [], [], []
    used = list(dict.fromkeys(percepts))
    groups: dict[str, list[str]] = {}
    for text in scenario.percepts:
        name = parse_ground(text).name
        if name in ("speed", "limit", "heading", "drives", "task"):
            groups.setdefault(name, []).append(text)
    for name, texts in groups.items():
        if any(t in used for t in texts):
            values = tuple(show(parse_ground(t).args[0]) for t in texts)
            variables.append(Variable(f"sensed_{name}", values, values, None, scenario.origin))
            definitions += [Definition(f"p:{t}", eq(var(f"sensed_{name}"), const(v))) for t, v in zip(texts, values, strict=True)]
    for text in used:
        if parse_ground(text).name not in groups:
            variables.append(Variable(f"sensed {text}", (False, True), (False, True), None, scenario.origin))
            definitions.append(Definition(f"p:{text}", var(f"sensed {text}")))
    known = {d.name for d in definitions}
    for group in scenario.percept_exclusions:
        inside = [ref(f"p:{t}") for t in group if f"p:{t}" in known]
        invariant += [negate(conj(a, b)) for i, a in enumerate(inside) for b in inside[i + 1 :]]
    return Part("world", tuple(variables), tuple(definitions), tuple(invariant))
