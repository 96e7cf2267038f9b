"""Exporting a rule base: SWI-Prolog answers from it as we do, import gets it back, no text of a rule becomes code."""

from __future__ import annotations

import json
import random
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reference import reference
from rotra.advice import compile
from rotra.diagnostics import Rejected
from rotra.emitters.agentspeak import emit_advice
from rotra.emitters.prolog import atom, emit_prolog
from rotra.emitters.smv import emit_smv
from rotra.engines import places
from rotra.engines.process import run
from rotra.frontends.prolog_rules import read_prolog_rules
from rotra.frontends.rules import Acceptance, Directive, Rule, RuleBase, Term, load_rule_base
from rotra.lowering.situation import situation_system
from rotra.origins import NOWHERE
from rotra.pipeline.rules_export import export_rules
from rotra.pipeline.rules_import import import_rules
from rotra.system.expr import evaluate

CASES = Path(__file__).parent / "cases"
Situation = tuple[str, list[str], list[str]]


@pytest.fixture(scope="module", params=["uk", "small", "published"])
def base(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> RuleBase:
    if request.param == "published":
        folder = tmp_path_factory.mktemp("published") / "base"
        import_rules(reference("published_rules.pl"), folder, CASES / "import" / "published_overlay.yaml")
        return load_rule_base(folder)
    return load_rule_base("uk" if request.param == "uk" else CASES / "export" / "small")


def some_situations(base: RuleBase, number: int) -> list[Situation]:
    chance = random.Random(base.name)
    words = {kind: [w for k, w in base.ontology.names if k == kind] for kind in ("belief", "intention")}
    found: list[Situation] = []
    for _ in range(number):
        rule = chance.choice(base.rules)
        beliefs = {*rule.beliefs, *chance.sample(words["belief"], chance.randrange(min(9, len(words["belief"]))))}
        intentions = {*rule.intentions, *chance.sample(words["intention"], chance.randrange(min(3, len(words["intention"]))))}
        found.append((chance.choice(list(base.ontology.contexts)), sorted(beliefs), sorted(intentions)))
    return found


def our_answers(base: RuleBase, asked: list[Situation]) -> list[list[str]]:
    adviser = compile(base)
    return [[f"{d.label}-{d.action}" for d in adviser.advise(*situation).directives] for situation in asked]


# ---- Prolog ----------------------------------------------------------------------------------------------------------


def swipl() -> str:
    found = shutil.which("swipl")
    if found is None:
        pytest.skip("swipl is not installed (Debian package swi-prolog-nox)")
    return found


def consulted(text: str, goals: str, folder: Path) -> list[str]:
    """What SWI-Prolog prints for `main` over the exported file; nothing may be said on the error stream."""
    (folder / "base.pl").write_text(text, encoding="utf-8")
    (folder / "goals.pl").write_text(":- initialization(main, main).\n:- consult('base.pl').\n" + goals, encoding="utf-8")
    outcome = run([swipl(), "goals.pl"], cwd=folder, timeout=120)
    assert outcome.ok and outcome.stderr == "", outcome.why() + outcome.stderr
    return outcome.stdout.splitlines()


def prolog_answers(text: str, asked: list[Situation], folder: Path) -> list[list[str]]:
    def words(held: list[str]) -> str:
        return f"[{', '.join(map(atom, held))}]"

    goals = [f"asked({atom(c)}, {words(b)}, {words(i)})." for c, b, i in asked]
    goals.append("main :- forall(asked(C, B, I), (getRecommended(C, B, I, A), forall(member(D, A), (write(D), write(' '))), nl)).")
    return [line.split() for line in consulted(text, "\n".join(goals) + "\n", folder)]


def test_swi_prolog_answers_as_we_do(base: RuleBase, tmp_path: Path) -> None:
    asked = some_situations(base, 2000)
    assert prolog_answers(emit_prolog(base), asked, tmp_path) == our_answers(base, asked)


def test_swi_prolog_answers_the_reference_situations(base: RuleBase, tmp_path: Path) -> None:
    if base.name != "uk_published":
        return
    told = [json.loads(line) for line in reference("advice_situations.jsonl").read_text(encoding="utf-8").splitlines()]
    answers = prolog_answers(emit_prolog(base), [(s["context"], s["beliefs"], s["intentions"]) for s in told], tmp_path)
    assert [s["id"] for s, a in zip(told, answers, strict=True) if set(a) != set(s["by_definition"])] == []


def test_a_word_with_a_hyphen_may_be_said_as_a_term(tmp_path: Path) -> None:
    small = emit_prolog(load_rule_base(CASES / "export" / "small"))
    lines = consulted(small, "main :- getRecommended(standard, [mini-roundabout], [], A), print(A), nl.\n", tmp_path)
    assert lines == ["[must-keep_left,must-'road_surfaces-avoid_non']"]


hostile = "x'), halt. % \\' \n:- initialization(halt(1)).\n*/ \"\0\u2028é"


def hostile_base() -> RuleBase:
    small = load_rule_base(CASES / "export" / "small")
    term = Term(hostile, "belief", hostile, (hostile + "2",), (), (), NOWHERE)
    ontology = replace(small.ontology, beliefs={**small.ontology.beliefs, hostile: term}, contexts={**small.ontology.contexts, hostile: hostile})
    rule = Rule(hostile, hostile, hostile, hostile, (hostile,), (), (), (), (Directive("must", hostile),), (hostile,), hostile, hostile, NOWHERE, hostile, "", (Acceptance("conflict", hostile, hostile, NOWHERE),))
    return replace(small, ontology=ontology, rules=(rule,))


def test_hostile_words_stay_words(tmp_path: Path) -> None:
    text = emit_prolog(hostile_base())
    goals = f"main :- getRecommended({atom(hostile)}, [{atom(hostile)}], [], [must-A]), atom_codes(A, Codes), print(Codes), nl.\n"
    assert consulted(text, goals, tmp_path) == [str([ord(c) for c in hostile]).replace(" ", "")]
    (tmp_path / "hostile.pl").write_text(text, encoding="utf-8")
    (back,) = read_prolog_rules(tmp_path / "hostile.pl").rules
    assert (back.name, back.context, back.beliefs, back.directives) == (hostile, hostile, (hostile,), (("must", hostile),))


@settings(deadline=None)
@given(st.lists(st.text(st.characters(exclude_categories=["Cs"]), min_size=1), min_size=1))
def test_every_text_is_read_back(tmp_path_factory: pytest.TempPathFactory, words: list[str]) -> None:
    file = tmp_path_factory.mktemp("words") / "rules.pl"
    file.write_text(f"rule(r, c, [{', '.join(map(atom, words))}], [], [must-stop]).\n", encoding="utf-8")
    (back,) = read_prolog_rules(file).rules
    assert back.beliefs == tuple(dict.fromkeys(words))


# ---- there and back --------------------------------------------------------------------------------------------------


def bare(base: RuleBase) -> RuleBase:
    """The base without what Prolog does not carry: places, where it was imported from, meanings in the grid world."""

    def terms(kind: str) -> dict[str, Term]:
        words = base.ontology
        named = {n: t for n, t in words.terms(kind).items()}
        return {
            n: replace(t, origin=NOWHERE, excludes=tuple(words.canonical(kind, w) or w for w in t.excludes), opposites=tuple(words.canonical(kind, w) or w for w in t.opposites))
            for n, t in named.items()
        }

    def accept(found: tuple[Acceptance, ...]) -> tuple[Acceptance, ...]:
        return tuple(replace(a, origin=NOWHERE) for a in found)

    ontology = replace(base.ontology, beliefs=terms("belief"), intentions=terms("intention"), actions=terms("action"), imported_from="")
    rules = tuple(replace(r, origin=NOWHERE, accept=accept(r.accept)) for r in base.rules)
    return replace(base, folder="", ontology=ontology, rules=rules, meanings=(), accept=accept(base.accept))


def test_there_and_back_loses_nothing(base: RuleBase, tmp_path: Path) -> None:
    (tmp_path / "base.pl").write_text(emit_prolog(base), encoding="utf-8")
    import_rules(tmp_path / "base.pl", tmp_path / "made")
    back = load_rule_base(tmp_path / "made")
    assert bare(back) == bare(base)
    assert emit_prolog(back) == emit_prolog(base)


def test_a_file_that_cannot_be_written_is_said(tmp_path: Path) -> None:
    with pytest.raises(Rejected, match="IO104"):
        export_rules("uk", "prolog", tmp_path / "absent" / "uk.pl")
    assert export_rules("uk", "jason", tmp_path / "uk.asl") == emit_advice(load_rule_base("uk")) == (tmp_path / "uk.asl").read_text()


# ---- SMV -------------------------------------------------------------------------------------------------------------


def test_the_definitions_of_the_smv_module_are_the_advice(base: RuleBase) -> None:
    system = situation_system(base)
    definitions = system.definitions()
    for context, beliefs, intentions in some_situations(base, 60):
        held = {f"believes {base.ontology.canonical('belief', b)}" for b in beliefs} | {f"intends {base.ontology.canonical('intention', i)}" for i in intentions}
        state = {name: name in held for name in system.variables()} | {"context": context}
        ours = {f"{d.label} {d.action}" for d in compile(base).advise(context, beliefs, intentions).directives}
        asked = {str(d) for r in base.rules for d in r.directives}
        assert {name for name in asked if evaluate(definitions[name], state, definitions)} == ours


def test_nusmv_reads_the_module(base: RuleBase, tmp_path: Path) -> None:
    if not places.nusmv().is_file():
        pytest.skip("NuSMV is not built")
    (tmp_path / "advice.smv").write_text(emit_smv(situation_system(base), "hostile\nMODULE main").text, encoding="utf-8")
    outcome = run([places.nusmv(), "-dcx", "advice.smv"], cwd=tmp_path, timeout=120)
    assert outcome.ok and "error" not in outcome.stderr.lower(), outcome.why()
