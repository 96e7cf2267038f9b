"""The adviser gives exactly what the set definition says; tests/bench measures what it costs."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from rotra.advice import compile
from rotra.frontends.rules import load_rule_base

BASE = load_rule_base("uk")
ADVISER = compile(BASE)


def by_definition(context: str, beliefs: set[str], intentions: set[str]) -> list[tuple[str, str, tuple[str, ...]]]:
    found: dict[tuple[str, str], list[str]] = {}
    for rule in BASE.rules:
        excepted = set(rule.unless_beliefs) & beliefs or set(rule.unless_intentions) & intentions
        if rule.context == context and set(rule.beliefs) <= beliefs and set(rule.intentions) <= intentions and not excepted:
            for d in rule.directives:
                found.setdefault((d.label, d.action), []).append(rule.id)
    return [(label, action, tuple(found[label, action])) for label, action in sorted(found)]  # must < should


@settings(max_examples=300, deadline=None)
@given(
    st.sampled_from(sorted(BASE.ontology.contexts)),
    st.sets(st.sampled_from(sorted(BASE.ontology.beliefs)), max_size=40),
    st.sets(st.sampled_from(sorted(BASE.ontology.intentions)), max_size=6),
)
def test_set_definition(context: str, beliefs: set[str], intentions: set[str]) -> None:
    assert [tuple(d) for d in ADVISER.advise(context, beliefs, intentions).directives] == by_definition(context, beliefs, intentions)


def test_order_repetition_and_aliases_do_not_matter() -> None:
    one = ADVISER.advise("standard", ["light_red", "driving"], ["approaching_traffic_light"])
    assert ADVISER.advise("standard", ["driving", "lightRed", "redLight", "light_red"], ["approachingTrafficLight"]) == one


def test_unknown_words_once_each() -> None:
    assert ADVISER.advise("odd", ["x", "driving", "x"], ["y"]).unknown == ("odd", "x", "y")
