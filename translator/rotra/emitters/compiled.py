"""Write a rule base compiled for an adviser in another language: words and directives as numbers, nothing to resolve.

In: RuleBase.  Out: the JSON text that `rotra.advice.Adviser.compile` (agents/java) reads; the same base gives the same bytes:

    {"contexts": [..], "beliefs": {word: term}, "intentions": {word: term}, "directives": [[label, action], ..],
     "opposed": [[directive, ..], ..],
     "rules": [{"id", "context", "needs": [term, ..], "unless": [term, ..], "gives": [directive, ..], "authority": rank}]}

A word is a term or an alias; a directive is named by its place in `directives`, which is the order of advice; `opposed` has
for each directive those that cannot be heeded with it, and is empty where no rule states an authority.
Left to others: answering.
"""

from __future__ import annotations

import json
from typing import Any

from rotra.advice import Adviser, compile
from rotra.frontends.rules import Rule, RuleBase


def emit_compiled(base: RuleBase) -> str:
    adviser = compile(base)
    place = {directive: number for number, directive in enumerate(adviser.directives)}
    document = {
        "rule_base": base.name,
        "contexts": list(base.ontology.contexts),
        **{f"{kind}s": numbers for kind, numbers in adviser.terms.items()},
        "directives": adviser.directives,
        "opposed": [adviser.opposed.get(number, ()) for number in range(len(adviser.directives))] if adviser.opposed else [],
        "rules": [_rule(rule, adviser, place) for rule in base.rules],
    }
    return json.dumps(document, indent=None, separators=(",", ":"), sort_keys=True) + "\n"


def _rule(rule: Rule, adviser: Adviser, place: dict[tuple[str, str], int]) -> dict[str, Any]:
    beliefs, intentions = adviser.terms["belief"], adviser.terms["intention"]
    return {
        "id": rule.id,
        "context": rule.context,
        "needs": _numbers(beliefs, rule.beliefs) + _numbers(intentions, rule.intentions),
        "unless": _numbers(beliefs, rule.unless_beliefs) + _numbers(intentions, rule.unless_intentions),
        "gives": [place[d.label, d.action] for d in rule.directives],
        "authority": adviser.authority.get(rule.id, 0),
    }


def _numbers(terms: dict[str, int], words: tuple[str, ...]) -> list[int]:
    return sorted({terms[word] for word in words})
