"""Find what is wrong with a rule base, over all situations that the exclusions of its ontology allow.

    conflict: r106 (must safe_pull_over_and_stop) and r271a (must avoid_stopping), first in [motorway, police_behind]

In: RuleBase.  Out: findings, each with its rules, a smallest situation where it shows, and the reason where its author
accepts it.  Errors: RB126 for an acceptance of something that is not found.  Left to others: printing (cli.py).

Every answer is proved by a SAT solver.  Exclusions and `unless` only ever forbid words, so the words that some rules need
are a situation for them if they have one at all, and no smaller one will do: that is the minimal situation.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import combinations

from pysat.solvers import Solver

from rotra.diagnostics import Diagnostic, Rejected, problem
from rotra.frontends.rules import KINDS, Acceptance, Directive, Rule, RuleBase, load_rule_base
from rotra.lowering.situation import exclusions

CODES = ("duplicate-name", "never-applicable", "identical", "subsumed", "unused-term", "conflict", "must-and-should", "empty-context")


@dataclass(frozen=True, slots=True)
class Situation:
    context: str
    beliefs: tuple[str, ...]
    intentions: tuple[str, ...]

    def __str__(self) -> str:
        words = [*self.beliefs, *(f"intending {i}" for i in self.intentions)]
        return f"{self.context}: {', '.join(words) or 'nothing believed or intended'}"


@dataclass(frozen=True, slots=True)
class Finding:
    """`words`: the terms, directives or context it is about.  `accepted`: why it stays as it is, "" where nobody says."""

    code: str
    rules: tuple[str, ...]
    words: tuple[str, ...]
    says: str
    situation: Situation | None = None
    accepted: str = ""

    def as_json(self) -> dict[str, object]:
        situation = self.situation and {"context": self.situation.context, "beliefs": list(self.situation.beliefs), "intentions": list(self.situation.intentions)}
        return {
            "code": self.code,
            "rules": list(self.rules),
            "words": list(self.words),
            "says": self.says,
            "situation": situation,
            "accepted": bool(self.accepted),
            "reason": self.accepted,
        }


def check_rules(rules: str) -> tuple[Finding, ...]:
    return find(load_rule_base(rules))


def find(base: RuleBase) -> tuple[Finding, ...]:
    """All findings, by code and then by the rules' places."""
    with Situations(base) as situations:
        dead = {r.id for r in base.rules if not situations.possible(r)}
        alive = [r for r in base.rules if r.id not in dead]
        same = list(_identical(alive, situations))
        found = [
            *_duplicate_names(base),
            *(_never(r, situations) for r in base.rules if r.id in dead),
            *same,
            *_subsumed(alive, {r for f in same for r in f.rules[1:]}, {frozenset(f.rules) for f in same}, situations),
            *_unused(base),
            *_conflicts(base, alive, situations),
            *_both_labels(base, alive, situations),
            *_empty_contexts(base, alive),
        ]
    return _accept(base, found)


def summed_up(found: Iterable[Finding]) -> list[tuple[Finding, int]]:
    """The findings that nobody accepts; of those about the same words, the one with the smallest situation, and their number."""
    alike: dict[tuple[str, tuple[str, ...] | Finding], list[Finding]] = defaultdict(list)
    for finding in found:
        if not finding.accepted:
            alike[finding.code, finding.words if finding.code == "conflict" else finding].append(finding)
    return [(min(fs, key=lambda f: len(str(f.situation))), len(fs)) for fs in alike.values()]


# ---- all situations --------------------------------------------------------------------------------------------------


class Situations:
    """Every situation that the exclusions allow, as clauses: a variable for each context, term and rule."""

    def __init__(self, base: RuleBase) -> None:
        self.base = base
        self._number: dict[tuple[str, str], int] = {}
        self._rule: dict[int, str] = {}
        self._solver = Solver(name="minisat22")
        contexts = [self._of("context", c) for c in base.ontology.contexts]
        self._solver.add_clause(contexts)
        for a, b in combinations(contexts, 2):
            self._solver.add_clause([-a, -b])
        self.excluded = exclusions(base)
        for kind, one, other in self.excluded:
            self._solver.add_clause([-self._of(kind, one), -self._of(kind, other)])
        for rule in base.rules:
            self._define(rule)

    def __enter__(self) -> Situations:
        return self

    def __exit__(self, *_: object) -> None:
        self._solver.delete()

    def _of(self, kind: str, name: str) -> int:
        return self._number.setdefault((kind, name), len(self._number) + 1)

    def _define(self, rule: Rule) -> None:
        """The variable of a rule holds iff the rule applies."""
        parts = [self._of("context", rule.context)]
        for kind, needed, forbidden in (("belief", rule.beliefs, rule.unless_beliefs), ("intention", rule.intentions, rule.unless_intentions)):
            parts += [self._of(kind, w) for w in needed]
            parts += [-self._of(kind, w) for w in forbidden]
        whole = self._of("rule", rule.id)
        self._rule[whole] = rule.id
        for part in parts:
            self._solver.add_clause([-whole, part])
        self._solver.add_clause([whole, *(-p for p in parts)])

    def possible(self, *rules: Rule) -> bool:
        """Is there a situation in which all of them apply?"""
        return bool(self._solver.solve([self._of("rule", r.id) for r in rules]))

    def covered(self, rule: Rule, by: Iterable[Rule]) -> tuple[str, ...] | None:
        """Rules of `by`, enough of them that one applies wherever `rule` does; None where there are none."""
        if self._solver.solve([self._of("rule", rule.id), *(-self._of("rule", r.id) for r in by)]):
            return None
        needed = {-literal for literal in self._solver.get_core() or ()}
        return tuple(self._rule[n] for n in sorted(needed) if n in self._rule)

    def smallest(self, *rules: Rule) -> Situation | None:
        """The smallest situation in which all of them apply; None where there is none."""
        if not self.possible(*rules):
            return None
        beliefs = dict.fromkeys(b for r in rules for b in r.beliefs)
        intentions = dict.fromkeys(i for r in rules for i in r.intentions)
        return Situation(rules[0].context, tuple(beliefs), tuple(intentions))


