"""A second world, written from model/README.md alone and as plainly as can be, for tests to compare with.

In: a Scenario and its choices.  Out: states, percepts, next states.  Left to others: who is right (README.md says).
"""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass, field

from rotra.frontends.scenario import Beyond, InCells, Overtaken, Scenario

CLOCKWISE = ["north", "east", "south", "west"]
VECTOR = {"north": (0, -1), "east": (1, 0), "south": (0, 1), "west": (-1, 0)}


def rotate(heading: str, quarters: int) -> str:
    return CLOCKWISE[(CLOCKWISE.index(heading) + quarters) % 4]


@dataclass
class Car:
    name: str
    at: tuple[int, int]
    heading: str
    pace: int = 0
    speed: int = 0
    crashed: bool = False


@dataclass
class Simulator:
    """Car 0 is the driver."""

    scenario: Scenario
    cars: list[Car]
    phases: dict[str, int]
    beside: bool = False
    finished: bool = False
    hesitating: set[str] = field(default_factory=set)

    def flows(self, cell: tuple[int, int]) -> list[str]:
        if any(light.at == cell for light in self.scenario.lights):
            return []
        symbol = self.scenario.rows[cell[1]][cell[0]].lower()
        return {"^": ["north"], "v": ["south"], "<": ["west"], ">": ["east"], "+": CLOCKWISE}.get(symbol, [])

    def beyond(self, cell: tuple[int, int], heading: str, cells: int = 1) -> tuple[int, int]:
        dx, dy = VECTOR[heading]
        return ((cell[0] + cells * dx) % self.scenario.width, (cell[1] + cells * dy) % self.scenario.height)

    def colour(self, name: str) -> str:
        light = next(x for x in self.scenario.lights if x.name == name)
        shown = [c for c, steps in light.cycle for _ in range(steps)]
        return shown[self.phases[name] % len(shown)]

    def percepts(self) -> set[str]:
        s, me = self.scenario, self.cars[0]
        if me.crashed:
            return set()
        seen = {f"speed({me.speed})", f"limit({s.limit})", f"heading({me.heading})", f"drives({s.drives})", f"task({s.driver.task})"}
        for r in range(-s.radius, s.radius + 1):
            for a in range(-s.radius, s.radius + 1):
                cell = self.beyond(self.beyond(me.at, me.heading, a), rotate(me.heading, 1), r)
                for flow in self.flows(cell):
                    word = ["ahead", "right", "back", "left"][(CLOCKWISE.index(flow) - CLOCKWISE.index(me.heading)) % 4]
                    seen.add(f"road({r},{a},{word})")
                if any(c.at == cell for c in self.cars[1:]):
                    seen.add(f"car({r},{a})")
                for light in s.lights:
                    if light.faces == rotate(me.heading, 2):
                        if light.at == cell:
                            seen.add(f"light({r},{a},{self.colour(light.name)})")
                        if light.stop_line == cell:
                            seen.add(f"stop_line({r},{a})")
        return seen

    def plan(self, act: str) -> list[tuple[str, str]]:
        """(way, heading afterwards) of each cell that the act goes."""
        heading = self.cars[0].heading
        name, _, inside = act.rstrip(")").partition("(")
        if name == "wait":
            return []
        if name == "forward":
            return [(heading, heading)] * int(inside)
        side, cells = inside.split(",")
        way = rotate(heading, 1 if side == "right" else -1)
        after = way if name == "turn" else heading
        return [(way, after)] + [(after, after)] * (int(cells) - 1)

    def step(self, act: str) -> None:
        s, me = self.scenario, self.cars[0]
        was_beside = self.beside
        plans = [self.plan(act) if not me.crashed else []]
        for c in self.cars[1:]:
            plans.append([] if c.crashed or c.name in self.hesitating else [(c.heading, c.heading)] * c.pace)
        for c in self.cars:
            c.speed = 0
        for k in range(max(map(len, plans))):
            moving = {i for i, c in enumerate(self.cars) if len(plans[i]) > k and not c.crashed}
            ahead = {i: self.beyond(self.cars[i].at, plans[i][k][0]) for i in moving}
            while True:  # the largest set of movers: strike out who would enter a cell that is kept
                held = {i for i in moving if i and any(j != i and j not in moving and c.at == ahead[i] for j, c in enumerate(self.cars))}
                if not held:
                    break
                moving -= held
            before = deepcopy(self.cars)
            for i in moving:
                self.cars[i].at, self.cars[i].heading = ahead[i], plans[i][k][1]
                self.cars[i].speed += 1
            back = {i for i in moving for j in moving if i != j and ahead[i] == before[j].at and ahead[j] == before[i].at}
            for i in back:
                self.cars[i].at, self.cars[i].crashed = before[i].at, True
                self.cars[i].speed -= 1
            shared = [c for c in self.cars if sum(d.at == c.at for d in self.cars) > 1]
            for c in shared:
                c.crashed = True
            for c in self.cars:
                if not self.flows(c.at):
                    c.crashed = True
        if not me.crashed:
            match s.goal:
                case InCells(cells):
                    self.finished |= me.at in cells
                case Beyond(name, n):
                    light = next(x for x in s.lights if x.name == name)
                    self.finished |= me.at == self.beyond(light.stop_line, rotate(light.faces, 2), n)
                case Overtaken(name, within):
                    car = next(c for c in self.cars if c.name == name)
                    self.finished |= was_beside and any(me.at == self.beyond(car.at, car.heading, n) for n in range(1, within + 1))
                    offside = rotate(car.heading, 1 if s.drives == "left" else -1)
                    self.beside |= me.heading == car.heading and me.at == self.beyond(car.at, offside)
        for light in s.lights:
            self.phases[light.name] = (self.phases[light.name] + 1) % sum(n for _, n in light.cycle)
        self.hesitating = set()
