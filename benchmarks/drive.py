"""How fast cars drive: `make benchmark-drive` fills docs/suspension/handling.md."""

from __future__ import annotations

import argparse
import platform
import resource
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import kintrafo
import numpy as np
from kintrafo.generator.backends.counting import operations_of
from kintrafo.generator.equations.outputs import generate
from kintrafo.systems.compile.build import build
from kintrafo.systems.compile.compiler import find_compiler
from kintrafo.vehicle.assembly.controls import Controls
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.models.car.equations import CarModel, declared

from .report import fill_page

PAGE = Path(__file__).parent.parent / "docs/suspension/handling.md"
CAR = "driving_car"
SPEED, DURATION = 80.0 / 3.6, 5.0  # m/s, s
ANGLE, PERIOD = np.deg2rad(25.0), 1.0  # of the steering wheel, a sine, from 0.5 s on
METHODS = (
    ("Runge-Kutta of order 4, 1 ms", {"method": "RK4", "step": 1e-3}),
    ("RODASP, 4 ms", {"method": "RODASP", "step": 4e-3}),
    ("Dormand-Prince, 1e-6", {"method": "DormandPrince"}),
    ("Dormand-Prince, 1e-4", {"method": "DormandPrince", "rtol": 1e-4, "atol": 1e-6}),
    ("BDF, 1e-6", {"method": "BDF"}),
)
REPEATED = 3
CALLS = 5000


def main() -> None:
    """Measure everything, and fill the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--page", action="store_true", help="fill the page")
    chosen = parser.parse_args()
    text = "\n".join([*_made(), "", *_driven(), "", _where()])
    print(text)
    if chosen.page:
        fill_page(PAGE, {"drive": text})


def _made() -> list[str]:
    """Return how many operations the equations have, and how long deriving and compiling takes."""
    begun = time.process_time()
    derived = generate(declared(kintrafo.load(CAR)))
    deriving = time.process_time() - begun
    with TemporaryDirectory() as folder:
        own = Path(folder) / derived.formulation.name
        own.mkdir()
        begun, compiled = time.process_time(), _of_children()
        build(derived, own, find_compiler())
        writing, compiling = time.process_time() - begun, _of_children() - compiled
    rows = ["| equations of the driving car | operations of a call |", "|---|---:|"]
    rows += [
        f"| {words} | {operations_of(derived.emitted[name]).total():,} |"
        for words, name in (("rates of the state", "rhs"), ("exact Jacobian", "rhs_jacobian"))
    ]
    took = ("deriving", deriving), ("writing", writing), ("compiling", compiling)
    words = ", ".join(f"{what} {seconds:.0f} s" for what, seconds in took)
    return [*rows, "", f"Processor time of the derivation, once: {words}."]


def _of_children() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _driven() -> list[str]:
    """Return how fast a sine with the steering wheel is simulated, and how accurately."""
    model = CarModel(kintrafo.load(CAR))
    start = assembly_of(model).running(SPEED)
    times = np.linspace(0.0, DURATION, round(DURATION / 1e-3) + 1)
    phase = 2.0 * np.pi / PERIOD * np.clip(times - 0.5, 0.0, PERIOD)
    # begins and ends with no rate, so that the rack does not jump
    angles = ANGLE * np.sin(phase) * np.sin(0.5 * phase) ** 2
    rack = Controls(model.car).rack(angles)["rack_position"]
    inputs = {"rack_position": kintrafo.Samples(times, rack, "spline")}
    states = np.repeat(np.asarray(start)[None], CALLS, axis=0)
    held = np.repeat(start.inputs[None], CALLS, axis=0)

    def run(**options: object) -> tuple[float, np.ndarray]:
        begun = time.process_time()
        found = kintrafo.simulate(
            model, (0.0, DURATION), start, inputs=inputs, t_eval=times[::5], **options
        )
        seconds = time.process_time() - begun
        return seconds, found.signals["body_acceleration_y"]

    _, exact = run(method="Verner", rtol=1e-11, atol=1e-13)
    rows = [
        "| method | times real time | error of the lateral acceleration, of its largest value |"
    ]
    rows.append("|---|---:|---:|")
    for words, options in METHODS:
        runs = [run(**options) for _ in range(REPEATED)]
        seconds, found = min(runs, key=lambda each: each[0])
        error = np.abs(found - exact).max() / np.abs(exact).max()
        rows.append(f"| {words} | {DURATION / seconds:,.0f} | {error:.1e} |")
        print(rows[-1], flush=True)
    calls = (
        f"A call takes {_per_call(model, 'rhs', states, held):.2g} us, one of the Jacobian "
        f"{_per_call(model, 'rhs_jacobian', states, held):.2g} us."
    )
    return [*rows, "", calls]


def _per_call(model: CarModel, function: str, states: np.ndarray, inputs: np.ndarray) -> float:
    """Return the processor time of a call in an array of many [us]."""
    times = []
    for _ in range(REPEATED):
        begun = time.process_time()
        model.evaluate(function, states, inputs)
        times.append(time.process_time() - begun)
    return 1e6 * min(times) / len(states)


def _where() -> str:
    machine = f"{platform.machine()}, Python {platform.python_version()}"
    return (
        f"Processor time on one core of {machine}: {DURATION:g} s from {3.6 * SPEED:g} km/h, in "
        f"which the steering wheel swings by {np.rad2deg(ANGLE):.0f} deg, tyres of the Magic "
        f"Formula with relaxation, a state every 5 ms; the quickest of {REPEATED}. The error is "
        "that of the lateral acceleration, against Verner's method at 1e-11."
    )


if __name__ == "__main__":
    main()
