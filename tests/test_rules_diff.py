"""How two rule bases differ, rule by rule: every status and every reason by a small pair; our base against the published one."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

from click.testing import CliRunner

from reference import reference
from rotra.cli import main
from rotra.frontends.rules import load_rule_base
from rotra.pipeline.rules_diff import compare, counts, diff_rules
from rotra.pipeline.rules_import import import_rules

CASES = Path(__file__).parent / "cases"
OURS, THEIRS = (str(CASES / "rules_diff" / name) for name in ("ours", "theirs"))


def test_every_status_and_reason(expected: Callable[[Path, str], None]) -> None:
    said = "".join(json.dumps(row.as_json()) + "\n" for row in diff_rules(OURS, THEIRS))
    expected(CASES / "rules_diff" / "expected.txt", said)


def test_a_base_is_the_same_as_itself() -> None:
    assert {row.status for row in diff_rules(OURS, OURS)} == {"same"}


def test_exit_status_tells_of_what_nobody_explains() -> None:
    answer = CliRunner().invoke(main, ["rules", "diff", OURS, THEIRS, "--json"])
    assert answer.exit_code == 1 and json.loads(answer.output)["counts"] == {"same": 2, "changed": 5, "added": 1, "removed": 2}
    assert CliRunner().invoke(main, ["rules", "diff", OURS, OURS]).exit_code == 0


def test_every_rule_of_both_bases_is_accounted_for(tmp_path: Path) -> None:
    import_rules(reference("published_rules.pl"), tmp_path / "published", CASES / "import" / "published_overlay.yaml")
    ours, theirs = load_rule_base("uk"), load_rule_base(tmp_path / "published")
    rows = compare(ours, theirs)
    assert sorted(r.ours for r in rows if r.ours) == sorted(r.id for r in ours.rules)
    assert {r.theirs for r in rows if r.theirs} == {r.id for r in theirs.rules}
    assert counts(rows)["same"] > 50
