"""Read a rule base: one jurisdiction's folder of rules, its ontology, and what its actions mean in the grid world.

    - id: r175a                                  Rule(id="r175a", beliefs=("light_red",), ...,
      beliefs: [lightRed]             ->              directives=(Directive("must", "stop_at_white_line"),),
      directives: [must stop_at_white_line]           origin=Origin("rules/uk/lights.yaml", 12))

In: a shipped name (`uk`) or the path of a folder.  Out: `RuleBase`, every name the ontology's own (aliases resolved).
Errors: IO1xx and RB1xx, all those of a base at once, as `Rejected`.  Left to others: answering (advice.py), AgentSpeak
text (emitters/agentspeak.py), conflicts between rules (rules check).
"""

from __future__ import annotations

import difflib
import hashlib
import json
import os
import pickle
import re
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

from rotra.diagnostics import Diagnostic, Rejected, problem
from rotra.frontends.meaning import ACTS, formula_fault, pattern_fault
from rotra.frontends.yamlfile import Node, load_yaml
from rotra.origins import PROJECT, Origin, shown_path

RULES = PROJECT / "rules"
SCHEMAS = RULES / "schema"
# Rule bases read without fault, by what they were read from.
KEPT = PROJECT / ".build" / "rules"
KINDS = ("belief", "intention", "action")
# Files of the folder that hold no rules.
BESIDE_THE_RULES = ("ontology.yaml", "directives.yaml", "coverage.yaml", "dropped.yaml")
# Words of AgentSpeak that cannot be atoms.
_RESERVED = frozenset("not true false div mod if else elif for while begin end include".split())


@dataclass(frozen=True, slots=True)
class Term:
    """A word.  `excludes`: what cannot hold with it; `opposites`: what cannot be done with it (actions)."""

    name: str
    kind: str
    means: str
    aliases: tuple[str, ...] = ()
    excludes: tuple[str, ...] = ()
    opposites: tuple[str, ...] = ()
    origin: Origin = Origin("")


@dataclass(frozen=True, slots=True)
class Ontology:
    """The words of a rule base.  `contexts`, `labels` and `authorities` map each word to its meaning; labels and authorities
    stand in order of rank.  `imported_from`: the file that an import read, "" for a base of our own making."""

    contexts: Mapping[str, str]
    labels: Mapping[str, str]
    beliefs: Mapping[str, Term]
    intentions: Mapping[str, Term]
    actions: Mapping[str, Term]
    names: Mapping[tuple[str, str], str]
    authorities: Mapping[str, str] = field(default_factory=dict)
    imported_from: str = ""

    def canonical(self, kind: str, word: str) -> str | None:
        """The term that a word (a name or an alias) stands for; None where it is unknown."""
        return self.names.get((kind, word))

    def terms(self, kind: str) -> Mapping[str, Term]:
        return {"belief": self.beliefs, "intention": self.intentions, "action": self.actions}[kind]

    def opposed(self) -> dict[str, frozenset[str]]:
        """The actions that cannot be done with each action, whichever of the two names the other."""
        found: dict[str, set[str]] = {}
        for term in self.actions.values():
            for word in term.opposites:
                other = self.names.get(("action", word), word)
                found.setdefault(term.name, set()).add(other)
                found.setdefault(other, set()).add(term.name)
        return {name: frozenset(others) for name, others in found.items()}


@dataclass(frozen=True, slots=True, order=True)
class Directive:
    label: str
    action: str

    def __str__(self) -> str:
        return f"{self.label} {self.action}"


@dataclass(frozen=True, slots=True)
class Acceptance:
    """A finding of `rules check` that its author knows of and leaves as it is.  `other`: the rule or word it is about."""

    finding: str
    other: str
    reason: str
    origin: Origin


@dataclass(frozen=True, slots=True)
class Rule:
    """Applicable iff the contexts are equal, its beliefs and intentions are all there, and nothing of `unless_*` is."""

    id: str
    paragraph: str
    says: str
    context: str
    beliefs: tuple[str, ...]
    intentions: tuple[str, ...]
    unless_beliefs: tuple[str, ...]
    unless_intentions: tuple[str, ...]
    directives: tuple[Directive, ...]
    legal: tuple[str, ...]
    published_name: str
    section: str
    origin: Origin
    note: str = ""
    authority: str = ""
    accept: tuple[Acceptance, ...] = ()


@dataclass(frozen=True, slots=True)
class Contradiction:
    """An act that goes against an action where `when` (over percepts) and `where` (over its variables) hold."""

    act: str
    when: str
    where: str
    origin: Origin


