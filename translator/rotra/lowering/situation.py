"""A rule base alone as a transition system: every situation that its exclusions allow, and the advice in each.

    situation: context, believes light_red, intends turn_right, ...      free in every state, exclusions kept
    advice:    rule r175a := ...;  must stop_at_white_line := rule r175a | rule r176

In: RuleBase.  Out: System.  Left to others: SMV text (emitters/smv.py), what is wrong with the rules (rules_check.py).
"""

from __future__ import annotations

from rotra.frontends.rules import Rule, RuleBase
from rotra.origins import NOWHERE
from rotra.system.expr import Expr, conj, const, disj, eq, negate, ref, var
from rotra.system.transition import Definition, Part, System, Variable

_WORD = {"belief": "believes", "intention": "intends"}


def situation_system(base: RuleBase) -> System:
    contexts = tuple(base.ontology.contexts)
    variables = [Variable("context", contexts, contexts, None)]
    for kind, verb in _WORD.items():
        for term in base.ontology.terms(kind).values():
            variables.append(Variable(f"{verb} {term.name}", (False, True), (False, True), None, term.origin))
    excluded = tuple(negate(conj(_held(kind, a), _held(kind, b))) for kind, a, b in exclusions(base))
    directives: dict[str, list[Expr]] = {}
    for rule in base.rules:
        for d in rule.directives:
            directives.setdefault(str(d), []).append(ref(f"rule {rule.id}"))
    definitions = [Definition(f"rule {r.id}", _applies(r), r.origin) for r in base.rules]
    definitions += [Definition(name, disj(*by), NOWHERE) for name, by in sorted(directives.items())]
    return System((Part("situation", tuple(variables), (), excluded), Part("advice", (), tuple(definitions))))


def exclusions(base: RuleBase) -> tuple[tuple[str, str, str], ...]:
    """Which two terms of a kind cannot hold together, each pair once."""
    found = {}
    for kind in _WORD:
        for term in base.ontology.terms(kind).values():
            for word in term.excludes:
                other = base.ontology.canonical(kind, word)
                if other is not None and other != term.name:
                    found[kind, *sorted((term.name, other))] = (kind, *sorted((term.name, other)))
    return tuple((k, a, b) for k, a, b in found)


def _held(kind: str, name: str) -> Expr:
    return var(f"{_WORD[kind]} {name}")


def _applies(rule: Rule) -> Expr:
    return conj(
        eq(var("context"), const(rule.context)),
        *(_held("belief", b) for b in rule.beliefs),
        *(_held("intention", i) for i in rule.intentions),
        *(negate(_held("belief", b)) for b in rule.unless_beliefs),
        *(negate(_held("intention", i)) for i in rule.unless_intentions),
    )
