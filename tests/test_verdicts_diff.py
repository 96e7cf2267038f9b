"""What a change of the rules does to the verdicts of the catalogue."""

from __future__ import annotations

import shutil
from pathlib import Path

import yaml

from rotra.engines import places
from rotra.pipeline.verdicts_diff import flipped_verdicts


def test_a_rule_that_is_missing_flips_the_verdicts_about_it(tmp_path: Path) -> None:
    base = tmp_path / "uk"
    shutil.copytree(places.PROJECT / "rules" / "uk", base)
    file = base / "traffic_lights.yaml"
    section = yaml.safe_load(file.read_text(encoding="utf-8"))
    file.write_text(yaml.safe_dump({**section, "rules": [r for r in section["rules"] if r["id"] != "r176"]}, sort_keys=False), encoding="utf-8")
    flips = {f.property: f for f in flipped_verdicts("uk", str(base), ("reactive",), ("traffic_light",), lambda *_: None)}
    assert set(flips) == {"waits_at_white_line", "never_crosses_on_red", "advised_to_stop_on_red", "waits_on_red_amber"}
    assert (flips["never_crosses_on_red"].ours, flips["never_crosses_on_red"].theirs) == ("holds", "violated")
    assert "r175a is silent: approaching_traffic_light is not intended" in flips["never_crosses_on_red"].why
    assert flips["waits_at_white_line"].theirs == "vacuous"
