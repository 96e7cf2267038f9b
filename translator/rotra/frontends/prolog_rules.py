"""Read a Prolog file of rules in the published form.

    rule(r175a, standard, [lightRed], [approachingTrafficLight], [must-stop_at_white_line]).      rule/5: the published form
    rule(r176, standard, [lightRed], [], [greenFilter], [], [must-stop_at_white_line]).           rule/7: with exceptions
    rule_detail(r176, paragraph, '176').  term_detail(belief, lightRed, means, 'The light ...').  what our export adds

In: the path of a .pl file.  Out: `PublishedRules`, every word as it is written there, with a remark (RB120, RB123) on
each thing that was passed over or repaired.  Errors: IO100, RB121, RB122, all those of a file at once, as `Rejected`.
Left to others: names that are fit for us, duplicates, an ontology (pipeline/rules_import.py).

An action is label-action: the label is what stands before the first hyphen, the action all the rest.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from lark import Lark, Token, Tree
from lark.exceptions import UnexpectedToken

from rotra.diagnostics import Diagnostic, Rejected, problem
from rotra.origins import Origin

_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "a": "\a", "b": "\b", "f": "\f", "v": "\v", "e": "\x1b", "s": " ", "\n": ""}
_WRITTEN = {
    "LPAR": "(", "RPAR": ")", "LSQB": "[", "RSQB": "]", "COMMA": ",", "_HYPHEN": "-", "NAME": "an atom", "QUOTED": "a quoted atom", "$END": "a full stop",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class PublishedRule:
    """`directives` are pairs of label and action."""

    name: str
    context: str
    beliefs: tuple[str, ...]
    intentions: tuple[str, ...]
    unless_beliefs: tuple[str, ...]
    unless_intentions: tuple[str, ...]
    directives: tuple[tuple[str, str], ...]
    origin: Origin


@dataclass(frozen=True, slots=True)
class PublishedDetail:
    """What our own export says besides the rules: `words` are the arguments of one fact, `about` its functor."""

    about: str
    words: tuple[str, ...]
    origin: Origin


@dataclass(frozen=True, slots=True)
class PublishedRules:
    rules: tuple[PublishedRule, ...]
    details: tuple[PublishedDetail, ...]
    remarks: tuple[Diagnostic, ...]


# The facts that are read, with the number of their arguments.
_RULES = {5, 7}
DETAILS = {"rule_base": 1, "rule_detail": 3, "term_detail": 4, "accepted": 4}

# More opening brackets than any fact needs.
_BRACKETS = 200

# A list or an atom of one fact, with its line.
_Atom = tuple[str, int]
_Term = _Atom | list[_Atom]


def read_prolog_rules(file: Path) -> PublishedRules:
    """The rules of a file in its order."""
    try:
        text = file.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason, hint = (error.strerror, "check the path") if isinstance(error, OSError) else ("not UTF-8 text", "save it as UTF-8")
        raise Rejected([problem("IO100", Origin(str(file)), f"cannot read the file: {reason}", hint)]) from error
    faults: list[Diagnostic] = []
    remarks: list[Diagnostic] = []
    rules: list[PublishedRule] = []
    details: list[PublishedDetail] = []
    for clause in _clauses(text):
        reader = _Clause(str(file), clause, faults, remarks)
        match reader.read():
            case PublishedRule() as rule:
                rules.append(rule)
            case PublishedDetail() as detail:
                details.append(detail)
    if not rules and not faults:
        faults.append(problem("RB121", Origin(str(file)), "the file holds no rule", "a rule is a fact rule(Name, Context, Beliefs, Intentions, Actions)."))
    if faults:
        raise Rejected(faults)
    return PublishedRules(tuple(rules), tuple(details), tuple(remarks))


@cache
def _parser() -> Lark:
    grammar = (Path(__file__).parent / "prolog_grammar.lark").read_text(encoding="utf-8")
    return Lark(grammar, parser="lalr", lexer="basic", start=["fact", "anything"])


def _clauses(text: str) -> Iterator[list[Token]]:
    """The tokens of each clause, its full stop included where it has one."""
    clause: list[Token] = []
    for token in _parser().lex(text):
        clause.append(token)
        if token.type == "END":
            yield clause
            clause = []
    if clause:
        yield clause


@dataclass(frozen=True, slots=True)
class _Clause:
    """One clause on its way to a fact; what is wrong with it goes to `faults`, what is passed over or repaired to `remarks`."""

    file: str
    tokens: list[Token]
    faults: list[Diagnostic]
    remarks: list[Diagnostic]

    def read(self) -> PublishedRule | PublishedDetail | None:
        first = self.tokens[0]
        functor = str(first) if first.type == "NAME" else ""
        if functor != "rule" and functor not in DETAILS:
            self._remark("RB120", first.line or 0, f"{_start(self.tokens)}: not a rule, passed over", "")
            return None
        if self.tokens[-1].type != "END":
            self._fault(self.tokens[-1].end_line or 0, f"{_start(self.tokens)}: no full stop behind the clause", "end each fact with a full stop")
            return None
        neck = next((t for t in self.tokens if t.type == "NECK"), None)
        if neck is not None:
            self._fault(neck.line or 0, f"{_start(self.tokens)}: a clause with a body", "only facts are read: write the conditions into the lists of beliefs and intentions")
            return None
        for token in self.tokens:
            if token.type == "_HYPHEN" and token != "-":
                self._remark("RB123", token.line or 0, f"{_start(self.tokens)}: {str(token)!r} is read as one hyphen", "write a plain -")
        tree = self._tree()
        if tree is None:
            return None
        arguments = [self._term(t) for t in tree.children[1:] if isinstance(t, Tree)]
        if any(a is None for a in arguments):
            return None
        return self._fact(functor, [a for a in arguments if a is not None])

    def _fact(self, functor: str, arguments: list[_Term]) -> PublishedRule | PublishedDetail | None:
        line = self.tokens[0].line or 0
        if functor != "rule":
            words = [a for a in arguments if isinstance(a, tuple)]
            if len(words) != len(arguments) or len(words) != DETAILS[functor]:
                self._fault(line, f"{functor} takes {DETAILS[functor]} atoms", "see the file that rotra rules export --format prolog writes")
                return None
            return PublishedDetail(functor, tuple(w for w, _ in words), Origin(self.file, line))
        names, lists = arguments[:2], arguments[2:]
        if len(arguments) not in _RULES or any(isinstance(a, list) for a in names) or any(isinstance(a, tuple) for a in lists):
            self._fault(line, "not the form of a rule", "rule(Name, Context, [Beliefs], [Intentions], [Actions]), or with two lists of exceptions before the actions")
            return None
        name, context = (a[0] for a in names if isinstance(a, tuple))
        beliefs, intentions, *exceptions, actions = (a for a in lists if isinstance(a, list))
        if not all(word for word, _ in (*(a for a in names if isinstance(a, tuple)), *(w for a in lists if isinstance(a, list) for w in a))):
            self._fault(line, f"{name}: an empty atom is no word", "write the word, or drop it")
            return None
        if not actions:
            self._remark("RB120", line, f"{name} asks for nothing, passed over", "give it an action, as in [must-stop]")
            return None
        directives = [self._directive(name, *a) for a in actions]
        if any(d is None for d in directives):
            return None
        unless = [_once(e) for e in exceptions] or [(), ()]
        return PublishedRule(
            name, context, _once(beliefs), _once(intentions), unless[0], unless[1], tuple(dict.fromkeys(d for d in directives if d)), Origin(self.file, line, name)
        )

    def _directive(self, rule: str, written: str, line: int) -> tuple[str, str] | None:
        label, hyphen, action = written.partition("-")
        if label and action:
            return label, action
        what = f"{rule}: the action {written} has no label" if not hyphen else f"{rule}: {written} is not a label and an action"
        self.faults.append(problem("RB122", Origin(self.file, line), what, "write label-action, as in must-stop"))
        return None

    def _tree(self) -> Tree[Token] | None:
        if sum(t.type == "LPAR" for t in self.tokens) > _BRACKETS:
            self._fault(self.tokens[0].line or 0, f"{_start(self.tokens)}: more than {_BRACKETS} brackets", "write label-action without them")
            return None
        parse = _parser().parse_interactive("", start="fact")
        try:
            for token in self.tokens[:-1]:
                parse.feed_token(token)
            return parse.feed_eof(self.tokens[-1])
        except UnexpectedToken as error:
            found = error.token
            wanted = sorted(_WRITTEN[e] for e in error.accepts or error.expected if e in _WRITTEN)
            what = "the fact ends too early" if found.type == "$END" else f"{str(found)[:40]!r} cannot stand here"
            hint = "a variable is no word: write a small first letter or quotes" if found.type == "VARIABLE" else f"expected is {' or '.join(wanted)}"
            self._fault(found.line or self.tokens[-1].line or 0, f"{_start(self.tokens)}: {what}", hint)
            return None

    def _term(self, tree: Tree[Token]) -> _Term | None:
        if tree.data == "hyphened":
            return self._atom(tree)
        items = [self._atom(t) for t in tree.children if isinstance(t, Tree) and t.data == "hyphened"]
        if len(items) != len(tree.children):
            self._fault(self.tokens[0].line or 0, f"{_start(self.tokens)}: a list in a list", "a list holds words")
            return None
        return None if any(i is None for i in items) else [i for i in items if i is not None]

    def _atom(self, tree: Tree[Token]) -> _Atom | None:
        """The text of an atom, or of atoms joined by hyphens."""
        tokens = list(tree.scan_values(lambda v: isinstance(v, Token)))
        parts = [_unquoted(str(t)) if t.type == "QUOTED" else str(t) for t in tokens]
        line = tokens[0].line or 0
        wrong = next((str(t) for t, part in zip(tokens, parts, strict=True) if part is None), None)
        if wrong is not None:
            self._fault(line, f"{wrong[:40]} cannot be read", "after a backslash stands n, t, \\, ' or a number as in \\x41\\")
            return None
        return "-".join(p for p in parts if p is not None), line

    def _fault(self, line: int, message: str, hint: str) -> None:
        self.faults.append(problem("RB121", Origin(self.file, line), message, hint))

    def _remark(self, code: str, line: int, message: str, hint: str) -> None:
        self.remarks.append(problem(code, Origin(self.file, line), message, hint))


def _once(words: list[_Atom]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(word for word, _ in words))


def _start(tokens: list[Token]) -> str:
    """How a clause begins, to name it in a message."""
    shown = "".join(str(t) for t in tokens[:3])
    return shown[:60] + ("..." if len(tokens) > 3 or len(shown) > 60 else "")


def _unquoted(token: str) -> str | None:
    """What a quoted atom says; None for an escape that Prolog does not have."""

    def escaped(match: re.Match[str]) -> str:
        if match.group(1):
            return chr(int(match.group(1), 16))
        if match.group(2):
            return chr(int(match.group(2), 8))
        if match.group(3):
            return chr(int(match.group(3)[1:], 16))
        if match.group(4):
            return _ESCAPES.get(match.group(4), match.group(4))
        return "'"

    inside = token[1:-1]
    pattern = r"\\x([0-9A-Fa-f]+)\\?|\\([0-7]+)\\|\\(u[0-9A-Fa-f]{4}|U[0-9A-Fa-f]{8})|\\([ntrabfves\n\\'\"`])|''"
    if "\\" in re.sub(pattern, "", inside):
        return None
    try:
        text = re.sub(pattern, escaped, inside)
        text.encode()
    except (ValueError, OverflowError):  # a number that is no character, or half of one
        return None
    return text
