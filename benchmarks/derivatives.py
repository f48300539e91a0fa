"""What exact derivatives by parameters cost: `make benchmark-derivatives` fills its page."""

import platform
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any
from unittest.mock import patch

import kintrafo
import numpy as np
import typer
from kintrafo import Suspension, variation
from kintrafo.generator.mechanisms import MODELS
from scipy.optimize import least_squares

from . import studies
from .report import fill_page, load, milliseconds

PAGE = Path(__file__).parent.parent / "docs/simulation/derivatives.md"
MECHANISMS = ("four_bar", "macpherson", "multi_link")
TRAVEL = studies.TRAVEL
FREE = [(point, axis) for point in ("tie_rod_inner", "tie_rod_outer") for axis in "xyz"]
REACH_MM, WITHIN, RELUCTANCE = 10.0, np.deg2rad(0.05), 0.01
STATES = 200
REPEATED = 30
SHIPPED = {model.name: model for model in MODELS}


def main(
    *, only_motion: Annotated[bool, typer.Option("--motion", help="Only of a motion.")] = False
) -> None:
    """Measure everything and fill the page."""
    where = (
        f"On {platform.machine()}, one core, Python {platform.python_version()}; the quickest of "
        f"{REPEATED} runs."
    )
    of_motion = f"{where.replace('one core', 'directions on all cores')} {load()}"
    blocks = {"derivatives motion": "\n".join([*motion(), "", of_motion])}
    if not only_motion:
        blocks["derivatives"] = "\n".join([*costs(), "", *toe(), "", where])
    print(*blocks.values(), sep="\n\n")
    fill_page(PAGE, blocks)


def quickest(call: Callable[[], Any]) -> float:
    """Return the shortest time of several runs [s]."""
    times = []
    for _ in range(REPEATED):
        begin = time.perf_counter()
        call()
        times.append(time.perf_counter() - begin)
    return min(times)


def costs() -> list[str]:
    """Return a table: operations, times of a call, code, and how long it takes to be made."""
    lines = [
        "| | " + " | ".join(MECHANISMS) + " |",
        "|---|" + "---:|" * len(MECHANISMS),
    ]
    columns = [_column(name) for name in MECHANISMS]
    rows = ([row, *(column[row] for column in columns)] for row in columns[0])
    return [*lines, *(f"| {' | '.join(row)} |" for row in rows)]


def _column(name: str) -> dict[str, str]:
    with tempfile.TemporaryDirectory() as plain, tempfile.TemporaryDirectory() as folder:
        without, seconds_without = _compiled(name, plain, derivatives=False)
        module, seconds = _compiled(name, folder, derivatives=True)
        sizes = [_sources(made) for made in (without, module)]
        system = kintrafo.System(module)
        functions = module.equations.manifest["functions"]
        rhs, tangent, adjoint = (
            functions[n]["operations"]["total"] for n in ("rhs", "rhs_tangent", "rhs_adjoint")
        )
        states = np.tile(system.design_state, (STATES, 1))
        direction = {next(iter(system.parameters)): 1.0}
        weights = np.ones(module.rhs.shape)
        gradient = quickest(lambda: kintrafo.gradient(system, "rhs", weights, states)) / STATES
        along = quickest(lambda: kintrafo.derivative(system, "rhs", direction, states)) / STATES
        plain_call = quickest(lambda: system.evaluate("rhs", states)) / STATES
        values = np.array([*system.parameters.values()])
        both = plain_call + quickest(lambda: module.prepare(values))
        return {
            "parameters": str(values.size),
            "operations of `rhs`": str(rhs),
            "derivative along a direction, relative": f"{tangent / rhs:.1f}",
            "gradient, relative": f"{adjoint / rhs:.1f}",
            "`rhs` at a state, µs": f"{1e6 * plain_call:.2f}",
            "`derivative` at a state, µs": f"{1e6 * along:.2f}",
            "`gradient` with respect to all at a state, µs": f"{1e6 * gradient:.1f}",
            "one-sided differences for all, with `prepare`, µs": f"{1e6 * both * values.size:.0f}",
            "C, kB, without and with": f"{sizes[0] / 1e3:.0f}, {sizes[1] / 1e3:.0f}",
            "derive and compile, without and with, s": f"{seconds_without:.1f}, {seconds:.1f}",
        }


def _compiled(name: str, folder: str, *, derivatives: bool) -> tuple[Any, float]:
    begin = time.perf_counter()
    module = kintrafo.compile(SHIPPED[name], parameter_derivatives=derivatives, folder=folder)
    return module, time.perf_counter() - begin


def _sources(module: Any) -> int:
    files = Path(str(module.__file__)).parent.iterdir()
    return sum(file.stat().st_size for file in files if file.suffix in (".c", ".h"))


