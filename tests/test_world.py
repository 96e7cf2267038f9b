"""The lowered world against a plain simulator, step by step, in worlds and under acts that hypothesis makes up."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rotra.frontends.scenario import (
    DEFAULT_CYCLE,
    Beyond,
    DriverCar,
    Goal,
    InCells,
    Light,
    Overtaken,
    Scenario,
    ScriptedCar,
    Varied,
    resolve_scenario,
)
from rotra.lowering.world import HEADINGS, lower_world, possible_percepts
from rotra.origins import NOWHERE
from rotra.system.expr import Expr, const, evaluate
from rotra.system.transition import Part
from simulator import Car, Simulator

MANY = settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large])


def all_acts(top: int) -> tuple[str, ...]:
    numbers = range(1, top + 1)
    sideways = (f"{name}({side},{n})" for name in ("change_lane", "turn") for side in ("left", "right") for n in numbers)
    return ("wait", *(f"forward({n})" for n in numbers), *sideways)


def fixed(value: Any) -> Varied[Any]:
    return Varied(value, (value,))


@st.composite
def scenarios(draw: st.DrawFn) -> Scenario:
    width, height = draw(st.integers(1, 5)), draw(st.integers(1, 5))
    rows = tuple("".join(draw(st.sampled_from("+++^v<>.")) for _ in range(width)) for _ in range(height))
    cells = [(x, y) for y in range(height) for x in range(width)]
    light_at = draw(st.sampled_from([None, *cells]))
    road = [(x, y) for x, y in cells if rows[y][x] != "." and (x, y) != light_at]
    if not road:
        road, rows = [(0, 0)], ("+" * width,) * height
        light_at = None
    starts = draw(st.lists(st.sampled_from(road), min_size=1, max_size=4, unique=True))
    headings = st.sampled_from(HEADINGS)
    traffic = tuple(
        ScriptedCar(f"t{i}", fixed(at), draw(headings), draw(st.sampled_from([fixed(1), fixed(2), Varied(1, (0, 1, 2))])), draw(st.sampled_from([fixed(False), Varied(False, (False, True))])), NOWHERE)
        for i, at in enumerate(starts[1:])
    )
    lights = () if light_at is None else (Light("tl", light_at, draw(st.sampled_from(road)), draw(headings), DEFAULT_CYCLE, Varied(0, tuple(range(10))), NOWHERE),)
    goals: list[Goal | None] = [None, InCells((road[0],))]
    goals += [Beyond("tl", draw(st.integers(1, 3)))] if lights else []
    goals += [Overtaken("t0", draw(st.integers(1, 3)))] if traffic else []
    driver = DriverCar(fixed(starts[0]), draw(headings), "straight_on", NOWHERE)
    return Scenario("t", "t", "", draw(st.sampled_from(["left", "right"])), 2, 2, 3, rows, lights, driver, traffic, draw(st.sampled_from(goals)), (), (), NOWHERE)


def begin(s: Scenario, draw: Any) -> Simulator:
    """A start of the scenario; no two cars on one cell."""
    cars = [Car("driver", draw(st.sampled_from(s.driver.at.all)), s.driver.heading)]
    for c in s.traffic:
        free = [at for at in c.at.all if at not in {d.at for d in cars}]
        cars.append(Car(c.name, draw(st.sampled_from(free)), c.heading, draw(st.sampled_from(c.speed.all))))
    return Simulator(s, cars, {x.name: draw(st.sampled_from(x.phase.all)) for x in s.lights})


def choices(sim: Simulator) -> dict[str, Any]:
    """What the simulator's state says of every name that the model may use."""
    me = sim.cars[0]
    state: dict[str, Any] = {"x": me.at[0], "y": me.at[1], "heading": me.heading, "speed": me.speed, "crashed": me.crashed, "finished": sim.finished, "beside": sim.beside}
    state |= {f"phase_{name}": phase for name, phase in sim.phases.items()}
    for c in sim.cars[1:]:
        state |= {f"car_{c.name}_x": c.at[0], f"car_{c.name}_y": c.at[1], f"car_{c.name}_crashed": c.crashed, f"car_{c.name}_speed": c.pace, f"hesitates_{c.name}": c.name in sim.hesitating}
    return state


def agree(part: Part, sim: Simulator, state: dict[str, Any]) -> None:
    """Variables and constant definitions of the model are what the simulator has."""
    shown = choices(sim)
    constants = {d.name: d.expr.args[0] for d in part.definitions if d.expr.op == "const"}
    for name, value in shown.items():
        if name in state:
            assert state[name] == value, name
        elif name in constants and not name.endswith("_speed"):
            assert constants[name] == value, name


