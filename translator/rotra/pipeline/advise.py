"""Ask the adviser: one situation from the command line, or one a line from a file.

In: a rule base by name or path, situations.  Out: answers as plain data, ready for JSON.  Left to others: printing.
Errors: RB112 a word unknown under `strict`; a line that cannot be read answers `{"error": ...}` in its place.
"""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from rotra.advice import Advice, Adviser, compile
from rotra.diagnostics import Rejected, problem
from rotra.frontends.rules import RuleBase, load_rule_base
from rotra.origins import Origin


def advise_one(rules: str, context: str, beliefs: Iterable[str], intentions: Iterable[str], strict: bool = False) -> dict[str, Any]:
    base = load_rule_base(rules)
    advice = compile(base).advise(context, beliefs, intentions)
    if strict and advice.unknown:
        raise Rejected(
            [problem("RB112", Origin("situation"), f"{word!r} is not a word of this rule base", _near(base, word)) for word in advice.unknown]
        )
    return answer(advice)


def advise_lines(rules: str, source: Path, strict: bool = False) -> Iterator[dict[str, Any]]:
    """One answer a line of the file, empty lines left out."""
    adviser = compile(load_rule_base(rules))
    try:
        lines = source.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "not UTF-8 text"
        raise Rejected([problem("IO100", Origin(str(source)), f"cannot read the file: {reason}", "check the path")]) from error
    return (_line(adviser, line, f"{source}:{number}", strict) for number, line in enumerate(lines, 1) if line.strip())


def answer(advice: Advice) -> dict[str, Any]:
    by = {(o.label, o.action): {"outranked_by": list(o.by)} for o in advice.outranked}
    return {
        "directives": [{"label": d.label, "action": d.action, "rules": list(d.rules)} | by.get((d.label, d.action), {}) for d in advice.directives],
        "unknown": list(advice.unknown),
    }


def _line(adviser: Adviser, line: str, place: str, strict: bool) -> dict[str, Any]:
    def wrong(what: str) -> dict[str, Any]:
        return {"error": f"{place}: RB114 {what}"}

    try:
        situation = json.loads(line)
    except (ValueError, RecursionError) as error:
        return wrong(f"not JSON: {error}")
    if not isinstance(situation, dict):
        return wrong("a situation is an object with context, beliefs, intentions")
    context = situation.get("context", "standard")
    words = [situation.get(key, []) for key in ("beliefs", "intentions")]
    if not isinstance(context, str):
        return wrong("context is not a text")
    if not all(isinstance(w, list) and all(isinstance(x, str) for x in w) for w in words):
        return wrong("beliefs and intentions are lists of texts")
    advice = adviser.advise(context, *words)
    if strict and advice.unknown:
        return wrong(f"unknown: {', '.join(advice.unknown)}")
    return answer(advice)


def _near(base: RuleBase, word: str) -> str:
    near = difflib.get_close_matches(word, [*base.ontology.contexts, *(n for kind, n in base.ontology.names if kind != "action")], 1)
    return f"did you mean {near[0]}?" if near else "the ontology of the rule base lists the words; without --strict it is left out"
