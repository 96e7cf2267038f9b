"""Make a rule base of ours from a published Prolog file.

    rule(r135, standard, [a], [], [must-x]).          - {id: r135, published_name: r135, paragraph: 135, beliefs: [a], ...}
    rule(r135, standard, [b], [], [must-y]).    ->    - {id: r135#2, published_name: r135, paragraph: 135, beliefs: [b], ...}

In: the file; an overlay of ours with what the Prolog form does not say (meanings, aliases, exclusions, opposites, what an
action means in the grid world), in the file's words; a base whose names its words shall have; a folder.  Out: the folder's files and a remark for each thing that
was passed over or repaired.  Errors: RB107, RB125, IO104 and all of the readers.
Left to others: reading Prolog (frontends/prolog_rules.py), what is wrong with the rules (rules_check.py).
"""

from __future__ import annotations

import difflib
import re
import shutil
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import yaml

from rotra.diagnostics import Diagnostic, Rejected, problem
from rotra.frontends.prolog_rules import PublishedDetail, PublishedRule, PublishedRules, read_prolog_rules
from rotra.frontends.rules import KINDS, Ontology, check_shape, fit_name, load_rule_base, read_meanings
from rotra.frontends.yamlfile import Node, load_yaml
from rotra.origins import Origin

_MARK = "# Made by rotra rules import: change the source or the overlay and import again."
_LABELS = ("must", "should")
# The lists of a term, and of a rule as its details give them.
_LISTS = {"alias": "aliases", "excludes": "excludes", "opposite": "opposites"}
_BLOCKS = {"context": "contexts", "label": "labels", "authority": "authorities", **{kind: f"{kind}s" for kind in KINDS}}
_NOTHING = Node({}, "", 0)
_STILL = "as published it stays an alias"
_RULE_KEYS = ("paragraph", "section", "says", "note", "published_name", "authority")


@dataclass(frozen=True, slots=True)
class Imported:
    files: tuple[Path, ...]
    rules: int
    remarks: tuple[Diagnostic, ...]


def import_rules(source: Path, folder: Path, overlay: Path | None = None, words: str = "") -> Imported:
    """Write the rule base; a folder that holds anything but an earlier import is left alone.

    With `words`, a rule base, a word that this base knows gets its name there, so that what speaks its words understands
    the import, too; words that are one word there become one.  Without, every word stays itself.
    """
    _refuse_foreign(folder)
    published = read_prolog_rules(source)
    added = _load_overlay(overlay)
    names = _name(published)
    if words:
        names = _renamed(names, load_rule_base(words).ontology)
    remarks = [*published.remarks, *names.remarks]
    faults: list[Diagnostic] = []
    sections = _rules(published, names, faults)
    ontology = _ontology(source, published, names, added, faults)
    if faults:
        raise Rejected(faults)
    files = {"ontology.yaml": _text(ontology), "directives.yaml": _text(_plain(added.get("directives")))}
    for number, (section, rules) in enumerate(sections, 1):
        name = "rules.yaml" if len(sections) == 1 else f"rules_{number:0{len(str(len(sections)))}}.yaml"
        files[name] = _text({"section": section, "source": source.name, "rules": rules} | (_accepted(published, "") if number == 1 else {}))
    return Imported(_write(files, folder, added), sum(len(rules) for _, rules in sections), tuple(sorted(remarks, key=lambda d: (d.origin.line, d.code))))


# ---- names -----------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Names:
    """Our name of each word of the file, by kind; `ids`, our ids of its rules, in their order."""

    words: dict[tuple[str, str], str]
    ids: tuple[str, ...]
    remarks: tuple[Diagnostic, ...]


def _name(published: PublishedRules) -> _Names:
    remarks: list[Diagnostic] = []
    places: dict[tuple[str, str], Origin] = {}
    for detail in published.details:
        if detail.about == "term_detail":
            places.setdefault((detail.words[0], detail.words[1]), detail.origin)
    for rule in published.rules:
        for kind, word in _words_of(rule):
            places.setdefault((kind, word), rule.origin)
    words: dict[tuple[str, str], str] = {}
    for kind in dict.fromkeys(k for k, _ in places):
        fits = _action if kind == "action" else fit_name
        given = _give([w for k, w in places if k == kind], fits)
        words.update({(kind, w): name for w, name in given.items()})
        for word, name in given.items():
            if word != name:
                remarks.append(problem("RB123", places[kind, word], f"the {kind} {word!r} becomes {name}", _STILL if kind in KINDS else ""))
    ids = _ids(published.rules, remarks)
    return _Names(words, ids, tuple(remarks))