# ---- findings about rules --------------------------------------------------------------------------------------------


def _duplicate_names(base: RuleBase) -> Iterator[Finding]:
    """Names that stand for several rules where the base comes from: only an import has another name than its id."""
    if not base.ontology.imported_from:
        return
    named: dict[str, list[Rule]] = defaultdict(list)
    for rule in base.rules:
        named[rule.published_name or rule.id].append(rule)
    for name, rules in named.items():
        if len(rules) > 1:
            ids = tuple(r.id for r in rules)
            yield Finding("duplicate-name", ids, (name,), f"the name {name} stands for {len(rules)} rules")


def _never(rule: Rule, situations: Situations) -> Finding:
    needs = {("belief", b) for b in rule.beliefs} | {("intention", i) for i in rule.intentions}
    both = sorted({w for k, w in needs & {("belief", b) for b in rule.unless_beliefs} | needs & {("intention", i) for i in rule.unless_intentions}})
    pairs = [(a, b) for kind, a, b in situations.excluded if (kind, a) in needs and (kind, b) in needs]
    why = [f"{a} and {b} exclude each other" for a, b in pairs] + [f"{w} is asked for and an exception" for w in both]
    return Finding("never-applicable", (rule.id,), tuple(sorted({w for p in pairs for w in p} | set(both))), f"{rule.id} can never apply: {'; '.join(why)}")


def _identical(alive: list[Rule], situations: Situations) -> Iterator[Finding]:
    """Pairs that apply in the same situations and ask for the same."""
    alike: dict[tuple[str, frozenset[Directive]], list[Rule]] = defaultdict(list)
    for rule in alive:
        alike[rule.context, frozenset(rule.directives)].append(rule)
    for rules in alike.values():
        for a, b in combinations(rules, 2):
            if situations.covered(a, [b]) is not None and situations.covered(b, [a]) is not None:
                says = f"{a.id} and {b.id} apply in the same situations and ask for the same"
                yield Finding("identical", (a.id, b.id), _words(a.directives), says, situations.smallest(a))


def _subsumed(alive: list[Rule], repeated: set[str], identical: set[frozenset[str]], situations: Situations) -> Iterator[Finding]:
    """Rules without which the advice is the same in every situation: for one other rule, else for several together."""
    giving: dict[Directive, list[Rule]] = defaultdict(list)
    for rule in alive:
        for directive in rule.directives:
            giving[directive].append(rule)
    place = {r.id: n for n, r in enumerate(alive)}
    for rule in alive:
        asked = set(rule.directives)
        others = [o for o in giving[rule.directives[0]] if o is not rule and o.context == rule.context]
        single = [o for o in others if asked <= set(o.directives) and situations.covered(rule, [o]) is not None]
        for other in single:
            if frozenset((rule.id, other.id)) not in identical:
                yield Finding("subsumed", (rule.id, other.id), _words(rule.directives), f"{other.id} asks for all of {rule.id} wherever {rule.id} applies", situations.smallest(rule))
        if single or rule.id in repeated:
            continue
        covers = [situations.covered(rule, [o for o in giving[d] if o is not rule]) for d in rule.directives]
        if all(c is not None for c in covers):
            by = sorted({name for c in covers for name in c or ()} - {rule.id}, key=place.__getitem__)
            yield Finding("subsumed", (rule.id, *by), _words(rule.directives), f"{', '.join(by)} together ask for all of {rule.id} wherever {rule.id} applies", situations.smallest(rule))


