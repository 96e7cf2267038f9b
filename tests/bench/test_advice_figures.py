"""What a query of the adviser costs in Python, Java and SWI-Prolog: the same queries, the same run, the rule base 1, 10 and 100 times.

A copy of the rule base has beliefs of its own and shares intentions and actions, so a rule that asks for no belief applies
in every copy.  The queries have the words of the first copy.  Out: figures.json; nothing here fails for being slow.
"""

from __future__ import annotations

import json
import random
import shutil
import statistics
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from bench.keeping import keep
from rotra.advice import compile
from rotra.emitters.compiled import emit_compiled
from rotra.emitters.prolog import atom, emit_prolog
from rotra.engines import places
from rotra.engines.process import run
from rotra.frontends import rules as reader
from rotra.frontends.rules import Rule, RuleBase, load_rule_base

pytestmark = pytest.mark.bench
TIMES = (1, 10, 100)
RULES = 313
QUERIES = 500
Situation = tuple[str, list[str], list[str]]
HARNESS = places.PROJECT / "tests" / "bench" / "java"

# The wall time of each query, several times over where one is too short for the clock.
_TIMED = """\
:- initialization(main, main).
:- set_prolog_flag(double_quotes, atom).
:- consult('base.pl').
:- consult('asked.pl').
main :- forall(asked(C, B, I), (timed(C, B, I, T), format('~w~n', [T]))).
timed(C, B, I, Each) :-
    Repeat = REPEAT,
    get_time(Start),
    forall(between(1, Repeat, _), getRecommended(C, B, I, _)),
    get_time(End),
    Each is (End - Start) / Repeat * 1000000.
"""


def first(base: RuleBase, number: int) -> RuleBase:
    return replace(base, rules=base.rules[:number])


def copies(base: RuleBase, times: int) -> RuleBase:
    """The base and further copies of it, each with beliefs of its own."""
    ontology, rules = base.ontology, list(base.rules)
    beliefs, names = dict(ontology.beliefs), dict(ontology.names)
    for number in range(2, times + 1):
        end = f"_copy{number}"
        beliefs |= {name + end: replace(term, name=name + end, aliases=()) for name, term in ontology.beliefs.items()}
        names |= {(kind, word + end): name + end for (kind, word), name in ontology.names.items() if kind == "belief"}
        rules += (_renamed(rule, end) for rule in base.rules)
    return replace(base, ontology=replace(ontology, beliefs=beliefs, names=names), rules=tuple(rules))


