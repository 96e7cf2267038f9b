"""Prove every property of one driver in one scenario, and say what the answers are worth.

In: a Model, the properties, what is expected.  Out: `Verdict`s with traces.  Left to others: which drivers and scenarios
(cli.py), writing files (pipeline/results.py).  Design, section 7: a truth is `holds` only where initial states exist,
every state has a successor, the assumptions leave a fair path from every state, and no antecedent is hollow.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from rotra.emitters.smv import Names, Specification, emit_smv, name_everything, write_expr
from rotra.engines import places
from rotra.engines.nusmv import Answers, Check, EngineFailed, Holds, Unknown, Violated, check_model
from rotra.frontends.properties import Property
from rotra.lowering.atoms import Bound, Impossible, State, bind, expressions, hollow, is_invariant, negation, promised, to_ctl, to_ltl
from rotra.lowering.model import Model
from rotra.lowering.trace import trace_steps
from rotra.lowering.words import Words
from rotra.system.expr import Expr, Value, conj, negate

# an engine that finds a contradiction in the model itself answers nothing about any property
BROKEN = "the model has no initial state, or a state without successor, so nothing can be concluded"


@dataclass(frozen=True, slots=True)
class Verdict:
    """One row.  verdict: holds, violated, vacuous or unknown; `trace`: the steps of the counterexample, `loop` its return."""

    property: str
    verdict: str
    reason: str
    seconds: float
    steps: tuple[Mapping[str, Any], ...] = ()
    loop: int | None = None
    witness: tuple[Mapping[str, Any], ...] = ()
    witness_loop: int | None = None
    failed: bool = False


@dataclass(slots=True)
class Question:
    """What is asked of the engine about one property: check names by role.

    `enough`: if one of these holds so does the main one, `slow`, which is asked only if none does.
    """

    property: Property
    bound: Bound | None
    impossible: str = ""
    main: str = ""
    hollow: list[tuple[str, str]] = field(default_factory=list)
    fair: list[str] = field(default_factory=list)
    witness: str = ""
    enough: list[str] = field(default_factory=list)
    slow: Specification | None = None


@dataclass(slots=True)
class Record:
    """What a verdict rests on, for who wants to keep it: models and logs of the engine, and each property's checks by role."""

    models: list[str] = field(default_factory=list)
    logs: list[str] = field(default_factory=list)
    checks: list[dict[str, Any]] = field(default_factory=list)


def verify_model(model: Model, properties: Sequence[Property], timeout: float, witnesses: bool, timings: dict[str, float], record: Record | None = None) -> tuple[Verdict, ...]:
    """Verdicts in the order of the properties.  `timings` gains the seconds of each phase, `record` what the verdicts rest on.  Errors: PR1xx as `Rejected`."""
    begun = time.monotonic()
    words = Words(model)
    questions = [_question(n, p, words) for n, p in enumerate(properties)]
    system = model.system(_asked(questions, words))
    names = name_everything(system)
    specifications, checks = _specify(questions, names, words, witnesses)
    lowered = time.monotonic()
    timings["emit"] = timings.get("emit", 0) + lowered - begun
    with tempfile.TemporaryDirectory(prefix="rotra-") as folder:
        file = Path(folder) / "model.smv"
        file.write_text(emit_smv(system, model.scenario.id, specifications, names).text)
        answers = check_model(places.nusmv(), file, checks, timeout)
        _keep(record, file, answers)
        for q in questions:
            if any(isinstance(answers.checks[e], Holds) for e in q.enough):
                answers = replace(answers, checks={**answers.checks, q.main: Holds()}, seconds={**answers.seconds, q.main: sum(answers.seconds.get(e, 0.0) for e in q.enough)})
        slow = [q.slow for q in questions if q.slow is not None and q.main not in answers.checks]
        if slow:
            file.write_text(emit_smv(system, model.scenario.id, slow, names).text)
            more = check_model(places.nusmv(), file, [Check(s.name, s.kind, True) for s in slow], max(1.0, timeout - (time.monotonic() - lowered)))
            _keep(record, file, more)
            answers = replace(answers, checks={**answers.checks, **more.checks}, seconds={**answers.seconds, **more.seconds})
    timings["solve"] = timings.get("solve", 0) + time.monotonic() - lowered
    begun = time.monotonic()
    verdicts = tuple(_verdict(q, answers, names, model) for q in questions)
    if record is not None:
        record.checks += [_roles(q) for q in questions]
    timings["traces"] = timings.get("traces", 0) + time.monotonic() - begun
    return verdicts