def _renamed(names: _Names, known: Ontology) -> _Names:
    """The names with those of `known` for the words that it knows."""
    found = {(kind, word): known.canonical(kind, word) if kind in KINDS else None for kind, word in names.words}
    return replace(names, words={at: found[at] or name for at, name in names.words.items()})


def _action(name: str) -> bool:
    return fit_name(name, hyphens=True)


def _words_of(rule: PublishedRule) -> Iterable[tuple[str, str]]:
    yield "context", rule.context
    for kind, words in (("belief", (*rule.beliefs, *rule.unless_beliefs)), ("intention", (*rule.intentions, *rule.unless_intentions))):
        for word in words:
            yield kind, word
    for label, action in rule.directives:
        yield "label", label
        yield "action", action


def _give(words: Iterable[str], fits: Callable[[str], bool]) -> dict[str, str]:
    """A name for each word: the word where it fits, else one like it that is free."""
    words = list(words)
    taken = {w for w in words if fits(w)}
    given = {}
    for word in words:
        if word not in taken or not fits(word):
            given[word] = _free(_like(word), taken)
            taken.add(given[word])
        else:
            given[word] = word
    return given


def _like(word: str) -> str:
    plain = re.sub(r"[^A-Za-z0-9_]+", "_", word).strip("_")
    plain = plain.lower() if plain.isupper() else plain[:1].lower() + plain[1:]
    return plain if fit_name(plain) else f"{plain}_word" if fit_name(f"{plain}_word") else f"word_{plain}".rstrip("_")


def _free(name: str, taken: set[str]) -> str:
    found, number = name, 1
    while found in taken:
        number += 1
        found = f"{name}_{number}"
    return found


def _ids(rules: tuple[PublishedRule, ...], remarks: list[Diagnostic]) -> tuple[str, ...]:
    """The name of each rule; r135#2 for the second of a name, and one like it for a name that cannot be an id."""
    fits = re.compile(r"[A-Za-z][A-Za-z0-9_]*(#[0-9]+)?")
    taken = {r.name for r in rules if fits.fullmatch(r.name)}
    stems: dict[str, str] = {}
    seen = Counter[str]()
    ids = []
    for rule in rules:
        seen[rule.name] += 1
        if seen[rule.name] > 1:
            stem = stems[rule.name]
            number = seen[rule.name]
            while (found := f"{stem}#{number}") in taken:
                number += 1
            remarks.append(problem("RB124", rule.origin, f"the name {rule.name} stands a second time; this rule becomes {found}", "give each rule a name of its own"))
        elif fits.fullmatch(rule.name):
            found = rule.name
        else:
            like = re.sub(r"[^A-Za-z0-9_]+", "_", rule.name).strip("_")
            found = _free(like if re.match("[A-Za-z]", like) else f"r_{like}".rstrip("_"), taken)
            remarks.append(problem("RB123", rule.origin, f"the rule {rule.name!r} becomes {found}", "its published_name keeps the name"))
        stems.setdefault(rule.name, found.split("#")[0])
        taken.add(found)
        ids.append(found)
    return tuple(ids)


# ---- rules -----------------------------------------------------------------------------------------------------------


def _rules(published: PublishedRules, names: _Names, faults: list[Diagnostic]) -> list[tuple[str, list[dict[str, Any]]]]:
    """The rules by section, as they stand."""
    details: dict[str, list[PublishedDetail]] = {r.name: [] for r in published.rules}
    for detail in published.details:
        if detail.about != "rule_detail":
            continue
        name, key, _ = detail.words
        if name not in details or key not in (*_RULE_KEYS, "legal"):
            what = f"there is no rule {name}" if name not in details else f"{key} is no detail of a rule"
            faults.append(problem("RB125", detail.origin, what, f"details are {', '.join((*_RULE_KEYS, 'legal'))}"))
            continue
        details[name].append(detail)
    ours = any(d.about == "rule_base" for d in published.details)
    sections: list[tuple[str, list[dict[str, Any]]]] = []
    for rule, identity in zip(published.rules, names.ids, strict=True):
        said = {d.words[1]: d.words[2] for d in details[rule.name]}
        section = said.get("section", "Rules as published")
        if not sections or sections[-1][0] != section:
            sections.append((section, []))
        sections[-1][1].append(_rule(rule, identity, names, said, [d.words[2] for d in details[rule.name] if d.words[1] == "legal"], ours) | _accepted(published, rule.name))
    return sections


