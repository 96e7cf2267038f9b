"""Write a rule base for another program: Prolog, Jason or NuSMV.

In: a rule base by name or path, a format.  Out: the text.  Left to others: what each format looks like (emitters/).
Errors: IO104 where the file cannot be written.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from rotra.diagnostics import Rejected, problem
from rotra.emitters.agentspeak import emit_advice
from rotra.emitters.compiled import emit_compiled
from rotra.emitters.prolog import emit_prolog
from rotra.emitters.smv import emit_smv
from rotra.frontends.rules import RuleBase, load_rule_base
from rotra.lowering.situation import situation_system
from rotra.origins import Origin


def _smv(base: RuleBase) -> str:
    return emit_smv(situation_system(base), f"The advice of the rule base {base.name} in every situation").text


FORMATS: dict[str, Callable[[RuleBase], str]] = {"prolog": emit_prolog, "jason": emit_advice, "smv": _smv, "json": emit_compiled}


def export_rules(rules: str, form: str, output: Path | None = None) -> str:
    """The text, written to `output` where one is named."""
    text = FORMATS[form](load_rule_base(rules))
    if output is not None:
        try:
            output.write_text(text, encoding="utf-8")
        except OSError as error:
            raise Rejected([problem("IO104", Origin(str(output)), f"cannot write the file: {error.strerror}", "choose a place that can be written")]) from error
    return text