def _keep(record: Record | None, file: Path, answers: Answers) -> None:
    if record is not None:
        record.models.append(file.read_text())
        record.logs.append(answers.log.replace(str(file), file.name))


def _roles(q: Question) -> dict[str, Any]:
    """The names of the checks as evidence/check.py reads them; none where the property was not asked."""
    if q.bound is None or q.impossible:
        return {}
    return {"main": q.main, "enough": q.enough, "fair": q.fair, "hollow": [name for name, _ in q.hollow], "witness": q.witness}


def _question(number: int, wanted: Property, words: Words) -> Question:
    bound = bind(wanted.formula, words)
    if isinstance(bound, Impossible):
        return Question(wanted, None, bound.reason)
    return Question(wanted, bound, main=f"p{number}")


def _asked(questions: Iterable[Question], words: Words) -> list[Expr]:
    found: list[Expr] = []
    for q in questions:
        if q.bound is not None:
            found += expressions(q.bound)
            for _, b in hollow(q.property.formula, words):
                found += expressions(b)
        asked = (*q.property.assuming, *(() if q.property.witness is None else (q.property.witness,)))
        for bound in (bind(f, words) for f in asked):
            found += [] if isinstance(bound, Impossible) else expressions(bound)
    return found


def _specify(questions: list[Question], names: Names, words: Words, witnesses: bool) -> tuple[list[Specification], list[Check]]:
    """The specifications of all questions; equal ones are asked once."""
    specifications: list[Specification] = []
    checks: list[Check] = []
    known: dict[tuple[str, str], str] = {}

    def write(e: Expr) -> str:
        return write_expr(e, names)

    def ask(name: str, kind: str, text: str, trace: bool) -> str:
        if not trace and (kind, text) in known:
            return known[kind, text]
        known.setdefault((kind, text), name)
        specifications.append(Specification(name, kind, text))
        checks.append(Check(name, kind, trace))
        return name

    def never(name: str, bound: Bound, trace: bool) -> str:
        """A check that is violated iff `bound` can hold at some time."""
        if isinstance(bound, State):
            return ask(name, "invariant", write(negate(bound.expr)), trace)
        return ask(name, "ltl", f"! (F ({to_ltl(bound, write)}))", trace)

    for q in questions:
        if q.bound is None:
            continue
        fair: list[Expr] = []
        for f in q.property.assuming:
            b = bind(f, words)
            if isinstance(b, State):
                fair.append(b.expr)
            else:
                q.impossible = f"the assumption can never come true here: {b.reason}" if isinstance(b, Impossible) else "an assumption must be about one moment, without always, eventually or past words"
        if q.impossible:
            continue
        invariant = is_invariant(q.bound)
        if invariant is not None and not fair:
            ask(q.main, "invariant", write(invariant), True)
        else:
            claim = to_ltl(q.bound, write)
            if fair:
                claim = f"(({' & '.join(f'(G F ({write(e)}))' for e in fair)}) -> ({claim}))"
            # under assumptions always in LTL: its tableau is small, and fair CTL would seek fair paths in states never reached
            branching = None if fair else to_ctl(q.bound, write)
            goal = promised(q.bound) if fair else None
            if goal is not None:
                # each time the assumption holds, the next moment brings what is promised, if it is not there yet
                q.enough = [ask(f"{q.main}_enough{i}", "ctl", f"AG ({write(conj(e, negate(goal)))} -> AX {write(goal)})", False) for i, e in enumerate(fair)]
                q.slow = Specification(q.main, "ltl", claim)
            else:
                ask(q.main, "ltl" if branching is None else "ctl", branching or claim, True)
        q.fair = [ask(f"{q.main}_fair{i}", "ctl", f"AG EF ({write(e)})", False) for i, e in enumerate(fair)]
        for i, (what, b) in enumerate(hollow(q.property.formula, words)):
            q.hollow.append((never(f"{q.main}_live{i}", b, False), what))
        if q.property.witness is not None:
            seen = bind(q.property.witness, words)
            if isinstance(seen, Impossible):
                q.impossible = f"its witness can never be seen here: {seen.reason}"
            elif (state := _plain_eventually(seen)) is not None:
                q.witness = ask(f"{q.main}_witness", "invariant", write(negate(state)), witnesses)
            else:
                q.witness = ask(f"{q.main}_witness", "ltl", to_ltl(negation(seen), write), witnesses)
    return specifications, checks