@dataclass(frozen=True, slots=True)
class Meaning:
    """What an action means in the grid world; or why no single act shows it, and the property that stands for it."""

    action: str
    contradicted_by: tuple[Contradiction, ...]
    not_shown: str
    proxy: str
    origin: Origin


@dataclass(frozen=True, slots=True)
class RuleBase:
    """`name` is the jurisdiction; rules stand in the order of their files and lines.  `accept`: findings about no one rule."""

    name: str
    folder: str
    ontology: Ontology
    rules: tuple[Rule, ...]
    meanings: tuple[Meaning, ...]
    accept: tuple[Acceptance, ...] = ()

    def rule(self, identity: str) -> Rule | None:
        return next((r for r in self.rules if r.id == identity), None)

    def meaning(self, action: str) -> Meaning | None:
        return next((m for m in self.meanings if m.action == action), None)


def shipped_rule_bases() -> tuple[str, ...]:
    return tuple(sorted(p.parent.name for p in RULES.glob("*/ontology.yaml")))


def load_rule_base(given: str | Path) -> RuleBase:
    """The rule base of a shipped name or of a folder of the user's own.  Errors: RB100 and all of this module's.

    It is read once for what its files hold: asked again, a process gets the same value, for a rule base never changes.
    """
    folder = _folder(given)
    return _read_rule_base(folder, _contents(folder))


def _contents(folder: Path) -> tuple[tuple[str, str], ...]:
    """The names of the files and what stands in them, in short; what cannot be read is said when it is read."""

    def short(file: Path) -> str:
        try:
            return hashlib.sha256(file.read_bytes()).hexdigest()
        except OSError:
            return ""

    return tuple((f.name, short(f)) for f in sorted([*folder.glob("*.yaml"), *folder.glob("*.yml")]))


@lru_cache(maxsize=16)
def _read_rule_base(folder: Path, contents: tuple[tuple[str, str], ...]) -> RuleBase:
    """The rule base of a folder that holds `contents`: kept from an earlier process, or read and then kept.

    What is kept was found without fault, and is known by the files' contents and those of this program.
    """
    known_as = repr((str(folder.resolve()), shown_path(str(folder)), contents, _program(), sys.version))
    kept = KEPT / f"{hashlib.sha256(known_as.encode()).hexdigest()[:32]}.pickle"
    try:
        base: RuleBase = pickle.loads(kept.read_bytes())
        return base
    except (OSError, EOFError, ValueError, LookupError, AttributeError, ImportError, pickle.UnpicklingError):
        base = _validated(folder)
    # Where nothing can be written, nothing is kept.
    with suppress(OSError):
        kept.parent.mkdir(parents=True, exist_ok=True)
        fresh = kept.with_suffix(f".{os.getpid()}")
        fresh.write_bytes(pickle.dumps(base, pickle.HIGHEST_PROTOCOL))
        fresh.replace(kept)
    return base


@cache
def _program() -> tuple[str, ...]:
    """What reads a rule base, in short: this package's readers and the schemas."""
    readers = [*Path(__file__).parent.glob("*.py"), *SCHEMAS.glob("*.json"), Path(__file__).parents[1] / "origins.py"]
    return tuple(hashlib.sha256(file.read_bytes()).hexdigest() for file in sorted(readers))


def _validated(folder: Path) -> RuleBase:
    findings: list[Diagnostic] = []
    ontology = _load_ontology(folder / "ontology.yaml", findings)
    if ontology is None:
        raise Rejected(findings)
    meanings: tuple[Meaning, ...] = ()
    if (folder / "directives.yaml").is_file():
        meanings = tuple(read_meanings(load_yaml(folder / "directives.yaml"), ontology[1], findings))
    accept: list[Acceptance] = []
    rules = tuple(_load_rules(folder, ontology[1], findings, accept))
    if not rules and not findings:
        findings.append(
            problem(
                "RB111",
                Origin(str(folder)),
                "the rule base has no rules",
                "write a file of rules beside ontology.yaml; `rotra init` makes a project to start from",
            )
        )
    if findings:
        raise Rejected(findings)
    return RuleBase(ontology[0], shown_path(str(folder)), ontology[1], rules, meanings, tuple(accept))


