"""Tell a trace in the words of the rules and plans.

In: a trace document, the paragraph and sentence of each rule.  Out: text, a step at a time: what the car saw, believed
and intended, what was demanded of it by which rule, what it did by which plan; by default only what changed.
Left to others: loading the rule base, printing (cli.py); which act would have been right (blame.py).
Errors of `read_trace`: IO100, TR101, TR102.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import jsonschema

from rotra.diagnostics import Rejected, problem
from rotra.frontends.terms import Struct, parse_ground
from rotra.origins import Origin, shown_path

# rule id -> (paragraph, what the rule says)
Paragraphs = Mapping[str, tuple[str, str]]
# (step, action) -> an act that would not have contradicted the action, None where none is known
Better = Callable[[Mapping[str, Any], str], str | None]
Silent = Callable[[Mapping[str, Any]], Iterable[str]]

_TEXTS = {"type": "array", "items": {"type": "string"}}
_DIRECTIVES = {"type": "array", "items": {"type": "object", "required": ["label", "action"], "properties": {"label": {"type": "string"}, "action": {"type": "string"}, "rules": _TEXTS}}}
_CAR = {
    "type": "object",
    "required": ["x", "y", "crashed"],
    "properties": {"x": {"type": "integer"}, "y": {"type": "integer"}, "heading": {"type": "string"}, "speed": {"type": ["integer", "null"]}, "crashed": {"type": "boolean"}},
}
_STEP = {
    "type": "object",
    "required": ["step"],
    "properties": {
        "step": {"type": "integer"},
        "rules": {"type": "string"},
        "lights": {"type": "object", "additionalProperties": {"type": "string"}},
        "cars": {"type": "object", "additionalProperties": _CAR},
        "percepts": _TEXTS,
        "beliefs": _TEXTS,
        "goals": _TEXTS,
        "hesitates": _TEXTS,
        "busy": _TEXTS,
        "situation": {
            "type": "object",
            "required": ["beliefs", "intentions"],
            "properties": {"context": {"type": ["string", "null"]}, "beliefs": _TEXTS, "intentions": _TEXTS},
        },
        "advice": _DIRECTIVES,
        "ignored": _DIRECTIVES,
        "justified": _DIRECTIVES,
        "plans": {
            "type": "array",
            "items": {"type": "object", "required": ["label", "file", "line"], "properties": {"label": {"type": "string"}, "file": {"type": "string"}, "line": {"type": "integer"}}},
        },
        "acts": {"type": "object", "additionalProperties": {"type": "string"}},
        "finished": {"type": "boolean"},
    },
}
_MAYBE_TEXT = {"type": ["string", "null"]}
TRACE_SCHEMA = {
    "type": "object",
    "required": ["agent", "scenario", "steps"],
    "properties": {
        "agent": {"type": "string"},
        "scenario": {"type": "string"},
        "instance": {"enum": ["published", "all", None]},
        "rules": _MAYBE_TEXT,
        "property": _MAYBE_TEXT,
        "says": _MAYBE_TEXT,
        "verdict": _MAYBE_TEXT,
        "loop": {"type": ["integer", "null"], "minimum": 0},
        "rows": _TEXTS,
        "steps": {"type": "array", "minItems": 1, "items": _STEP},
    },
}

# what stands still in a road: told only in full
_DULL = frozenset({"road", "heading", "drives", "limit", "speed"})
_WIDTH = 10


def read_trace(path: Path | str) -> dict[str, Any]:
    """The trace document of a file, its shape checked.  Errors: IO100, TR101, TR102."""
    name = str(path)
    again = "record it with `rotra run --trace FILE` or `rotra verify -o DIR`"
    try:
        document = json.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise Rejected([problem("IO100", Origin(name), f"cannot read the file: {error.strerror}", "check the path")]) from error
    except json.JSONDecodeError as error:
        raise Rejected([problem("TR101", Origin(name, error.lineno), f"not JSON: {error.msg} at column {error.colno}", again)]) from error
    except (ValueError, RecursionError) as error:
        raise Rejected([problem("TR101", Origin(name), "not JSON: not UTF-8 text, or values without bounds", again)]) from error
    wrong = sorted(jsonschema.Draft202012Validator(TRACE_SCHEMA).iter_errors(document), key=lambda e: [str(p) for p in e.absolute_path])
    found = [problem("TR102", Origin(name), f"{_place(e.absolute_path)}: {_short(e.message)}", again) for e in wrong[:10]]
    if not found and (document.get("loop") or 0) >= len(document["steps"]):
        found = [problem("TR102", Origin(name), f"loop: there is no step with the index {document['loop']}", again)]
    if found:
        raise Rejected(found)
    assert isinstance(document, dict)
    return document


def _place(path: Iterable[Any]) -> str:
    return ".".join(map(str, path)) or "the trace"


def _short(text: str) -> str:
    return text if len(text) <= 200 else "..." + text[-197:]


def explain(trace: Mapping[str, Any], full: bool, rules: Paragraphs | None = None, better: Better | None = None, silent: Silent | None = None) -> str:
    """The story of a trace.  `full`: all of every step; else what changed since the step before.

    `better`, `silent`: what else could have been done (blame.py), which rules say nothing (silence.py); left out where None.
    """
    story = _Story(full, rules or {}, better)
    steps: Sequence[Mapping[str, Any]] = trace["steps"]
    loop: int | None = trace.get("loop")
    lines = list(_head(trace))
    before: Mapping[str, Any] = {}
    for number, step in enumerate(steps):
        lines.append("")
        if loop == number:
            lines.append("-- from here on it repeats --")
        if step.get("rules"):
            lines.append(f"-- from here on the rules are {step['rules']} --")
        lines += story.step(step, before)
        before = step
    lines += ["", *_end(steps, loop, story)]
    if silent is not None and not story.blame and loop is None and steps and trace.get("verdict") == "violated":
        lines += [f"       in step {steps[-1]['step']} {told}" for told in silent(steps[-1])]
    return "\n".join(lines)


def _head(trace: Mapping[str, Any]) -> Iterator[str]:
    which = f" ({trace['instance']})" if trace.get("instance") else ""
    yield f"{trace['agent']} in {trace['scenario']}{which}, rules {trace.get('rules') or 'uk'}"
    if trace.get("property"):
        told = {"holds": "holds; this path is a witness", "violated": "is violated"}.get(trace.get("verdict") or "", trace.get("verdict") or "")
        yield f"{trace['property']} {told}".rstrip() + (f": {trace['says']}" if trace.get("says") else "")


def _end(steps: Sequence[Mapping[str, Any]], loop: int | None, story: _Story) -> Iterator[str]:
    if loop is not None:
        yield f"loop: after step {steps[-1]['step']} comes step {steps[loop]['step']} again, and so for ever"
        if not steps[-1].get("finished") and "finished" in steps[-1]:
            yield "finish: never, as long as the loop goes on"
    if story.blame:
        yield from (f"blame: {line}" for line in story.blame)
    elif any(s.get("advice") for s in steps):
        yield "blame: none; no directive in force was ignored" + (f"; the last to fall silent: {story.silent}" if story.silent else "")


class _Story:
    """Tells the steps in order, and remembers what was said before."""

    def __init__(self, full: bool, rules: Paragraphs, better: Better | None) -> None:
        self.full, self.rules, self.better = full, rules, better
        self.quoted: set[str] = set()
        self.plan = ""
        self.silent = ""
        self.blame: list[str] = []

    def step(self, step: Mapping[str, Any], before: Mapping[str, Any]) -> Iterator[str]:
        act = step.get("acts", {}).get("driver")
        car = step.get("cars", {}).get("driver")
        where = f"at ({car['x']},{car['y']})" + (f" facing {car['heading']}" if car.get("heading") else "") + (f", speed {car['speed']}" if car.get("speed") is not None else "") if car else ""
        header = f"step {step['step']}" + (f"  {where}" if where else "")
        if act is not None and not (car and car["crashed"]):
            header += f": {act_words(act)}"
        yield header
        yield from self._world(step, before)
        if car and car["crashed"]:
            return
        yield from self._mind(step, before)
        yield from self._directives(step, before)
        yield from self._plans(step, before)
        yield from self._ignored(step, act)

    def _world(self, step: Mapping[str, Any], before: Mapping[str, Any]) -> Iterator[str]:
        lights, cars = step.get("lights", {}), step.get("cars", {})
        shown = {k: v for k, v in lights.items() if self.full or before.get("lights", {}).get(k) != v}
        if shown:
            yield _line("lights", ", ".join(f"{k} {v.replace('_', ' and ')}" for k, v in shown.items()))
        others = {k: v for k, v in cars.items() if k != "driver"}
        if self.full and others:
            yield _line("traffic", ", ".join(f"{k} at ({v['x']},{v['y']})" + (" crashed" if v["crashed"] else "") for k, v in others.items()))
        if step.get("hesitates"):
            yield _line("hesitates", ", ".join(step["hesitates"]))
        crashed = [k for k, v in cars.items() if v["crashed"] and not before.get("cars", {}).get(k, {}).get("crashed")]
        if crashed:
            yield _line("CRASH", _crash(crashed, cars, before.get("cars", {})))
        if step.get("finished") and not before.get("finished"):
            yield _line("FINISH", "the goal of the scenario is reached")

    def _mind(self, step: Mapping[str, Any], before: Mapping[str, Any]) -> Iterator[str]:
        def seen(of: Mapping[str, Any]) -> list[str]:
            return [p for p in of.get("percepts", []) if self.full or p.split("(")[0] not in _DULL]

        situation, previous = step.get("situation", {}), before.get("situation", {})
        if (context := situation.get("context")) and (self.full or context != previous.get("context", "standard")):
            yield _line("context", context)
        yield from self._changes("sees", seen(step), seen(before), lambda p: f"{percept_words(p)} [{p}]" if self.full else percept_words(p))
        yield from self._changes("believes", situation.get("beliefs", []), previous.get("beliefs", []))
        yield from self._changes("intends", situation.get("intentions", []), previous.get("intentions", []))
        if self.full or before:
            yield from self._changes("remembers", step.get("beliefs", []), before.get("beliefs", []))
        if self.full:
            yield from self._changes("goals", step.get("goals", []), [])

    def _changes(self, what: str, now: Sequence[str], before: Sequence[str], words: Callable[[str], str] = str) -> Iterator[str]:
        if self.full:
            if now:
                yield _line(what, ", ".join(map(words, now)))
            return
        new, gone = [x for x in now if x not in before], [x for x in before if x not in now]
        if what == "sees":  # a thing seen elsewhere now has moved; it is not gone
            kinds = {x.split("(")[0] for x in new}
            gone = [x for x in gone if x.split("(")[0] not in kinds]
        parts = [", ".join(map(words, new))] if new else []
        parts += ["no longer " + ", ".join(map(words, gone))] if gone else []
        if parts:
            yield _line(what, "; ".join(parts))

    def _directives(self, step: Mapping[str, Any], before: Mapping[str, Any]) -> Iterator[str]:
        now, previous = step.get("advice", []), before.get("advice", [])
        for d in now:
            if self.full or d not in previous:
                yield _line(d["label"], f"{d['action']}{self._by(d)}")
        held = {(d["label"], d["action"]) for d in now}
        for d in previous if "advice" in step else ():
            if (d["label"], d["action"]) not in held:
                rules = d.get("rules", [])
                silent = f": {' and '.join(rules)} no longer appl{'ies' if len(rules) == 1 else 'y'}" if rules else ""
                self.silent = f"{d['label']} {d['action']} in step {step['step']}{silent}"
                yield _line("released", f"{d['label']} {d['action']}{silent}")

    def _by(self, directive: Mapping[str, Any], quote: bool = True) -> str:
        """`, by r175 (paragraph 175: what it says)`; a rule's sentence is quoted once in a trace."""
        told = []
        for rule in directive.get("rules", []):
            if rule not in self.rules:
                told.append(rule)
                continue
            paragraph, says = self.rules[rule]
            sentence = f": {says.rstrip('.')}" if quote and says and (rule not in self.quoted or self.full) else ""
            self.quoted.add(rule)
            told.append(f"{rule} (paragraph {paragraph}{sentence})")
        return f", by {' and '.join(told)}" if told else ""

    def _plans(self, step: Mapping[str, Any], before: Mapping[str, Any]) -> Iterator[str]:
        plans = step.get("plans", [])
        if plans:
            self.plan = _plan(plans[-1])
        if plans and (self.full or plans != before.get("plans")):
            yield _line("plan", " > ".join(map(_plan, plans)) if self.full else self.plan)
        if step.get("busy"):
            yield _line("BUSY", f"a step has one act; refused: {', '.join(step['busy'])}")

    def _ignored(self, step: Mapping[str, Any], act: str | None) -> Iterator[str]:
        rules = {(d["label"], d["action"]): d for d in step.get("advice", [])}
        by = f" by plan {self.plan}" if self.plan else ""
        for d in step.get("ignored", []):
            source = self._by(rules.get((d["label"], d["action"]), d), quote=False)
            instead = self.better(step, d["action"]) if self.better else None
            right = f"it should have chosen {instead}, for one" if instead else "it should have chosen an act that does not go against it"
            yield _line("IGNORES", f"{d['label']} {d['action']}{source}: it {act_words(act or 'wait')}{by}; {right}")
            self.blame.append(f"step {step['step']}: {act or 'wait'}{by} ignores {d['label']} {d['action']}{source}; {right}")
        for d in step.get("justified", []):
            yield _line("excused", f"{d['label']} {d['action']} could not be followed without ignoring a must")


