"""Look at a rule base: every rule in a line, or one of them whole.

In: a rule base by name or path.  Out: plain data, ready for JSON or a table.  Errors: RB113 no such rule.
"""

from __future__ import annotations

import difflib
from typing import Any

from rotra.diagnostics import Rejected, problem
from rotra.frontends.rules import load_rule_base
from rotra.origins import Origin


def list_rules(rules: str) -> list[dict[str, Any]]:
    base = load_rule_base(rules)
    return [
        {"id": r.id, "paragraph": r.paragraph, "says": r.says, "section": r.section, "directives": [str(d) for d in r.directives]} for r in base.rules
    ]


def show_rule(rules: str, identity: str) -> dict[str, Any]:
    base = load_rule_base(rules)
    rule = base.rule(identity)
    if rule is None:
        near = difflib.get_close_matches(identity, [r.id for r in base.rules], 1)
        raise Rejected(
            [
                problem(
                    "RB113",
                    Origin(rules),
                    f"there is no rule {identity!r}",
                    f"did you mean {near[0]}?" if near else "rotra rules list shows what there is",
                )
            ]
        )
    return {
        "id": rule.id,
        "paragraph": rule.paragraph,
        "section": rule.section,
        "says": rule.says,
        "context": rule.context,
        "beliefs": list(rule.beliefs),
        "intentions": list(rule.intentions),
        "unless": [*rule.unless_beliefs, *rule.unless_intentions],
        "directives": [str(d) for d in rule.directives],
        "legal": list(rule.legal),
        "published_name": rule.published_name,
        "authority": rule.authority,
        "note": rule.note,
        "accept": [f"{a.finding} {a.other}".strip() + f": {a.reason}" for a in rule.accept],
        "place": f"{rule.origin.file}:{rule.origin.line}",
    }
