"""How long the loads on all parts take: `make benchmark-loads` fills docs/suspension/loads.md."""

import os
import platform
import re
import shutil
import tempfile
import timeit
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from kintrafo import Model, compliance, equilibrium, loads, roads, simulate
from kintrafo.vehicle.plots import curves
from kintrafo.vehicle.plots import loads as pictures

from .report import fill_page, milliseconds

ROOT = Path(__file__).parent.parent
PAGE = ROOT / "docs/suspension/loads.md"
PAGE_OF_BUSHES = ROOT / "docs/suspension/compliance.md"
IMAGES = ROOT / "docs/images"
BUSHES = {
    name: {
        f"{arm}_front": {"axial_N_per_mm": 1500.0, "radial_N_per_mm": 8000.0},
        f"{arm}_rear": {"axial_N_per_mm": 400.0, "radial_N_per_mm": [1200.0, 2500.0],
                        "axis": [0.0, 0.0, 1.0], "radial_axis": [1.0, 0.0, 0.0]},
        "wheel_center": {"tilt_Nm_per_deg": 4000.0},
    }
    for name, arm in (("reference_car", "arm"), ("double_wishbone_car", "lower_arm"))
}  # fmt: skip
MODELS = {name: Model(name) for name in ("reference_car", "double_wishbone_car")}
OUTPUTS = 10_000
TRAVELS = np.linspace(-0.06, 0.06, 100)
REPEATED = 5


def main() -> None:
    """Measure everything, draw, and fill the page."""
    random = np.random.default_rng(1)
    cases = {
        f"case_{i}": {"contact_N": [*random.uniform(-2e3, 2e3, 2), random.uniform(3e3, 5e3)]}
        for i in range(20)
    }
    table = ["| | reference car, ms | double wishbone, ms |", "|---|---:|---:|"]
    for words, work in (
        ("20 load cases, all parts", lambda model: lambda: loads.static(model, cases)),
        ("compliance at 100 positions, three bushes", _compliance),
        ("on these bushes at 100 positions, by equilibrium", _elastokinematics),
        ("under 20 lateral forces, by equilibrium", _deflection),
        (f"along a motion, {OUTPUTS} outputs, all parts", _along),
    ):
        times = [milliseconds(_quickest(work(model))) for model in MODELS.values()]
        table.append(f"| {words} | {' | '.join(times)} |")
    table += ["", f"On {platform.machine()}, Python {platform.python_version()}, {os.cpu_count()}"]
    table[-1] += f" cores; by the clock, the quickest of {REPEATED} runs."
    print("\n".join(table))
    fill_page(PAGE, {"loads": "\n".join(table)})
    _draw()


def _compliance(model: Model) -> Callable[[], object]:
    return lambda: compliance.linear(model, _bushes(model), TRAVELS)


def _elastokinematics(model: Model) -> Callable[[], object]:
    return lambda: compliance.elastokinematics(model, _bushes(model), along=TRAVELS)


def _deflection(model: Model) -> Callable[[], object]:
    return lambda: compliance.nonlinear(
        model, _bushes(model), "lateral", np.linspace(-5e3, 5e3, 20)
    )


def _bushes(model: Model) -> dict[str, Any]:
    (found,) = (BUSHES[name] for name, known in MODELS.items() if known is model)
    return found


def _quickest(call: Callable[[], object]) -> float:
    """Return the least time of some runs by the clock, since threads share some of the work [s]."""
    return min(timeit.repeat(call, number=1, repeat=REPEATED))


def _along(model: Model) -> Callable[[], object]:
    bump = {"road_height": roads.step(0.03, at=0.05, end=1.0)}
    times = np.linspace(0.0, 1.0, OUTPUTS)
    motion = simulate(
        model, (0.0, 1.0), equilibrium(model, spin_rate=50.0), inputs=bump, t_eval=times
    )
    return lambda: loads.along(model, motion)


def _bushes_of_page() -> dict[str, Any]:
    """Return the bushes of the first file on the page whose pictures show them."""
    page = PAGE_OF_BUSHES.read_text(encoding="utf-8")
    (text,) = re.findall(r"```toml\n(# bushes\.toml\n.*?)```", page, re.DOTALL)
    bushes: dict[str, Any] = tomllib.loads(text)["bushings"]
    return bushes


def _draw() -> None:
    """Draw the pictures of both pages."""
    # its strut stands beside the ball joint, so that their forces do not cover each other
    found = loads.static(Model("offset_strut_car"))
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "loads.png"
        pictures.write_free_bodies(found, path, "brake", ["knuckle"], title="offset strut")
        shutil.copyfile(path, IMAGES / "loads.png")
        car, bushes = MODELS["reference_car"], _bushes_of_page()
        sheet = compliance.linear(car, bushes, held="spring")
        curves.write_overview(
            sheet.drop_dims(["moved", "by"]),
            path,
            title=f"reference car, {sheet.attrs['held']}",
            force=True,
        )
        shutil.copyfile(path, IMAGES / "compliance.png")
        elastic = compliance.elastokinematics(car, bushes)
        curves.write_overview(elastic, path, title="reference car", force=True)
        shutil.copyfile(path, IMAGES / "elastokinematic.png")


if __name__ == "__main__":
    main()