def _line(what: str, text: str) -> str:
    return f"    {what:<{_WIDTH}}{text}"


def _plan(plan: Mapping[str, Any]) -> str:
    label = f"@{plan['label']} " if plan["label"] else ""
    return f"{label}({shown_path(plan['file'])}:{plan['line']})"


def _crash(crashed: Sequence[str], cars: Mapping[str, Any], before: Mapping[str, Any]) -> str:
    """Who crashed where, and into whom as far as the places tell."""
    told = []
    for name in crashed:
        cell = (cars[name]["x"], cars[name]["y"])
        on_it = [k for k, c in cars.items() if k != name and (c["x"], c["y"]) == cell]
        swapped = [k for k in crashed if k != name and k in before and name in before and k not in on_it and _next_to(cars[k], cars[name])]
        into = f" with {' and '.join(on_it)}" if on_it else f", face to face with {' and '.join(swapped)}" if swapped else ""
        told.append(f"{'the driver' if name == 'driver' else name} has crashed at ({cell[0]},{cell[1]}){into}")
    return "; ".join(told)


def _next_to(a: Mapping[str, Any], b: Mapping[str, Any]) -> bool:
    return abs(a["x"] - b["x"]) + abs(a["y"] - b["y"]) == 1


def act_words(act: str) -> str:
    """What the car does, in words; an unknown act as it stands."""
    literal = _literal(act)
    match (literal.name, literal.args) if literal else ("", ()):
        case ("wait", ()):
            return "waits"
        case ("forward", (int(n),)):
            return f"drives {_cells(n)} ahead"
        case ("change_lane", (Struct(side), int(n))):
            return f"changes to the lane on the {side}" + (f" and drives {_cells(n - 1)} ahead" if n > 1 else "")
        case ("turn", (Struct(side), int(n))):
            return f"turns {side}, {_cells(n)}"
    return f"does {act}"


