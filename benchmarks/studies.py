"""How long studies take: `make benchmark-studies` fills docs/suspension/design-studies.md."""

import platform
import shutil
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from kintrafo import Model, Suspension, characteristics, rig, variation
from kintrafo.vehicle.plots import curves
from kintrafo.vehicle.plots import pareto as fronts
from kintrafo.vehicle.plots import variation as pictures

from .report import fill_page

ROOT = Path(__file__).parent.parent
PAGE = ROOT / "docs/suspension/design-studies.md"
IMAGES = ROOT / "docs/images"
CAR = Suspension.load("reference_car")
TRAVEL = np.linspace(-0.06, 0.06, 13)
FREE = {"hardpoints.tie_rod_inner": 10.0, "hardpoints.tie_rod_outer": 10.0}
TOE = {"toe": {"at_mm": (1e3 * TRAVEL).tolist(), "value": 0.0, "within": 0.05}}
HEIGHT = {"roll_center_height_kinematic": {"at_mm": 0.0, "least": 100.0}}
BALL_JOINT = {"hardpoints.ball_joint.z": 10.0}
ROLL_CENTER = {"roll_center_height_kinematic": {"at_mm": 0.0}}
SCRUB = {"scrub_radius": {"at_mm": 0.0, "most": 21.0}}
# those of the examples on the page, for its pictures
SHOWN_FREE = {"hardpoints.tie_rod_inner": 10.0, "hardpoints.tie_rod_outer.z": 10.0}
SHOWN_TOE = {"toe": {"at_mm": [-60, -40, -20, 0, 20, 40, 60], "value": 0.0, "within": 0.02}}
SHOWN_TOLERANCES = {"hardpoints": 1.0, "hardpoints.tie_rod_inner": 0.5}
LIMITS = {"bump_steer": {"at_mm": [-20.0, 0.0, 20.0], "least": 0.005, "most": 0.008}}
CARS = 500
MANY = 20_000
REPEATED = 5


def main() -> None:
    """Measure everything, draw, and fill the page."""
    variation.sensitivity(CAR, ["hardpoints.ball_joint.z"])  # imports
    rows = [
        ("sensitivity: 21 coordinates, all characteristics at 81 positions", sensitivity),
        (f"tolerance: {CARS} cars, toe at 13 positions", tolerance),
        (f"cars: {MANY} cars, toe at 13 positions", lambda: many(["toe"])),
        (f"cars: {MANY} cars, all characteristics at 13 positions", lambda: many(None)),
        ("optimise: toe at 13 positions by 6 coordinates", optimise),
        ("pareto: the same and roll-centre height, by 7 coordinates", pareto),
    ]
    table = ["| study of the reference car | ms | cars | ms a car |", "|---|---:|---:|---:|"]
    for name, run in rows:
        elapsed, cars = quickest(run)
        table.append(f"| {name} | {1e3 * elapsed:.0f} | {cars} | {1e3 * elapsed / cars:.2g} |")
    table += ["", f"On {platform.machine()}, one core, Python {platform.python_version()}; the"]
    table[-1] += f" quickest of {REPEATED} runs."
    print("\n".join(table))
    fill_page(PAGE, {"studies": "\n".join(table)})
    draw()


def quickest(run: Callable[[], int]) -> tuple[float, int]:
    """Return the shortest time of several runs, and how many cars each looks at."""
    times = []
    for _ in range(REPEATED):
        begin = time.perf_counter()
        cars = run()
        times.append(time.perf_counter() - begin)
    return min(times), cars


def sensitivity() -> int:
    """Find all derivatives by the hardpoints."""
    return 4 * variation.sensitivity(CAR).sizes["place"]


def tolerance() -> int:
    """Look at many cars, and at the neighbours that tell shares of the variance."""
    found = variation.tolerance(
        CAR, {"hardpoints": 1.0}, count=CARS, positions=TRAVEL, names=["toe"]
    )
    return CARS + 4 * found.sizes["place"]


def many(names: list[str] | None) -> int:
    """Find the curves of many cars, all of whose points are off."""
    rng = np.random.default_rng(1)
    points = CAR.to_dict()["hardpoints"]
    values = {
        f"hardpoints.{name}.{axis}": point["xyz".index(axis)] + rng.normal(0.0, 0.3, MANY)
        for name, point in points.items()
        if name != "unit"
        for axis in "xyz"
    }
    found = variation.cars(CAR, values, positions=TRAVEL, names=names, threads=1)
    return found.sizes["car"]


def optimise() -> int:
    """Bring toe to zero."""
    found = variation.optimise(CAR, FREE, TOE)
    if not found.success:
        raise SystemExit(found.message)
    return found.evaluations


def pareto() -> int:
    """Bring toe to zero and the roll centre up."""
    return _front().evaluations


def _front(toe: dict[str, dict[str, Any]] = TOE) -> variation.Front:
    return variation.pareto(CAR, FREE | BALL_JOINT, toe, maximise=ROLL_CENTER, limits=SCRUB)


def draw() -> None:
    """Draw the pictures of the page."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        bars = variation.sensitivity(CAR, positions=[0.0])
        of = ["bump_steer", "camber_gradient"]
        pictures.write_bars(bars, folder / "sensitivity.png", of, title="reference car, at design")
        bands = variation.tolerance(
            CAR, SHOWN_TOLERANCES, count=CARS, names=["bump_steer", "caster"]
        )
        pictures.write_bands(
            bands,
            folder / "tolerance.png",
            ["bump_steer", "caster"],
            limits=variation.limits(LIMITS),
            title=f"{CARS} cars",
        )
        found = variation.optimise(CAR, SHOWN_FREE, SHOWN_TOE, HEIGHT)
        pictures.write_optimum(found, folder / "optimise.png", title="reference car")
        fronts.write_front(_front(SHOWN_TOE), folder / "pareto.png", title="reference car")
        curves.write_overview(_fitted(), folder / "fit.png", title="reference car as built")
        for picture in folder.iterdir():
            shutil.copyfile(picture, IMAGES / picture.name)


def _fitted() -> xr.Dataset:
    """Return curves of a car that is off by known errors and noise, and those of its fit."""
    built = CAR.with_changes({"hardpoints.tie_rod_inner": [-140.0, -310.5, 281.5]})
    built = built.with_changes({"hardpoints.arm_rear": [-150.0, -351.0, 206.5]})
    measured = characteristics.over(Model(built), "travel", TRAVEL)[["toe", "camber"]]
    noise = np.random.default_rng(1).normal(scale=np.deg2rad(0.005), size=(2, TRAVEL.size))
    for name, errors in zip(measured, noise, strict=True):
        measured[name] += errors
    accuracy = {"toe": 0.005, "camber": 0.005}
    found = variation.fit(CAR, measured, {"hardpoints": 3.0}, accuracy=accuracy)
    models = {"file": Model(found.start), "fitted": Model(found.suspension)}
    return rig.beside(measured, models)


if __name__ == "__main__":
    main()
