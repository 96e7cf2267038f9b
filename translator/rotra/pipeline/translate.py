"""Write both exports of one driver in one scenario: the SMV model with the map of its names, and the Jason project.

In: names or paths, an output folder.  Out: the files written.  Errors: IO104 where the folder holds other things, IO105.
Left to others: proving (verify.py), driving (drive.py).
"""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path, PurePosixPath

from rotra.diagnostics import Rejected, problem
from rotra.emitters.jason_project import emit_project
from rotra.emitters.smv import emit_smv
from rotra.engines import places
from rotra.engines.jvm import included_files
from rotra.frontends.scenario import Scenario, instance, resolve_scenario
from rotra.lowering.model import build_model
from rotra.origins import Origin
from rotra.pipeline.drive import run_request
from rotra.pipeline.inputs import Driver, Law, check_driver, load_drivers, load_law

STEPS = 40
OWN = frozenset({"model.smv", "names.json", "jason"})


def translate_to(agent: str, scenario: str, which: str, rules: str, folder: Path) -> tuple[Path, ...]:
    """`model.smv`, `names.json` and `jason/`; a translation that is there already is replaced."""
    if folder.exists() and (not folder.is_dir() or any(p.name not in OWN for p in folder.iterdir())):
        raise Rejected([problem("IO104", Origin(str(folder)), "the output folder holds something else", "name an empty folder, or one that does not exist yet")])
    (driver,) = load_drivers([agent])
    law = load_law(rules)
    declared = resolve_scenario(scenario)
    world = instance(declared, which)
    check_driver(driver, world)
    files = {**model_files(driver, law, world, which), **_project(driver, law, instance(declared, "published"), _title(driver, world))}
    if folder.exists():
        shutil.rmtree(folder)
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    (folder / "jason" / "lib").mkdir()
    for jar in places.jars():
        shutil.copy(jar, folder / "jason" / "lib" / jar.name)
    return (*(folder / name for name in files), folder / "jason" / "lib")


def _title(driver: Driver, world: Scenario) -> str:
    return f"{Path(driver.title).name} in {world.id}"


def model_files(driver: Driver, law: Law, world: Scenario, which: str) -> dict[str, str]:
    """`model.smv` and `names.json` of a scenario whose instance is applied; `which` names it."""
    title = f"{_title(driver, world)}, instance {which}, rules {law.base.name}"
    smv = emit_smv(build_model(driver.agent, law.advice, law.origins, world).system(), title)
    names = {smv.names.qualified(name): name for name in smv.names.local}
    table = {"names": names, "constants": {safe: name for name, safe in smv.names.constants.items()}}
    return {"model.smv": smv.text, "names.json": json.dumps(table, indent=1, sort_keys=True) + "\n"}


def _project(driver: Driver, law: Law, world: Scenario, title: str) -> dict[str, str]:
    files = included_files(driver.file)
    # what the user wrote keeps its place under the folder that all of it has in common; what ships lies beside that
    own = [f for f in files if not f.is_relative_to(places.AGENTS)] or list(files)
    root = Path(os.path.commonpath([f.parent for f in own]))
    sources = {PurePosixPath(f.relative_to(root if f in own else places.AGENTS).as_posix()): f.read_text(encoding="utf-8") for f in files}
    main = PurePosixPath(driver.file.resolve().relative_to(root).as_posix())
    project = emit_project(sources, main, law.text, run_request(world, STEPS), title)
    return {f"jason/{name}": text for name, text in project.items()}