def percept_words(percept: str) -> str:
    """What the car sees, in words; an unknown percept as it stands."""
    literal = _literal(percept)
    match (literal.name, literal.args) if literal else ("", ()):
        case ("car", (int(r), int(a))):
            return f"a car {_offset(r, a)}"
        case ("light", (int(r), int(a), Struct(colour))):
            return f"a light at {colour.replace('_', ' and ')} {_offset(r, a)}"
        case ("stop_line", (int(r), int(a))):
            return "a stop line under the car" if (r, a) == (0, 0) else f"a stop line {_offset(r, a)}"
        case ("road", (int(r), int(a), Struct(flow))):
            return f"road {'under the car' if (r, a) == (0, 0) else _offset(r, a)} that leads {flow}"
        case ("speed", (int(s),)):
            return f"its speed, {s}"
        case ("limit", (int(s),)):
            return f"the limit, {s}"
        case ("heading", (Struct(way),)):
            return f"that it faces {way}"
        case ("drives", (Struct(side),)):
            return f"that one drives on the {side}"
        case ("task", (Struct(task),)):
            return f"its task, {task}"
    return percept


def _literal(text: str) -> Struct | None:
    try:
        return parse_ground(text)
    except (ValueError, IndexError):
        return None


def _cells(n: int) -> str:
    return "1 cell" if n == 1 else f"{n} cells"


def _offset(right: int, ahead: int) -> str:
    parts = [f"{ahead} ahead" if ahead > 0 else f"{-ahead} behind"] if ahead else []
    parts += [f"{right} to the right" if right > 0 else f"{-right} to the left"] if right else []
    return " and ".join(parts) or "here"
