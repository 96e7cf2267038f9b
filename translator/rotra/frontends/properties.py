"""Load the catalogue of properties, and parse their formulas.

In: YAML files of properties.  Out: `Property`s with formulas as trees.  Left to others: what an atom means in a model
(lowering/atoms.py).  Errors: PR1xx with the line, as `Rejected`.  The language: properties/README.md.
"""

from __future__ import annotations

import difflib
import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import jsonschema
from lark import Lark
from lark.exceptions import UnexpectedInput, UnexpectedToken

from rotra.diagnostics import Diagnostic, Rejected, problem
from rotra.frontends.fragment import ACTS, PERCEPTS
from rotra.frontends.rules import RuleBase
from rotra.frontends.terms import Struct, Sum, Term, Var, show, variables
from rotra.frontends.yamlfile import Node, load_yaml
from rotra.origins import PROJECT, Origin, real_path

# word -> how many arguments it may have
WORDS: Mapping[str, tuple[int, ...]] = {
    "believes": (1,), "intends": (1,), "belief": (1,), "goal": (1,), "does": (1,), "percept": (1,), "advised": (2,), "ignored": (1, 2), "crashed": (0,),
    "finished": (0,), "hesitates": (1,), "heading": (1,), "light": (2,), "car": (3,), "busy": (0,), "restless": (0,), "main_goal": (0,),
}
HEADINGS = ("north", "east", "south", "west")
SETS = ("beliefs", "intentions", "actions", "cars", "lights")
VERDICTS = ("holds", "violated", "vacuous")
# the rules that the shipped catalogue speaks of
CATALOGUE_RULES = PROJECT / "rules" / "uk"


@dataclass(frozen=True, slots=True)
class Formula:
    """op: always eventually next historically once previously until since not and or implies iff forall compare atom.

    `args`: sub-formulas; for forall (variable, domain, formula), domain a set's name or a tuple of terms; for compare
    (relation, term, term); for atom (word, terms...).
    """

    op: str
    args: tuple[Any, ...]


@dataclass(frozen=True, slots=True)
class Property:
    """`expect`: driver -> verdict, or scenario -> verdict with `_` for the others."""

    id: str
    says: str
    formula: Formula
    cites: tuple[str, ...]
    scenarios: tuple[str, ...]
    assuming: tuple[Formula, ...]
    witness: Formula | None
    requirement: bool
    expect: Mapping[str, Any]
    origin: Origin


def expected(wanted: Property, agent: str | None, scenario: str) -> str | None:
    """What should come out: for a shipped driver what the catalogue says; a user's own is held to the requirements."""
    if agent is None:
        return "holds" if wanted.requirement else None
    stated = wanted.expect.get(agent)
    if isinstance(stated, Mapping):
        stated = stated.get(scenario, stated.get("_"))
    return stated if isinstance(stated, str) else None


@lru_cache(maxsize=1)
def _parser() -> Lark:
    return Lark((Path(__file__).parent / "properties_grammar.lark").read_text(encoding="utf-8"), parser="lalr", maybe_placeholders=True)


@lru_cache(maxsize=1)
def _schema() -> dict[str, Any]:
    loaded = json.loads((PROJECT / "properties" / "schema" / "properties.schema.json").read_text(encoding="utf-8"))
    assert isinstance(loaded, dict)
    return loaded


def load_properties(given: str | Path | None, base: RuleBase) -> tuple[Property, ...]:
    """The shipped catalogue (None), one shipped file of it by its name, or the properties of a user's file."""
    shipped = sorted((PROJECT / "properties").glob("*.yaml"))
    files = shipped if given is None else [f for f in shipped if f.stem == str(given)] or [Path(given)]
    found: list[Diagnostic] = []
    loaded: list[Property] = []
    for file in files:
        root = load_yaml(file)
        shape = [
            problem("IO103", _at(root, list(e.absolute_path)).origin(), f"{'/'.join(map(str, e.absolute_path)) or 'the file'}: {e.message}", "compare with the shipped catalogue; editors use properties/schema/properties.schema.json")
            for e in jsonschema.Draft202012Validator(_schema()).iter_errors(root.plain())
        ]
        if shape:
            found += shape
            continue
        known = {r.id for r in base.rules}
        # the catalogue that ships is written for one rule base: another may have other rules and words, or lack some
        ours = file not in shipped or real_path(base.folder).resolve() == CATALOGUE_RULES
        elsewhere = file in shipped and not base.ontology.imported_from and base.name != CATALOGUE_RULES.name
        for node in root:
            read = _property(node, base, known if ours else None, found)
            if elsewhere:
                read = _under_another_law(read)
            if any(p.id == read.id for p in loaded):
                found.append(problem("PR101", node.at("id").origin(), f"the property {read.id} is there twice", "give it another id"))
            loaded.append(read)
    if found:
        raise Rejected(found)
    return tuple(loaded)


