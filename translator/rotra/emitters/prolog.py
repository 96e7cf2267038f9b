"""Write a rule base as a Prolog file that answers the published query.

    rule(r175a, standard, [light_red], [approaching_traffic_light], [must-...]).       a rule without exceptions
    rule(r176, standard, [light_red], [], [green_filter], [], [must-...]).             one with `unless`
    ?- getRecommended(standard, [light_red], [approaching_traffic_light], Advice).

In: RuleBase.  Out: the text, read by any Prolog with lists (tried with SWI-Prolog), and by `rotra rules import`, which
gets back from it all but what the actions mean in the grid world.  Left to others: running Prolog.
Every word goes through `atom`, so that no text of a rule file can become code.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from rotra.frontends.rules import Acceptance, Rule, RuleBase, Term

_PROGRAM = """\
% getRecommended(+Context, +Beliefs, +Intentions, -Advice): the actions of all rules that apply, each once, by rank of
% their label and then by name.  A word of a situation may be an alias; one that no rule knows makes no difference.
getRecommended(Context, Beliefs, Intentions, Advice) :-
    rotra_names(Beliefs, belief, B),
    rotra_names(Intentions, intention, I),
    findall(Rank-(Label-Action), rotra_asked(Context, B, I, Rank, Label, Action), Found),
    sort(Found, Sorted),
    findall(Directive, member(_-Directive, Sorted), Advice).

% The published client's name for it.
getRecommendedActions(Context, Beliefs, Intentions, Advice) :-
    getRecommended(Context, Beliefs, Intentions, Advice).

% rotra_applies(+Context, +Beliefs, +Intentions, -Rule, -Actions): which rules apply, and what each asks for.
rotra_applies(Context, B, I, Name, Actions) :-
    rule(Name, Context, Bs, Is, Actions),
    rotra_all(Bs, B),
    rotra_all(Is, I).
rotra_applies(Context, B, I, Name, Actions) :-
    rule(Name, Context, Bs, Is, UnlessB, UnlessI, Actions),
    rotra_all(Bs, B),
    rotra_all(Is, I),
    rotra_none(UnlessB, B),
    rotra_none(UnlessI, I).

rotra_asked(Context, B, I, Rank, Label, Action) :-
    rotra_applies(Context, B, I, _, Actions),
    member(Label-Action, Actions),
    rotra_rank(Label, Rank).

rotra_all([], _).
rotra_all([Word|Words], Held) :- memberchk(Word, Held), rotra_all(Words, Held).

rotra_none([], _).
rotra_none([Word|Words], Held) :- \\+ memberchk(Word, Held), rotra_none(Words, Held).

rotra_names([], _, []).
rotra_names([Word|Words], Kind, [Name|Names]) :- rotra_name(Kind, Word, Name), rotra_names(Words, Kind, Names).

% A word with a hyphen reads as a term; as published it is an atom here.
rotra_name(Kind, Word, Name) :- \\+ atom(Word), !, format(atom(Atom), '~w', [Word]), rotra_name(Kind, Atom, Name).
rotra_name(Kind, Word, Name) :- term_detail(Kind, Name, alias, Word), !.
rotra_name(_, Word, Word).
"""


def emit_prolog(base: RuleBase) -> str:
    """The text; the same base gives the same bytes."""
    lines = [
        f"% The rule base {base.name} in Prolog, made by rotra rules export: change the rule base, not this file.",
        f"% ?- getRecommended({atom(next(iter(base.ontology.contexts)))}, [], [], Advice).",
        "",
        ":- dynamic rule/5, rule/7, rule_base/1, rule_detail/3, term_detail/4, accepted/4, rotra_rank/2.",
        ":- discontiguous rule/5, rule/7.",
        "",
        _fact("rule_base", base.name),
        "",
        "% rule(Name, Context, Beliefs, Intentions, Actions), or with two lists of exceptions before the actions.",
        *map(_rule, base.rules),
        "",
        _PROGRAM,
        "% What comes first.",
        *(f"rotra_rank({atom(label)}, {rank})." for rank, label in enumerate(base.ontology.labels)),
        "",
        "% The words: what they mean, what else they are called, what cannot be with them.",
        *_ontology(base),
        "",
        "% The rules: where they come from and what they say.",
        *(line for rule in base.rules for line in _details(rule)),
        "",
        "% What is known of them and stays as it is.",
        *(_accepted("", a) for a in base.accept),
        *(_accepted(r.id, a) for r in base.rules for a in r.accept),
    ]
    return "\n".join(lines).rstrip() + "\n"


def atom(text: str) -> str:
    """The text as a Prolog atom: plain where it reads so, else in quotes with nothing left that could end them."""
    if re.fullmatch(r"[a-z][A-Za-z0-9_]*", text):
        return text
    quoted = text.replace("\\", "\\\\").replace("'", "\\'").replace("\n", "\\n").replace("\t", "\\t")
    return "'" + re.sub(r"[\x00-\x1f\x7f-\x9f\u2028\u2029]", lambda m: f"\\x{ord(m.group()):x}\\", quoted) + "'"


def _fact(functor: str, *words: str) -> str:
    return f"{functor}({', '.join(map(atom, words))})."


def _list(words: Iterable[str]) -> str:
    return f"[{', '.join(words)}]"


def _rule(rule: Rule) -> str:
    conditions = [rule.beliefs, rule.intentions]
    if rule.unless_beliefs or rule.unless_intentions:
        conditions += [rule.unless_beliefs, rule.unless_intentions]
    lists = [_list(map(atom, words)) for words in conditions]
    actions = _list(f"{atom(d.label)}-{atom(d.action)}" for d in rule.directives)
    return f"rule({atom(rule.id)}, {atom(rule.context)}, {', '.join(lists)}, {actions})."


def _ontology(base: RuleBase) -> Iterator[str]:
    words = base.ontology
    for kind, meanings in (("context", words.contexts), ("label", words.labels), ("authority", words.authorities)):
        for name, means in meanings.items():
            yield _fact("term_detail", kind, name, "means", means)
    for kind in ("belief", "intention", "action"):
        for term in words.terms(kind).values():
            yield from _term(term)


def _term(term: Term) -> Iterator[str]:
    yield _fact("term_detail", term.kind, term.name, "means", term.means)
    for key, others in (("alias", term.aliases), ("excludes", term.excludes), ("opposite", term.opposites)):
        for other in others:
            yield _fact("term_detail", term.kind, term.name, key, other)


def _details(rule: Rule) -> Iterator[str]:
    single = {
        "paragraph": rule.paragraph,
        "section": rule.section,
        "says": rule.says,
        "published_name": rule.published_name,
        "authority": rule.authority,
        "note": rule.note,
    }
    for key, value in single.items():
        if value:
            yield _fact("rule_detail", rule.id, key, value)
    for law in rule.legal:
        yield _fact("rule_detail", rule.id, "legal", law)


def _accepted(rule: str, acceptance: Acceptance) -> str:
    return _fact("accepted", rule, acceptance.finding, acceptance.other, acceptance.reason)
