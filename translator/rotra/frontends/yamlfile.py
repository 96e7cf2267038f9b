"""Read a YAML file safely, keeping the line of every value.

In: a path.  Out: a `Node` tree.  Left to others: what the values mean.  Errors: IO100, IO101, IO102 as `Rejected`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from rotra.diagnostics import Rejected, problem
from rotra.origins import Origin, shown_path

_Loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


@dataclass(frozen=True, slots=True)
class Node:
    """A YAML value and its place.  `value` is a scalar, a dict of str -> Node, or a tuple of Nodes."""

    value: object
    file: str
    line: int

    def origin(self, what: str = "") -> Origin:
        return Origin(self.file, self.line, what)

    def plain(self) -> object:
        """The value without places, as yaml.safe_load gives it."""
        if isinstance(self.value, dict):
            return {key: node.plain() for key, node in self.value.items()}
        if isinstance(self.value, tuple):
            return [node.plain() for node in self.value]
        return self.value

    def get(self, key: str) -> Node | None:
        return self.value.get(key) if isinstance(self.value, dict) else None

    def at(self, key: str) -> Node:
        node = self.get(key)
        if node is None:
            raise KeyError(key)
        return node

    def items(self) -> Iterator[tuple[str, Node]]:
        return iter(self.value.items()) if isinstance(self.value, dict) else iter(())

    def __iter__(self) -> Iterator[Node]:
        return iter(self.value) if isinstance(self.value, tuple) else iter(())


def load_yaml(path: Path | str) -> Node:
    """The one document of a YAML file; an empty file is a Node holding None."""
    name = shown_path(str(path))
    try:
        text = Path(path).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "not UTF-8 text"
        raise Rejected([problem("IO100", Origin(name), f"cannot read the file: {reason}", "check the path")]) from error
    loader = _Loader(text)
    try:
        root = loader.get_single_node()
        return Node(None, name, 1) if root is None else _convert(root, name, loader, frozenset())
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
        line = mark.line + 1 if mark else 0
        what = getattr(error, "problem", None) or "not YAML"
        raise Rejected([problem("IO101", Origin(name, line), f"not well-formed YAML: {what}", "check indentation, quotes and brackets")]) from error
    finally:
        loader.dispose()


def _convert(node: yaml.Node, name: str, loader: Any, above: frozenset[int]) -> Node:
    line = node.start_mark.line + 1
    if id(node) in above:
        raise Rejected([problem("IO101", Origin(name, line), "a YAML alias that contains itself", "write the value out")])
    inside = above | {id(node)}
    if isinstance(node, yaml.MappingNode):
        entries: dict[str, Node] = {}
        for key, value in node.value:
            text = str(loader.construct_object(key, deep=True))
            if text in entries:
                raise Rejected([problem("IO102", Origin(name, key.start_mark.line + 1), f"the key {text!r} stands twice", "keep one of them")])
            entries[text] = _convert(value, name, loader, inside)
        return Node(entries, name, line)
    if isinstance(node, yaml.SequenceNode):
        return Node(tuple(_convert(item, name, loader, inside) for item in node.value), name, line)
    return Node(loader.construct_object(node, deep=True), name, line)
