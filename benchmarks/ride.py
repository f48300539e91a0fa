"""How fast cars ride: `make benchmark-ride` fills docs/suspension/car.md."""

from __future__ import annotations

import argparse
import platform
from functools import partial
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING

import kintrafo
import numpy as np
from kintrafo.generator.backends.counting import operations_of
from kintrafo.generator.equations.outputs import generate
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.models.car.equations import CarModel, declared
from kintrafo.vehicle.roads import iso8608

from .motions import REPEATED, Motion, by_methods, in_lanes, processor_seconds
from .report import fill_page

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kintrafo.vehicle.models.car import Car

PAGE = Path(__file__).parent.parent / "docs/suspension/car.md"
SPEED, DURATION, SEED = 20.0, 20.0, 1  # m/s, s
CARS = {
    "quarter car": "quarter_car",
    "car that heaves and pitches": "ride",
    "car that heaves, pitches and rolls": "roll",
}
"""The cars that are timed: a packaged one, or the motions of the body of the reference vehicle."""

METHODS = (
    ("Runge-Kutta of order 4, 1 ms", {"method": "RK4", "step": 1e-3}),
    ("Dormand-Prince, 1e-6", {"method": "DormandPrince"}),
    ("Dormand-Prince, 1e-4", {"method": "DormandPrince", "rtol": 1e-4, "atol": 1e-6}),
)


def main() -> None:
    """Measure everything, and fill the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cars", nargs="*", default=list(CARS), choices=list(CARS))
    parser.add_argument("--page", action="store_true", help="fill the page")
    chosen = parser.parse_args()
    counts = ["| equations | operations of a call | of its Jacobian | a call, µs |"]
    counts.append("|---|---:|---:|---:|")
    speeds = ["| car | method | times real time | error of the acceleration, relative to its RMS |"]
    speeds.append("|---|---|---:|---:|")
    for name in chosen.cars:
        car = _car(CARS[name])
        model = CarModel(car)
        counts.append(_counted(name, car, model))
        print(counts[-1], flush=True)
        for row in _timed(name, model):
            speeds.append(row)
            print(row, flush=True)
    machine = f"{platform.machine()}, Python {platform.python_version()}"
    where = (
        f"Processor time on one core of {machine}: {DURATION:g} s of a road of class B at "
        f"{SPEED:g} m/s, seed {SEED}, the rack held, a state every 5 ms; the quickest of "
        f"{REPEATED}. The error is that of the body's acceleration, against Verner's method at "
        "1e-11."
    )
    text = "\n".join([*counts, "", *speeds, "", where])
    print(text)
    if chosen.page:
        fill_page(PAGE, {"ride": text})


def _car(name: str) -> Car:
    if name == "quarter_car":
        return kintrafo.load(name)
    return kintrafo.load("reference_vehicle").with_changes({"car": name})


def _counted(name: str, car: Car, model: CarModel) -> str:
    emitted = generate(declared(car)).emitted
    numbers = [operations_of(emitted[f"{f}_rack_held"]).total() for f in ("rhs", "rhs_jacobian")]
    states = np.repeat(model.design_state[None], 20_000, axis=0)
    inputs = np.zeros((len(states), len(model.input_names)))
    calls = partial(model.evaluate, "rhs_rack_held", states, inputs)
    seconds = min(processor_seconds(calls) for _ in range(REPEATED))
    return f"| {name} | {numbers[0]:,} | {numbers[1]:,} | {1e6 * seconds / len(states):.2f} |"


def _timed(name: str, model: CarModel) -> Iterator[str]:
    assembly = assembly_of(model)
    road = iso8608("B", length=SPEED * DURATION, seed=SEED, track=assembly.track)
    behind = assembly.behind()
    inputs = {
        assembly.names_of(wheel).road: road.over_time(
            wheel.rpartition("_")[2], SPEED, behind[wheel], DURATION
        )
        for wheel in assembly.wheels
    }
    start = kintrafo.equilibrium(model)
    times = np.linspace(0.0, DURATION, round(DURATION / 5e-3) + 1)

    motion = Motion(start, times, inputs)
    heave = model.state_names.index("heave_rate")

    def acceleration(found: kintrafo.Simulation) -> np.ndarray:
        return model.evaluate("rhs", found.y.T, found.inputs)[:, heave]

    force = f"{assembly.names_of(assembly.wheels[0]).signals}tyre_force"
    measured = by_methods(model, motion, METHODS, acceleration, np.std)
    for cells in chain(measured, [in_lanes(model, motion, {force: "min"})]):
        yield f"| {name} | {cells} |"


if __name__ == "__main__":
    main()