def _rule(rule: PublishedRule, identity: str, names: _Names, said: dict[str, str], legal: list[str], ours: bool) -> dict[str, Any]:
    def of(kind: str, words: Iterable[str]) -> list[str]:
        return list(dict.fromkeys(names.words[kind, w] for w in words))

    number = re.search(r"\d+", rule.name)
    paragraph = said.get("paragraph", number.group() if number else rule.name or identity)
    beliefs = {name for (kind, _), name in names.words.items() if kind == "belief"}
    unless = [*of("belief", rule.unless_beliefs), *(f"intention {i}" if i in beliefs else i for i in of("intention", rule.unless_intentions))]
    found: dict[str, Any] = {
        "id": identity,
        "published_name": said.get("published_name", "" if ours and identity == rule.name else rule.name),
        "paragraph": int(paragraph) if re.fullmatch("[0-9]{1,9}", paragraph) else paragraph,
        "says": said.get("says") or _sentence(rule),
        "context": names.words["context", rule.context],
        "beliefs": of("belief", rule.beliefs),
        "intentions": of("intention", rule.intentions),
        "unless": unless,
        "directives": list(dict.fromkeys(f"{names.words['label', label]} {names.words['action', action]}" for label, action in rule.directives)),
        "legal": legal,
        "authority": said.get("authority", ""),
        "note": said.get("note", ""),
    }
    return {key: value for key, value in found.items() if value not in ("", [])}


def _sentence(rule: PublishedRule) -> str:
    """What a rule says, spelt out of its words."""
    when = [f"in context {rule.context}"]
    for opening, words in (("where", rule.beliefs), ("intending", rule.intentions), ("unless", rule.unless_beliefs), ("unless intending", rule.unless_intentions)):
        if words:
            when.append(f"{opening} {', '.join(map(spelt, words))}")
    return f"{'; '.join(when)}: {', '.join(f'{label} {spelt(action)}' for label, action in rule.directives)}"


def spelt(word: str) -> str:
    """A word in words: lightRed and light_red are light red."""
    return re.sub(r"\s+", " ", re.sub(r"(?<=[a-z0-9])(?=[A-Z])", " ", word).replace("_", " ")).strip().lower()


def _accepted(published: PublishedRules, rule: str) -> dict[str, Any]:
    found = [
        {"finding": finding, "with": other, "reason": reason} if other else {"finding": finding, "reason": reason}
        for name, finding, other, reason in (d.words for d in published.details if d.about == "accepted")
        if name == rule
    ]
    return {"accept": found} if found else {}


# ---- ontology --------------------------------------------------------------------------------------------------------


@dataclass(slots=True)
class _Draft:
    """A term on its way to the ontology."""

    means: str
    lists: dict[str, list[str]] = field(default_factory=dict)

    def add(self, key: str, words: Iterable[str]) -> None:
        kept = self.lists.setdefault(key, [])
        kept += [w for w in dict.fromkeys(words) if w not in kept]

    def plain(self) -> dict[str, Any]:
        return {"means": self.means} | {key: words for key, words in self.lists.items() if words}


