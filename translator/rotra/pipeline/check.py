"""Lint a driver: what the fragment refuses, and what is allowed but surely not meant.

In: a driver, a rule base.  Out: findings, in the order of their lines.  Errors: `Rejected` where it does not even parse.
"""

from __future__ import annotations

import difflib

from rotra.diagnostics import Diagnostic, Rejected, problem
from rotra.frontends.agent import Agent, Body
from rotra.frontends.fragment import asked_literals, check_fragment
from rotra.frontends.rules import RuleBase
from rotra.frontends.scenario import instance, resolve_scenario
from rotra.frontends.terms import Struct
from rotra.lowering.mind import lower_driver
from rotra.lowering.model import senses_of
from rotra.pipeline.inputs import load_drivers, load_law, shipped_scenarios

# a lint has no scenario of the user's: no act is too long, and what is sensed is what the roads that ship show
ANY_SPEED = 99


def check_agent(agent: str, rules: str) -> tuple[Diagnostic, ...]:
    (driver,) = load_drivers([agent])
    law = load_law(rules)
    found: list[Diagnostic] = []
    try:
        check_fragment(driver.agent, ANY_SPEED)
        for road in map(resolve_scenario, shipped_scenarios()):
            if not road.is_open:
                lower_driver(driver.agent, law.advice, senses_of(instance(road, "all")))
    except Rejected as refusal:
        found += refusal.diagnostics
    found += _directives(driver.agent, law.base)
    found += _double_acts(driver.agent)
    return tuple(sorted(set(found), key=lambda d: (d.origin.file, d.origin.line, d.code)))


def _directives(agent: Agent, base: RuleBase) -> list[Diagnostic]:
    given = {(d.label, d.action) for rule in base.rules for d in rule.directives}
    actions = sorted({action for _, action in given})
    found = []
    for literal, origin in asked_literals(agent):
        if literal.name not in ("advised", "advised_next") or len(literal.args) != 2:
            continue
        label, action = literal.args
        if not isinstance(action, Struct) or action.args:
            continue
        labels = {x for x, a in given if a == action.name}
        if not labels:
            near = difflib.get_close_matches(action.name, actions, 1)
            found.append(problem("AG120", origin, f"no rule gives the directive {action.name}", f"did you mean {near[0]}?" if near else "rotra rules list shows what there is"))
        elif isinstance(label, Struct) and label.name not in labels:
            found.append(problem("AG120", origin, f"{action.name} is never a {label.name}; the rules say {', '.join(sorted(labels))}", "ask for the label that the rules give"))
    return found


def _double_acts(agent: Agent) -> list[Diagnostic]:
    """A plan on a belief event that acts beside a maintenance goal that acts: two acts in one step."""
    acting = any(_acts(p.body) for p in agent.plans if p.trigger.type == "achieve")
    return [
        problem("AG121", p.origin, f"plan {p.title} acts when a belief changes, beside the goal that drives; the second act of a step is refused as busy", "note the change as a belief, and let the goal act on it")
        for p in agent.plans
        if acting and p.trigger.type == "belief" and _acts(p.body)
    ]


def _acts(body: Body) -> bool:
    return any(s.kind == "action" for s in body)
