"""Are two drivers the same?  Proved by a product: both minds in one world, which the first one drives.

In: names or paths of two drivers.  Out: per scenario, equal or the first step at which their acts differ.
As long as the acts agree both would be in the same world, so the first difference is found, and only a real one.
"""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rotra.emitters.smv import Specification, emit_smv, name_everything, write_expr
from rotra.engines import places
from rotra.engines.jvm import EngineError
from rotra.engines.nusmv import Check, EngineFailed, Holds, Unknown, Violated, check_model
from rotra.frontends.scenario import Scenario, instance, resolve_scenario
from rotra.lowering.model import build_product
from rotra.pipeline.inputs import Driver, Law, check_driver, load_drivers, load_law, shipped_scenarios
from rotra.system.expr import conj, const, disj, eq, evaluate, ref


def compare_drivers(first: str, second: str, scenarios: Sequence[str], which: str, rules: str, timeout: float) -> list[dict[str, Any]]:
    """Errors: `EngineError` where the engine gives no verdict: silence is never equality."""
    a, b = load_drivers([first, second])
    law = load_law(rules)
    worlds = [instance(resolve_scenario(s), which) for s in scenarios or shipped_scenarios()]
    for world in worlds:
        check_driver(a, world)
        check_driver(b, world)
    return [_compare(a, b, law, world, timeout) for world in worlds]


def _compare(a: Driver, b: Driver, law: Law, world: Scenario, timeout: float) -> dict[str, Any]:
    model = build_product(a.agent, b.agent, law.advice, law.origins, world)
    assert model.observer is not None
    other = model.observer[0]
    acts = sorted({*model.driver.acts, *other.acts})
    same = disj(*(conj(*(eq(ref(name), const(act)) if act in driver.acts else const(False) for name, driver in (("act", model.driver), ("act@2", other)))) for act in acts))
    system = model.system([same])
    names = name_everything(system)
    text = emit_smv(system, f"{a.title} beside {b.title} in {world.id}", [Specification("same_act", "invariant", write_expr(same, names))], names).text
    with tempfile.TemporaryDirectory(prefix="rotra-") as folder:
        file = Path(folder) / "product.smv"
        file.write_text(text, encoding="utf-8")
        answers = check_model(places.nusmv(), file, [Check("same_act", "invariant", True)], timeout)
    match answers.checks["same_act"]:
        case Holds() if answers.total and answers.initial:
            return {"scenario": world.id, "equal": True, "divergence": None}
        case Violated(states, _):
            values = {v: names.value(text) for q, text in states[-1].items() if (v := names.variable(q)) is not None}
            definitions = system.definitions()
            first, second = (evaluate(ref(n), values, definitions) for n in ("act", "act@2"))
            return {"scenario": world.id, "equal": False, "divergence": {"step": len(states), "first": first, "second": second}}
        case Unknown(why) | EngineFailed(why):
            raise EngineError(why)
    raise EngineError("the product model has a state without successor")