def _folder(given: str | Path) -> Path:
    if str(given) in shipped_rule_bases():
        return RULES / str(given)
    path = Path(given)
    if path.is_file() and path.suffix in (".yaml", ".yml"):
        path = path.parent
    if (path / "ontology.yaml").is_file():
        return path
    if path.is_dir():
        raise Rejected(
            [
                problem(
                    "RB100",
                    Origin(str(path)),
                    "the folder holds no ontology.yaml",
                    "a rule base is a folder with ontology.yaml, directives.yaml and files of rules",
                )
            ]
        )
    near = difflib.get_close_matches(str(given), shipped_rule_bases(), 1)
    hint = f"did you mean {near[0]}?" if near else f"shipped are {', '.join(shipped_rule_bases())}; or give the path of a folder"
    raise Rejected([problem("RB100", Origin(str(given)), f"there is no rule base {str(given)!r}", hint)])


# ---- shape: the JSON Schemas, their findings at the line -------------------------------------------------------------


@cache
def _validator(name: str) -> Any:
    import jsonschema

    schema = json.loads((SCHEMAS / f"{name}.schema.json").read_text(encoding="utf-8"))
    return jsonschema.Draft202012Validator(schema)


def check_shape(root: Node, schema: str, findings: list[Diagnostic]) -> bool:
    """Is the file's shape right?  Else a finding for each fault, at the line of the value that is wrong."""
    faults = sorted(_validator(schema).iter_errors(root.plain()), key=lambda e: list(map(str, e.absolute_path)))
    for fault in faults:
        node, path = root, []
        for step in fault.absolute_path:
            path.append(str(step))
            inside = node.value[step] if isinstance(node.value, (dict, tuple)) else None
            if not isinstance(inside, Node):
                break
            node = inside
        where = ".".join(path) or "the file"
        hint = f"see rules/schema/{schema}.schema.json and rules/README.md"
        if fault.validator == "additionalProperties":
            extra = [n for key, n in node.items() if key not in fault.schema.get("properties", {})]
            if any(n.value is None for n in extra):
                hint = 'put quotes around a text that holds a comma, as in `when: "stop_line(0, A)"`'
            node = extra[0]
        findings.append(problem("IO103", node.origin(), f"{where}: {_said(fault)}", hint))
    return not faults


def _said(fault: Any) -> str:
    match fault.validator:
        case "required":
            return fault.message.replace(" is a required property", " is missing")
        case "additionalProperties":
            known = sorted(fault.schema.get("properties", {}))
            return f"{fault.message.split('(')[-1].rstrip(')').replace(' was unexpected', '').replace(' were unexpected', '')} is not a key here; keys are {', '.join(known)}"
        case "pattern":
            return f"{fault.instance!r} is not written as {fault.schema.get('description', fault.validator_value)}"
        case "type":
            return f"{fault.instance!r} should be of type {fault.validator_value}"
        case "anyOf" | "oneOf":
            return fault.schema.get("description", "has none of the forms that are allowed")
    return str(fault.message)[:200]


# ---- ontology --------------------------------------------------------------------------------------------------------


def _load_ontology(file: Path, findings: list[Diagnostic]) -> tuple[str, Ontology] | None:
    root = load_yaml(file)
    if not check_shape(root, "ontology", findings):
        return None
    names: dict[tuple[str, str], str] = {}
    tables: dict[str, dict[str, Term]] = {kind: {} for kind in KINDS}
    for kind in KINDS:
        for name, node in (root.get(f"{kind}s") or Node({}, str(file), 1)).items():
            tables[kind][name] = _term(kind, name, node, findings)
    for kind in KINDS:
        for name in tables[kind]:
            names[kind, name] = name
        for name, term in tables[kind].items():
            for alias in term.aliases:
                if names.setdefault((kind, alias), name) != name:
                    findings.append(
                        problem(
                            "RB107",
                            term.origin,
                            f"the alias {alias} of {name} already stands for {names[kind, alias]}",
                            "one word, one term: drop it in one place",
                        )
                    )
    ontology = Ontology(
        _words(root, "contexts", findings),
        _words(root, "labels", findings),
        tables["belief"],
        tables["intention"],
        tables["action"],
        names,
        _words(root, "authorities", findings) if root.get("authorities") else {},
        str(root.at("imported_from").value) if root.get("imported_from") else "",
    )
    for kind in KINDS:
        for term in tables[kind].values():
            node = root.at(f"{kind}s").at(term.name)
            for key in ("excludes", "opposites"):
                for other in node.get(key) or ():
                    _resolve(ontology, kind, other, findings)
    return (str(root.at("jurisdiction").value), ontology) if not findings else None


def _words(root: Node, key: str, findings: list[Diagnostic]) -> dict[str, str]:
    found = {}
    for name, node in root.at(key).items():
        _safe(name, node, findings)
        found[name] = str(node.value)
    return found


