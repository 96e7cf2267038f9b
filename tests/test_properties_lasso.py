"""Temporal operators on a lasso, against their definitions written with quantifiers over a long unrolled path."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from rotra.frontends.properties import Formula
from rotra.lowering.atoms import Bound, Impossible, State, Temporal, bind, evaluate_on_lasso, is_invariant, negation, to_ltl
from rotra.system.expr import Expr, evaluate, var

NAMES = ("p", "q")
UNARY = ("not", "always", "eventually", "next", "historically", "once", "previously")
BINARY = ("until", "since", "and", "or", "implies", "iff")


def formulas() -> st.SearchStrategy[Bound]:
    leaf: st.SearchStrategy[Bound] = st.sampled_from([State(var(n)) for n in NAMES])
    return st.recursive(
        leaf,
        lambda inner: st.one_of(
            st.builds(lambda op, a: Temporal(op, (a,)), st.sampled_from(UNARY), inner),
            st.builds(lambda op, a, b: Temporal(op, (a, b)), st.sampled_from(BINARY), inner, inner),
        ),
        max_leaves=4,
    )


@st.composite
def lassos(draw: st.DrawFn) -> tuple[list[dict[str, bool]], int]:
    states = draw(st.lists(st.fixed_dictionaries({n: st.booleans() for n in NAMES}), min_size=1, max_size=4))
    return states, draw(st.integers(0, len(states) - 1))


def holds(expr: Expr, state: dict[str, bool]) -> bool:
    return bool(evaluate(expr, state, {}))


def naive(bound: Bound, states: list[dict[str, bool]], loop: int) -> bool:
    period = len(states) - loop
    # every subformula repeats well before this place: at most 8 operators, one round each
    settled = len(states) + 10 * period
    memo: dict[tuple[Bound, int], bool] = {}

    def at(b: Bound, i: int) -> bool:
        if (b, i) not in memo:
            memo[b, i] = meaning(b, i)
        return memo[b, i]

    def meaning(b: Bound, i: int) -> bool:
        if isinstance(b, State):
            return holds(b.expr, states[i if i < len(states) else loop + (i - loop) % period])
        if i >= settled + period:
            return at(b, settled + (i - settled) % period)
        later, earlier = range(i, max(i, settled) + 2 * period), range(i + 1)
        match b.op, b.args:
            case "not", (a,):
                return not at(a, i)
            case "and", (a, c):
                return at(a, i) and at(c, i)
            case "or", (a, c):
                return at(a, i) or at(c, i)
            case "implies", (a, c):
                return at(c, i) if at(a, i) else True
            case "iff", (a, c):
                return at(a, i) is at(c, i)
            case "next", (a,):
                return at(a, i + 1)
            case "previously", (a,):
                return i > 0 and at(a, i - 1)
            case "always", (a,):
                return all(at(a, k) for k in later)
            case "eventually", (a,):
                return any(at(a, k) for k in later)
            case "historically", (a,):
                return all(at(a, k) for k in earlier)
            case "once", (a,):
                return any(at(a, k) for k in earlier)
            case "until", (a, c):
                return any(at(c, k) and all(at(a, j) for j in range(i, k)) for k in later)
            case "since", (a, c):
                return any(at(c, k) and all(at(a, j) for j in range(k + 1, i + 1)) for k in earlier)
        raise AssertionError(b)

    return at(bound, 0)


@settings(max_examples=300, deadline=None)
@given(formulas(), lassos())
def test_evaluation_is_the_definition(bound: Bound, lasso: tuple[list[dict[str, bool]], int]) -> None:
    states, loop = lasso
    assert evaluate_on_lasso(bound, states, loop, holds) is naive(bound, states, loop)


@settings(max_examples=100, deadline=None)
@given(formulas(), lassos())
def test_negation_is_the_opposite(bound: Bound, lasso: tuple[list[dict[str, bool]], int]) -> None:
    states, loop = lasso
    assert evaluate_on_lasso(negation(bound), states, loop, holds) is not evaluate_on_lasso(bound, states, loop, holds)


def test_past_words_see_the_way_in() -> None:
    once_q = Temporal("always", (Temporal("once", (State(var("q")),)),))
    assert evaluate_on_lasso(once_q, [{"q": True}, {"q": False}], 1, holds)
    assert not evaluate_on_lasso(Temporal("previously", (State(var("q")),)), [{"q": True}], 0, holds)


def test_ltl_text_and_invariants() -> None:
    p, q = State(var("p")), State(var("q"))
    assert to_ltl(Temporal("always", (Temporal("since", (p, Temporal("previously", (q,)))),)), str) == "(G ((p) S (Y (q))))"
    assert is_invariant(Temporal("always", (p,))) is p.expr
    assert is_invariant(Temporal("eventually", (p,))) is None


class NoCars:
    """A vocabulary without cars, where every word asked is the variable p."""

    class scenario:
        traffic = ()

    def hesitates(self, car: object) -> Expr:
        return var("p")


def test_forall_over_nothing_is_not_a_truth() -> None:
    over_cars = Formula("forall", ("C", "cars", Formula("always", (Formula("atom", ("hesitates",)),))))
    assert bind(over_cars, NoCars()) == Impossible("there are no cars here")
