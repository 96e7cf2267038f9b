"""Say rule by rule how one rule base differs from another.

    r176   changed from r176: beliefs -light_not_green +light_red; ...    why: the note of the rule

In: two rule bases by name or path, the one looked at and the one it is compared with.  Out: a row for every rule of both:
same, changed, added (only in the first) or removed (only in the second), and why, as far as a note or a table says.
Words that the aliases of either base make one are one.  Left to others: printing, and what the difference does to drivers.
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterable
from dataclasses import dataclass

from rotra.frontends.rules import KINDS, PROJECT, Rule, RuleBase, load_rule_base
from rotra.frontends.yamlfile import load_yaml

STATUSES = ("same", "changed", "added", "removed")


@dataclass(frozen=True, slots=True)
class Row:
    """`ours` and `theirs`: ids in the first and the second base, "" where it has no such rule.  `open`: the changes, of a
    rule that was removed all of it, that nothing explains."""

    status: str
    ours: str
    theirs: str
    paragraph: str
    changes: tuple[str, ...]
    why: str
    open: tuple[str, ...] = ()

    def as_json(self) -> dict[str, object]:
        return {
            "status": self.status,
            "a": self.ours or None,
            "b": self.theirs or None,
            "paragraph": self.paragraph,
            "changes": list(self.changes),
            "why": self.why,
            "not_explained": list(self.open),
        }


def diff_rules(ours: str, theirs: str) -> tuple[Row, ...]:
    return compare(load_rule_base(ours), load_rule_base(theirs))


def counts(rows: Iterable[Row]) -> dict[str, int]:
    found = Counter(row.status for row in rows)
    return {status: found[status] for status in STATUSES}


def compare(ours: RuleBase, theirs: RuleBase) -> tuple[Row, ...]:
    """The rows in the order of the first base, then what only the second has."""
    words = _Words(ours, theirs)
    pairs = _paired(ours, theirs, words)
    reasons = _Reasons(ours, theirs, words)
    rows = []
    for rule in ours.rules:
        other = pairs.get(rule.id)
        if other is None:
            rows.append(Row("added", rule.id, "", rule.paragraph, (), rule.note or rule.says))
            continue
        changes = _changes(words.content(rule), words.content(other))
        shown = tuple(str(c) for c in changes)
        note = rule.note or other.note
        found = {c: reasons.why(rule, other, c, changes) for c in changes}
        why = note or "; ".join(dict.fromkeys(w for w in found.values() if w))
        rows.append(Row("changed" if changes else "same", rule.id, other.id, rule.paragraph, shown, why if changes else "", () if note else tuple(str(c) for c, w in found.items() if not w)))
    paired = {other.id for other in pairs.values()}
    for other in theirs.rules:
        if other.id not in paired:
            why = other.note or reasons.gone(other)
            rows.append(Row("removed", "", other.id, other.paragraph, (), why, () if why else (f"rule -{other.id}",)))
    return tuple(rows)


# ---- words -----------------------------------------------------------------------------------------------------------


_Content = dict[str, frozenset[str]]


class _Words:
    """One word for all that the aliases of the two bases make one, of each kind."""

    def __init__(self, *bases: RuleBase) -> None:
        self._above: dict[tuple[str, str], tuple[str, str]] = {}
        for base in bases:
            for kind in KINDS:
                for term in base.ontology.terms(kind).values():
                    for alias in term.aliases:
                        self._above.setdefault(self._top((kind, alias)), self._top((kind, term.name)))

    def _top(self, word: tuple[str, str]) -> tuple[str, str]:
        while (above := self._above.get(word, word)) != word:
            word = above
        return word

    def one(self, kind: str, name: str) -> str:
        return self._top((kind, name))[1]

    def content(self, rule: Rule) -> _Content:
        """What a rule says, in words of both bases."""
        return {
            "context": frozenset((rule.context,)),
            "beliefs": frozenset(self.one("belief", b) for b in rule.beliefs),
            "intentions": frozenset(self.one("intention", i) for i in rule.intentions),
            "unless": frozenset(
                (*(self.one("belief", b) for b in rule.unless_beliefs), *(f"intending {self.one('intention', i)}" for i in rule.unless_intentions))
            ),
            "directives": frozenset(f"{d.label} {self.one('action', d.action)}" for d in rule.directives),
        }


@dataclass(frozen=True, slots=True)
class _Change:
    """A word that came (`+`) to or went (`-`) from a part of a rule."""

    part: str
    sign: str
    word: str

    def __str__(self) -> str:
        return f"{self.part} {self.sign}{self.word}"


def _changes(ours: _Content, theirs: _Content) -> tuple[_Change, ...]:
    return tuple(
        _Change(part, sign, word) for part, words in ours.items() for sign, some in (("-", theirs[part] - words), ("+", words - theirs[part])) for word in sorted(some)
    )


# ---- which rule is which ---------------------------------------------------------------------------------------------


def _paired(ours: RuleBase, theirs: RuleBase, words: _Words) -> dict[str, Rule]:
    """The rule of the other base that each of ours comes from: of those of its id or published name the one most like it,
    else one that says the same."""
    named: dict[str, dict[str, Rule]] = defaultdict(dict)
    for rule in theirs.rules:
        for name in (rule.id, rule.published_name):
            named[name][rule.id] = rule
    pairs = {}
    for rule in ours.rules:
        names = [n for n in (rule.id, rule.published_name) if n]
        candidates = {identity: other for name in names for identity, other in named[name].items()}
        if candidates:
            pairs[rule.id] = min(candidates.values(), key=lambda other: (_distance(words.content(rule), words.content(other)), other.id != rule.id))
    taken = {r.id for r in pairs.values()}
    alike: dict[frozenset[tuple[str, frozenset[str]]], list[Rule]] = defaultdict(list)
    for rule in theirs.rules:
        if rule.id not in taken:
            alike[frozenset(words.content(rule).items())].append(rule)
    for rule in ours.rules:
        same = alike.get(frozenset(words.content(rule).items())) if rule.id not in pairs else None
        if same:
            pairs[rule.id] = same.pop(0)
    return pairs


def _distance(one: _Content, other: _Content) -> int:
    return sum(len(one[part] ^ other[part]) for part in one)


# ---- why -------------------------------------------------------------------------------------------------------------


class _Reasons:
    """What the bases themselves say of a difference: words that are dropped, laws, exceptions, rules of the same paragraph."""

    def __init__(self, ours: RuleBase, theirs: RuleBase, words: _Words) -> None:
        self._words = words
        self._dropped = _dropped(ours)
        self._ours, self._theirs = _by_paragraph(ours), _by_paragraph(theirs)

    def why(self, rule: Rule, other: Rule, change: _Change, changes: Iterable[_Change]) -> str:
        match change.part:
            case "unless" if change.sign == "+":
                return f"{change.word}: an exception of paragraph {rule.paragraph}"
            case "beliefs" | "intentions" if change.sign == "-":
                return self._said(change.part[:-1], change.word)
            case "directives":
                return self._directive(rule, other, change, changes)
        return ""

    def _directive(self, rule: Rule, other: Rule, change: _Change, changes: Iterable[_Change]) -> str:
        action = change.word.split(" ", 1)[1]
        if any(c.part == "directives" and c.sign != change.sign and c.word.split(" ", 1)[1] == action for c in changes):
            return f"{action}: the law is {', '.join(rule.legal)}" if rule.legal else f"{action}: paragraph {rule.paragraph} names no law for it"
        if change.sign == "-":
            found = [r.id for r in self._near(self._ours, rule.paragraph, other.paragraph) if r is not rule and self._gives(r, action)]
            return f"{action}: asked for by {', '.join(found)}" if found else self._said("action", action)
        found = [r.id for r in self._near(self._theirs, rule.paragraph, other.paragraph) if r is not other and self._gives(r, action)]
        return f"{action}: there asked for by {', '.join(found)}" if found else ""

    def gone(self, rule: Rule) -> str:
        """Why a rule is no longer there: its words were dropped, or others encode its paragraph."""
        used = [*(("belief", b) for b in rule.beliefs), *(("intention", i) for i in rule.intentions), *(("action", d.action) for d in rule.directives)]
        said = [self._said(kind, word) for kind, word in dict.fromkeys(used)]
        instead = [r.id for r in self._near(self._ours, rule.paragraph)]
        return "; ".join([*(s for s in said if s), *([f"paragraph {rule.paragraph} is encoded by {', '.join(instead)}"] if instead else [])])

    def _said(self, kind: str, word: str) -> str:
        reason = self._dropped.get((kind, word), "")
        return f"{word}: {reason.rstrip('.')}" if reason else ""

    def _gives(self, rule: Rule, action: str) -> bool:
        return any(self._words.one("action", d.action) == action for d in rule.directives)

    @staticmethod
    def _near(encoded: dict[str, list[Rule]], *paragraphs: str) -> list[Rule]:
        return list({r.id: r for p in paragraphs for number in _numbers(p) for r in encoded.get(number, ())}.values())


def _dropped(base: RuleBase) -> dict[tuple[str, str], str]:
    """What the base says of words of the other that it does not take: `dropped.yaml` beside its rules."""
    file = PROJECT / base.folder / "dropped.yaml"
    if not file.is_file():
        return {}
    root = load_yaml(file)
    blocks = [(kind, root.get(f"{kind}s")) for kind in KINDS]
    return {(kind, word): str(node.value) for kind, block in blocks if block is not None for word, node in block.items()}


def _by_paragraph(base: RuleBase) -> dict[str, list[Rule]]:
    found: dict[str, list[Rule]] = defaultdict(list)
    for rule in base.rules:
        for number in _numbers(rule.paragraph):
            found[number].append(rule)
    return found


def _numbers(paragraph: str) -> list[str]:
    return re.findall(r"\w+", paragraph)