def _plain_eventually(bound: Bound) -> Expr | None:
    """p of `eventually p`, where p is about one moment."""
    inner = bound.args[0] if not isinstance(bound, State) and bound.op == "eventually" else None
    return inner.expr if isinstance(inner, State) else None


def _verdict(q: Question, answers: Answers, names: Names, model: Model) -> Verdict:
    name = q.property.id
    if q.bound is None or q.impossible:
        return Verdict(name, "vacuous", q.impossible, 0.0)
    seconds = answers.seconds.get(q.main, 0.0)
    if answers.initial is False or answers.total is False:
        return Verdict(name, "unknown", BROKEN, seconds, failed=True)
    answer = answers.checks[q.main]
    match answer:
        case EngineFailed(why):
            return Verdict(name, "unknown", why, seconds, failed=True)
        case Unknown(why):
            return Verdict(name, "unknown", why, seconds)
        case Violated(states, loop):
            witness, witness_loop = _witness(q, answers, names, model)
            return Verdict(name, "violated", "", seconds, _steps(states, names, model), loop, witness, witness_loop)
    if answers.total is None:
        return Verdict(name, "unknown", "NuSMV did not say whether every state has a successor", seconds, failed=True)
    for check in q.fair:
        worth = answers.checks[check]
        if isinstance(worth, Violated):
            return Verdict(name, "vacuous", "from some reachable state no path meets the assumptions", seconds)
        if not isinstance(worth, Holds):
            return _silent(name, worth, seconds)
    for check, what in q.hollow:
        worth = answers.checks[check]
        if isinstance(worth, Holds):
            return Verdict(name, "vacuous", f"never true in any reachable state: {what}", seconds)
        if not isinstance(worth, Violated):
            return _silent(name, worth, seconds)
    if q.witness:
        worth = answers.checks[q.witness]
        if isinstance(worth, Holds):
            return Verdict(name, "vacuous", "its witness cannot be reached", seconds)
        if not isinstance(worth, Violated):
            return _silent(name, worth, seconds)
    witness, witness_loop = _witness(q, answers, names, model)
    return Verdict(name, "holds", "", seconds, witness=witness, witness_loop=witness_loop)


def _silent(name: str, answer: object, seconds: float) -> Verdict:
    why = answer.why if isinstance(answer, Unknown | EngineFailed) else "no answer"
    return Verdict(name, "unknown", why, seconds, failed=isinstance(answer, EngineFailed))


def _witness(q: Question, answers: Answers, names: Names, model: Model) -> tuple[tuple[Mapping[str, Any], ...], int | None]:
    seen = answers.checks.get(q.witness) if q.witness else None
    if not isinstance(seen, Violated) or not seen.states:
        return (), None
    return _steps(seen.states, names, model), seen.loop


def _steps(states: Sequence[Mapping[str, str]], names: Names, model: Model) -> tuple[Mapping[str, Any], ...]:
    decoded: list[dict[str, Value]] = []
    for state in states:
        values: dict[str, Value] = {}
        for text, value in state.items():
            variable = names.variable(text)
            if variable is not None:
                values[variable] = names.value(value)
        decoded.append(values)
    return tuple(trace_steps(model, decoded))

