"""Which verdicts of the catalogue change from one rule base to another, and why.

In: two rule bases, the drivers and scenarios to prove.  Out: a `Flip` for each verdict that differs.  Left to others: the proofs
(campaign.py), which rules differ (rules_diff.py).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from rotra.pipeline.campaign import Result, Wanted, run_campaign


@dataclass(frozen=True, slots=True)
class Flip:
    """`ours` and `theirs`: the verdict under each base; `why`: the reason of the one that does not hold."""

    agent: str
    scenario: str
    property: str
    ours: str
    theirs: str
    why: str

    def as_json(self) -> dict[str, str]:
        return {k: getattr(self, k) for k in self.__slots__}


def flipped_verdicts(ours: str, theirs: str, agents: tuple[str, ...], scenarios: tuple[str, ...], on_done: Callable[[str, int, int], None]) -> tuple[Flip, ...]:
    """Proved over all instances, with the shipped catalogue.  Errors: `Rejected` as `rotra verify`."""
    wanted = Wanted(agents, scenarios, (), (), "all", ours, None, 2, 600.0)
    one, other = (run_campaign(replace(wanted, rules=rules), on_done) for rules in (ours, theirs))
    there = _by_question(other)
    return tuple(
        Flip(row.agent, row.scenario, row.property, row.verdict, there[key].verdict, there[key].reason or row.reason)
        for key, row in _by_question(one).items()
        if key in there and there[key].verdict != row.verdict
    )


def _by_question(result: Result) -> dict[tuple[str, str, str], Any]:
    return {(row.agent, row.scenario, row.property): row for row in result.rows}
