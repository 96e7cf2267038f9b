"""Give a name to what is written more than once, so that the text of a model grows with what it says.

    a := f(long); b := g(long)      ->      common_1 := long; a := f(common_1); b := g(common_1)

In: System.  Out: an equal System, whose parts have further definitions.  Left to others: the text (emitters/smv.py).
NuSMV reads and types every copy anew; with names, reading a large model takes a tenth of the time.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from rotra.system.expr import Expr, children, rebuild, ref, walk
from rotra.system.transition import Definition, Part, System

# fewer operands than this are read more easily where they stand
WORTH_A_NAME = 8


def share(system: System) -> System:
    return System(tuple(_share(part) for part in system.parts))


def _share(part: Part) -> Part:
    roots = [*(d.expr for d in part.definitions), *(v.next for v in part.variables if v.next is not None), *part.invariant, *part.initially]
    nodes = list(walk(roots))
    used = Counter(roots)
    for node in nodes:
        used.update(children(node))
    written: dict[Expr, Expr] = {}  # a node as it is written where it is defined
    spoken: dict[Expr, Expr] = {}  # the same where it is used: a name, if it has one
    size: dict[Expr, int] = {}
    common: list[Definition] = []
    for node in nodes:
        inner = children(node)
        written[node] = rebuild(node, tuple(spoken[c] for c in inner)) if any(spoken[c] is not c for c in inner) else node
        size[node] = 1 + sum(size[c] for c in inner)
        spoken[node] = written[node]
        if used[node] > 1 and size[node] >= WORTH_A_NAME:
            name = f"common:{part.name}:{len(common) + 1}"
            common.append(Definition(name, written[node]))
            spoken[node], size[node] = ref(name), 1
    return replace(
        part,
        definitions=(*common, *(replace(d, expr=spoken[d.expr]) for d in part.definitions)),
        variables=tuple(v if v.next is None else replace(v, next=spoken[v.next]) for v in part.variables),
        invariant=tuple(spoken[e] for e in part.invariant),
        initially=tuple(spoken[e] for e in part.initially),
    )