def _ontology(source: Path, published: PublishedRules, names: _Names, overlay: _Overlay, faults: list[Diagnostic]) -> dict[str, Any]:
    drafts = {(kind, name): _Draft(f"{spelt(word)}, as published") for (kind, word), name in names.words.items()}
    for (kind, word), name in names.words.items():
        if word != name and kind in KINDS:
            drafts[kind, name].add("aliases", [word])
    for detail in published.details:
        if detail.about == "term_detail":
            _detail(detail, names, drafts, faults)
    overlay.apply(names, drafts, faults)
    _refuse_shared_aliases(drafts, overlay, faults)
    jurisdiction = overlay.get("jurisdiction")
    stated = next((d.words[0] for d in published.details if d.about == "rule_base"), "")
    stem = re.sub(r"[^a-z0-9]+", "_", source.stem.lower()).strip("_")
    found: dict[str, Any] = {
        "jurisdiction": str(jurisdiction.value) if jurisdiction else stated if re.fullmatch("[a-z][a-z0-9_]*", stated) else stem if stem[:1].isalpha() else f"rules_{stem}",
        "imported_from": source.name,
        "contexts": {n: d.means for (k, n), d in drafts.items() if k == "context"},
        "labels": {n: d.means for n, d in _by_rank({n: d for (k, n), d in drafts.items() if k == "label"}, published, overlay)},
        "authorities": {n: d.means for (k, n), d in drafts.items() if k == "authority"},
        **{f"{kind}s": {n: d.plain() for (k, n), d in drafts.items() if k == kind} for kind in KINDS},
    }
    return {key: value for key, value in found.items() if value or key != "authorities"}


def _by_rank(labels: dict[str, _Draft], published: PublishedRules, overlay: _Overlay) -> list[tuple[str, _Draft]]:
    """Labels as the overlay ranks them, else as the file states them, else must before should before any other."""
    stated = overlay.get("labels")
    if stated:
        rank = [name for name, _ in stated.items()]
    elif any(d.about == "term_detail" and d.words[0] == "label" for d in published.details):
        rank = list(labels)
    else:
        rank = list(_LABELS)
    return sorted(labels.items(), key=lambda item: (rank.index(item[0]) if item[0] in rank else len(rank)))


def _detail(detail: PublishedDetail, names: _Names, drafts: dict[tuple[str, str], _Draft], faults: list[Diagnostic]) -> None:
    kind, word, key, value = detail.words
    if kind not in _BLOCKS or not value:
        faults.append(problem("RB125", detail.origin, f"{kind} is no kind of word" if value else f"the {key} of {word} is empty", f"kinds are {', '.join(_BLOCKS)}"))
        return
    draft = drafts[kind, names.words[kind, word]]
    if key == "means":
        draft.means = value
    elif key == "alias" and kind in KINDS:
        draft.add("aliases", [value])
    elif (key == "excludes" and kind in ("belief", "intention")) or (key == "opposite" and kind == "action"):
        if (kind, value) not in names.words:
            faults.append(problem("RB125", detail.origin, f"{value} is not a word of this file", "name a word that a rule or a term_detail holds"))
            return
        draft.add(_LISTS[key], [names.words[kind, value]])
    else:
        faults.append(problem("RB125", detail.origin, f"{key} is no detail of this {kind}", f"details are means, {', '.join(_LISTS)}"))


def _refuse_shared_aliases(drafts: dict[tuple[str, str], _Draft], overlay: _Overlay, faults: list[Diagnostic]) -> None:
    owner = {(kind, name): name for kind, name in drafts}
    for (kind, name), draft in drafts.items():
        for alias in draft.lists.get("aliases", ()):
            if owner.setdefault((kind, alias), name) != name:
                faults.append(problem("RB107", overlay.place(kind, name), f"the alias {alias} of {name} already stands for {owner[kind, alias]}", "one word, one term: drop it in one place"))


# ---- overlay ---------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Overlay:
    root: Node

    def get(self, key: str) -> Node | None:
        return self.root.get(key)

    def place(self, kind: str, name: str) -> Origin:
        node = (self.root.get(_BLOCKS[kind]) or _NOTHING).get(name)
        return (node or self.root).origin()

    def apply(self, names: _Names, drafts: dict[tuple[str, str], _Draft], faults: list[Diagnostic]) -> None:
        for kind in ("context", "label", "authority"):
            for word, node in (self.root.get(_BLOCKS[kind]) or _NOTHING).items():
                name = names.words.get((kind, word), word)
                if kind == "authority":
                    drafts[kind, name] = _Draft(str(node.value))
                elif (kind, name) in drafts:
                    drafts[kind, name].means = str(node.value)
                else:
                    faults.append(_unknown(kind, word, node, names))
        for kind in KINDS:
            for word, node in (self.root.get(_BLOCKS[kind]) or _NOTHING).items():
                found = self._resolve(kind, word, node, names, faults)
                if found is None:
                    continue
                for key, value in node.items():
                    if key == "means":
                        drafts[kind, found].means = str(value.value)
                    elif key == "aliases":
                        drafts[kind, found].add(key, [str(v.value) for v in value if v.value != found])
                    else:
                        others = [self._resolve(kind, str(v.value), v, names, faults) for v in value]
                        drafts[kind, found].add(key, [o for o in others if o is not None and o != found])

    def _resolve(self, kind: str, word: str, node: Node, names: _Names, faults: list[Diagnostic]) -> str | None:
        found = names.words.get((kind, word))
        if found is None:
            faults.append(_unknown(kind, word, node, names))
        return found


