"""What the rules demand in a situation, by the set definition (design, section 3), fast.

In: a RuleBase; a situation.  Out: `Advice`: the directives with the rules behind each, must before should, then by
action name; the words that the ontology does not know.  Left to others: where situations come from, refusing words.

A situation is a whole number with one bit for each term; a rule applies iff its bits are all there and none of its
exceptions is.  Each rule is filed under one of its terms (the rarest), so that only rules that may apply are looked at.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from rotra.frontends.rules import RuleBase


@dataclass(frozen=True, slots=True)
class Advised:
    label: str
    action: str
    rules: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Advice:
    directives: tuple[Advised, ...]
    unknown: tuple[str, ...]


# (needed, forbidden, id, ranks of its directives)
_Entry = tuple[int, int, str, tuple[int, ...]]


@dataclass(frozen=True, slots=True)
class Adviser:
    """A compiled rule base.  `directives` stand in the order of advice; an entry names them by rank."""

    bits: dict[str, dict[str, int]]
    always: dict[str, tuple[_Entry, ...]]
    filed: dict[str, dict[int, tuple[_Entry, ...]]]
    directives: tuple[tuple[str, str], ...]
    order: dict[str, int]

    def advise(self, context: str, beliefs: Iterable[str], intentions: Iterable[str] = ()) -> Advice:
        """The advice of one situation; a word may be a term or an alias."""
        unknown: list[str] = []
        held, mask = [], 0
        for known, words in ((self.bits["belief"], beliefs), (self.bits["intention"], intentions)):
            for word in words:
                bit = known.get(word)
                if bit is None:
                    if word not in unknown:
                        unknown.append(word)
                elif not mask & bit:
                    mask |= bit
                    held.append(bit)
        if context not in self.always:
            unknown.insert(0, context)
        found: dict[int, list[str]] = {}
        filed = self.filed.get(context, {})
        for entries in (self.always.get(context, ()), *(filed[b] for b in held if b in filed)):
            for needed, forbidden, name, ranks in entries:
                if needed & mask == needed and not forbidden & mask:
                    for rank in ranks:
                        found.setdefault(rank, []).append(name)
        order = self.order
        return Advice(
            tuple(Advised(*self.directives[rank], tuple(sorted(found[rank], key=order.__getitem__))) for rank in sorted(found)),
            tuple(unknown),
        )


def compile(base: RuleBase) -> Adviser:
    """The adviser of a rule base."""
    bits: dict[str, dict[str, int]] = {"belief": {}, "intention": {}}
    position = 0
    for kind in ("belief", "intention"):
        for name in base.ontology.terms(kind):
            bits[kind][name] = 1 << position
            position += 1
    for (kind, word), name in base.ontology.names.items():
        if kind in bits:
            bits[kind].setdefault(word, bits[kind][name])
    rank = {label: n for n, label in enumerate(base.ontology.labels)}
    directives = sorted({(d.label, d.action) for r in base.rules for d in r.directives}, key=lambda d: (rank[d[0]], d[1]))
    place = {d: n for n, d in enumerate(directives)}
    needs = {r.id: [bits["belief"][b] for b in r.beliefs] + [bits["intention"][i] for i in r.intentions] for r in base.rules}
    common = Counter(bit for needed in needs.values() for bit in needed)
    always: dict[str, list[_Entry]] = {context: [] for context in base.ontology.contexts}
    filed: dict[str, dict[int, list[_Entry]]] = {context: {} for context in base.ontology.contexts}
    for rule in base.rules:
        needed = needs[rule.id]
        forbidden = sum({bits["belief"][b] for b in rule.unless_beliefs} | {bits["intention"][i] for i in rule.unless_intentions})
        entry = (sum(set(needed)), forbidden, rule.id, tuple(place[d.label, d.action] for d in rule.directives))
        if needed:
            filed[rule.context].setdefault(min(needed, key=lambda bit: (common[bit], bit)), []).append(entry)
        else:
            always[rule.context].append(entry)
    return Adviser(
        bits,
        {c: tuple(entries) for c, entries in always.items()},
        {c: {bit: tuple(entries) for bit, entries in table.items()} for c, table in filed.items()},
        tuple(directives),
        {rule.id: n for n, rule in enumerate(base.rules)},
    )