def drive(s: Scenario, part: Part, acts: tuple[str, ...], percepts: tuple[str, ...], draw: Any, steps: int) -> None:
    definitions: dict[str, Expr] = {d.name: d.expr for d in part.definitions}
    sim = begin(s, draw)
    state = {v.name: choices(sim)[v.name] for v in part.variables}
    for v in part.variables:
        assert state[v.name] in v.initial, v.name
    assert all(evaluate(e, state, definitions) for e in part.initially)
    for _ in range(steps):
        sim.hesitating = {c.name for c in s.traffic if any(c.hesitates.all) and draw(st.booleans())}
        state |= {v.name: choices(sim)[v.name] for v in part.variables if v.name.startswith("hesitates_")}
        seen = sim.percepts()
        assert {t for t in percepts if evaluate(definitions[f"p:{t}"], state, definitions)} == seen
        assert all(evaluate(definitions[f"light_{x.name}"], state, definitions) == sim.colour(x.name) for x in s.lights)
        act = "wait" if sim.cars[0].crashed else draw(st.sampled_from(acts))
        there, memo = definitions | {"act": const(act)}, {}  # type: ignore[var-annotated]
        state = {v.name: state[v.name] if v.next is None else evaluate(v.next, state, there, memo) for v in part.variables}
        sim.step(act)
        for v in part.variables:
            assert state[v.name] in v.domain or v.next is None, v.name
            if v.next is None and not v.frozen:
                state[v.name] = False
        agree(part, sim, state)


@MANY
@given(scenarios(), st.data())
def test_any_world(s: Scenario, data: st.DataObject) -> None:
    acts = all_acts(s.top_speed)
    if data.draw(st.booleans()):
        acts = tuple(a for a in acts if "turn" not in a)
    percepts = possible_percepts(s)
    drive(s, lower_world(s, percepts, acts), acts, percepts, data.draw, 6)


@pytest.mark.parametrize("name", ["traffic_light", "overtake", "right_turn"])
def test_shipped_world(name: str) -> None:
    s = resolve_scenario(name)
    acts, percepts = all_acts(s.top_speed), possible_percepts(s)
    part = lower_world(s, percepts, acts)

    @settings(MANY, max_examples=20)
    @given(st.data())
    def run(data: st.DataObject) -> None:
        drive(s, part, acts, percepts, data.draw, 8)

    run()


def test_open_scenario_says_one_of_each_kind() -> None:
    s = resolve_scenario("open")
    part = lower_world(s, possible_percepts(s), ("wait",))
    names = {d.name for d in part.definitions}
    assert names == {f"p:{t}" for t in s.percepts}
    definitions = {d.name: d.expr for d in part.definitions}
    state = {v.name: v.domain[0] for v in part.variables}
    for kind in ("speed", "limit", "heading", "drives", "task"):
        assert sum(evaluate(definitions[n], state, definitions) for n in names if n.startswith(f"p:{kind}(")) == 1
    assert all(evaluate(e, state, definitions) for e in part.invariant)
    state["sensed light(-1,1,red)"] = state["sensed light(-1,1,green)"] = True
    assert not all(evaluate(e, state, definitions) for e in part.invariant)


def test_car_put_back_by_a_swap_is_in_the_way_of_the_next() -> None:
    def car(name: str, y: int) -> ScriptedCar:
        return ScriptedCar(name, fixed((0, y)), "south", fixed(1), fixed(False), NOWHERE)

    driver = DriverCar(fixed((0, 3)), "north", "straight_on", NOWHERE)
    s = Scenario("t", "t", "", "left", 2, 2, 3, ("+",) * 5, (), driver, (car("first", 2), car("second", 1)), None, (), (), NOWHERE)
    part = lower_world(s, (), ("wait", "forward(1)"))
    definitions = {d.name: d.expr for d in part.definitions} | {"act": const("forward(1)")}
    state = {v.name: v.initial[0] for v in part.variables}
    after = {v.name: evaluate(v.next, state, definitions) for v in part.variables if v.next is not None}
    assert {n: after[n] for n in after if n.endswith("crashed")} == {"crashed": True, "car_first_crashed": True, "car_second_crashed": True}
    assert (after["y"], after["car_first_y"], after["car_second_y"], after["speed"]) == (3, 2, 2, 0)