class Toe:
    """Toe of the reference car over travel, and its derivatives with the wheel at its height."""

    def __init__(self) -> None:
        self.car = Suspension.load("reference_car")
        equations = kintrafo.Model(self.car).equations
        self._module = kintrafo.compile(SHIPPED[equations.NAME], parameter_derivatives=True)
        self._seen: dict[bytes, tuple[kintrafo.Model, Any]] = {}

    def at(self, model: kintrafo.Model) -> Any:
        """Return the states in which the wheel has its heights."""
        height = model.signal("wheel_center_z", model.design_state)
        states = np.tile(model.design_state, (TRAVEL.size, 1))
        states[:, 0] = kintrafo.arm_angles(model, height + TRAVEL)
        return states

    def by_parameters(self, model: kintrafo.Model, states: Any) -> dict[str, Any]:
        """Return the derivatives by all parameters."""
        system = kintrafo.System(self._module, model.parameters)
        toe, rise = (
            kintrafo.gradient(
                system, "signals", [float(name == of) for name in system.signal_names], states
            )
            for of in ("toe", "wheel_center_z")
        )
        slope = toe["beta1"] / rise["beta1"]
        return {name: toe[name] - slope * rise[name] for name in system.parameters}

    def optimised(self) -> Any:
        """Bring toe to zero with exact derivatives: the problem of `studies`, by itself."""
        self._seen.clear()
        ones = np.ones(len(FREE))
        return least_squares(
            self._missed,
            0.0 * ones,
            self._slopes,
            bounds=(-ones, ones),
            xtol=1e-8,
            ftol=1e-8,
            gtol=1e-8,
        )

    def _look(self, x: Any) -> tuple[kintrafo.Model, Any]:
        if x.tobytes() not in self._seen:
            start = self.car.to_dict()["hardpoints"]
            changes = {
                f"hardpoints.{point}.{axis}": start[point]["xyz".index(axis)] + REACH_MM * by
                for (point, axis), by in zip(FREE, x, strict=True)
            }
            model = kintrafo.Model(self.car.with_changes(changes))
            self._seen[x.tobytes()] = model, self.at(model)
        return self._seen[x.tobytes()]

    def _missed(self, x: Any) -> Any:
        model, states = self._look(x)
        return np.concatenate([model.signals(states)["toe"] / WITHIN, RELUCTANCE * x])

    def _slopes(self, x: Any) -> Any:
        by = self.by_parameters(*self._look(x))
        columns = [by[f"{point}_{axis}"] * 1e-3 * REACH_MM / WITHIN for point, axis in FREE]
        return np.concatenate([np.transpose(columns), RELUCTANCE * np.eye(len(FREE))])


def motion() -> list[str]:
    """Return how long the gradient of a motion takes, beside the motion."""
    car = kintrafo.Model("reference_car")
    module = kintrafo.compile(SHIPPED[car.equations.NAME], parameter_derivatives=True)
    system = kintrafo.System(module, car.parameters)
    start, times = kintrafo.state_at_height(car, 0.325, spin_rate=93.0), np.linspace(0.0, 1.0, 201)

    def simulated() -> Any:
        found = kintrafo.simulate(car, (0.0, 1.0), start, method="DormandPrince", t_eval=times)
        return found.signals["wheel_acceleration"]

    def differentiated() -> Any:
        asked = {"wheel_acceleration": "rms"}
        return kintrafo.motion_gradient(system, (0.0, 1.0), start, asked, t_eval=times)

    def over_time(count: int) -> Any:
        by = [*system.parameters][:count]
        return kintrafo.motion_sensitivity(
            system, (0.0, 1.0), start, by, signals=["wheel_acceleration"], t_eval=times
        )

    by = f"{len(differentiated().by)} numbers (parameters and initial state)"
    forward, backward = quickest(simulated), quickest(differentiated)
    in_lanes = [quickest(lambda n=n: over_time(n)) for n in (1, 20)]
    with patch("kintrafo.simulation.forwards.in_lanes", lambda *_: None):
        in_numpy = [quickest(lambda n=n: over_time(n)) for n in (1, 20)]
    times_longer = f"{milliseconds(backward)} ({backward / forward:.0f} times as long)"
    return [
        "| a second of the reference car, ms | |",
        "|---|---:|",
        f"| simulated, with a signal at 201 times | {milliseconds(forward)} |",
        f"| with the gradient of its RMS by {by} | {times_longer} |",
        f"| with derivatives in 1, in 20 directions | {', '.join(map(milliseconds, in_lanes))} |",
        f"| the same in NumPy | {', '.join(map(milliseconds, in_numpy))} |",
    ]


def toe() -> list[str]:
    """Return what the derivatives of toe take, and a search with them, beside those of cars."""
    exact = Toe()
    model = kintrafo.Model(exact.car)
    states = exact.at(model)

    def compared() -> Any:
        points = ["hardpoints"]
        return variation.sensitivity(exact.car, points, positions=TRAVEL, names=["toe"])["toe"]

    found, differences = exact.by_parameters(model, states), compared()
    names = [
        str(p).removeprefix("hardpoints.").replace(".", "_") for p in differences["place"].values
    ]
    rows = [i for i, name in enumerate(names) if not name.startswith("wheel_center")]
    off = max(float(np.abs(found[names[i]] - differences.values[i]).max()) for i in rows)
    greatest = float(np.abs(differences.values[rows]).max())
    optimum, other = exact.optimised(), variation.optimise(exact.car, studies.FREE, studies.TOE)
    ends = [other.moved[f"hardpoints.{point}.{axis}"] for point, axis in FREE]
    apart = float(np.abs(REACH_MM * optimum.x - ends).max())
    times = {
        "derivatives of toe at 13 positions": (
            lambda: exact.by_parameters(model, states),
            f"by all {len(found)} parameters",
            compared,
            f"by {len(names)} coordinates",
        ),
        "toe brought to zero by 6 coordinates": (
            exact.optimised,
            f"{optimum.njev} steps",
            studies.optimise,
            f"{other.evaluations} cars",
        ),
    }
    table = ["| the reference car | exact, ms | differences of cars, ms |", "|---|---:|---:|"]
    for title, (one, much, two, more) in times.items():
        cells = f"{milliseconds(quickest(one))} ({much}) | {milliseconds(quickest(two))} ({more})"
        table.append(f"| {title} | {cells} |")
    agreed = (
        f"The derivatives agree to {off / greatest:.0e} of the greatest one, the optimised "
        f"coordinates to {apart:.0e} mm."
    )
    return [*table, "", agreed]


if __name__ == "__main__":
    typer.run(main)
