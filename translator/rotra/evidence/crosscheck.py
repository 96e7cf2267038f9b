"""Is the graph of the running system the graph of the model?  Both are walked together, from the starts to the end.

    (Jason's state, model's state) agree in all that both show   ->   so must the states that follow, one for one

In: what `rotra.jason.Main explore` wrote, a model's text read by smv_text.py, the map of names.  Out: `Agreement`.
Left to others: making either side.  The relation that is built is a bisimulation, and where no state of either side has
two partners the graphs are the same, state by state and edge by edge.  No code is shared with the translator.
"""

from __future__ import annotations

import json
import re
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rotra.evidence.smv_text import SmvTextError, State, TextModel, Value, reachable, read_text

_NOTHING = object()
Getter = Callable[[Mapping[str, Any], Mapping[str, Any], Mapping[str, Any]], Any]


@dataclass(frozen=True, slots=True)
class Explored:
    """The running system: states with their mind, answer and successors by number."""

    minds: tuple[Mapping[str, Any], ...]
    answers: tuple[Mapping[str, Any], ...]
    states: tuple[Mapping[str, Any], ...]
    summary: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Agreement:
    """`states`, `edges`: of the model; `one_to_one`: no state of either side has two partners."""

    states: int
    edges: int
    one_to_one: bool
    divergence: Mapping[str, Any] | None


@dataclass(frozen=True, slots=True)
class _Shown:
    """What both sides show under one name: the model's name, the system's name, and how Jason's side says it."""

    smv: str
    name: str
    of: Getter


def read_explored(lines: Iterable[str]) -> Explored:
    kept: dict[str, list[Any]] = {"mind": [], "answer": [], "state": [], "summary": []}
    for line in lines:
        entry = json.loads(line)
        kind = next(k for k in kept if k in entry)
        kept[kind].append(entry[kind])
    return Explored(tuple(kept["mind"]), tuple(kept["answer"]), tuple(kept["state"]), kept["summary"][0])


def agreement(explored: Explored, text: str, names: Mapping[str, str], constants: Mapping[str, str], most: int) -> Agreement:
    """`names`, `constants`: as names.json has them.  Errors: `TooManyStates`."""
    try:
        model = read_text(text)
        graph = reachable(model, most)
    except SmvTextError as wrong:
        return Agreement(0, 0, False, {"step": 1, "what": "the model's text", "jason": None, "model": str(wrong)})
    return _Walk(explored, model, graph, _origins(text), names, constants).agreement()


def _origins(text: str) -> dict[str, str]:
    """Qualified name -> what its line in the model says it comes from."""
    found: dict[str, str] = {}
    part = ""
    for line in text.splitlines():
        if module := re.match(r"MODULE (?:module_)?(\w+)", line):
            part = module.group(1)
        elif origin := re.match(r"  (\w+) :=? .*?-- (.*)$", line):
            found[f"{part}.{origin.group(1)}"] = origin.group(2)
    return found


# ---- what Jason's side says to a name of the system ---------------------------------------------------------------------


def _world(name: str) -> Getter | None:
    if name in ("x", "y", "heading", "speed", "crashed"):
        return lambda s, m, a: s["cars"]["driver"][name]
    if name in ("finished", "beside"):
        return lambda s, m, a: s[name]
    for head, entry in (("phase_", "phases"), ("light_", "lights")):
        if name.startswith(head):
            return lambda s, m, a: s[entry].get(name.removeprefix(head), _NOTHING)
    if name.startswith("hesitates_"):
        return lambda s, m, a: name.removeprefix("hesitates_") in s["hesitates"]
    if car := re.match(r"car_(.*)_(x|y|crashed|speed)\Z", name):
        who, what = car.groups()
        return (lambda s, m, a: s["speeds"].get(who, _NOTHING)) if what == "speed" else lambda s, m, a: s["cars"][who][what]
    return None


