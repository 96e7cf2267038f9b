"""What becomes of every paragraph of the source: the rules that encode it, or why none does.

    rules:          paragraph: 113, 226                    113  implemented    r113a, r113b, r113c
    coverage.yaml:  {paragraphs: 1-6, ...}          ->     1    not_for_a_car  General guidance for people on foot.

In: a rule base by name or path, with `coverage.yaml` beside its rules or without.  Out: a `Paragraph` each, in order; the
same as Markdown.  Errors: IO103 a table of the wrong shape, RB130 a paragraph that is disposed of twice, as `Rejected`.
Left to others: reading the rules (frontends/rules.py), printing (cli.py).
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from rotra.diagnostics import Diagnostic, Rejected, problem
from rotra.frontends.rules import RULES, load_rule_base, shipped_rule_bases
from rotra.frontends.yamlfile import Node, load_yaml

IMPLEMENTED, MISSING = "implemented", "missing"
DISPOSITIONS = ("not_for_a_car", "not_for_an_automated_driver", "definition")
_RANGE = re.compile(r"([A-Za-z]*)(\d+)\s*-\s*([A-Za-z]*)(\d+)")


@dataclass(frozen=True, slots=True)
class Paragraph:
    """`disposition`: implemented (by `rules`), one of DISPOSITIONS (because of `reason`), or missing."""

    paragraph: str
    disposition: str
    rules: tuple[str, ...] = ()
    reason: str = ""

    def as_json(self) -> dict[str, Any]:
        return {**asdict(self), "rules": list(self.rules)}


def coverage(rules: str) -> tuple[Paragraph, ...]:
    """Every paragraph of the source; without a table, those that rules encode."""
    encoded: dict[str, list[str]] = {}
    for rule in load_rule_base(rules).rules:
        for name in paragraphs(rule.paragraph):
            encoded.setdefault(name, []).append(rule.id)
    table = _folder(rules) / "coverage.yaml"
    everything, disposed = _read(table, encoded) if table.is_file() else ((), {})
    names = dict.fromkeys([*everything, *sorted(encoded, key=_order)])
    return tuple(_paragraph(name, encoded.get(name, ()), disposed.get(name)) for name in names)


def paragraphs(text: str) -> tuple[str, ...]:
    """The paragraphs that a text names: `113, 226` or `H1-H3, 1-307`."""
    found: list[str] = []
    for part in (p.strip() for p in text.split(",")):
        span = _RANGE.fullmatch(part)
        if span and span[1] == span[3]:
            found += [f"{span[1]}{n}" for n in range(int(span[2]), int(span[4]) + 1)]
        elif part:
            found.append(part)
    return tuple(found)


def as_markdown(found: Sequence[Paragraph]) -> str:
    """The table of a README: neighbours without rules that share a reason in one row."""
    rows = [f"| {' to '.join(dict.fromkeys((first.paragraph, last.paragraph)))} | {_said(first)} |" for first, last in _runs(found)]
    return "\n".join(["| paragraph | rules, or why there are none |", "|---|---|", *rows]) + "\n"


def _said(found: Paragraph) -> str:
    if found.rules:
        return ", ".join(f"`{r}`" for r in found.rules)
    return f"{found.disposition.replace('_', ' ')}: {found.reason}" if found.reason else found.disposition


def _runs(found: Sequence[Paragraph]) -> Iterator[tuple[Paragraph, Paragraph]]:
    """First and last of neighbours that are disposed of together."""
    start = 0
    for at in range(1, len(found) + 1):
        together = (
            at < len(found) and found[at].reason and (found[at].disposition, found[at].reason) == (found[start].disposition, found[start].reason)
        )
        if not together:
            yield found[start], found[at - 1]
            start = at


def _paragraph(name: str, rules: Sequence[str], disposed: tuple[str, str] | None) -> Paragraph:
    if rules:
        return Paragraph(name, IMPLEMENTED, tuple(rules))
    return Paragraph(name, *((disposed[0], (), disposed[1]) if disposed else (MISSING,)))


def _order(name: str) -> tuple[str, int, str]:
    """H3 before 1, 9 before 10, 240 before 240a."""
    match = re.match(r"(\D*)(\d*)(.*)", name)
    assert match
    return ("" if match[1] else "~", int(match[2] or 0), name)


def _folder(rules: str) -> Path:
    path = RULES / rules if rules in shipped_rule_bases() else Path(rules)
    return path if path.is_dir() else path.parent


def _read(file: Path, encoded: dict[str, list[str]]) -> tuple[tuple[str, ...], dict[str, tuple[str, str]]]:
    """All paragraphs of the source, and the disposition and reason of those that no rule encodes."""
    root = load_yaml(file)
    findings = list(_shape(root))
    if findings:
        raise Rejected(findings)
    disposed: dict[str, tuple[str, str]] = {}
    for node in root.get("without_rules") or ():
        for name in paragraphs(str(node.at("paragraphs").value)):
            if name in encoded or name in disposed:
                other = f"rules encode it ({', '.join(encoded[name])})" if name in encoded else "it stands above already"
                findings.append(problem("RB130", node.origin(), f"paragraph {name} is disposed of here, but {other}", "keep one of the two"))
            disposed[name] = (str(node.at("disposition").value), str(node.at("reason").value))
    if findings:
        raise Rejected(findings)
    return paragraphs(str(root.at("paragraphs").value)), disposed


def _shape(root: Node) -> Iterator[Diagnostic]:
    hint = "see rules/uk/coverage.yaml: `paragraphs: 1-307`, and under `without_rules` paragraphs, disposition and reason"
    if not _is_text(root.get("paragraphs")):
        yield problem("IO103", root.origin(), "the table does not say which paragraphs there are", hint)
    for node in root.get("without_rules") or ():
        missing = [key for key in ("paragraphs", "disposition", "reason") if not _is_text(node.get(key))]
        if missing:
            yield problem("IO103", node.origin(), f"{' and '.join(missing)} is missing here", hint)
        elif node.at("disposition").value not in DISPOSITIONS:
            yield problem(
                "IO103", node.origin(), f"{node.at('disposition').value!r} is no disposition", f"dispositions are {', '.join(DISPOSITIONS)}"
            )


def _is_text(node: Node | None) -> bool:
    return node is not None and isinstance(node.value, str | int)