def _under_another_law(wanted: Property) -> Property:
    """What one law makes a driver do says nothing of another; to the requirements every driver is held."""
    return replace(wanted, expect=dict.fromkeys(wanted.expect, "holds") if wanted.requirement else {})


def _at(root: Node, path: list[Any]) -> Node:
    node = root
    for key in path:
        items = list(node) if isinstance(node.value, tuple) else []
        following = node.get(str(key)) if isinstance(node.value, dict) else items[key] if isinstance(key, int) and key < len(items) else None
        if following is None:
            return node
        node = following
    return node


def _property(node: Node, base: RuleBase, known: set[str] | None, found: list[Diagnostic]) -> Property:
    def formula(at: Node | None) -> Formula:
        if at is None:
            return Formula("atom", ("crashed",))
        return _formula(str(at.value), at.origin(), None if known is None else base, found)

    cites = tuple(str(n.value) for n in node.get("cites") or ())
    for cited in cites:
        if known is not None and cited not in known:
            near = difflib.get_close_matches(cited, known, 1)
            found.append(problem("PR104", node.at("cites").origin(), f"there is no rule {cited}", f"did you mean {near[0]}?" if near else "rotra rules list shows what there is"))
    expect = node.get("expect")
    stated = [str(n.value) for n in node.get("scenarios") or ()]
    for driver, verdicts in expect.items() if expect else ():
        for scenario, verdict in verdicts.items():
            if stated and scenario not in (*stated, "_"):
                found.append(problem("PR111", verdict.origin(), f"{scenario} is not among the scenarios of this property, so what {driver} does there is never asked", f"its scenarios are {', '.join(stated)}"))
    witness = node.get("witness")
    return Property(
        str(node.at("id").value), str(node.at("says").value), formula(node.at("formula")), cites, tuple(str(n.value) for n in node.get("scenarios") or ()),
        tuple(formula(n) for n in node.get("assuming") or ()), None if witness is None else formula(witness),
        bool(node.get("requirement") and node.at("requirement").value), expect.plain() if expect else {}, node.at("id").origin(),  # type: ignore[arg-type]
    )


def _formula(text: str, origin: Origin, base: RuleBase | None, found: list[Diagnostic]) -> Formula:
    """Without a base the terms may be anybody's: one that no rule base here has cannot come true, and lowering says so."""
    try:
        tree = _parser().parse(text)
    except UnexpectedInput as error:
        where = _where(error, text)
        found.append(problem("PR102", origin, f"the formula cannot be read {where}", "see properties/README.md for the language"))
        return Formula("atom", ("crashed",))
    result = _tree(tree)
    _check(result, origin, base, found)
    for name in sorted(_unbound(result, frozenset())):
        found.append(problem("PR107", origin, f"no forall says what {name} is", f"write `forall {name} in ...: ` around it, or `_` for anything"))
    return result


def _where(error: UnexpectedInput, text: str) -> str:
    """The place of a syntax error inside the formula, which may be several lines long."""
    if isinstance(error, UnexpectedToken) and error.token.type == "$END":
        return "at its end"
    following = text[error.pos_in_stream or 0 :].split("\n")[0][:20]
    line = f"line {error.line}, " if "\n" in text.strip() else ""
    return f"at {line}column {error.column} of the formula, before {following!r}"


def _unbound(formula: Formula, bound: frozenset[str]) -> frozenset[str]:
    """Variables that no forall around them binds."""
    match formula.op:
        case "forall":
            name, domain, inner = formula.args
            terms = () if isinstance(domain, str) else domain
            return frozenset().union(_unbound(inner, bound | {name}), *(variables(t) - bound - {"_"} for t in terms))
        case "atom" | "compare":
            return frozenset().union(*(variables(t) for t in formula.args[1:])) - bound - {"_"}
    return frozenset().union(*(_unbound(part, bound) for part in formula.args))


def _tree(tree: Any) -> Formula:
    match tree.data:
        case "forall":
            return Formula("forall", (str(tree.children[0]), _domain(tree.children[1]), _tree(tree.children[2])))
        case "iff":
            parts = [_tree(c) for c in tree.children]
            result = parts[0]
            for part in parts[1:]:
                result = Formula("iff", (result, part))
            return result
        case "implies":
            return Formula("implies", (_tree(tree.children[0]), _tree(tree.children[1])))
        case "or_":
            return Formula("or", tuple(_tree(c) for c in tree.children))
        case "and_":
            return Formula("and", tuple(_tree(c) for c in tree.children))
        case "binary":
            left, word, right = tree.children
            return Formula(str(word), (_tree(left), _tree(right)))
        case "not_":
            return Formula("not", (_tree(tree.children[0]),))
        case "prefixed":
            return Formula(str(tree.children[0]), (_tree(tree.children[1]),))
        case "comparison":
            left, relation, right = tree.children
            return Formula("compare", (str(relation), _term(left), _term(right)))
        case "atom":
            name, *rest = tree.children
            return Formula("atom", (str(name), *(_term(c) for c in rest if c is not None)))
    raise AssertionError(tree.data)


