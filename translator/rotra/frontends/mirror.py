"""The other side of the road: a term, a world or a property as it looks in a mirror.

    always (does(turn(right,_)) implies not percept(car(1,1)))
    always (does(turn(left,_)) implies not percept(car(-1,1)))

In: what was written for a world.  Out: the same for its mirrored world, in which traffic drives on the other side.
Left to others: which worlds are mirrored (scenario.py), which properties are asked there (pipeline/campaign.py).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from rotra.frontends.properties import Formula, Property
from rotra.frontends.rules import RuleBase
from rotra.frontends.terms import Struct, Sum, Term

_OTHER = {"left": "right", "right": "left", "east": "west", "west": "east"}
# percepts whose first argument counts cells to the right of the car
_PLACED = frozenset({"road", "car", "light", "stop_line"})
# words of a formula about the driver, the car and its mind; those about the world's own cars and lights keep their names
_OF_THE_CAR = frozenset({"believes", "intends", "belief", "goal", "does", "percept", "advised", "ignored", "heading"})
_TERM_KIND = {"believes": "belief", "intends": "intention", "advised": "action", "ignored": "action"}

Word = Callable[[str], str]


def other_side(word: str) -> str:
    """`turn_left` is `turn_right` in the mirror."""
    return "_".join(_OTHER.get(part, part) for part in word.split("_"))


def mirrored_term(term: Term, word: Word = other_side) -> Term:
    """Sides swapped; what lies R cells to the right lies -R cells to the right."""
    match term:
        case Struct(name, args):
            inside = tuple(mirrored_term(a, word) for a in args)
            if name in _PLACED and isinstance(args[0] if args else None, int):
                inside = (-args[0], *inside[1:])  # type: ignore[operator]
            return replace(term, name=word(name), args=inside)
    return term


def mirrored_property(wanted: Property, base: RuleBase, width: int) -> Property:
    """The property for the mirrored world, `width` cells wide.

    A word of the rule base takes the other side only where the base has that word: British law knows no `keep_right`.
    """

    def formula(f: Formula) -> Formula:
        return _formula(f, base, width)

    return replace(wanted, formula=formula(wanted.formula), assuming=tuple(map(formula, wanted.assuming)), witness=None if wanted.witness is None else formula(wanted.witness))


def _formula(f: Formula, base: RuleBase, width: int) -> Formula:
    match f.op:
        case "forall":
            name, domain, inner = f.args
            return Formula("forall", (name, domain if isinstance(domain, str) else tuple(mirrored_term(t) for t in domain), _formula(inner, base, width)))
        case "compare":
            relation, *sides = f.args
            return Formula("compare", (relation, *(_number(t, width) for t in sides)))
        case "atom":
            return Formula("atom", _atom(f.args[0], f.args[1:], base, width))
    return Formula(f.op, tuple(_formula(part, base, width) for part in f.args))


def _atom(word: str, terms: tuple[Any, ...], base: RuleBase, width: int) -> tuple[Any, ...]:
    kind = _TERM_KIND.get(word)
    if word == "car":
        return (word, terms[0], width - 1 - terms[1] if isinstance(terms[1], int) else terms[1], terms[2])
    if word not in _OF_THE_CAR:
        return (word, *terms)

    def known(name: str) -> str:
        return other_side(name) if kind is None or other_side(name) in base.ontology.terms(kind) else name

    return (word, *(mirrored_term(t, known) for t in terms))


def _number(term: Term, width: int) -> Term:
    if term == Struct("x"):
        return Sum("-", (width - 1, term))
    if isinstance(term, Sum):
        return replace(term, args=tuple(_number(a, width) for a in term.args))
    return term