def _conflicts(base: RuleBase, alive: list[Rule], situations: Situations) -> Iterator[Finding]:
    """Two directives in force that cannot both be heeded."""
    against = base.ontology.opposed()
    giving: dict[str, list[tuple[int, Directive, Rule]]] = defaultdict(list)
    for number, rule in enumerate(alive):
        for directive in rule.directives:
            giving[directive.action].append((number, directive, rule))
    found = []
    for action, others in against.items():
        for other in others:
            if action < other:
                found += [(a, b) if a[0] <= b[0] else (b, a) for a in giving[action] for b in giving[other]]
    for (_, first, a), (_, second, b) in sorted(found, key=lambda pair: (pair[0][0], pair[1][0], pair[0][1], pair[1][1])):
        situation = situations.smallest(a, b)
        if situation is not None:
            says = f"{a.id} says {first}, {b.id} says {second}" if a is not b else f"{a.id} says both {first} and {second}"
            yield Finding("conflict", (a.id,) if a is b else (a.id, b.id), (str(first), str(second)), says, situation, _ranked(base, a, b))


def _ranked(base: RuleBase, a: Rule, b: Rule) -> str:
    """Why a conflict is settled, where one of the two has the higher authority."""
    rank = list(base.ontology.authorities)
    if not rank:
        return ""
    first, second = (rank.index(r.authority or rank[-1]) for r in (a, b))
    if first == second:
        return ""
    strong, weak = (a, b) if first < second else (b, a)
    return f"{strong.id} ({strong.authority}) outranks {weak.id} ({weak.authority or rank[-1]})"


def _both_labels(base: RuleBase, alive: list[Rule], situations: Situations) -> Iterator[Finding]:
    """Actions that are a must and a should at once, each in the smallest situation in which it is."""
    giving: dict[str, list[tuple[str, Rule]]] = defaultdict(list)
    for rule in alive:
        for d in rule.directives:
            giving[d.action].append((d.label, rule))
    for action, given in giving.items():
        both = [(s, first, a, second, b) for (first, a), (second, b) in combinations(given, 2) if first != second and (s := situations.smallest(a, b))]
        if both:
            situation, first, a, second, b = min(both, key=lambda found: len(found[0].beliefs) + len(found[0].intentions))
            says = f"{action} is a {first} ({a.id}) and a {second} ({b.id}) at once"
            yield Finding("must-and-should", (a.id,) if a is b else (a.id, b.id), (action,), says, situation)


# ---- findings about words --------------------------------------------------------------------------------------------


def _unused(base: RuleBase) -> Iterator[Finding]:
    used = {("belief", w) for r in base.rules for w in (*r.beliefs, *r.unless_beliefs)}
    used |= {("intention", w) for r in base.rules for w in (*r.intentions, *r.unless_intentions)}
    used |= {("action", d.action) for r in base.rules for d in r.directives}
    for kind in KINDS:
        for name in base.ontology.terms(kind):
            if (kind, name) not in used:
                yield Finding("unused-term", (), (name,), f"no rule uses the {kind} {name}")


def _empty_contexts(base: RuleBase, alive: list[Rule]) -> Iterator[Finding]:
    for context in base.ontology.contexts:
        if not any(r.context == context for r in alive):
            yield Finding("empty-context", (), (context,), f"no rule applies in the context {context}", Situation(context, (), ()))


def _words(directives: Iterable[Directive]) -> tuple[str, ...]:
    return tuple(map(str, directives))


# ---- what is accepted ------------------------------------------------------------------------------------------------


def _accept(base: RuleBase, found: list[Finding]) -> tuple[Finding, ...]:
    """The findings with the reasons of those that are accepted.  Errors: RB126."""
    stated = [(rule.id, a) for rule in base.rules for a in rule.accept] + [("", a) for a in base.accept]
    ids = {rule.id for rule in base.rules}
    used: set[Acceptance] = set()
    done = []
    for finding in found:
        by = [a for rule, a in stated if _meant(rule, a, finding, ids)]
        used.update(by)
        done.append(replace(finding, accepted=by[0].reason) if by else finding)
    stale: list[Diagnostic] = [
        problem("RB126", a.origin, f"there is no finding {a.finding}{' with ' + a.other if a.other else ''}{' of ' + rule if rule else ''}", "drop the acceptance, or name the other rule or word as the finding does")
        for rule, a in stated
        if a not in used
    ]
    if stale:
        raise Rejected(stale)
    return tuple(sorted(done, key=lambda f: CODES.index(f.code)))


def _meant(rule: str, acceptance: Acceptance, finding: Finding, ids: set[str]) -> bool:
    """An acceptance in a rule is about findings of that rule; one of a whole file names what it is about."""
    if acceptance.finding != finding.code or (rule and rule not in finding.rules):
        return False
    if not acceptance.other:
        return bool(rule)
    words = {*finding.words, *(w.split(" ", 1)[1] for w in finding.words if " " in w)}
    return acceptance.other in (finding.rules if acceptance.other in ids else words)
