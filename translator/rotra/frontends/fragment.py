"""Is an agent inside the fragment that is translated?  What can be told from the text alone is told here, all at once.

In: an Agent as Jason's parser sees it, the fastest move of the world.  Out: nothing, or `Rejected` with AG1xx codes.
Left to others: what only shows while minds are explored (lowering/): domains, growth, order.  See agents/README.md.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator

from rotra.diagnostics import Diagnostic, Rejected, problem
from rotra.frontends.agent import Agent, Formula, Plan, Step, literals_of, steps_of
from rotra.frontends.terms import Struct, Term, Var, is_ground, show
from rotra.origins import Origin

PERCEPTS = {"road": 3, "car": 2, "light": 3, "stop_line": 2, "speed": 1, "limit": 1, "heading": 1, "drives": 1, "task": 1}
ACTS = {"wait": 0, "forward": 1, "change_lane": 2, "turn": 2}
_IN_BODIES = frozenset(".print .println .log .fail .drop_intention .drop_desire .abolish .intend .desire .member .count .ground".split())
_IN_FORMULAS = frozenset(".print .println .log .intend .desire .member .count .ground".split())
_MESSAGES = frozenset(".send .broadcast .my_name .all_names .receive".split())
_CLOCK = frozenset(".wait .at .time .date .random .random_element .shuffle .nano_time math.random system.time".split())
_STEPS = frozenset("action internal achieve achieve_new test add add_end add_new del del_new update constraint if".split())
_ERROR_ANNOTATIONS = frozenset("error busy no_such_act".split())


def check_fragment(agent: Agent, top_speed: int) -> None:
    """Errors: AG101 to AG103 and AG111 to AG115, every one found, as one `Rejected`."""
    found = [*_unread(agent), *_knowledge(agent), *_triggers(agent), *_bodies(agent, top_speed), *_formulas(agent)]
    if found:
        raise Rejected(found)


def _unread(agent: Agent) -> Iterator[Diagnostic]:
    for unread in agent.unread:
        hint = "leave the annotation out; a driver cannot tell beliefs apart by it" if unread.code == "AG114" else "write it without; agents/README.md lists the fragment"
        yield problem(unread.code, unread.origin, f"{unread.what} is not translated", hint)


def _knowledge(agent: Agent) -> Iterator[Diagnostic]:
    for rule in agent.knowledge:
        if PERCEPTS.get(rule.head.name) == len(rule.head.args) and not rule.head.negated:
            yield problem("AG112", rule.origin, f"{show(rule.head)} is a percept; a driver cannot believe it on its own account", "give your own belief another name, as in `seen(car)`")


def _derived(agent: Agent) -> frozenset[tuple[str, int]]:
    own = {(r.head.name, len(r.head.args)) for r in agent.knowledge if r.body.op != "true"}
    return frozenset(own | {("advised", 2), ("advised_next", 2), ("intends", 1)})


def _triggers(agent: Agent) -> Iterator[Diagnostic]:
    for plan in agent.plans:
        trigger = plan.trigger
        if trigger.op not in ("+", "-") or trigger.type not in ("belief", "achieve", "test"):
            yield problem("AG113", plan.origin, f"the trigger {trigger} is not translated", "use +!g, -!g, +b or -b")
        elif trigger.type == "belief" and (trigger.literal.name, len(trigger.literal.args)) in _derived(agent):
            yield problem("AG111", plan.origin, f"{trigger} never happens: {trigger.literal.name} is derived by rules, and Jason raises no event for it", "ask for it in the context of a goal that calls itself, as in `+!drive : advised(must, A) <- ...; !drive`")
        for annotation in plan.annotations:
            if annotation != Struct("atomic"):
                yield problem("AG114", plan.origin, f"the annotation {show(annotation)} of a plan is not translated", "leave it out; only [atomic] is translated")
        for annotation in trigger.annotations:
            if not (isinstance(annotation, Struct) and annotation.name in _ERROR_ANNOTATIONS):
                yield problem("AG114", plan.origin, f"the annotation {show(annotation)} of a trigger is not translated", "leave it out, or use error(E), busy or no_such_act in a -! plan")


def _bodies(agent: Agent, top_speed: int) -> Iterator[Diagnostic]:
    for plan in agent.plans:
        for step in steps_of(plan.body):
            yield from _step(plan, step, top_speed)
    for literal, origin in agent.goals:
        if not is_ground(literal):
            yield problem("AG104", origin, f"the initial goal {show(literal)} has a variable", "write the value")


def _step(plan: Plan, step: Step, top_speed: int) -> Iterator[Diagnostic]:
    if step.kind not in _STEPS:
        yield problem("AG113", step.origin, f"`{step.kind}` in plan {plan.title} is not translated", "use if/else, or a goal that calls itself last")
    elif step.kind == "action":
        yield from _act(step, top_speed)
    elif step.kind == "internal":
        yield from _internal(step.name, step.origin, _IN_BODIES)
    elif step.kind in ("add", "add_end", "add_new", "del", "del_new", "update") and isinstance(step.literal, Struct):
        if step.literal.name in PERCEPTS and PERCEPTS[step.literal.name] == len(step.literal.args):
            yield problem("AG112", step.origin, f"{show(step.literal)} is a percept; a driver cannot change what it senses", "give your own belief another name, as in `+seen(car)`")


def _act(step: Step, top_speed: int) -> Iterator[Diagnostic]:
    act = step.literal
    if isinstance(act, Var):
        yield problem("AG101", step.origin, f"the act is a variable, {act.name}", "write the act out")
        return
    assert isinstance(act, Struct)
    if ACTS.get(act.name) != len(act.args):
        near = difflib.get_close_matches(act.name, ACTS, 1)
        hint = f"did you mean `{near[0]}`?" if near and near[0] != act.name else "the acts are wait, forward(N), change_lane(left|right, N), turn(left|right, N)"
        yield problem("AG101", step.origin, f"there is no act {act.name}/{len(act.args)}", hint)
        return
    if act.args and isinstance(act.args[-1], int) and not 1 <= act.args[-1] <= top_speed:
        yield problem("AG101", step.origin, f"{show(act)} asks for {act.args[-1]} cells; 1 to {top_speed} can be asked for here", "stay within the scenario's top speed")
    if len(act.args) == 2 and is_ground(act.args[0]) and act.args[0] not in (Struct("left"), Struct("right")):
        yield problem("AG101", step.origin, f"{show(act)}: {show(act.args[0])} is no side", "say left or right")


def _internal(name: str, origin: Origin, allowed: Iterable[str]) -> Iterator[Diagnostic]:
    if name in _MESSAGES:
        yield problem("AG102", origin, f"{name} sends or reads messages, which is not translated", "let the driver sense the other car instead")
    elif name in _CLOCK:
        yield problem("AG103", origin, f"{name} depends on the clock or on chance, so no run could be repeated", "wait with the act `wait`, and decide by percepts")
    elif name not in allowed:
        near = difflib.get_close_matches(name, allowed, 1)
        yield problem("AG102", origin, f"the internal action {name} is not translated here", f"did you mean {near[0]}?" if near else f"translated are {', '.join(sorted(allowed))}")


def _formulas(agent: Agent) -> Iterator[Diagnostic]:
    everywhere = [(r.body, r.origin) for r in agent.knowledge] + [(p.context, p.origin) for p in agent.plans]
    for plan in agent.plans:
        for step in steps_of(plan.body):
            everywhere += [(f, step.origin) for f in (step.formula, *(c for c, _ in step.branches)) if f is not None]
    for formula, origin in everywhere:
        yield from _formula(formula, origin)
    for rule in agent.knowledge:
        if rule.body.op == "true" and not is_ground(rule.head):
            yield problem("AG104", rule.origin, f"the belief {show(rule.head)} has a variable", "write the value, or make it a rule with a body")


def _formula(formula: Formula, origin: Origin) -> Iterator[Diagnostic]:
    if formula.op == "internal":
        yield from _internal(formula.name, origin, _IN_FORMULAS)
    elif formula.op == "lit" and isinstance(formula.args[0], Struct) and "." in formula.args[0].name:
        yield from _internal(formula.args[0].name, origin, _IN_FORMULAS)  # one that Jason does not know either, read as a belief
    elif formula.op == "rel" and formula.name == "=..":
        yield problem("AG113", origin, "`=..` is not translated", "name the literal")
    elif formula.op in ("and", "or", "not"):
        for part in formula.args:
            yield from _formula(part, origin)


def called_goals(plan: Plan) -> Iterator[Term]:
    """The goals that a plan adopts."""
    return (s.literal for s in steps_of(plan.body) if s.kind in ("achieve", "achieve_new") and s.literal is not None)


def asked_literals(agent: Agent) -> Iterator[tuple[Struct, Origin]]:
    """Every literal that a context, a rule or a test asks for, with the place."""
    for rule in agent.knowledge:
        yield from ((lit, rule.origin) for lit in literals_of(rule.body) if isinstance(lit, Struct))
    for plan in agent.plans:
        yield from ((lit, plan.origin) for lit in literals_of(plan.context) if isinstance(lit, Struct))
        for step in steps_of(plan.body):
            for formula in (step.formula, *(c for c, _ in step.branches)):
                if formula is not None:
                    yield from ((lit, step.origin) for lit in literals_of(formula) if isinstance(lit, Struct))
