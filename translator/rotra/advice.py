"""What the rules demand in a situation, by the set definition (design, section 3), fast.

In: a RuleBase; a situation.  Out: `Advice`: the directives with the rules behind each, must before should, then by
action name; the words that the ontology does not know; which directives are outranked by a higher authority that asks for
the opposite (none is left out for it).  Left to others: where situations come from, refusing words.

A situation is a set of terms, each a number; a rule applies iff its terms are all there and none of its exceptions is.
Each rule is filed under one of its terms (the rarest), so that only rules that may apply are looked at.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
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


# (place in the base, id, ranks of its directives, what it needs besides the term that it is filed under, what it forbids)
_Entry = tuple[int, str, tuple[int, ...], frozenset[int], frozenset[int]]


@dataclass(frozen=True, slots=True)
class Adviser:
    """A compiled rule base.  `directives` stand in the order of advice; an entry names them by rank.  `terms`: the number
    of each belief's and each intention's term, by name and by alias.

    `authority`: rank of each rule, 0 the highest; `opposed`: the directives that cannot be heeded with one; both are empty
    where no rule states an authority.
    """

    terms: dict[str, dict[str, int]]
    always: dict[str, tuple[_Entry, ...]]
    filed: dict[str, dict[int, tuple[_Entry, ...]]]
    directives: tuple[tuple[str, str], ...]
    authority: dict[str, int]
    opposed: dict[int, tuple[int, ...]]

    def advise(self, context: str, beliefs: Iterable[str], intentions: Iterable[str] = ()) -> Advice:
        """The advice of one situation; a word may be a term or an alias."""
        unknown: list[str] = []
        held: set[int] = set()
        for known, words in ((self.terms["belief"], beliefs), (self.terms["intention"], intentions)):
            for word in words:
                term = known.get(word)
                if term is not None:
                    held.add(term)
                elif word not in unknown:
                    unknown.append(word)
        if context not in self.always:
            return Advice((), (context, *unknown))
        filed = self.filed[context]
        candidates = list(self.always[context])
        for term in held:
            if term in filed:
                candidates += filed[term]
        free = held.isdisjoint
        # An entry begins with its place: sorted, they stand in the order of the base.
        applicable = sorted([e for e in candidates if e[3] <= held and free(e[4])])
        found: dict[int, list[str]] = {}
        for _, name, ranks, _, _ in applicable:
            for rank in ranks:
                if rank in found:
                    found[rank].append(name)
                else:
                    found[rank] = [name]
        directives = self.directives
        advised = tuple([Advised(*directives[rank], tuple(found[rank])) for rank in sorted(found)])
        return Advice(advised, tuple(unknown), self._outranked(found) if self.opposed else ())

    def _outranked(self, found: dict[int, list[str]]) -> tuple[Outranked, ...]:
        marked = []
        for rank in sorted(found.keys() & self.opposed.keys()):
            best = min(self.authority[name] for name in found[rank])
            against = [name for other in self.opposed[rank] for name in found.get(other, ()) if self.authority[name] < best]
            if against:
                marked.append(Outranked(*self.directives[rank], tuple(dict.fromkeys(against))))
        return tuple(marked)


def compile(base: RuleBase) -> Adviser:
    """The adviser of a rule base."""
    terms: dict[str, dict[str, int]] = {"belief": {}, "intention": {}}
    for kind, table in terms.items():
        for name in base.ontology.terms(kind):
            table[name] = sum(map(len, terms.values()))
    for (kind, word), name in base.ontology.names.items():
        if kind in terms:
            terms[kind].setdefault(word, terms[kind][name])
    rank = {label: n for n, label in enumerate(base.ontology.labels)}
    directives = sorted({(d.label, d.action) for r in base.rules for d in r.directives}, key=lambda d: (rank[d[0]], d[1]))
    place = {d: n for n, d in enumerate(directives)}
    needs = [_numbers(terms, rule.beliefs, rule.intentions) for rule in base.rules]
    common = Counter(term for needed in needs for term in needed)
    always: dict[str, list[_Entry]] = {context: [] for context in base.ontology.contexts}
    filed: dict[str, dict[int, list[_Entry]]] = {context: {} for context in base.ontology.contexts}
    for number, (rule, needed) in enumerate(zip(base.rules, needs, strict=True)):
        under = min(needed, key=lambda term: (common[term], term)) if needed else None
        forbidden = _numbers(terms, rule.unless_beliefs, rule.unless_intentions)
        entry = (number, rule.id, tuple(place[d.label, d.action] for d in rule.directives), needed - {under}, forbidden)
        (always[rule.context] if under is None else filed[rule.context].setdefault(under, [])).append(entry)
    return Adviser(
        terms,
        {c: tuple(entries) for c, entries in always.items()},
        {c: {term: tuple(entries) for term, entries in table.items()} for c, table in filed.items()},
        tuple(directives),
        *_authorities(base, directives),
    )


def _numbers(terms: dict[str, dict[str, int]], beliefs: Iterable[str], intentions: Iterable[str]) -> frozenset[int]:
    return frozenset([terms["belief"][word] for word in beliefs] + [terms["intention"][word] for word in intentions])


def _authorities(base: RuleBase, directives: list[tuple[str, str]]) -> tuple[dict[str, int], dict[int, tuple[int, ...]]]:
    """The rank of each rule and the directives against each directive; a rule that states none has the lowest."""
    if not any(rule.authority for rule in base.rules):
        return {}, {}
    rank = {name: n for n, name in enumerate(base.ontology.authorities)}
    opposed = base.ontology.opposed()
    against = {n: tuple(m for m, (_, other) in enumerate(directives) if other in opposed.get(action, ())) for n, (_, action) in enumerate(directives)}
    return {r.id: rank.get(r.authority, len(rank) - 1) for r in base.rules}, {n: others for n, others in against.items() if others}
