"""Which act would have been right."""

from __future__ import annotations

import pytest

from rotra.frontends.rules import Contradiction, Meaning, Ontology, RuleBase
from rotra.frontends.terms import parse_ground
from rotra.origins import Origin
from rotra.pipeline.blame import better_act, contradicts

HERE = Origin("directives.yaml", 1)


def against(act: str, when: str = "", where: str = "") -> Contradiction:
    return Contradiction(act, when, where, HERE)


@pytest.mark.parametrize(
    ("act", "when", "where", "done", "percepts", "answer"),
    [
        ("forward(N)", "stop_line(0, A)", "N > A", "forward(1)", ["stop_line(0,0)"], True),
        ("forward(N)", "stop_line(0, A)", "N > A", "forward(1)", ["stop_line(0,1)"], False),
        ("forward(N)", "stop_line(0, A)", "N > A", "wait", ["stop_line(0,0)"], False),
        ("forward(N)", "stop_line(0, A) & A >= 0 & not car(0, A + 1)", "", "forward(1)", ["stop_line(0,0)", "car(0,1)"], False),
        ("turn(right, _)", "", "", "turn(right,2)", [], True),
        ("turn(_, _)", "car(1, A) & (A == 0 | A == 1)", "", "turn(right,2)", ["car(1,1)"], True),
        ("turn(_, _)", "car(1, A) & (A == 0 | A == 1)", "", "turn(right,2)", ["car(1,2)"], False),
        ("forward(N)", "limit(L)", "(N + 1) * 2 > L", "forward(1)", ["limit(3)"], True),
        ("wait", "not stop_line(0, _) & speed(0)", "", "wait", ["speed(0)"], True),
        ("wait", "car(-1, X) & X = 0 - 1", "", "wait", ["car(-1,-1)"], True),
    ],
)
def test_contradicts(act: str, when: str, where: str, done: str, percepts: list[str], answer: bool) -> None:
    assert contradicts(done, [against(act, when, where)], [parse_ground(p) for p in percepts]) is answer


def base(**meanings: Contradiction) -> RuleBase:
    ontology = Ontology({"standard": ""}, {"must": "", "should": ""}, {}, {}, {}, {})
    return RuleBase("test", "", ontology, (), tuple(Meaning(a, (c,), "", "", HERE) for a, c in meanings.items()))


def test_the_better_act_breaks_no_must() -> None:
    better = better_act(base(go=against("wait"), stop=against("forward(N)", "", "N > 1")))
    step = {"percepts": ["road(0,1,ahead)", "road(0,2,ahead)", "limit(2)"], "advice": [{"label": "should", "action": "go"}, {"label": "must", "action": "stop"}]}
    assert better(step, "stop") == "forward(1)"
    assert better(step, "go") == "forward(1)"


def test_never_into_a_car_and_none_where_nothing_is_known() -> None:
    better = better_act(base(go=against("wait")))
    assert better({"percepts": ["road(0,1,ahead)", "car(0,1)", "limit(1)"], "advice": []}, "go") is None
    assert better({"percepts": []}, "be_kind") is None
