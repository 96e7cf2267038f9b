"""Write the model of one driver in one scenario: the SMV text and the map of its names.

In: names or paths, an output folder.  Out: the files written.  Errors: IO104 where the folder holds other things.
Left to others: proving (verify.py).  The Jason project is not written yet.
"""

from __future__ import annotations

import json
from pathlib import Path

from rotra.diagnostics import Rejected, problem
from rotra.emitters.smv import emit_smv
from rotra.frontends.scenario import instance, resolve_scenario
from rotra.lowering.model import build_model
from rotra.origins import Origin
from rotra.pipeline.inputs import check_driver, load_drivers, load_law

FILES = ("model.smv", "names.json")


def translate_to(agent: str, scenario: str, which: str, rules: str, folder: Path) -> tuple[Path, ...]:
    if folder.exists() and (not folder.is_dir() or any(p.name not in FILES for p in folder.iterdir())):
        raise Rejected([problem("IO104", Origin(str(folder)), "the output folder holds something else", "name an empty folder, or one that does not exist yet")])
    (driver,) = load_drivers([agent])
    law = load_law(rules)
    world = instance(resolve_scenario(scenario), which)
    check_driver(driver, world)
    smv = emit_smv(build_model(driver.agent, law.advice, law.origins, world).system(), f"{Path(driver.title).name} in {world.id}, instance {which}, rules {law.base.name}")
    names = {smv.names.qualified(name): name for name in smv.names.local}
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "model.smv").write_text(smv.text, encoding="utf-8")
    (folder / "names.json").write_text(json.dumps({"names": names, "constants": {safe: name for name, safe in smv.names.constants.items()}}, indent=1, sort_keys=True) + "\n", encoding="utf-8")
    return tuple(folder / name for name in FILES)
