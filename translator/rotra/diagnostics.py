"""What a user's mistake is answered with: a stable code, the place, the line itself and a way out.

In: the findings of a stage.  Out: `Rejected`, raised once a stage with all its diagnostics.  Left to others: printing
and the exit status (cli.py).  Any other exception is a bug of ours.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from rotra.origins import Origin, real_path

# Every code once, with its title; tests/test_diagnostics.py demands a case file for each.
CODES: dict[str, str] = {
    "IO100": "file not found or not readable",
    "IO101": "not well-formed YAML",
    "IO102": "a key stands twice in one mapping",
    "IO103": "the shape is not what the schema asks for",
    "IO104": "output would leave its folder or overwrite a foreign file",
    "IO105": "a file name that cannot stand in a Jason project",
    "SC100": "no such scenario",
    "SC101": "a car off the road",
    "SC102": "rows of different length",
    "SC103": "two cars on one cell",
    "SC104": "a limit larger than the radius",
    "SC105": "a goal that cannot be",
    "SC106": "a light that cannot be",
    "SC107": "something that needs a grid",
    "SC108": "one name for two things",
    "SC109": "no such percept",
    "SC110": "a world text that cannot be read",
    "SC111": "a line of a world text that is passed over",
    "SC112": "a mirror of a mirror",
    "RB100": "no such rule base",
    "RB101": "a word that the ontology does not know",
    "RB102": "two rules with one id",
    "RB103": "a term of the wrong kind",
    "RB104": "not a label",
    "RB105": "a meaning names an act that does not exist",
    "RB106": "not usable as a name",
    "RB107": "one word for two terms",
    "RB108": "a condition that cannot be read",
    "RB110": "not a context",
    "RB111": "a rule base without rules",
    "RB112": "a word of a situation that the ontology does not know",
    "RB113": "no such rule",
    "RB114": "a situation that cannot be read",
    "RB115": "not an authority",
    "RB120": "a clause of a Prolog file that is passed over",
    "RB121": "a Prolog fact that cannot be read",
    "RB122": "an action without a label",
    "RB123": "a name repaired on import",
    "RB124": "a rule name that stands twice in an import",
    "RB125": "an overlay or a detail speaks of what the import does not hold",
    "RB126": "an accepted finding that is not found",
    "RB130": "a paragraph disposed of twice",
    "AG100": "Jason's parser refuses the agent",
    "AG101": "no such act",
    "AG102": "internal action not translated",
    "AG103": "depends on the clock or on chance",
    "AG104": "a variable without a finite domain",
    "AG105": "recursion that grows the mind",
    "AG106": "the answer depends on which belief was added last",
    "AG107": "rules that call each other without end",
    "AG108": "a goal that calls itself last and returns a value",
    "AG109": "too many events in one step",
    "AG110": "unbounded counting",
    "AG111": "a trigger on a derived literal",
    "AG112": "an own belief named like a percept",
    "AG113": "construct outside the fragment",
    "AG114": "annotation outside the fragment",
    "AG116": "no such agent",
    "AG120": "a directive that no rule gives",
    "AG121": "two acts in one step",
    "PR101": "a property id stands twice",
    "PR102": "a formula that cannot be read",
    "PR103": "an unknown word in a formula",
    "PR104": "a rule cited that is not there",
    "PR105": "a word with the wrong number of arguments",
    "PR106": "a term that the ontology does not know",
    "PR107": "a variable that no forall binds",
    "PR108": "a range that holds nothing",
    "PR109": "an act, percept or heading that does not exist",
    "PR110": "no such property",
    "PR111": "an expectation that is never asked",
    "CC100": "a scenario with too many states to try every one",
    "CC101": "a translation that is not there",
    "EV101": "a key that cannot be read",
    "EV102": "a key that would be overwritten",
    "EV103": "not a bundle of evidence",
    "TR101": "a trace that is not JSON",
    "TR102": "a trace with a key missing or of the wrong type",
    "TR103": "a trace that cannot be replayed",
    "TR104": "a change of rules in a run that cannot be made",
}


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One finding.  `source_line` is the text of the line, "" where there is none to show."""

    code: str
    origin: Origin
    message: str
    hint: str = ""
    source_line: str = ""

    def text(self) -> str:
        """The finding as the terminal shows it: place, code, message, the line itself, the way out."""
        lines = [f"{self.origin.file}:{self.origin.line}: {self.code} {self.message}"]
        if self.source_line:
            lines.append(f"  {self.origin.line:>3} | {self.source_line}")
        if self.hint:
            lines.append(f"      hint: {self.hint}")
        return "\n".join(lines)

    def as_json(self) -> dict[str, object]:
        return {
            "code": self.code,
            "file": self.origin.file,
            "line": self.origin.line,
            "message": self.message,
            "hint": self.hint,
            "source_line": self.source_line,
        }


class Rejected(Exception):
    """The input was refused; carries at least one diagnostic, sorted by place."""

    def __init__(self, diagnostics: Iterable[Diagnostic]) -> None:
        self.diagnostics = tuple(sorted(set(diagnostics), key=lambda d: (d.origin.file, d.origin.line, d.code, d.message)))
        super().__init__("\n".join(d.text() for d in self.diagnostics))

    def __reduce__(self) -> tuple[type[Rejected], tuple[tuple[Diagnostic, ...]]]:
        """A refusal in a worker process reaches the command whole."""
        return Rejected, (self.diagnostics,)


def problem(code: str, origin: Origin, message: str, hint: str = "") -> Diagnostic:
    """A diagnostic with the text of its own line read back from the file, where the file can still be read."""
    if code not in CODES:
        raise KeyError(f"diagnostic code {code} is not in the catalogue")
    return Diagnostic(code, origin, message, hint, _line_of(origin))


def _line_of(origin: Origin) -> str:
    if not origin.line:
        return ""
    try:
        lines = real_path(origin.file).read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return ""
    return lines[origin.line - 1].rstrip() if origin.line <= len(lines) else ""