def _term(kind: str, name: str, node: Node, findings: list[Diagnostic]) -> Term:
    _safe(name, node, findings, hyphens=kind == "action")
    plain: dict[str, Any] = node.plain()  # type: ignore[assignment]
    return Term(
        name,
        kind,
        plain["means"],
        tuple(plain.get("aliases", ())),
        tuple(plain.get("excludes", ())),
        tuple(plain.get("opposites", ())),
        Origin(shown_path(node.file), node.line, name),
    )


def fit_name(name: str, hyphens: bool = False) -> bool:
    """Can it be the name of a term, a label, a context?"""
    return bool(re.fullmatch(r"[a-z][A-Za-z0-9_-]*" if hyphens else r"[a-z][A-Za-z0-9_]*", name)) and name not in _RESERVED


def _safe(name: str, node: Node, findings: list[Diagnostic], hyphens: bool = False) -> None:
    """A name goes into AgentSpeak and SMV text as it stands, so it has to be an atom there (an imported action may hold hyphens)."""
    if fit_name(name, hyphens):
        return
    findings.append(
        problem(
            "RB106",
            node.origin(),
            f"{name!r} cannot be a name",
            "begin with a small letter and go on with letters, digits and _; not, true, false and the like are words of AgentSpeak",
        )
    )


def _resolve(ontology: Ontology, kind: str, node: Node, findings: list[Diagnostic]) -> str:
    """The term a word of a rule stands for.  Errors: RB101 unknown, RB103 a word of another kind."""
    word = str(node.value)
    name = ontology.canonical(kind, word)
    if name is not None:
        return name
    other = next((k for k in KINDS if ontology.canonical(k, word) is not None), None)
    if other is not None:
        findings.append(
            problem("RB103", node.origin(), f"{word} is {_a(other)}, but {_a(kind)} is asked for here", f"move it to `{other}s`, or use another word")
        )
    else:
        findings.append(
            problem("RB101", node.origin(), f"{word!r} is not {_a(kind)} of the ontology", _near(word, [n for k, n in ontology.names if k == kind]))
        )
    return word


def _a(kind: str) -> str:
    return ("an " if kind[0] in "aeiou" else "a ") + kind


def _near(word: str, known: Iterable[str]) -> str:
    near = difflib.get_close_matches(word, list(known), 1)
    return f"did you mean {near[0]}?" if near else "add it to ontology.yaml with its meaning"


# ---- rules -----------------------------------------------------------------------------------------------------------


def _load_rules(folder: Path, ontology: Ontology, findings: list[Diagnostic], accept: list[Acceptance]) -> Iterator[Rule]:
    first: dict[str, Rule] = {}
    for file in sorted([*folder.glob("*.yaml"), *folder.glob("*.yml")]):
        if file.name in BESIDE_THE_RULES:
            continue
        # Names of files stand in the comments of what we write, which a line end would end.
        if not str(file).isprintable():
            findings.append(problem("IO105", Origin(ascii(str(file))), "the name of a file of rules holds a line end or the like", "rename the file"))
            continue
        try:
            root = load_yaml(file)
        except Rejected as refusal:
            findings += refusal.diagnostics
            continue
        if not check_shape(root, "rules", findings):
            continue
        accept += _acceptances(root)
        for node in root.at("rules"):
            rule = _rule(node, str(root.at("section").value), ontology, findings)
            if rule.id in first:
                findings.append(
                    problem(
                        "RB102",
                        node.at("id").origin(),
                        f"the rule {rule.id} stands twice; the other is at {first[rule.id].origin.file}:{first[rule.id].origin.line}",
                        "give each rule an id of its own",
                    )
                )
                continue
            first[rule.id] = rule
            yield rule