def _unknown(kind: str, word: str, node: Node, names: _Names) -> Diagnostic:
    near = difflib.get_close_matches(word, [w for k, w in names.words if k == kind], 1)
    return problem("RB125", node.origin(), f"{word} is no {kind} of the imported file", f"did you mean {near[0]}?" if near else "use the words of the file, as they are written there")


def _load_overlay(file: Path | None) -> _Overlay:
    if file is None:
        return _Overlay(_NOTHING)
    root = load_yaml(file)
    root = Node({}, root.file, 1) if root.value is None else root
    faults: list[Diagnostic] = []
    if not check_shape(root, "overlay", faults):
        raise Rejected(faults)
    directives = root.get("directives")
    if directives is not None and not check_shape(directives, "directives", faults):
        raise Rejected(faults)
    return _Overlay(root)


# ---- files -----------------------------------------------------------------------------------------------------------


def _plain(node: Node | None) -> Any:
    return {} if node is None else node.plain()


def _text(document: Any) -> str:
    dumper = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
    return f"{_MARK}\n{yaml.dump(document, Dumper=dumper, default_flow_style=None, sort_keys=False, allow_unicode=True, width=150)}"


def _refuse_foreign(folder: Path) -> None:
    """A folder that is new, empty or holds nothing but an earlier import may be written."""
    if folder.is_symlink() or (folder.exists() and not folder.is_dir()):
        raise Rejected([problem("IO104", Origin(str(folder)), "there is a file of this name already", "name a folder that does not exist yet")])
    for path in sorted(folder.iterdir()) if folder.is_dir() else ():
        if not path.is_file() or path.is_symlink() or not path.read_bytes().startswith(_MARK.encode()):
            raise Rejected([problem("IO104", Origin(str(folder)), f"the folder holds {path.name}, which no import wrote", "name an empty folder, or one that does not exist yet")])


def _write(files: dict[str, str], folder: Path, overlay: _Overlay) -> tuple[Path, ...]:
    """All of the files or none: they are made beside their place, read back as any rule base is, and then moved there."""
    try:
        folder.absolute().parent.mkdir(parents=True, exist_ok=True)
        made = Path(tempfile.mkdtemp(prefix=".rotra-import-", dir=folder.absolute().parent))
        try:
            for name, text in files.items():
                (made / name).write_text(text, encoding="utf-8")
            _refuse_meanings(made, overlay)
            load_rule_base(made)
            made.chmod(0o755)
            if folder.is_dir():
                for path in folder.iterdir():
                    path.unlink()
                for path in sorted(made.iterdir()):
                    path.replace(folder / path.name)
            else:
                made.replace(folder)
        finally:
            shutil.rmtree(made, ignore_errors=True)
    except OSError as error:
        raise Rejected([problem("IO104", Origin(str(folder)), f"cannot write the rule base: {error.strerror}", "choose a place that can be written")]) from error
    return tuple(folder / name for name in sorted(files))


def _refuse_meanings(made: Path, overlay: _Overlay) -> None:
    """What is wrong with the overlay's meanings is said at the overlay's lines."""
    meanings = overlay.get("directives")
    if meanings is None:
        return
    text = (made / "directives.yaml").read_text(encoding="utf-8")
    (made / "directives.yaml").write_text("{}\n", encoding="utf-8")
    faults: list[Diagnostic] = []
    list(read_meanings(meanings, load_rule_base(made).ontology, faults))
    if faults:
        raise Rejected(faults)
    (made / "directives.yaml").write_text(text, encoding="utf-8")
