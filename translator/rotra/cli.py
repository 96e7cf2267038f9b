"""The command line: the only place that prints and picks the exit status.

Exit status, the first that applies: 2 the input was refused, 3 an engine failed, 1 something is not as expected, 0.
In: arguments.  Out: tables and pictures, or with --json one JSON document.  Left to others: all work (pipeline/).
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial, wraps
from pathlib import Path
from typing import Any

import click
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn
from rich.table import Table

from rotra.diagnostics import Diagnostic, Rejected
from rotra.engines.jvm import EngineError

REFUSED, FAILED, UNEXPECTED = 2, 3, 1
errors = Console(stderr=True, highlight=False)
# a file or a pipe has no width of its own: wide enough for every table
screen = Console(highlight=False, width=None if sys.stdout.isatty() else 140)
_COLOUR = {"holds": "green", "violated": "red", "vacuous": "yellow", "unknown": "magenta"}
_SIGN = {"holds": "✓", "violated": "✗", "vacuous": "○", "unknown": "?"}
_MARK = {verdict: f"[{colour}]{verdict}[/]" for verdict, colour in _COLOUR.items()}


def say_json(document: Any) -> None:
    click.echo(json.dumps(document, indent=2, sort_keys=True, ensure_ascii=False))


def say(text: str) -> None:
    click.echo(text)


def warn(diagnostics: tuple[Diagnostic, ...]) -> None:
    for d in diagnostics:
        click.echo(d.text(), err=True)


def answered(command: Callable[..., int | None]) -> Callable[..., None]:
    """Turn what a command raises into messages and an exit status."""

    @wraps(command)
    def run(*args: Any, **kwargs: Any) -> None:
        as_json = bool(kwargs.get("as_json"))
        try:
            status = command(*args, **kwargs) or 0
        except Rejected as refusal:
            if as_json:
                say_json({"error": [d.as_json() for d in refusal.diagnostics]})
            else:
                warn(refusal.diagnostics)
            status = REFUSED
        except EngineError as failure:
            if as_json:
                say_json({"error": [{"code": "EN100", "message": str(failure)}]})
            else:
                click.echo(f"EN100 an engine failed: {failure}", err=True)
            status = FAILED
        except BrokenPipeError:
            status = 0
        sys.exit(status)

    return run


@contextmanager
def proving(silent: bool) -> Iterator[Callable[[str, int, int], None]]:
    """A bar that shows how far the proofs are, where somebody looks."""
    columns = (SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=errors, transient=True, disable=silent or not errors.is_terminal) as progress:
        task = progress.add_task("proving", total=None)
        yield lambda what, done, total: progress.update(task, completed=done, total=total, description=what)


as_json = click.option("--json", "as_json", is_flag=True, help="Print one JSON document and nothing else.")
rules_option = click.option("--rules", default="uk", show_default=True, help="A shipped rule base or a folder.")
instance_all = click.option("--instance", type=click.Choice(["published", "all"]), default="all", show_default=True)
instance_published = click.option("--instance", type=click.Choice(["published", "all"]), default="published", show_default=True)


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="rotra")
def main() -> None:
    """Rules of the Road Advisor, formally checked."""


@main.command()
@as_json
@answered
def doctor(as_json: bool) -> int:
    """Say what is installed, and what is missing with the command that installs it."""
    from rotra.pipeline.doctor import examine, healthy

    findings = examine()
    if as_json:
        say_json({"findings": [f.as_json() for f in findings]})
    else:
        table = Table("part", "found", "to install it")
        for f in findings:
            missing = "[red]missing[/]" if f.needed else "missing (needed only to build)"
            table.add_row(f.name, f"{f.found or missing} {f.remark}".strip(), "" if f.ok else f.install)
        screen.print(table)
    return 0 if healthy(findings) else FAILED


@main.command("list")
@as_json
@answered
def list_(as_json: bool) -> None:
    """Name what ships."""
    from rotra.pipeline.listing import shipped

    found = shipped()
    if as_json:
        say_json(found)
        return
    for kind, entries in found.items():
        table = Table(kind, "what it is")
        for name, about in entries.items():
            table.add_row(name, about)
        screen.print(table)


@main.command()
@click.argument("folder", type=click.Path(path_type=Path))
@as_json
@answered
def init(folder: Path, as_json: bool) -> None:
    """Make a starter project of your own in FOLDER."""
    from rotra.pipeline.starter import make_project

    made = make_project(folder)
    if as_json:
        say_json({"files": [str(p) for p in made]})
    else:
        for path in made:
            say(f"made {path}")
        say(f"read {folder}/README.md next")


@main.command()
@click.argument("agent")
@rules_option
@as_json
@answered
def check(agent: str, rules: str, as_json: bool) -> int:
    """Lint AGENT: the fragment, its acts, the directives it names, two acts in a step."""
    from rotra.pipeline.check import check_agent

    found = check_agent(agent, rules)
    if as_json:
        say_json({"findings": [d.as_json() for d in found]})
    elif found:
        for d in found:
            say(d.text())
    else:
        say(f"{agent}: nothing to complain about")
    return UNEXPECTED if found else 0


@main.command()
@click.option("--context", default="standard", show_default=True)
@click.option("--believes", multiple=True, help="A belief; may be repeated or hold several, separated by commas.")
@click.option("--intends", multiple=True, help="An intention; as --believes.")
@click.option("--strict", is_flag=True, help="Refuse words that the ontology does not know.")
@click.option("--from", "source", type=click.Path(path_type=Path), help="Situations, one JSON object a line.")
@rules_option
@as_json
@answered
def advise(context: str, believes: tuple[str, ...], intends: tuple[str, ...], strict: bool, source: Path | None, rules: str, as_json: bool) -> int:
    """Ask what the rules demand in a situation."""
    from rotra.pipeline.advise import advise_lines, advise_one

    if source is not None:
        status = 0
        for answer in advise_lines(rules, source, strict):
            click.echo(json.dumps(answer, sort_keys=True))
            status = REFUSED if "error" in answer else status
        return status

    def words(given: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(w.strip() for g in given for w in g.split(",") if w.strip())

    answer = advise_one(rules, context, words(believes), words(intends), strict)
    if as_json:
        say_json(answer)
        return 0
    for word in answer["unknown"]:
        click.echo(f"warning: {word!r} is not a word of this rule base; it is left out", err=True)
    table = Table("label", "action", "rules")
    for d in answer["directives"]:
        outranked = f" (outranked by {', '.join(d['outranked_by'])})" if "outranked_by" in d else ""
        table.add_row(d["label"], d["action"], ", ".join(d["rules"]) + outranked)
    screen.print(table)
    return 0


@main.group()
def rules() -> None:
    """Look at a rule base."""


@rules.command("list")
@rules_option
@as_json
@answered
def rules_list(rules: str, as_json: bool) -> None:
    """Every rule in a line."""
    from rotra.pipeline.rules_view import list_rules

    rows = list_rules(rules)
    if as_json:
        say_json({"rules": rows})
        return
    table = Table("rule", "paragraph", "what it says", "directives")
    for row in rows:
        table.add_row(row["id"], str(row["paragraph"]), row["says"], ", ".join(row["directives"]))
    screen.print(table)


@rules.command("show")
@click.argument("rule")
@rules_option
@as_json
@answered
def rules_show(rule: str, rules: str, as_json: bool) -> None:
    """One rule, whole."""
    from rotra.pipeline.rules_view import show_rule

    found = show_rule(rules, rule)
    if as_json:
        say_json(found)
    else:
        for key, value in found.items():
            say(f"{key:>12}  {', '.join(map(str, value)) if isinstance(value, list | tuple) else value}")


@rules.command("coverage")
@rules_option
@as_json
@answered
def rules_coverage(rules: str, as_json: bool) -> int:
    """Say of every paragraph which rules encode it, or why none does."""
    from rotra.pipeline.rules_coverage import MISSING, coverage

    found = coverage(rules)
    if as_json:
        say_json({"paragraphs": [p.as_json() for p in found]})
    else:
        table = Table("paragraph", "disposition", "rules, or why there are none")
        for p in found:
            table.add_row(p.paragraph, p.disposition.replace("_", " "), ", ".join(p.rules) or p.reason)
        screen.print(table)
    return UNEXPECTED if any(p.disposition == MISSING for p in found) else 0


@rules.command("check")
@rules_option
@click.option("--all", "every", is_flag=True, help="Show what is accepted, too, and every pair of rules.")
@as_json
@answered
def rules_check(rules: str, every: bool, as_json: bool) -> int:
    """Find rules that never apply, repeat or contradict each other, and words that nothing uses."""
    from rotra.pipeline.rules_check import check_rules, summed_up

    found = check_rules(rules)
    if as_json:
        say_json({"findings": [f.as_json() for f in found]})
    else:
        for finding, alike in [(f, 1) for f in found] if every else summed_up(found):
            say(f"{finding.code}: {finding.says}" + (f" (and {alike - 1} more pairs of rules)" if alike > 1 else ""))
            for line in ((f"in {finding.situation}",) if finding.situation else ()) + ((f"accepted: {finding.accepted}",) if finding.accepted else ()):
                say(f"    {line}")
        say(f"{sum(not f.accepted for f in found)} findings, {sum(bool(f.accepted) for f in found)} accepted ones")
    return UNEXPECTED if any(not f.accepted for f in found) else 0


@rules.command("diff")
@click.argument("ours", metavar="A")
@click.argument("theirs", metavar="B")
@click.option("--all", "every", is_flag=True, help="Show the rules that are the same, too.")
@click.option("--verdicts", is_flag=True, help="Say which verdicts of the catalogue differ, and why.")
@click.option("--agent", "agents", multiple=True, help="With --verdicts: a driver; all shipped ones if left out.")
@click.option("--scenario", "scenarios", multiple=True, help="With --verdicts: a scenario; all shipped ones if left out.")
@as_json
@answered
def rules_diff(ours: str, theirs: str, every: bool, verdicts: bool, agents: tuple[str, ...], scenarios: tuple[str, ...], as_json: bool) -> int:
    """Say rule by rule what A changes, adds and leaves out, compared with B."""
    from rotra.pipeline.rules_diff import counts, diff_rules
    from rotra.pipeline.verdicts_diff import Flip, flipped_verdicts

    rows = diff_rules(ours, theirs)
    flips: tuple[Flip, ...] = ()
    if verdicts:
        with proving(as_json) as on_done:
            flips = flipped_verdicts(ours, theirs, agents, scenarios, on_done)
    if as_json:
        say_json({"rules": [row.as_json() for row in rows], "counts": counts(rows), **({"verdicts": [f.as_json() for f in flips]} if verdicts else {})})
    else:
        for row in rows:
            if every or row.status != "same":
                name = row.ours if row.ours in (row.theirs, "") or not row.theirs else f"{row.ours} ({row.theirs})"
                say(f"{row.status:8}{name or row.theirs}, paragraph {row.paragraph}" + (f": {'; '.join(row.changes)}" if row.changes else ""))
                for line in ([row.why] if row.why else []) + ([f"NOT EXPLAINED: {'; '.join(row.open)}"] if row.open else []):
                    say(f"        {line}")
        say(", ".join(f"{number} {status}" for status, number in counts(rows).items()) + f"; {sum(bool(row.open) for row in rows)} not explained")
        for flip in flips:
            say(f"{flip.agent} in {flip.scenario}: {flip.property} is {flip.ours} under A, {flip.theirs} under B" + (f": {flip.why}" if flip.why else ""))
        if verdicts:
            say(f"{len(flips)} verdicts differ")
    return UNEXPECTED if any(row.open for row in rows) else 0


@rules.command("import")
@click.argument("source", type=click.Path(path_type=Path))
@click.option("-o", "--output", required=True, type=click.Path(path_type=Path), help="The folder to write.")
@click.option("--overlay", type=click.Path(path_type=Path), help="Meanings, aliases, exclusions and opposites that Prolog does not say.")
@click.option("--words", default="", help="A rule base whose names its words shall have, so that our drivers know them.")
@as_json
@answered
def rules_import(source: Path, output: Path, overlay: Path | None, words: str, as_json: bool) -> None:
    """Make a rule base of the Prolog facts in SOURCE."""
    from rotra.pipeline.rules_import import import_rules

    made = import_rules(source, output, overlay, words)
    if as_json:
        say_json({"files": [str(p) for p in made.files], "rules": made.rules, "remarks": [d.as_json() for d in made.remarks]})
        return
    warn(made.remarks)
    for path in made.files:
        say(f"wrote {path}")
    say(f"{made.rules} rules")


@rules.command("export")
@click.option("--format", "form", type=click.Choice(["prolog", "jason", "smv", "json"]), required=True)
@click.option("-o", "--output", type=click.Path(path_type=Path), help="The file to write; the screen if left out.")
@rules_option
@as_json
@answered
def rules_export(form: str, output: Path | None, rules: str, as_json: bool) -> None:
    """Write the rule base for Prolog, Jason or NuSMV."""
    from rotra.pipeline.rules_export import export_rules

    text = export_rules(rules, form, output)
    if as_json:
        say_json({"text": text} if output is None else {"files": [str(output)]})
    elif output is None:
        click.echo(text, nl=False)
    else:
        say(f"wrote {output}")


@main.command()
@click.option("--agent", required=True)
@click.option("--scenario", required=True)
@click.option("-o", "--output", required=True, type=click.Path(path_type=Path))
@instance_all
@rules_option
@as_json
@answered
def translate(agent: str, scenario: str, output: Path, instance: str, rules: str, as_json: bool) -> None:
    """Write the Jason project, the SMV model and the map of names between them."""
    from rotra.pipeline.translate import translate_to

    made = translate_to(agent, scenario, instance, rules, output)
    if as_json:
        say_json({"files": [str(p) for p in made]})
    else:
        for path in made:
            say(f"wrote {path}")


@main.command()
@click.option("--agent", "agents", multiple=True, help="A shipped driver or an .asl file; all shipped ones if left out.")
@click.option("--scenario", "scenarios", multiple=True, help="A shipped scenario or a file; all shipped ones if left out.")
@click.option("--property", "names", multiple=True, help="The id of a property; all if left out.")
@click.option("--properties", "catalogues", multiple=True, help="A properties file of your own, instead of the catalogue.")
@instance_all
@rules_option
@click.option("-o", "--output", type=click.Path(path_type=Path), help="Write models, verdicts, counterexamples and witnesses here.")
@click.option("--jobs", default=2, show_default=True, type=click.IntRange(1, 64))
@click.option("--timeout", default=600.0, show_default=True, help="Seconds for one driver in one scenario.")
@click.option("--timings", is_flag=True, help="Print the seconds of each phase.")
@as_json
@answered
def verify(agents: tuple[str, ...], scenarios: tuple[str, ...], names: tuple[str, ...], catalogues: tuple[str, ...], instance: str, rules: str, output: Path | None, jobs: int, timeout: float, timings: bool, as_json: bool) -> int:
    """Prove the properties of drivers in scenarios."""
    from rotra.pipeline.campaign import Wanted, run_campaign

    wanted = Wanted(agents, scenarios, names, catalogues, instance, rules, output, jobs, timeout)
    with proving(as_json) as on_done:
        result = run_campaign(wanted, on_done)
    if as_json:
        say_json({"verdicts": [row.as_json() for row in result.rows], **({"timings": result.timings} if timings else {})})
    else:
        _matrix(result.rows)
        for note in result.notes:
            say(f"note: {note}")
        if timings:
            table = Table("phase", "seconds")
            for phase, seconds in result.timings.items():
                table.add_row(phase, f"{seconds:.2f}")
            screen.print(table)
    if any(row.failed for row in result.rows):
        return FAILED
    return UNEXPECTED if any(row.as_expected is False or row.verdict == "unknown" for row in result.rows) else 0


def _matrix(rows: tuple[Any, ...]) -> None:
    scenarios = list(dict.fromkeys(r.scenario for r in rows))
    drivers = list(dict.fromkeys(r.agent for r in rows))
    cells = {(r.scenario, r.agent, r.property): r for r in rows}
    if len(scenarios) > 1:
        screen.print(_compact(cells, scenarios, drivers, rows[0].instance))
        signs = ", ".join(f"{sign} {verdict}" for verdict, sign in _SIGN.items())
        screen.print(f"{signs}; ! not as expected, - not asked there. In each cell: {', '.join(drivers)}.")
    else:
        table = Table(f"{scenarios[0]} ({rows[0].instance})" if rows else "", *drivers)
        for name in dict.fromkeys(r.property for r in rows):
            here = [cells.get((scenarios[0], d, name)) for d in drivers]
            table.add_row(name, *("" if r is None else _MARK[r.verdict] + ("" if r.as_expected is not False else f" [red]!! {r.expected} expected[/]") for r in here))
        screen.print(table)
    for row in rows:
        if row.as_expected is False:
            reason = f": {row.reason}" if row.reason else ""
            say(f"{row.agent} in {row.scenario}: {row.property} is {row.verdict}, {row.expected} was expected{reason}")
    counts = {v: sum(r.verdict == v for r in rows) for v in _MARK}
    as_expected = sum(r.as_expected is not False for r in rows)
    say(f"{len(rows)} verdicts: " + ", ".join(f"{n} {v}" for v, n in counts.items() if n) + f"; {as_expected} as expected, {len(rows) - as_expected} not")


def _compact(cells: dict[tuple[str, str, str], Any], scenarios: list[str], drivers: list[str], instance: str) -> Table:
    """One table for all: a line a property, a sign a driver."""
    table = Table(f"instance {instance}", *scenarios)
    for name in dict.fromkeys(name for _, _, name in cells):
        line = []
        for scenario in scenarios:
            here = [cells.get((scenario, driver, name)) for driver in drivers]
            signs = ("-" if r is None else f"[{_COLOUR[r.verdict]}]{_SIGN[r.verdict]}[/]" + ("[red]![/]" if r.as_expected is False else "") for r in here)
            line.append("" if not any(here) else " ".join(signs))
        table.add_row(name, *line)
    return table


@main.command()
@click.option("--agent", required=True)
@click.option("--scenario", required=True)
@click.option("--steps", default=40, show_default=True, type=click.IntRange(1, 10_000_000))
@instance_published
@rules_option
@click.option("--then", "changes", multiple=True, metavar="RULES@STEP", help="From that step on other rules advise, as in de@20; may be repeated.")
@click.option("--seed", type=int, default=None, help="Chance for all that the instance leaves open.")
@click.option("--until", type=click.Choice(["crashed", "finished"]), default=None)
@click.option("--trace", "trace_file", type=click.Path(path_type=Path), help="Write the trace as JSON.")
@click.option("--watch", is_flag=True, help="Step through the run on the screen.")
@as_json
@answered
def run(agent: str, scenario: str, steps: int, instance: str, rules: str, changes: tuple[str, ...], seed: int | None, until: str | None, trace_file: Path | None, watch: bool, as_json: bool) -> int:
    """Drive an agent in Jason."""
    from rotra.pipeline.drive import drive, read_changes, write_trace

    trace = drive(agent, scenario, steps, instance, rules, seed, until, read_changes(changes, steps))
    if trace_file is not None:
        write_trace(trace_file, trace)
    if as_json:
        say_json(trace)
    else:
        _show_run(trace, watch)
    return UNEXPECTED if trace.get("fault") else 0


def _show_run(trace: dict[str, Any], watch: bool) -> None:
    from rotra.pipeline.draw import draw_step

    if watch:
        for step in trace["steps"]:
            screen.clear()
            say(draw_step(trace["rows"], step, trace["lights"]))
            if sys.stdin.isatty():
                click.pause("any key for the next step")
        return
    table = Table("step", "at", "speed", "lights", "intends", "must", "should", "act", "ignored")
    for s in trace["steps"]:
        car = s["cars"].get("driver", {})
        place = f"{car['x']},{car['y']} {car['heading']}" if car else ""
        advice = s.get("advice", [])
        table.add_row(
            str(s["step"]), place + (" [red]crashed[/]" if car.get("crashed") else ""), str(car.get("speed", "")), ", ".join(f"{k} {v}" for k, v in s.get("lights", {}).items()),
            ", ".join(s.get("situation", {}).get("intentions", [])), *(str(sum(d["label"] == label for d in advice)) for label in ("must", "should")),
            s.get("acts", {}).get("driver", ""), ", ".join(f"{d['label']} {d['action']}" for d in s.get("ignored", [])),
        )
    screen.print(table)
    if trace.get("fault"):
        say(f"fault: {trace['fault']}")


@main.command()
@click.argument("trace", type=click.Path(path_type=Path))
@click.option("--full", is_flag=True, help="All of every step, not only what changed.")
@rules_option
@answered
def explain(trace: Path, full: bool, rules: str) -> None:
    """Tell a trace in the words of the rules and plans."""
    from rotra.frontends.rules import load_rule_base
    from rotra.pipeline.blame import better_act
    from rotra.pipeline.explain import explain as tell
    from rotra.pipeline.explain import read_trace
    from rotra.pipeline.silence import silent_rules

    document = read_trace(trace)
    base = load_rule_base(document.get("rules") or rules)
    every = [*(load_rule_base(step["rules"]) for step in document["steps"] if "rules" in step), base]
    say(tell(document, full, {r.id: (str(r.paragraph), r.says) for one in every for r in one.rules}, better_act(base), partial(silent_rules, base)))


@main.command()
@click.argument("trace", type=click.Path(path_type=Path))
@as_json
@answered
def replay(trace: Path, as_json: bool) -> int:
    """Drive the path of a trace in Jason and say whether it happens there."""
    from rotra.pipeline.explain import read_trace
    from rotra.pipeline.replay import replay_trace

    divergence = replay_trace(read_trace(trace))
    if as_json:
        say_json({"happened": divergence is None, "divergence": divergence})
    elif divergence is None:
        say("it happened: Jason took the same path")
    else:
        say(f"it parts at step {divergence['step']}: {divergence['what']} is {divergence['jason']} in Jason, {divergence['trace']} in the trace")
    return 0 if divergence is None else UNEXPECTED


@main.command()
@click.argument("first")
@click.argument("second")
@click.option("--scenario", "scenarios", multiple=True, help="A shipped scenario or a file; all shipped ones if left out.")
@instance_all
@rules_option
@click.option("--timeout", default=120.0, show_default=True)
@as_json
@answered
def compare(first: str, second: str, scenarios: tuple[str, ...], instance: str, rules: str, timeout: float, as_json: bool) -> int:
    """Are two drivers the same, and if not, where do they part?"""
    from rotra.pipeline.compare import compare_drivers

    answers = compare_drivers(first, second, scenarios, instance, rules, timeout)
    equal = all(a["equal"] for a in answers)
    if as_json:
        say_json({"equal": equal, "divergence": next((a["divergence"] for a in answers if not a["equal"]), None), "scenarios": answers})
    else:
        for a in answers:
            say(f"{a['scenario']}: " + ("the same act in every step" if a["equal"] else f"they part in step {a['divergence']['step']}: {a['divergence']['first']} and {a['divergence']['second']}"))
    return 0 if equal else UNEXPECTED


@main.command()
@click.option("--agent", required=True)
@click.option("--scenario", required=True)
@instance_published
@rules_option
@click.option("--model", "folder", type=click.Path(path_type=Path), help="A folder that `rotra translate` wrote, instead of a fresh translation.")
@click.option("--timeout", default=300.0, show_default=True, help="Seconds for each engine.")
@as_json
@answered
def crosscheck(agent: str, scenario: str, instance: str, rules: str, folder: Path | None, timeout: float, as_json: bool) -> int:
    """Is the running system the model, state by state and edge by edge?"""
    from rotra.pipeline.crosscheck import crosscheck as check

    found = check(agent, scenario, instance, rules, folder, timeout)
    parted = found["divergence"]
    if as_json:
        say_json(found)
    elif parted is None:
        say(f"{agent} in {scenario} ({instance}): equal, {found['notion']}: {found['states']} states, {found['edges']} edges, {found['states_per_second']} states a second")
    else:
        say(f"{agent} in {scenario} ({instance}): they part at step {parted['step']}: {parted['what']} is {parted['jason']} in Jason, {parted['model']} in the model")
        for place in filter(None, (parted.get("from"), *parted.get("by", ()))):
            say(f"    {place}")
    return 0 if found["equal"] else UNEXPECTED


@main.command()
@click.option("-o", "--output", type=click.Path(path_type=Path), help="The folder to write.")
@click.option("--agent", "agents", multiple=True, help="A shipped driver or an .asl file; all shipped ones if left out.")
@click.option("--scenario", "scenarios", multiple=True, help="A shipped scenario or a file; all shipped ones if left out.")
@click.option("--property", "names", multiple=True, help="The id of a property; all if left out.")
@click.option("--properties", "catalogues", multiple=True, help="A properties file of your own, instead of the catalogue.")
@click.option("--key", type=click.Path(path_type=Path), help="Your private key; the bundle is unsigned without one.")
@click.option("--new-key", is_flag=True, help="Make the key first: FILE, and FILE.pub to give away.")
@click.option("--timeout", default=600.0, show_default=True, help="Seconds for one driver in one scenario.")
@as_json
@answered
def certify(output: Path | None, agents: tuple[str, ...], scenarios: tuple[str, ...], names: tuple[str, ...], catalogues: tuple[str, ...], key: Path | None, new_key: bool, timeout: float, as_json: bool) -> int:
    """Prove, and write a bundle of evidence that others can check."""
    from rotra.evidence.bundle import passed, title
    from rotra.evidence.statement import load_private
    from rotra.evidence.statement import new_key as make_key
    from rotra.pipeline.campaign import Wanted
    from rotra.pipeline.certify import certify as make_bundle

    if output is None and not new_key:
        raise click.UsageError("say with -o where the bundle shall be, or with --new-key that you want a key")
    key = Path("rotra.key") if new_key and key is None else key
    made = make_key(key) if new_key and key is not None else ()
    signing = None if key is None else load_private(key)
    rows: list[dict[str, Any]] = []
    if output is not None:
        with proving(as_json) as on_done:
            rows = make_bundle(Wanted(agents, scenarios, names, catalogues, "all", "uk", None, 1, timeout), output, signing, on_done)
    signed = "unsigned" if signing is None else "signed"
    if as_json:
        say_json({"keys": [str(p) for p in made], "bundle": None if output is None else str(output), "signature": signed, "verdicts": [{k: r[k] for k in ("agent", "scenario", "property", "verdict", "expected", "as_expected")} for r in rows]})
        return 0 if all(map(passed, rows)) else UNEXPECTED
    for path in made:
        say(f"made {path}")
    for row in rows:
        if not passed(row):
            say(printable(f"{title(row)} is {row['verdict']}" + (f", {row['expected']} was expected" if row["as_expected"] is False else "")))
    if output is not None:
        say(f"wrote {output}: {len(rows)} verdicts, {sum(map(passed, rows))} as expected; {signed}")
    return 0 if all(map(passed, rows)) else UNEXPECTED


def printable(text: str) -> str:
    """A stranger's text without what would steer the terminal."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


