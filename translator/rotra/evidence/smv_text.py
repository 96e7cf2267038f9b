"""Read the SMV text of a model and enumerate its reachable states, one by one, as the text itself says.

    next(x) := case driver.act = forward_1 : (x + 1) mod 8; TRUE : x; esac;   ->   x' = (x + 1) % 8 if ... else x

In: the text that `rotra translate` writes.  Out: `TextModel` (initial states, successors, values of definitions) and
`reachable`.  Left to others: what names mean (crosscheck.py).  It shares no code with the translator: a second reading of
the text, by its own parser, is what makes agreement evidence (NuSMV is the third: it must count as many states).
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from lark import Lark, Token, Tree
from lark.exceptions import UnexpectedInput

Value = bool | int | str
State = tuple[Value, ...]
_NESTED = 60
_ASKED = ("INVARSPEC", "LTLSPEC", "CTLSPEC")
_BETWEEN = {"either": "or", "both": "and", "equal": "==", "unequal": "!=", "less": "<", "at_most": "<=", "more": ">", "at_least": ">=", "inside": "in", "plus": "+", "minus": "-", "times": "*", "modulo": "%"}


class SmvTextError(Exception):
    """The text is not in the part of SMV that is read here, or contradicts itself."""


class TooManyStates(Exception):
    """More states than were allowed."""


@dataclass(frozen=True, slots=True)
class Declared:
    """A variable: its qualified name, its domain, and the text of what it begins with and turns into (None: anything)."""

    name: str
    domain: tuple[Value, ...]
    first: Tree[Token] | None
    then: Tree[Token] | None
    frozen: bool


@dataclass(slots=True)
class _Module:
    parameters: tuple[str, ...] = ()
    variables: dict[str, tuple[Tree[Token], bool]] = field(default_factory=dict)
    definitions: dict[str, Tree[Token]] = field(default_factory=dict)
    first: dict[str, Tree[Token]] = field(default_factory=dict)
    then: dict[str, Tree[Token]] = field(default_factory=dict)
    always: list[Tree[Token]] = field(default_factory=list)
    initially: list[Tree[Token]] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class TextModel:
    """Variables in the order of the text; a state gives their values in that order."""

    variables: tuple[Declared, ...]
    definitions: tuple[str, ...]
    starts: tuple[State, ...]
    successors: Callable[[State], list[State]]
    reader: Callable[[Sequence[str]], Callable[[State], State]]


@cache
def _parser() -> Lark:
    return Lark(Path(__file__).with_name("smv.lark").read_text(encoding="utf-8"), parser="lalr", maybe_placeholders=False)


def read_text(text: str) -> TextModel:
    """Errors: `SmvTextError`."""
    kept = "\n".join("" if line.startswith(_ASKED) else line for line in text.splitlines())
    try:
        tree = _parser().parse(kept)
    except UnexpectedInput as wrong:
        raise SmvTextError(f"line {wrong.line}: not in the part of SMV that is read here: {wrong.get_context(kept).splitlines()[0].strip()[:120]}") from wrong
    modules: dict[str, _Module] = {}
    constants: set[str] = set()
    for module in tree.children:
        assert isinstance(module, Tree)
        name, *parts = module.children
        modules[str(name)] = _module(parts, constants)
    return _Flat(modules, constants).model()


def _module(parts: Iterable[Tree[Token] | Token], constants: set[str]) -> _Module:
    found = _Module()
    for part in parts:
        assert isinstance(part, Tree)
        match part.data:
            case "parameters":
                found.parameters = tuple(map(str, part.children))
            case "constants":
                constants.update(map(str, part.children))
            case "changing" | "frozen":
                for variable in part.children:
                    name, domain = variable.children  # type: ignore[union-attr]
                    found.variables[str(name)] = (domain, part.data == "frozen")  # type: ignore[assignment]
            case "definitions":
                for definition in part.children:
                    name, value = definition.children  # type: ignore[union-attr]
                    found.definitions[str(name)] = value  # type: ignore[assignment]
            case "assignments":
                for assignment in part.children:
                    name, value = assignment.children  # type: ignore[union-attr]
                    (found.first if assignment.data == "first" else found.then)[str(name)] = value  # type: ignore[union-attr,assignment]
            case "always" | "initially":
                (found.always if part.data == "always" else found.initially).append(part.children[0])  # type: ignore[arg-type]
    return found


class _Flat:
    """The modules as one list of variables and definitions with qualified names, compiled to Python."""

    def __init__(self, modules: Mapping[str, _Module], constants: set[str]) -> None:
        self.constants = constants
        self.before: list[str] = []
        self.inside: dict[str, _Module] = {}
        self.known: dict[str, dict[str, str]] = {}
        for instance, (kind, _) in modules["main"].variables.items():
            if kind.data != "instance":
                raise SmvTextError(f"main: {instance} is no module")
            name, *arguments = map(str, kind.children)
            if name not in modules or len(arguments) != len(modules[name].parameters):
                raise SmvTextError(f"main: {instance} does not fit module {name}")
            self.inside[instance] = modules[name]
            self.known[instance] = dict(zip(modules[name].parameters, arguments, strict=True))
        self.variables = tuple(self._declared())
        self.place = {v.name: f"s[{i}]" for i, v in enumerate(self.variables)}
        self.definitions = {f"{part}.{name}": (part, value) for part, m in self.inside.items() for name, value in m.definitions.items()}
        self.number = {name: f"d{i}" for i, name in enumerate(self.definitions)}

    def _declared(self) -> Iterator[Declared]:
        for part, module in self.inside.items():
            for name, (domain, frozen) in module.variables.items():
                yield Declared(f"{part}.{name}", self._domain(domain), module.first.get(name), module.then.get(name), frozen)

    def _domain(self, domain: Tree[Token]) -> tuple[Value, ...]:
        if domain.data == "boolean":
            return (False, True)
        if domain.data == "range":
            low, high = (int(str(n)) for n in domain.children)
            return tuple(range(low, high + 1))
        return tuple(self._constant(v) for v in domain.children)  # type: ignore[arg-type]

    def _constant(self, value: Tree[Token]) -> Value:
        """A value of an enumeration; NuSMV declares its words by writing them there."""
        match value.data:
            case "true" | "false":
                return value.data == "true"
            case "number":
                return int(str(value.children[0]))
            case "name":
                self.constants.add(str(value.children[0]))
                return str(value.children[0])
        raise SmvTextError(f"an enumeration holds {value.data}")

    # ---- expressions ----------------------------------------------------------------------------------------------

    def named(self, part: str, name: str) -> str | None:
        """The qualified name behind a name or `module.name` as it stands in a part; None for a constant."""
        if "." in name:
            head, tail = name.split(".")
            target = self.known[part].get(head)
            if target is None:
                raise SmvTextError(f"{part}: there is no module {head} here")
            name = f"{target}.{tail}"
        elif name in self.constants:
            return None
        else:
            name = f"{part}.{name}"
        if name not in self.place and name not in self.number:
            raise SmvTextError(f"there is no {name}")
        return name

    def python(self, part: str, tree: Tree[Token]) -> str:
        """The expression as Python; what is nested too deeply for Python's parser is computed before, as `t0`, `t1` ..."""
        text = self.written(part, tree)
        if text.count("(") < _NESTED:
            return text
        self.before.append(text)
        return f"t{len(self.before) - 1}"

    def written(self, part: str, tree: Tree[Token]) -> str:
        """The expression over the state `s` and the definitions already computed, `d0`, `d1` ..."""
        kids = tree.children
        match tree.data:
            case "true" | "false":
                return str(tree.data == "true")
            case "number":
                return str(kids[0])
            case "name" | "member":
                text = ".".join(map(str, kids))
                name = self.named(part, text)
                return repr(text) if name is None else self.place.get(name) or self.number[name]
            case "no":
                return f"(not {self.python(part, kids[0])})"  # type: ignore[arg-type]
            case "set":
                return "(" + "".join(f"{self.python(part, k)}, " for k in kids) + ")"  # type: ignore[arg-type]
            case "implication":
                return f"(not {self.python(part, kids[0])} or {self.python(part, kids[1])})"  # type: ignore[arg-type]
            case "cases":
                branches = [tuple(self.python(part, e) for e in branch.children) for branch in kids]  # type: ignore[union-attr,arg-type]
                return "(" + "".join(f"{value} if {condition} else " for condition, value in branches) + "uncovered())"
        operator = _BETWEEN[tree.data]
        # a chain of one operator leans to the left: it is written without the brackets of every link
        links = []
        while isinstance(tree, Tree) and _BETWEEN.get(tree.data) == operator and operator in ("and", "or"):
            tree, right = tree.children  # type: ignore[assignment]
            links.append(right)
        if not links:
            return f"({self.python(part, kids[0])} {operator} {self.python(part, kids[1])})"  # type: ignore[arg-type]
        return "(" + f" {operator} ".join(self.python(part, e) for e in (tree, *reversed(links))) + ")"  # type: ignore[arg-type]

    def needed(self, part: str, trees: Iterable[Tree[Token]]) -> Iterator[str]:
        for tree in trees:
            for leaf in tree.iter_subtrees():
                if leaf.data in ("name", "member"):
                    name = self.named(part, ".".join(map(str, leaf.children)))
                    if name in self.number:
                        yield name

    def in_order(self, names: Iterable[str]) -> list[str]:
        """The definitions and all they need, each after what it needs.  Errors: one that needs itself."""
        done: dict[str, None] = {}
        open_: set[str] = set()
        todo = [(name, False) for name in names]
        while todo:
            name, ready = todo.pop()
            if ready:
                open_.discard(name)
                done[name] = None
            elif name not in done:
                if name in open_:
                    raise SmvTextError(f"{name} is defined by itself")
                open_.add(name)
                todo.append((name, True))
                part, tree = self.definitions[name]
                todo += [(n, False) for n in self.needed(part, [tree]) if n not in done]
        return list(done)

    def function(self, wanted: Sequence[tuple[str, Tree[Token]]]) -> Callable[[State], State]:
        """state -> the values of the expressions, each with the part in which it stands."""
        needs = [n for part, tree in wanted for n in self.needed(part, [tree])]
        self.before = []
        lines: list[str] = []

        def finished(text: str) -> str:
            for number in range(sum(line.startswith("    t") for line in lines), len(self.before)):
                lines.append(f"    t{number} = {self.before[number]}")
            return text

        for n in self.in_order(needs):
            lines.append(finished(f"    {self.number[n]} = {self.python(*self.definitions[n])}"))
        values = finished("".join(f"{self.python(part, tree)}, " for part, tree in wanted))
        space: dict[str, Any] = {"uncovered": _uncovered}
        exec("\n".join(["def compute(s):", *lines, f"    return ({values})"]), space)  # noqa: S102
        compute: Callable[[State], State] = space["compute"]
        return compute

    # ---- the model ------------------------------------------------------------------------------------------------

    def model(self) -> TextModel:
        always = [(part, e) for part, m in self.inside.items() for e in m.always]
        moving = [v for v in self.variables if not v.frozen and v.then is not None]
        step = self.function([(_part(v.name), v.then) for v in moving if v.then is not None])
        allowed = self.function(always)
        free = [v.domain for v in self.variables if not v.frozen and v.then is None]
        # where each value of the next state comes from: the last state, the computed values, the free choices
        computed, chosen = itertools.count(), itertools.count()
        source = [(0, i) if v.frozen else (1, next(computed)) if v.then is not None else (2, next(chosen)) for i, v in enumerate(self.variables)]
        domains = [(n, frozenset(v.domain)) for n, v in enumerate(moving)]

        def successors(state: State) -> list[State]:
            then = step(state)
            for n, domain in domains:
                if then[n] not in domain:
                    raise SmvTextError(f"next({moving[n].name}) is {then[n]}, which is not in its domain")
            found = (tuple((state, then, choice)[where][i] for where, i in source) for choice in itertools.product(*free))
            return [new for new in found if all(allowed(new))] if always else list(found)

        def reader(names: Sequence[str]) -> Callable[[State], State]:
            return self.function([("", Tree("member", [Token("NAME", word) for word in n.split(".")])) for n in names])

        self.known[""] = {part: part for part in self.inside}
        return TextModel(self.variables, tuple(self.definitions), tuple(self.starts(always)), successors, reader)

    def starts(self, always: Sequence[tuple[str, Tree[Token]]]) -> Iterator[State]:
        """Variable by variable; a constraint is asked as soon as all that it speaks of has a value."""
        constraints = [*always, *((part, e) for part, m in self.inside.items() for e in m.initially)]
        number = {v.name: i for i, v in enumerate(self.variables)}
        due: dict[int, list[Callable[[State], State]]] = {}
        for part, e in constraints:
            due.setdefault(max((number[n] for n in self.spoken_of(part, e)), default=0), []).append(self.function([(part, e)]))
        partial: list[State] = [()]
        for i, v in enumerate(self.variables):
            choices = v.domain if v.first is None else self.function([(_part(v.name), v.first)])(())[0]
            values = choices if isinstance(choices, tuple) else (choices,)
            if not set(values) <= set(v.domain):
                raise SmvTextError(f"init({v.name}) is {choices}, which is not in its domain")
            partial = [new for known in partial for value in values for new in [(*known, value)] if all(all(check(new)) for check in due.get(i, ()))]
        yield from partial

    def spoken_of(self, part: str, e: Tree[Token]) -> set[str]:
        """The variables on which an expression depends, through its definitions, too."""
        found = {self.named(part, ".".join(map(str, leaf.children))) for leaf in e.iter_subtrees() if leaf.data in ("name", "member")}
        for name in self.in_order(n for n in found if n in self.number):
            where, tree = self.definitions[name]
            found |= {self.named(where, ".".join(map(str, leaf.children))) for leaf in tree.iter_subtrees() if leaf.data in ("name", "member")}
        return {n for n in found if n in self.place}


def _part(name: str) -> str:
    return name.split(".")[0]


def _uncovered() -> Value:
    raise SmvTextError("a case has no branch that applies")


def reachable(model: TextModel, most: int) -> dict[State, list[State]]:
    """Every reachable state with its successors, breadth first.  Errors: `TooManyStates`."""
    found: dict[State, list[State]] = {}
    layer = list(model.starts)
    while layer:
        fresh: dict[State, None] = {}
        for state in layer:
            if state not in found:
                found[state] = model.successors(state)
                if len(found) > most:
                    raise TooManyStates(f"more than {most} states")
                fresh.update(dict.fromkeys(s for s in found[state] if s not in found))
        layer = list(fresh)
    return found