def _rule(node: Node, section: str, ontology: Ontology, findings: list[Diagnostic]) -> Rule:
    def words(key: str, kind: str) -> tuple[str, ...]:
        return tuple(dict.fromkeys(_resolve(ontology, kind, n, findings) for n in node.get(key) or ()))

    def text(key: str, otherwise: str = "") -> str:
        found = node.get(key)
        return otherwise if found is None else str(found.value)

    context = text("context", "standard")
    if context not in ontology.contexts:
        findings.append(problem("RB110", (node.get("context") or node).origin(), f"{context!r} is not a context", _near(context, ontology.contexts)))
    directives = tuple(dict.fromkeys(_directive(n, ontology, findings) for n in node.at("directives")))
    unless = [_exception(n, ontology, findings) for n in node.get("unless") or ()]
    legal = tuple(str(n.value) for n in node.get("legal") or ())
    authority = text("authority")
    if authority and authority not in ontology.authorities:
        known = ", ".join(ontology.authorities) or "none: add `authorities:` to ontology.yaml, the strongest first"
        findings.append(problem("RB115", node.at("authority").origin(), f"{authority!r} is not an authority", f"authorities are {known}"))
    return Rule(
        id=text("id"),
        paragraph=text("paragraph"),
        says=text("says"),
        context=context,
        beliefs=words("beliefs", "belief"),
        intentions=words("intentions", "intention"),
        unless_beliefs=tuple(w for k, w in unless if k == "belief"),
        unless_intentions=tuple(w for k, w in unless if k == "intention"),
        directives=directives,
        legal=legal,
        published_name=text("published_name"),
        section=section,
        origin=Origin(shown_path(node.file), node.line, text("id")),
        note=text("note"),
        authority=authority,
        accept=_acceptances(node),
    )


def _acceptances(node: Node) -> tuple[Acceptance, ...]:
    """What a rule, or a whole file, accepts of the findings of `rules check`."""
    return tuple(
        Acceptance(str(n.at("finding").value), str(other.value) if (other := n.get("with")) else "", str(n.at("reason").value), Origin(shown_path(n.file), n.line))
        for n in node.get("accept") or ()
    )


def _exception(node: Node, ontology: Ontology, findings: list[Diagnostic]) -> tuple[str, str]:
    """A word of `unless`: of the kind that is named (`intention overtake`), else an intention where only an intention has
    that name, else a belief."""
    word = str(node.value)
    stated, _, rest = word.partition(" ")
    if stated in ("belief", "intention") and rest:
        return stated, _resolve(ontology, stated, Node(rest.strip(), node.file, node.line), findings)
    if ontology.canonical("belief", word) is None and ontology.canonical("intention", word) is not None:
        return "intention", _resolve(ontology, "intention", node, findings)
    return "belief", _resolve(ontology, "belief", node, findings)


def _directive(node: Node, ontology: Ontology, findings: list[Diagnostic]) -> Directive:
    label, _, action = str(node.value).partition(" ")
    if label not in ontology.labels:
        findings.append(
            problem(
                "RB104",
                node.origin(),
                f"{label!r} is not a label",
                f"labels are {', '.join(ontology.labels)}: write `{next(iter(ontology.labels))} {action}`",
            )
        )
    return Directive(label, _resolve(ontology, "action", Node(action.strip(), node.file, node.line), findings))


# ---- what the actions mean in the grid world -------------------------------------------------------------------------


def read_meanings(root: Node, ontology: Ontology, findings: list[Diagnostic]) -> Iterator[Meaning]:
    """The entries of a directives file."""
    if not check_shape(root, "directives", findings):
        return
    seen: dict[str, str] = {}
    for word, node in root.items():
        action = _resolve(ontology, "action", Node(word, node.file, node.line), findings)
        if action in seen:
            findings.append(problem("RB107", node.origin(), f"{word} and {seen[action]} are the same action", "keep one entry"))
        seen[action] = word
        against = tuple(_contradiction(n, findings) for n in node.get("contradicted_by") or ())
        plain: dict[str, Any] = node.plain()  # type: ignore[assignment]
        yield Meaning(action, against, plain.get("not_shown", ""), plain.get("proxy", ""), Origin(shown_path(node.file), node.line, word))


def _contradiction(node: Node, findings: list[Diagnostic]) -> Contradiction:
    act = str(node.at("act").value)
    fault = pattern_fault(act)
    if fault:
        near = difflib.get_close_matches(act.split("(")[0], ACTS, 1)
        findings.append(
            problem(
                "RB105",
                node.at("act").origin(),
                fault,
                f"did you mean {near[0]}?" if near and near[0] != act.split("(")[0] else "acts are wait, forward(N), change_lane(S, N), turn(S, N)",
            )
        )
    parts = {}
    for key in ("when", "where"):
        part = node.get(key)
        parts[key] = "" if part is None else str(part.value)
        fault = formula_fault(parts[key]) if part is not None else ""
        if part is not None and fault:
            findings.append(
                problem("RB108", part.origin(), f"`{parts[key]}`: {fault}", "write a condition over percepts, as in `stop_line(0, A) & A >= 0`")
            )
    return Contradiction(act, parts["when"], parts["where"], Origin(shown_path(node.file), node.line, act))
