"""Names for what is written twice change the text of a system, never its meaning."""

from __future__ import annotations

from itertools import product

from rotra.system.expr import conj, disj, evaluate, negate, var
from rotra.system.sharing import share
from rotra.system.transition import Definition, Part, System

LETTERS = "abcdefgh"


def test_a_shared_system_means_the_same() -> None:
    a, b, *rest = map(var, LETTERS)
    long = disj(conj(a, b), conj(*rest), negate(a))
    system = System((Part("world", (), (Definition("one", conj(long, a)), Definition("two", negate(long)), Definition("three", long))),))
    before, after = system.definitions(), share(system).definitions()
    (extra,) = set(after) - set(before)
    assert after[extra] is long
    for values in product((False, True), repeat=len(LETTERS)):
        state = dict(zip(LETTERS, values, strict=True))
        for name, expr in before.items():
            assert evaluate(expr, state, before) == evaluate(after[name], state, after)


def test_what_is_short_or_written_once_stays() -> None:
    a, b, *rest = map(var, LETTERS)
    system = System((Part("world", (), (Definition("one", conj(a, b)), Definition("two", disj(conj(a, b), *rest)))),))
    assert share(system) == system
