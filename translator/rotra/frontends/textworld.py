"""Read a world in the published text format and put it under the scenario file that names it.

    text: TrafficLight.txt   becomes   grid: |        limit: 1    lights: [{name: tl, at: [1, 5], ..}]
                                         ..^..        driver: {at: [2, 7], ..}
In: the Node of a scenario file with `text:`.  Out: the same with `grid`, and warnings.  What the scenario file says of a
light or car of that name is added to, and wins over, what the text says.  Left to others: whether it makes sense.
Errors: SC110; warnings: SC111 (the published program passes over those lines in silence).
"""

from __future__ import annotations

from pathlib import Path

from rotra.diagnostics import Diagnostic, Rejected, problem
from rotra.frontends.yamlfile import Node
from rotra.origins import Origin

_HEADING = {"n": "north", "e": "east", "s": "south", "w": "west"}


def with_text_world(root: Node) -> tuple[Node, tuple[Diagnostic, ...]]:
    """The scenario with the world of its text file; the path counts from the scenario's own folder."""
    named = root.at("text")
    path = Path(root.file).parent / str(named.value)
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise Rejected([problem("SC110", named.origin(), f"cannot read the world text {named.value}", "the path counts from the folder of the scenario file")]) from error
    return _Text(str(path), lines).under(root)


class _Text:
    def __init__(self, file: str, lines: list[str]) -> None:
        self.file, self.lines = file, lines
        self.warnings: list[Diagnostic] = []

    def refused(self, line: int, message: str, hint: str) -> Rejected:
        return Rejected([problem("SC110", Origin(self.file, line), message, hint)])

    def node(self, value: object, line: int) -> Node:
        if isinstance(value, dict):
            return Node({k: self.node(v, line) for k, v in value.items()}, self.file, line)
        if isinstance(value, (list, tuple)):
            return Node(tuple(self.node(v, line) for v in value), self.file, line)
        return Node(value, self.file, line)

    def number(self, text: str, line: int, what: str) -> int:
        if not (text.isascii() and text.isdigit()):
            raise self.refused(line, f"{what} should be a whole number, not {text.strip()!r}", "lines 1 to 3 are width, height and limit; places are X and Y from the top left")
        return int(text)

    def heading(self, text: str, line: int) -> str:
        found = _HEADING.get(text[:1].lower())
        if found is None or text.lower() not in (found, found[0]):
            raise self.refused(line, f"{text!r} is no direction", "write north, east, south or west")
        return found

    def under(self, root: Node) -> tuple[Node, tuple[Diagnostic, ...]]:
        head = [*self.lines[:3], "", "", ""]
        width, height, limit = (self.number(head[i].strip(), i + 1, what) for i, what in enumerate(("the width", "the height", "the limit")))
        rows = self.lines[3 : 3 + height]
        if len(rows) < height or not width or not height:
            raise self.refused(2, f"{height} rows of {width} cells are announced, {len(rows)} are there", "draw as many rows as line 2 says")
        for n, row in enumerate(rows, start=4):
            if len(row) < width:
                raise self.refused(n, f"this row has {len(row)} cells, the width is {width}", "fill it up: any other character is no road")
        # a blank row would be lost to the reader of grids, so what is no road is written as a dot
        grid = "\n".join("".join(c if c in "^vV<>+" else "." for c in row[:width]) for row in rows)
        lights, cars = self.directives(3 + height)
        drivers = [c for c in cars if "heading" not in c.value]  # type: ignore[operator]
        if len(drivers) > 1:
            raise self.refused(drivers[1].line, "there are two cars to be driven", "name all but one of them `slow`")
        whole = dict(root.items())
        del whole["text"]
        whole["grid"] = Node(grid, self.file, 3)
        whole.setdefault("limit", self.node(limit, 3))
        for key, found in (("lights", lights), ("traffic", [c for c in cars if c not in drivers])):
            whole[key] = _joined(found, whole.get(key), self.file)
        said = whole.get("driver") or self.node({}, 0)
        if drivers and said.get("at") is None:
            whole["driver"] = Node({**dict(said.items()), "at": drivers[0].at("at")}, said.file, said.line)
        return Node(whole, root.file, root.line), tuple(self.warnings)

    def directives(self, start: int) -> tuple[list[Node], list[Node]]:
        lights: list[Node] = []
        cars: list[Node] = []
        slow = sum([w.lower() for w in line.split()[:2]] == ["car", "slow"] for line in self.lines[start:])
        met = 0
        for n, line in enumerate(self.lines[start:], start=start + 1):
            words = line.split()
            match [w.lower() for w in words[:1]]:
                case ["trl"] if len(words) == 7:
                    x, y, stop_x, stop_y = (self.number(w, n, "a place") for w in words[2:6])
                    lights.append(self.node({"name": words[1].lower(), "at": [x, y], "stop_line": [stop_x, stop_y], "faces": self.heading(words[6], n)}, n))
                case ["car"] if len(words) >= 4:
                    at = [self.number(w, n, "a place") for w in words[2:4]]
                    if words[1].lower() == "slow":
                        met += 1
                        way = self.heading(words[4], n) if len(words) > 4 else "north"
                        cars.append(self.node({"name": f"slow{met}" if slow > 1 else "slow", "at": at, "heading": way, "speed": 1}, n))
                    else:
                        cars.append(self.node({"at": at}, n))
                case ["trl"] | ["car"]:
                    raise self.refused(n, f"a {words[0]} line is incomplete", "trl NAME X Y STOP_X STOP_Y FACES, or car NAME X Y [HEADING]")
                case []:
                    pass
                case _:
                    what = "a row more than line 2 announces" if n == start + 1 else "neither trl nor car"
                    self.warnings.append(problem("SC111", Origin(self.file, n), f"passed over: {what}", "delete the line"))
        return lights, cars


def _joined(found: list[Node], said: Node | None, file: str) -> Node:
    """The things of the text, each with what the scenario file says of its name; then those it alone has."""
    more = {str(n.at("name").value): n for n in said or ()}
    things = [Node({**dict(f.items()), **dict(m.items())}, f.file, f.line) if (m := more.pop(str(f.at("name").value), None)) else f for f in found]
    return Node((*things, *more.values()), file, said.line if said else 0)