def _mind(name: str) -> Getter | None:
    if name == "act":
        return lambda s, m, a: a["rest"]["act"]
    if name == "busy":
        return lambda s, m, a: bool(a["rest"]["busy"])
    if name == "restless":
        return lambda s, m, a: a["rest"]["restless"]
    kind, _, what = name.partition(":")
    match kind:
        case "b":
            return lambda s, m, a: what in m["own"]
        case "was":
            return lambda s, m, a: what in m["watched"]
        case "now":
            return lambda s, m, a: what in a["rest"]["beliefs"]
        case "p":
            return lambda s, m, a: what in a["percepts"]
        case "rule":
            return lambda s, m, a: any(what in d["rules"] for d in a["rest"]["advice"])
        case "advised" | "ignored":
            told = "advice" if kind == "advised" else kind
            return lambda s, m, a: what in (f"{d['label']}:{d['action']}" for d in a["rest"][told])
        case "rest":
            said = re.match(r"(believes|intends|context)\((.*)\)\Z", what)
            if said is not None:
                functor, word = said.groups()
                if functor == "context":
                    return lambda s, m, a: a["rest"]["situation"]["context"] == word
                entry = {"believes": "beliefs", "intends": "intentions"}[functor]
                return lambda s, m, a: word in a["rest"]["situation"][entry]
    return None


# ---- both together ------------------------------------------------------------------------------------------------------


