"""The adviser in Java answers as the one in Python does: directives, rules, unknown words, what is outranked."""

from __future__ import annotations

import json
import random
from pathlib import Path
from typing import Any

import pytest

from reference import reference
from rotra.advice import compile
from rotra.emitters.compiled import emit_compiled
from rotra.engines import places
from rotra.engines.process import run
from rotra.frontends.rules import RuleBase, load_rule_base
from rotra.pipeline.advise import answer
from rotra.pipeline.rules_import import import_rules

OVERLAY = Path(__file__).parent / "cases" / "import" / "published_overlay.yaml"


def java_answers(base: RuleBase, asked: list[dict[str, Any]], folder: Path) -> list[dict[str, Any]]:
    if not places.classpath_file().is_file():
        pytest.skip("the Java side is not built")
    rules = folder / "rules.json"
    rules.write_text(emit_compiled(base), encoding="utf-8")
    classes = ":".join((*map(str, places.classes()), places.classpath_file().read_text().strip()))
    lines = "".join(json.dumps(situation) + "\n" for situation in asked)
    outcome = run([places.java(), "-cp", classes, "rotra.advice.Answers", str(rules)], stdin=lines, timeout=60)
    assert outcome.ok, outcome.why()
    return [json.loads(line) for line in outcome.stdout.splitlines()]


def python_answers(base: RuleBase, asked: list[dict[str, Any]]) -> list[dict[str, Any]]:
    adviser = compile(base)
    return [answer(adviser.advise(s["context"], s["beliefs"], s["intentions"])) for s in asked]


def situations(base: RuleBase, number: int) -> list[dict[str, Any]]:
    """Half of the words of a few rules together, aliases and an unknown word among the rest."""
    chance = random.Random(number)
    words = {kind: [*(word for k, word in base.ontology.names if k == kind), "no_such_word"] for kind in ("belief", "intention")}
    found = []
    for _ in range(number):
        rules = chance.sample(base.rules, chance.randrange(6))
        beliefs = [b for rule in rules for b in rule.beliefs] + chance.sample(words["belief"], chance.randrange(30))
        intentions = [i for rule in rules for i in rule.intentions] + chance.sample(words["intention"], chance.randrange(5))
        chance.shuffle(beliefs)
        found.append({"context": chance.choice([*base.ontology.contexts, "odd"]), "beliefs": beliefs, "intentions": intentions})
    return found


def test_random_situations(tmp_path: Path) -> None:
    base = load_rule_base("uk")
    asked = situations(base, 2000)
    assert java_answers(base, asked, tmp_path) == python_answers(base, asked)


def test_reference_situations(tmp_path: Path) -> None:
    told = [json.loads(line) for line in reference("advice_situations.jsonl").read_text(encoding="utf-8").splitlines()]
    import_rules(reference("published_rules.pl"), tmp_path / "base", OVERLAY)
    base = load_rule_base(tmp_path / "base")
    answers = java_answers(base, told, tmp_path)
    assert answers == python_answers(base, told)
    given = [{f"{d['label']}-{d['action']}" for d in a["directives"]} for a in answers]
    assert [s["id"] for s, directives in zip(told, given, strict=True) if directives != set(s["by_definition"])] == []


def test_the_same_base_gives_the_same_bytes() -> None:
    base = load_rule_base("uk")
    assert emit_compiled(base) == emit_compiled(base)
