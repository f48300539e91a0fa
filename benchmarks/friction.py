"""A case that is stiff by physics: the same suspension with Coulomb friction in its strut.

Friction is regularised, ``-F v / sqrt(v^2 + v0^2)``: the smaller v0, the closer to dry friction,
and the faster the mode in which a sticking strut creeps to rest. Its eigenvalue is about
``-F MR^2 / (m v0)``, with the motion ratio MR and the unsprung mass m. The motion itself hardly
changes with v0, so accuracy asks for the same steps, and stability does not.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from kintrafo import Model, Simulation, Suspension, simulate, state_at_height
from kintrafo.pictures.figures import STYLE
from kintrafo.simulation.simulate import Method
from kintrafo.simulation.solvers import native_available
from kintrafo.vehicle.analysis.paper import DURATION, SPIN_RATE, START_HEIGHT, rest
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from .paper_timing import ATOL_PER_RTOL, ERROR_POINTS, NAMES, RTOL
from .report import Timing, count, markdown_table, milliseconds, power, seconds_of, timing_of
from .work_precision import LOOKS

Array = NDArray[np.float64]

FRICTION = 150.0  # of the strut in full sliding [N]: what struts of cars have
SPEEDS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5)  # v0 [m/s]
REFERENCE_RTOL = 1e-11
LARGEST_STEPS = 2_000_000


@dataclass(frozen=True)
class Point:
    """One method at one regularisation.

    Attributes
    ----------
    speed : float
        v0 [m/s].
    eigenvalue : float
        The fastest at rest [1/s].
    error : float
        Greatest error of the arm angle at 101 times, as a part of its range.
    """

    method: str
    speed: float
    eigenvalue: float
    error: float
    steps: int
    evaluations: int
    seconds: Timing


def methods() -> tuple[Method, ...]:
    """Return the methods that are compared, Gear's first."""
    return ("BDF", "DormandPrince", "Verner") if native_available() else ("BDF", "RK45")


def with_friction(speed: float) -> Model:
    """Return the reference car with friction that is regularised at some velocity [m/s]."""
    changes = {"strut.friction_N": FRICTION, "strut.friction_velocity_m_per_s": speed}
    return Model(Suspension.load("reference_car").with_changes(changes))


def measure(
    speeds: Sequence[float] = SPEEDS,
    *,
    rounds: int = 3,
    advance: Callable[[], None] = lambda: None,
) -> list[Point]:
    """Simulate the paper's second with friction, by every method at every regularisation."""
    points = []
    for speed in speeds:
        model = with_friction(speed)
        start = state_at_height(model, START_HEIGHT, spin_rate=SPIN_RATE)
        eigenvalue = float(np.min(model.eigenvalues(rest(model).state).real))
        reference = _arm_angle(_simulate(model, start, "BDF", REFERENCE_RTOL))
        for method in methods():
            result = _simulate(model, start, method, RTOL)
            error = np.max(np.abs(_arm_angle(result) - reference)) / np.ptp(reference)
            seconds = [
                seconds_of(partial(_simulate, model, start, method, RTOL)) for _ in range(rounds)
            ]
            points.append(
                Point(
                    method,
                    speed,
                    eigenvalue,
                    float(error),
                    result.steps,
                    result.nfev,
                    timing_of(seconds),
                )
            )
            advance()
    return points


def _simulate(model: Model, start: Array, method: Method, rtol: float) -> Simulation:
    return simulate(
        model,
        (0.0, DURATION),
        start,
        method=method,
        rtol=rtol,
        atol=rtol * ATOL_PER_RTOL,
        t_eval=np.linspace(0.0, DURATION, ERROR_POINTS),
        max_steps=LARGEST_STEPS,
    )


def _arm_angle(result: Simulation) -> Array:
    return np.asarray(result.y)[0]


# -- showing ------------------------------------------------------------------------------------


def table(points: Sequence[Point]) -> str:
    """Return the points as a Markdown table, one row for each regularisation."""
    names = list(dict.fromkeys(p.method for p in points))
    rows = []
    for speed in dict.fromkeys(p.speed for p in points):
        own = {p.method: p for p in points if p.speed == speed}
        gear = own[names[0]]
        others = [p for name, p in own.items() if name != names[0]]
        rows.append(
            [
                power(speed),
                count(gear.eigenvalue),
                *(count(p.evaluations) for p in own.values()),
                *(milliseconds(p.seconds.least) for p in own.values()),
                f"{min(p.seconds.least for p in others) / gear.seconds.least:.2g}",
            ]
        )
    header = [
        "v0 [m/s]",
        "fastest eigenvalue [1/s]",
        *(f"evaluations, {NAMES.get(name, name)}" for name in names),
        *(f"time [ms], {NAMES.get(name, name)}" for name in names),
        "time, best Runge-Kutta / Gear",
    ]
    return markdown_table(header, rows)


def draw(points: Sequence[Point], processor: str) -> Figure:
    """Draw evaluations and time over the fastest eigenvalue."""
    with rc_context(STYLE):
        figure = Figure(figsize=(9.0, 4.4), layout="constrained")
        evaluations, times = figure.subplots(1, 2)
        for name in dict.fromkeys(p.method for p in points):
            own = [p for p in points if p.method == name]
            rates = [-p.eigenvalue for p in own]
            for axes, values in (
                (evaluations, [p.evaluations for p in own]),
                (times, [1e3 * p.seconds.least for p in own]),
            ):
                colour, marker = LOOKS["C" if native_available() else "SciPy", name]
                axes.plot(rates, values, color=colour, marker=marker, label=NAMES.get(name, name))
        _axes(evaluations, "evaluations of the right-hand side")
        _axes(times, "processor time [ms]")
        evaluations.legend(frameon=False)
        figure.suptitle(
            f"One second of the reference car with {FRICTION:g} N of friction in the strut, "
            f"relative tolerance {RTOL:g}\n(one core of {processor})",
            fontsize=10,
        )
    return figure


def _axes(axes: Axes, label: str) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("fastest decay at rest, $-\\lambda$ [1/s]")
    axes.set_ylabel(label)


def write_figure(points: Sequence[Point], processor: str, folder: Path) -> list[Path]:
    """Write the diagram as PNG and SVG; return the files."""
    figure = draw(points, processor)
    files = [folder / f"friction.{ending}" for ending in ("png", "svg")]
    with rc_context(STYLE):
        for file in files:
            metadata = {"Date": None} if file.suffix == ".svg" else None
            figure.savefig(file, dpi=130, metadata=metadata)
    return files
