"""Which rules say nothing in a step that they are about, and for want of what.

    forward(1) at the line, light_red believed   ->   r175a is silent: approaching_traffic_light is not intended

In: a rule base, a trace step.  Out: sentences.  Left to others: whether something is wrong at all (verify.py), whether a
directive in force was ignored (the trace says).  A rule is about a step when the act goes against one of its directives and
the car believes all that the rule asks for: only an intention, or an exception, keeps it silent.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from rotra.frontends.rules import Rule, RuleBase
from rotra.pipeline.blame import act_contradicts


def silent_rules(base: RuleBase, step: Mapping[str, Any]) -> Iterator[str]:
    """One sentence for each rule that is silent here though the act goes against what it would demand."""
    situation, act = step.get("situation") or {}, (step.get("acts") or {}).get("driver")
    if act is None:
        return
    against = {a for a in {d.action for r in base.rules for d in r.directives} if act_contradicts(base, step, act, a)}
    for rule in base.rules:
        if any(d.action in against for d in rule.directives) and set(rule.beliefs) <= set(situation.get("beliefs", ())):
            wanting = list(_wanting(rule, situation))
            if wanting:
                yield f"{rule.id} is silent: {', '.join(wanting)}"


def _wanting(rule: Rule, situation: Mapping[str, Any]) -> Iterator[str]:
    held, meant = situation.get("beliefs", ()), situation.get("intentions", ())
    if situation.get("context") != rule.context:
        yield f"the context is not {rule.context}"
    yield from (f"{word} is not intended" for word in rule.intentions if word not in meant)
    yield from (f"{word} is believed" for word in rule.unless_beliefs if word in held)
    yield from (f"{word} is intended" for word in rule.unless_intentions if word in meant)


def why_violated(base: RuleBase, steps: Sequence[Mapping[str, Any]], loop: int | None) -> str:
    """The reason of a violated row: the first directive ignored, else the rules that are silent where the path ends."""
    for step in steps:
        if step.get("ignored"):
            told = ", ".join(f"{d['label']} {d['action']}" for d in step["ignored"])
            return f"step {step['step']}: {step['acts']['driver']} ignores {told}"
    if loop is not None or not steps:
        return ""
    silent = "; ".join(silent_rules(base, steps[-1]))
    return f"step {steps[-1]['step']}: {steps[-1]['acts']['driver']} while {silent}" if silent else ""
