"""What the rules demand in a situation, by the set definition (design, section 3), fast.

In: a RuleBase; a situation.  Out: `Advice`: the directives with the rules behind each, must before should, then by
action name; the words that the ontology does not know; which directives are outranked by a higher authority that asks for
the opposite (none is left out for it).  Left to others: where situations come from, refusing words.

A situation is a whole number with one bit for each term; a rule applies iff its bits are all there and none of its
exceptions is.  Each rule is filed under one of its terms (the rarest), so that only rules that may apply are looked at.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from operator import itemgetter
from typing import NamedTuple

from rotra.frontends.rules import RuleBase


class Advised(NamedTuple):
    label: str
    action: str
    rules: tuple[str, ...]


class Outranked(NamedTuple):
    """A directive of the advice that the rules `by`, of a higher authority, contradict."""

    label: str
    action: str
    by: tuple[str, ...]


class Advice(NamedTuple):
    directives: tuple[Advised, ...]
    unknown: tuple[str, ...]
    outranked: tuple[Outranked, ...] = ()


# (needed, forbidden, place in the base, id, ranks of its directives)
_Entry = tuple[int, int, int, str, tuple[int, ...]]
_place = itemgetter(2)


@dataclass(frozen=True, slots=True)
class Adviser:
    """A compiled rule base.  `directives` stand in the order of advice; an entry names them by rank.

    `authority`: rank of each rule, 0 the highest; `opposed`: the directives that cannot be heeded with one; both are empty
    where no rule states an authority.
    """

    bits: dict[str, dict[str, int]]
    always: dict[str, tuple[_Entry, ...]]
    filed: dict[str, dict[int, tuple[_Entry, ...]]]
    directives: tuple[tuple[str, str], ...]
    authority: dict[str, int]
    opposed: dict[int, tuple[int, ...]]

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
        filed = self.filed.get(context, {})
        candidates = list(self.always.get(context, ()))
        for bit in held:
            candidates += filed.get(bit, ())
        applicable = [e for e in candidates if e[0] & mask == e[0] and not e[1] & mask]
        applicable.sort(key=_place)
        found: dict[int, tuple[str, ...]] = {}
        for _, _, _, name, ranks in applicable:
            for rank in ranks:
                found[rank] = (*found[rank], name) if rank in found else (name,)
        directives = self.directives
        advised = tuple([Advised(*directives[rank], found[rank]) for rank in sorted(found)])
        return Advice(advised, tuple(unknown), self._outranked(found) if self.opposed else ())

    def _outranked(self, found: dict[int, tuple[str, ...]]) -> tuple[Outranked, ...]:
        marked = []
        for rank in sorted(found):
            best = min(self.authority[name] for name in found[rank])
            against = [name for other in self.opposed.get(rank, ()) for name in found.get(other, ()) if self.authority[name] < best]
            if against:
                marked.append(Outranked(*self.directives[rank], tuple(dict.fromkeys(against))))
        return tuple(marked)


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
    for number, rule in enumerate(base.rules):
        needed = needs[rule.id]
        forbidden = sum({bits["belief"][b] for b in rule.unless_beliefs} | {bits["intention"][i] for i in rule.unless_intentions})
        entry = (sum(set(needed)), forbidden, number, rule.id, tuple(place[d.label, d.action] for d in rule.directives))
        if needed:
            filed[rule.context].setdefault(min(needed, key=lambda bit: (common[bit], bit)), []).append(entry)
        else:
            always[rule.context].append(entry)
    return Adviser(
        bits,
        {c: tuple(entries) for c, entries in always.items()},
        {c: {bit: tuple(entries) for bit, entries in table.items()} for c, table in filed.items()},
        tuple(directives),
        *_authorities(base, directives),
    )


def _authorities(base: RuleBase, directives: list[tuple[str, str]]) -> tuple[dict[str, int], dict[int, tuple[int, ...]]]:
    """The rank of each rule and the directives against each directive; a rule that states none has the lowest."""
    if not any(rule.authority for rule in base.rules):
        return {}, {}
    rank = {name: n for n, name in enumerate(base.ontology.authorities)}
    opposed = base.ontology.opposed()
    against = {n: tuple(m for m, (_, other) in enumerate(directives) if other in opposed.get(action, ())) for n, (_, action) in enumerate(directives)}
    return {r.id: rank.get(r.authority, len(rank) - 1) for r in base.rules}, {n: others for n, others in against.items() if others}