def _renamed(rule: Rule, end: str) -> Rule:
    def own(words: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(word + end for word in words)

    return replace(rule, id=rule.id + end, beliefs=own(rule.beliefs), unless_beliefs=own(rule.unless_beliefs))


def situations(base: RuleBase) -> list[Situation]:
    """In each the conditions of one rule hold, and some more words."""
    chance = random.Random(QUERIES)
    beliefs, intentions = list(base.ontology.beliefs), list(base.ontology.intentions)
    rules = [chance.choice(base.rules) for _ in range(QUERIES)]
    return [
        (r.context, sorted({*r.beliefs, *chance.sample(beliefs, 6)}), sorted({*r.intentions, *chance.sample(intentions, 1)})) for r in rules
    ]


def in_python(base: RuleBase, asked: list[Situation]) -> float:
    """The median of the queries, in microseconds."""
    adviser = compile(base)
    return statistics.median(_microseconds(adviser.advise, situation) for _ in range(5) for situation in asked)


def _microseconds(advise, situation: Situation) -> float:  # type: ignore[no-untyped-def]
    start = time.perf_counter()
    advise(*situation)
    return (time.perf_counter() - start) * 1e6


def in_java(bases: dict[int, RuleBase], asked: list[Situation], folder: Path) -> Iterator[tuple[int, float]]:
    """The median of the queries for each size, in microseconds, by JMH."""
    built = run(
        [str(places.PROJECT / "translator/rotra/toolchain/maven.sh"), ".build/maven-bench.stamp", "-q", "-P", "bench"]
        + ["-pl", "tests/bench/java", "-am", "package", "-Dmaven.test.skip=true"],
        cwd=places.PROJECT,
        timeout=300,
    )
    assert built.ok, built.why()
    lines = (json.dumps({"context": c, "beliefs": b, "intentions": i}) for c, b, i in asked)
    (folder / "situations.jsonl").write_text("\n".join(lines) + "\n", encoding="utf-8")
    files = {str(folder / f"rules{times}.json"): times for times in bases}
    for file, times in files.items():
        Path(file).write_text(emit_compiled(bases[times]), encoding="utf-8")
    classes = [str(HARNESS / "target" / "classes"), *map(str, places.classes()), (HARNESS / "target" / "classpath.txt").read_text().strip()]
    command = [places.java(), "-cp", ":".join(classes), "org.openjdk.jmh.Main", "rotra.bench.Query"]
    command += ["-p", f"rules={','.join(files)}", "-p", f"situations={folder / 'situations.jsonl'}"]
    command += ["-f", "1", "-wi", "3", "-w", "1s", "-i", "3", "-r", "1s", "-rf", "json", "-rff", str(folder / "jmh.json")]
    outcome = run(command, cwd=folder, timeout=300)
    assert outcome.ok, outcome.why()
    for result in json.loads((folder / "jmh.json").read_text()):
        yield files[result["params"]["rules"]], result["primaryMetric"]["scorePercentiles"]["50.0"]


def in_prolog(base: RuleBase, asked: list[Situation], repeat: int, folder: Path) -> float | None:
    """The median of the queries, in microseconds; None where SWI-Prolog is not installed."""
    swipl = shutil.which("swipl")
    if swipl is None:
        return None

    def words(held: list[str]) -> str:
        return f"[{', '.join(map(atom, held))}]"

    folder.mkdir()
    (folder / "base.pl").write_text(emit_prolog(base), encoding="utf-8")
    (folder / "asked.pl").write_text("".join(f"asked({atom(c)}, {words(b)}, {words(i)}).\n" for c, b, i in asked), encoding="utf-8")
    (folder / "timed.pl").write_text(_TIMED.replace("REPEAT", str(repeat)), encoding="utf-8")
    outcome = run([swipl, "timed.pl"], cwd=folder, timeout=300)
    assert outcome.ok, outcome.why()
    return statistics.median(map(float, outcome.stdout.split()))


def test_a_query(tmp_path: Path) -> None:
    base = first(load_rule_base("uk"), RULES)
    asked = situations(base)
    bases = {times: copies(base, times) for times in TIMES}
    java = dict(in_java(bases, asked, tmp_path))
    print("\n  rules    Java  Python  SWI-Prolog   (median microseconds a query)")
    for times, larger in bases.items():
        prolog = in_prolog(larger, asked, max(1, 10 // times), tmp_path / f"prolog{times}")
        figures = {"Java": java[times], "Python": in_python(larger, asked)} | ({} if prolog is None else {"SWI-Prolog": prolog})
        keep(f"advice of {len(larger.rules)} rules, microseconds", {name: round(figure, 2) for name, figure in figures.items()})
        print(f"{len(larger.rules):7} {figures['Java']:7.2f} {figures['Python']:7.1f} {figures.get('SWI-Prolog', float('nan')):11.1f}")


def test_loading(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reader, "KEPT", tmp_path / "kept")
    took = {name: _loading() for name in ("never read before", "kept")}
    keep("loading the UK base, milliseconds", {name: round(figure, 1) for name, figure in took.items()} | {"rules": len(load_rule_base("uk").rules)})
    print("\nloading: " + ", ".join(f"{name} {figure:.0f} ms" for name, figure in took.items()))


def _loading() -> float:
    """Milliseconds; the process has what it read forgotten first."""
    reader._read_rule_base.cache_clear()
    start = time.perf_counter()
    load_rule_base("uk")
    return (time.perf_counter() - start) * 1e3
