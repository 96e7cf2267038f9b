"""The rule base at work, as AgentSpeak rules: what a driver asks, and what is read at rest.

    advised(must,stop_at_white_line) :- context(standard) & believes(light_red) & ... .   // r175a <- rules/uk/lights.yaml:12

In: RuleBase.  Out: the text of advice.asl: intends/1, advised/2, advised_next/2, rule_of/3, contradicted/2.
Left to others: running it (agents/java) and modelling it (lowering/), which both read this one text.
Rules stand in the order of advice (label, then action, then rule), so that `advised(must, A)` answers in that order too.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from rotra.frontends.rules import Directive, Rule, RuleBase

_ATOM = re.compile(r"[a-z][A-Za-z0-9_]*")


def emit_advice(base: RuleBase) -> str:
    """The text; the same base gives the same bytes."""
    lines = [
        f"// The rule base {base.name} as AgentSpeak rules, made by the translator: change the rule base, not this file.",
        "",
        "// An intention of the ontology is held iff the driver has a goal of that name.",
        *(f"intends({i}) :- .intend({i}).  // {t.origin}" for i, t in sorted(base.ontology.intentions.items())),
        "",
        "// What the rules demand now.",
        *(_line(f"advised({_pair(d)})", _body(r, ""), r) for d, r in directives_in_order(base)),
        "",
        "// What they demand in the situation that the driver predicts.",
        *(_line(f"advised_next({_pair(d)})", _body(r, "next_"), r) for d, r in directives_in_order(base)),
        "",
        "// Which rule demands it.",
        *(_line(f"rule_of({_text(r.id)},{_pair(d)})", _body(r, ""), r) for d, r in directives_in_order(base)),
        "",
        "// What goes against an action.",
        *_contradictions(base),
    ]
    return "\n".join(lines) + "\n"


def directives_in_order(base: RuleBase) -> list[tuple[Directive, Rule]]:
    """Each directive of each rule: by rank of the label, then by action, then by the rule's place in the base."""
    rank = {label: n for n, label in enumerate(base.ontology.labels)}
    every = [(d, n, r) for n, r in enumerate(base.rules) for d in r.directives]
    return [(d, r) for d, _, r in sorted(every, key=lambda e: (rank[e[0].label], e[0].action, e[1]))]


def _line(head: str, body: str, rule: Rule) -> str:
    return f"{head} :- {body}.  // {rule.id} <- {rule.origin.file}:{rule.origin.line}"


def _body(rule: Rule, prefix: str) -> str:
    return " & ".join(
        [
            f"{prefix}context({rule.context})",
            *(f"{prefix}believes({b})" for b in rule.beliefs),
            *(f"{prefix}intends({i})" for i in rule.intentions),
            *(f"not {prefix}believes({b})" for b in rule.unless_beliefs),
            *(f"not {prefix}intends({i})" for i in rule.unless_intentions),
        ]
    )


def _contradictions(base: RuleBase) -> Iterator[str]:
    for meaning in base.meanings:
        for against in meaning.contradicted_by:
            act = re.sub(r"\s+", "", against.act).replace(",", ", ")
            conditions = [f"({part})" if "|" in part else part for part in (against.when.strip(), against.where.strip()) if part]
            where = f"  // {meaning.action} <- {against.origin.file}:{against.origin.line}"
            yield f"contradicted({_atom(meaning.action)}, {act}) :- {' & '.join(conditions) or 'true'}.{where}"


def _pair(directive: Directive) -> str:
    return f"{directive.label},{_atom(directive.action)}"


def _atom(name: str) -> str:
    """An atom where AgentSpeak has one of that form; else a string (an imported action may hold a hyphen)."""
    return name if _ATOM.fullmatch(name) else _text(name)


def _text(value: str) -> str:
    return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