class _Walk:
    """The pairs of states found so far, and by which pair each was found."""

    def __init__(self, explored: Explored, model: TextModel, graph: Mapping[State, list[State]], origins: Mapping[str, str], names: Mapping[str, str], constants: Mapping[str, str]) -> None:
        self.explored, self.model, self.graph, self.origins = explored, model, graph, origins
        self.meant = dict(constants)
        known = [*(v.name for v in model.variables), *model.definitions]
        variables = {v.name for v in model.variables}
        pairs = [(q, names[q]) for q in known if q in names]
        self.world = [_Shown(q, n, of) for q, n in pairs if (of := _world(n)) is not None]
        self.mind = [_Shown(q, n, of) for q, n in pairs if (of := _mind(n)) is not None]
        # a driver that has crashed perceives nothing, and remembers nothing that it would ever compare
        self.dead = [s for s in self.mind if not s.name.startswith(("p:", "was:"))]
        self.matched = variables & {s.smv for s in (*self.world, *self.mind)}
        self.plans = [(q, place) for q, n in pairs if n.startswith("take:") and (place := _plan(origins.get(q, ""))) is not None]
        self.read_world = model.reader([s.smv for s in self.world])
        self.read_alive = model.reader([*(s.smv for s in self.mind), *(q for q, _ in self.plans)])
        self.read_dead = model.reader([s.smv for s in self.dead])
        self.said: dict[tuple[int, int], tuple[Any, ...]] = {}
        self.found: dict[tuple[int, State], tuple[int, State] | None] = {}
        self.ahead: deque[tuple[int, State]] = deque()

    def agreement(self) -> Agreement:
        edges = sum(map(len, self.graph.values()))
        divergence = self.walk()
        forward = {j for j, _ in self.found}
        back = {m for _, m in self.found}
        one_to_one = len(forward) == len(back) == len(self.found)
        if divergence is None and self.explored.summary["differ"]:
            again = self.explored.summary["differ"][0]
            divergence = {"step": 0, "what": "the same mind and percepts, asked again by another history", "jason": again, "model": None}
        return Agreement(len(self.graph), edges, one_to_one, divergence)

    def walk(self) -> dict[str, Any] | None:
        """Breadth first, so that the first difference is one of the nearest."""
        divergence = self.follow(None, self.explored.summary["starts"], self.model.starts)
        while self.ahead and divergence is None:
            pair = self.ahead.popleft()
            j, m = pair
            divergence = self.differing(pair)
            if divergence is None and not self.answer(j)["rest"]["restless"]:
                divergence = self.follow(pair, self.explored.states[j]["next"], self.graph[m])
        return divergence

    def answer(self, j: int) -> Mapping[str, Any]:
        return self.explored.answers[self.explored.states[j]["answer"]]

    def world_said(self, j: int) -> tuple[Any, ...]:
        state = self.explored.states[j]
        return tuple(s.of(state, {}, {}) for s in self.world)

    def world_shown(self, m: State) -> tuple[Any, ...]:
        return tuple(self.value(v) for v in self.read_world(m))

    def value(self, value: Value) -> Value:
        return self.meant.get(value, value) if isinstance(value, str) else value

    def follow(self, by: tuple[int, State] | None, jason: Sequence[int], model: Sequence[State]) -> dict[str, Any] | None:
        """Pairs the states that follow by what the world shows in them; each has exactly one partner."""
        ours = {self.world_said(j): j for j in jason}
        theirs = {self.world_shown(m): m for m in model}
        if ours.keys() == theirs.keys() and len(theirs) == len(model):
            for shown, j in ours.items():
                pair = (j, theirs[shown])
                if pair not in self.found:
                    self.found[pair] = by
                    self.ahead.append(pair)
            return None
        step = self.step(by) + 1
        if ours.keys() == theirs.keys():
            loose = next(v.name for i, v in enumerate(self.model.variables) if v.name not in self.matched and len({m[i] for m in model}) > 1)
            return self.report(by, step, loose, "one state", f"{len(model) // len(theirs)} states that differ in it")
        lone = next((s for s in ours if s not in theirs), None)
        other = next((s for s in theirs if s not in ours), None)
        if lone is None or other is None:
            return self.report(by, step, "what may follow", f"{len(ours)} states", f"{len(theirs)} states")
        near = min((s for s in theirs if s not in ours), key=lambda s: sum(a != b for a, b in zip(s, lone, strict=True)))
        n = next(i for i, (a, b) in enumerate(zip(lone, near, strict=True)) if a != b)
        return self.report(by, step, self.world[n].smv, lone[n], near[n], self.world[n].name)

    def differing(self, pair: tuple[int, State]) -> dict[str, Any] | None:
        """The first thing in which the minds of two paired states differ at rest."""
        j, m = pair
        state = self.explored.states[j]
        alive = not state["cars"]["driver"]["crashed"]
        key = (state["mind"], state["answer"])
        shown = self.mind if alive else self.dead
        if key not in self.said:
            mind, answer = self.explored.minds[state["mind"]], self.answer(j)
            self.said[key] = tuple(s.of({}, mind, answer) for s in shown)
        values = (self.read_alive if alive else self.read_dead)(m)
        for s, ours, theirs in zip(shown, self.said[key], map(self.value, values), strict=False):
            if ours != theirs:
                return self.report(pair, self.step(pair), s.smv, ours, theirs, s.name)
        if alive and not self.answer(j)["rest"]["restless"]:
            return self.other_plans(pair, values[len(shown) :])
        return None

    def other_plans(self, pair: tuple[int, State], taken: Iterable[Value]) -> dict[str, Any] | None:
        theirs = {place for (_, place), chosen in zip(self.plans, taken, strict=True) if chosen}
        ours = {(p["file"].rsplit("/", 1)[-1], p["line"]) for p in self.answer(pair[0])["rest"]["plans"]}
        if ours == theirs:
            return None
        return self.report(pair, self.step(pair), "the plans", [f"{f}:{n}" for f, n in sorted(ours)], [f"{f}:{n}" for f, n in sorted(theirs)])

    # ---- telling it -----------------------------------------------------------------------------------------------

    def path(self, pair: tuple[int, State] | None) -> list[tuple[int, State]]:
        steps = []
        while pair is not None:
            steps.append(pair)
            pair = self.found[pair]
        return steps[::-1]

    def step(self, pair: tuple[int, State] | None) -> int:
        return len(self.path(pair))

    def report(self, pair: tuple[int, State] | None, step: int, smv: str, jason: Any, model: Any, what: str = "") -> dict[str, Any]:
        """`by`: the plans that Jason chose in the last step that both took; `from`: what the model's line names."""
        path = self.path(pair)
        told: dict[str, Any] = {"step": step, "what": what or smv, "smv": smv, "jason": _plain(jason), "model": _plain(model), "from": self.origins.get(smv)}
        if path:
            told["by"] = [f"{p['label']} <- {p['file'].rsplit('/', 1)[-1]}:{p['line']}" for p in self.answer(path[-1][0])["rest"]["plans"]]
            told["start"] = {k: v for k, v in self.explored.states[path[0][0]].items() if k not in ("mind", "answer", "next")}
            told["hesitates"] = [self.explored.states[j]["hesitates"] for j, _ in path]
        return told


def _plain(value: Any) -> Any:
    return None if value is _NOTHING else value


def _plan(origin: str) -> tuple[str, int] | None:
    place = re.match(r"plan .* <- (\S+):(\d+)$", origin)
    return (place.group(1).rsplit("/", 1)[-1], int(place.group(2))) if place else None