@main.group()
def evidence() -> None:
    """Look at a bundle of evidence."""


@evidence.command("verify")
@click.argument("folder", metavar="DIR", type=click.Path(path_type=Path))
@click.option("--key", type=click.Path(path_type=Path), help="The public key that it must be signed with.")
@click.option("--rerun", "again", is_flag=True, help="Prove all of it again from the inputs in it.")
@click.option("--timeout", default=600.0, show_default=True, help="With --rerun: seconds for one driver in one scenario.")
@as_json
@answered
def evidence_verify(folder: Path, key: Path | None, again: bool, timeout: float, as_json: bool) -> int:
    """Is the bundle in DIR whole, whose is it, and do its logs support what it says?"""
    from rotra.evidence.check import Judgement, check_bundle
    from rotra.evidence.statement import load_public

    judged = check_bundle(folder, None if key is None else load_public(key))
    if again and judged.accepted:
        from rotra.pipeline.certify import rerun

        with proving(as_json) as on_done:
            judged = Judgement(tuple(rerun(folder, timeout, on_done)), judged.signature)
    if as_json:
        say_json(judged.as_json())
    else:
        for fault in judged.faults:
            say(printable(f"{fault.file}: {fault.fault}"))
        signature = {"good": "signed with this key", "not checked": "signed, but no --key was given to check it", "bad": "its signature is not good"}.get(judged.signature, judged.signature)
        say(f"{'accepted' if judged.accepted else 'rejected'}; {signature}")
    return 0 if judged.accepted else UNEXPECTED


if __name__ == "__main__":
    main()