def _term(tree: Any) -> Term:
    match tree.data:
        case "int_":
            return int(tree.children[0])
        case "var_":
            return Var(str(tree.children[0]))
        case "any_":
            return Var("_")
        case "word_":
            return Struct(str(tree.children[0]))
        case "struct":
            name, *rest = tree.children
            return Struct(str(name), tuple(_term(c) for c in rest if c is not None))
        case "sum":
            result = _term(tree.children[0])
            for sign, part in zip(tree.children[1::2], tree.children[2::2], strict=True):
                result = Sum(str(sign), (result, _term(part)))
            return result
    raise AssertionError(tree.data)


def _domain(tree: Any) -> Any:
    match tree.data:
        case "range":
            low, high = (_term(c) for c in tree.children)
            assert isinstance(low, int) and isinstance(high, int)
            return tuple(range(low, high + 1))
        case "named":
            return str(tree.children[0])
    return tuple(_term(c) for c in tree.children)


def _check(formula: Formula, origin: Origin, base: RuleBase | None, found: list[Diagnostic]) -> None:
    """Known words with the right number of arguments; terms of the ontology where a word asks for one."""
    if formula.op == "forall":
        if isinstance(formula.args[1], str) and formula.args[1] not in SETS:
            found.append(problem("PR103", origin, f"there is no set {formula.args[1]}", f"the sets are {', '.join(SETS)}, a range as in 1..4, or a list in braces"))
        if formula.args[1] == ():
            found.append(problem("PR108", origin, f"the range of {formula.args[0]} holds nothing", "write the smaller number first, as in 1..4"))
        _check(formula.args[2], origin, base, found)
    elif formula.op == "atom":
        word, *terms = formula.args
        if word not in WORDS:
            near = difflib.get_close_matches(word, WORDS, 1)
            found.append(problem("PR103", origin, f"{word} is no word of the property language", f"did you mean {near[0]}?" if near else f"the words are {', '.join(sorted(WORDS))}"))
        elif len(terms) not in WORDS[word]:
            found.append(problem("PR105", origin, f"{word} has {len(terms)} argument(s) here; it takes {' or '.join(map(str, WORDS[word]))}", "see properties/README.md"))
        else:
            _terms(word, terms, origin, base, found)
    elif formula.op != "compare":
        for part in formula.args:
            _check(part, origin, base, found)


def _terms(word: str, terms: list[Term], origin: Origin, base: RuleBase | None, found: list[Diagnostic]) -> None:
    if base is not None:
        _ontology_terms(word, terms, origin, base, found)
    if word in ("does", "percept"):
        _literal(terms[0], "act" if word == "does" else "percept", ACTS if word == "does" else PERCEPTS, origin, found)
    if word == "heading" and isinstance(terms[0], Struct) and show(terms[0]) not in HEADINGS:
        found.append(problem("PR109", origin, f"there is no heading {show(terms[0])}", f"the headings are {', '.join(HEADINGS)}"))


def _ontology_terms(word: str, terms: list[Term], origin: Origin, base: RuleBase, found: list[Diagnostic]) -> None:
    ontology = base.ontology
    asked: list[tuple[int, Mapping[str, Any], str]] = {"believes": [(0, ontology.beliefs, "belief")], "intends": [(0, ontology.intentions, "intention")]}.get(word, [])
    if word in ("advised", "ignored"):
        asked = [(0, ontology.labels, "label"), (1, ontology.actions, "action")]
    for place, known, kind in asked:
        if place < len(terms):
            term = terms[place]
            if isinstance(term, Struct) and term.name not in known:
                near = difflib.get_close_matches(term.name, list(known), 1)
                found.append(problem("PR106", origin, f"{term.name} is no {kind} of the rule base {base.name}", f"did you mean {near[0]}?" if near else "see its ontology.yaml"))


def _literal(term: Term, kind: str, known: Mapping[str, int], origin: Origin, found: list[Diagnostic]) -> None:
    """An act or percept must exist; whether it can happen in a scenario is not decided here."""
    if isinstance(term, Struct) and term.name not in known:
        near = difflib.get_close_matches(term.name, list(known), 1)
        found.append(problem("PR109", origin, f"there is no {kind} {show(term)}", f"did you mean {near[0]}?" if near else f"each {kind} is one of {', '.join(known)}"))
    elif isinstance(term, Struct) and len(term.args) != known[term.name]:
        found.append(problem("PR105", origin, f"the {kind} {term.name} has {len(term.args)} argument(s) here; it takes {known[term.name]}", "see properties/README.md"))
    elif isinstance(term, int):
        found.append(problem("PR109", origin, f"{term} is no {kind}", f"each {kind} is one of {', '.join(known)}"))
