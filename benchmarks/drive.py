"""How fast cars drive: `make benchmark-drive` fills docs/suspension/handling.md."""

from __future__ import annotations

import argparse
import platform
import time
from functools import partial
from itertools import chain
from pathlib import Path
from tempfile import TemporaryDirectory

import kintrafo
import numpy as np
from kintrafo.core.units import KM_PER_H
from kintrafo.generator.backends.counting import operations_of
from kintrafo.generator.equations.outputs import generate
from kintrafo.systems.compile.build import build
from kintrafo.systems.compile.compiler import find_compiler
from kintrafo.vehicle.assembly.controls import Controls
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.models.car.equations import CarModel, declared

from .motions import REPEATED, Motion, by_methods, in_lanes, processor_seconds
from .report import children_seconds, fill_page

PAGE = Path(__file__).parent.parent / "docs/suspension/handling.md"
CAR = "driving_car"
SPEED, DURATION = 80.0 / KM_PER_H, 5.0  # m/s, s
ANGLE, PERIOD = np.deg2rad(25.0), 1.0  # of the steering wheel, a sine, from 0.5 s on
METHODS = (
    ("Runge-Kutta of order 4, 1 ms", {"method": "RK4", "step": 1e-3}),
    ("Runge-Kutta of order 4, 4 ms", {"method": "RK4", "step": 4e-3}),
    ("RODASP, 4 ms", {"method": "RODASP", "step": 4e-3}),
    ("Dormand-Prince, 1e-6", {"method": "DormandPrince"}),
    ("Dormand-Prince, 1e-4", {"method": "DormandPrince", "rtol": 1e-4, "atol": 1e-6}),
    ("BDF, 1e-6", {"method": "BDF"}),
)
LANE_CHANGE = "double_lane_change"
LATERAL = "body_acceleration_y"
CALLS = 5000


def main() -> None:
    """Measure everything, and fill the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--page", action="store_true", help="fill the page")
    parser.add_argument(
        "--driven", action="store_true", help="skip the derivation of the equations"
    )
    chosen = parser.parse_args()
    blocks = {} if chosen.driven else {"made": "\n".join(_made())}
    blocks["drive"] = "\n".join([*_driven(), "", _where()])
    print("\n\n".join(blocks.values()))
    if chosen.page:
        fill_page(PAGE, blocks)


def _made() -> list[str]:
    """Return how many operations the equations have, and how long deriving and compiling takes."""
    begun = time.process_time()
    derived = generate(declared(kintrafo.load(CAR)))
    deriving = time.process_time() - begun
    with TemporaryDirectory() as folder:
        own = Path(folder) / derived.formulation.name
        own.mkdir()
        begun, compiled = time.process_time(), children_seconds()
        build(derived, own, find_compiler())
        writing, compiling = time.process_time() - begun, children_seconds() - compiled
    rows = ["| equations of the driving car | operations of a call |", "|---|---:|"]
    rows += [
        f"| {words} | {operations_of(derived.emitted[name]).total():,} |"
        for words, name in (("rates of the state", "rhs"), ("exact Jacobian", "rhs_jacobian"))
    ]
    took = ("deriving", deriving), ("writing", writing), ("compiling", compiling)
    words = ", ".join(f"{what} {seconds:.0f} s" for what, seconds in took)
    return [*rows, "", f"Processor time of the derivation, once: {words}."]


def _swung(model: CarModel) -> Motion:
    """Return a sine with the steering wheel."""
    times = np.linspace(0.0, DURATION, round(DURATION / 1e-3) + 1)
    phase = 2.0 * np.pi / PERIOD * np.clip(times - 0.5, 0.0, PERIOD)
    # begins and ends with no rate, so that the rack does not jump
    angles = ANGLE * np.sin(phase) * np.sin(0.5 * phase) ** 2
    rack = Controls(model.car).rack(angles)["rack_position"]
    inputs = {"rack_position": kintrafo.Samples(times, rack, "spline")}
    return Motion(assembly_of(model).running(SPEED), times[::5], inputs)


def _lane_changed(model: CarModel) -> Motion:
    """Return a double lane change with the rack as a driver moved it, at constant speed."""
    run = kintrafo.handling.drive(model, LANE_CHANGE).runs[0]
    times = run.motion["time"].to_numpy()
    moved = [n for n in model.input_names if n == "rack_position" or n.endswith("_drive_torque")]
    inputs = {
        name: kintrafo.Samples(times, run.inputs[:, model.input_names.index(name)], "spline")
        for name in moved
    }
    return Motion(run.states[0], times, inputs)


def _driven() -> list[str]:
    """Return how fast motions are simulated, and how accurately."""
    model = CarModel(kintrafo.load(CAR))
    swing = _swung(model)
    states = np.repeat(np.asarray(swing.start)[None], CALLS, axis=0)
    held = np.repeat(swing.start.inputs[None], CALLS, axis=0)
    error = "relative error of the lateral acceleration"
    rows = [f"| motion | method | times real time | {error} |", "|---|---|---:|---:|"]
    for name, motion, methods in (
        ("sine", swing, METHODS),
        ("double lane change", _lane_changed(model), METHODS[-3:-1]),
    ):
        measured = by_methods(model, motion, methods, _lateral, lambda exact: np.abs(exact).max())
        for cells in chain(measured, [in_lanes(model, motion, {LATERAL: "max"})]):
            rows.append(f"| {name} | {cells} |")
            print(rows[-1], flush=True)
    calls = (
        f"A call takes {_per_call(model, 'rhs', states, held):.2g} µs, one of the Jacobian "
        f"{_per_call(model, 'rhs_jacobian', states, held):.2g} µs."
    )
    return [*rows, "", calls]


def _lateral(motion: kintrafo.Simulation) -> np.ndarray:
    return motion.signals[LATERAL]


def _per_call(model: CarModel, function: str, states: np.ndarray, inputs: np.ndarray) -> float:
    """Return the processor time of a call in an array of many [us]."""
    calls = partial(model.evaluate, function, states, inputs)
    return 1e6 * min(processor_seconds(calls) for _ in range(REPEATED)) / len(states)


def _where() -> str:
    machine = f"{platform.machine()}, Python {platform.python_version()}"
    return (
        f"Processor time on one core of {machine}; tyres of the Magic Formula with relaxation, a "
        f"state every 5 ms; the quickest of {REPEATED}. The sine is {DURATION:g} s from "
        f"{3.6 * SPEED:g} km/h, in which the steering wheel swings by {np.rad2deg(ANGLE):.0f} deg. "
        "The double lane change is that of `kintrafo drive`; the rack moves as the driver moved it "
        "there. Cars in lanes differ in one damper. The error is that of the lateral acceleration, "
        "against Verner's method at 1e-11."
    )


if __name__ == "__main__":
    main()
