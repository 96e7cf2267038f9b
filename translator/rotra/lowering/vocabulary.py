"""What the words of a property mean in one model: each atom as an expression over the transition system, read at rest.

In: DriverModel, the advice, the scenario.  Out: `Meanings` with the adviser's Part.  Left to others: the formula
language (frontends/properties.py) and its temporal operators (atoms.py).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from rotra.frontends.agent import Formula, Rule
from rotra.frontends.terms import Struct, Term, Text, Var, is_ground, parse_ground, show, unify
from rotra.lowering.mind import DriverModel, legal_acts
from rotra.lowering.query import holds, solve
from rotra.origins import NOWHERE, Origin
from rotra.system.expr import FALSE, TRUE, Expr, conj, const, disj, eq, negate, ref
from rotra.system.transition import Definition, Part


@dataclass(frozen=True, slots=True)
class Directive:
    label: str
    action: str


@dataclass(slots=True)
class Adviser:
    """The adviser's module as it grows: which rule applies, what is advised, what an act contradicts, all at rest.

    `rules`: rule id -> its origin.  `shown`: actions that some act can contradict.
    """

    driver: DriverModel
    advice: tuple[Rule, ...]
    rules: Mapping[str, Origin]
    top_speed: int
    crashed: Expr
    definitions: dict[str, Definition] = field(default_factory=dict)
    directives: dict[Directive, list[str]] = field(default_factory=dict)
    meanings: dict[str, list[Rule]] = field(default_factory=dict)
    clashes: dict[tuple[str, str], Expr] = field(default_factory=dict)

    def define(self, name: str, expr: Expr, origin: Origin = NOWHERE) -> Expr:
        name += self.driver.suffix
        self.definitions.setdefault(name, Definition(name, expr, origin))
        return ref(name)

    def advise(self) -> None:
        """Define `rule:<id>` for every rule that can apply here, and `advised:<label>:<action>` for every directive of one."""
        applies: dict[str, bool] = {}
        for rule in self.advice:
            if rule.head.name != "rule_of" or len(rule.head.args) != 3:
                continue
            identity, label, action = rule.head.args
            name = _plain(identity)
            if name not in applies:
                condition = holds(rule.body, {}, self.driver.rest)
                applies[name] = condition is not FALSE
                if applies[name]:
                    origin = self.rules.get(name, rule.origin)
                    self.define(f"rule:{name}", condition, Origin(origin.file, origin.line, f"rule {name}"))
            if applies[name]:
                self.directives.setdefault(Directive(_plain(label), _plain(action)), []).append(name)
        for directive, names in self.directives.items():
            self.define(f"advised:{directive.label}:{directive.action}", disj(*(ref(f"rule:{n}{self.driver.suffix}") for n in names)))

    def advised(self, directive: Directive) -> Expr:
        return ref(f"advised:{directive.label}:{directive.action}{self.driver.suffix}") if directive in self.directives else FALSE

    def contradicts(self, action: str, act: str) -> Expr:
        """Would this act go against that action here?"""
        if (action, act) not in self.clashes:
            if not self.meanings:
                for rule in self.advice:
                    if rule.head.name == "contradicted" and len(rule.head.args) == 2:
                        self.meanings.setdefault(_plain(rule.head.args[0]), []).append(rule)
            asked = parse_ground(act)
            found = []
            for rule in self.meanings.get(action, ()):
                bound = unify(rule.head.args[1], asked, {})
                if bound is not None:
                    found += [s.guard for s in solve(rule.body, bound, self.driver.rest)]
            expr = disj(*found)
            plain = expr in (TRUE, FALSE)
            self.clashes[action, act] = expr if plain else self.define(f"against:{action}:{act}", expr, Origin("directives", 0, f"meaning of {action}"))
        return self.clashes[action, act]

    def shown(self, action: str) -> bool:
        """Can any act at all contradict this action?"""
        return any(self.contradicts(action, a) is not FALSE for a in legal_acts(self.top_speed))

    def act(self, act: str) -> Expr:
        return eq(ref("act" + self.driver.suffix), const(act)) if act in self.driver.acts else FALSE

    def against(self, directive: Directive) -> Expr:
        """The directive is in force and the act contradicts it."""
        done = disj(*(conj(self.act(a), self.contradicts(directive.action, a)) for a in self.driver.acts))
        return conj(negate(self.crashed), self.advised(directive), done)

    def justified(self, directive: Directive) -> Expr:
        """A `should` that no act can heed without going against a must in force (design, section 7)."""
        if directive.label == "must" or not self.shown(directive.action):
            return FALSE
        name = f"no_way_to_heed:{directive.label}:{directive.action}"
        if name + self.driver.suffix not in self.definitions:
            musts = [d for d in self.directives if d.label == "must" and self.shown(d.action)]
            ways = []
            for a in legal_acts(self.top_speed):
                blocked = (conj(self.advised(m), self.contradicts(m.action, a)) for m in musts)
                ways.append(disj(self.contradicts(directive.action, a), *blocked))
            self.define(name, conj(*ways))
        return ref(name + self.driver.suffix)

    def ignored(self, directive: Directive) -> Expr:
        name = f"ignored:{directive.label}:{directive.action}"
        if name + self.driver.suffix not in self.definitions:
            expr = conj(self.against(directive), negate(self.justified(directive)))
            if expr is FALSE:
                return FALSE
            self.define(name, expr)
        return ref(name + self.driver.suffix)

    def at_stake(self, directive: Directive) -> Expr:
        """In force, together with an act of those there are that would contradict it: what keeps `ignored` from being hollow."""
        some = disj(*(self.contradicts(directive.action, a) for a in legal_acts(self.top_speed)))
        return conj(negate(self.crashed), self.advised(directive), some)

    def part(self) -> Part:
        return Part("adviser" + self.driver.suffix, (), tuple(self.definitions.values()))

    # ---- the situation -------------------------------------------------------------------------------------------

    def solutions(self, functor: str, pattern: Term) -> list[tuple[Term, Expr]]:
        """(value, condition) of every `functor(value)` at rest that fits the pattern."""
        if is_ground(pattern):
            return [(pattern, holds(Formula("lit", (Struct(functor, (pattern,)),)), {}, self.driver.rest))]
        found: dict[Term, Expr] = {}
        for s in solve(Formula("lit", (Struct(functor, (Var("Asked"),)),)), {}, self.driver.rest):
            value = s.bound.get("Asked")
            if value is not None and is_ground(value) and unify(pattern, value, {}) is not None:
                found[value] = disj(found.get(value, FALSE), s.guard)
        return sorted(found.items(), key=lambda f: show(f[0]))

    def somewhere(self, functor: str, pattern: Term) -> Expr:
        return disj(*(guard for _, guard in self.solutions(functor, pattern)))

    def own_beliefs(self, pattern: Struct) -> Expr:
        """The Jason mind: is there a belief (own, percept or derived) that fits?"""
        return holds(Formula("lit", (pattern,)), {}, self.driver.rest)

    def goals(self, pattern: Struct) -> Expr:
        return holds(Formula("internal", (pattern,), ".intend"), {}, self.driver.rest)

    def does(self, pattern: Struct) -> Expr:
        return disj(*(self.act(a) for a in self.driver.acts if unify(pattern, parse_ground(a), {}) is not None))

    def matching(self, label: Term, action: Term | None) -> Iterable[Directive]:
        return [d for d in self.directives if unify(label, Struct(d.label), {}) is not None and (action is None or unify(action, Struct(d.action), {}) is not None)]


def _plain(term: Term) -> str:
    return term.value if isinstance(term, Text) else show(term)
