"""Free steps: what each method costs for the accuracy that it reaches.

Every method chooses its own steps and interpolates at 101 outputs. Its tolerance goes from 1e-3 to
1e-11; the error is that of the arm angle at the outputs, as a part of its amplitude.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import factorial
from pathlib import Path
from typing import Any

import numpy as np
from kintrafo.pictures.figures import BLUE, GREEN, ORANGE, STYLE
from kintrafo.simulation.solvers import native_methods
from kintrafo.vehicle.analysis.paper import DURATION
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from .paper_timing import ATOL_PER_RTOL, NAMES, Case, native_call
from .report import Timing, count, markdown_table, milliseconds, power, seconds_of, timing_of

BUDGET = 0.1  # a point is repeated for so long [s]
TOLERANCES = tuple(10.0**-k for k in range(3, 12))
ERROR_OF_COMPARISON = 1e-6
NATIVE = ("Verner", "DormandPrince", "BDF", "Adams")
SCIPY = ("RK45", "DOP853", "BDF", "Radau", "LSODA")
_IMPLICIT = ("BDF", "Radau", "LSODA")

PURPLE, SKY, GREY, BLACK = "#cc79a7", "#56b4e9", "#777777", "#000000"
# Colour and marker of each curve: the same colour for the same formulas.
LOOKS = {
    ("C", "Verner"): (GREEN, "s"),
    ("C", "DormandPrince"): (BLUE, "o"),
    ("C", "BDF"): (ORANGE, "^"),
    ("C", "Adams"): (PURPLE, "D"),
    ("SciPy", "RK45"): (BLUE, "o"),
    ("SciPy", "DOP853"): (SKY, "v"),
    ("SciPy", "BDF"): (ORANGE, "^"),
    ("SciPy", "Radau"): (BLACK, "X"),
    ("SciPy", "LSODA"): (GREY, "P"),
}


@dataclass(frozen=True)
class Point:
    """One method at one tolerance.

    Attributes
    ----------
    library, method : str
    rtol, error : float
        Relative tolerance, and error of the arm angle as a part of its amplitude.
    steps : int
        0 where the library does not tell.
    evaluations, jacobians : int
    seconds : Timing
    """

    library: str
    method: str
    rtol: float
    error: float
    steps: int
    evaluations: int
    jacobians: int
    seconds: Timing


@dataclass(frozen=True)
class Stiffness:
    """How fast the model's own motions are, against the steps that accuracy asks for."""

    eigenvalues: NDArray[np.complex128]  # at rest [1/s]
    # longest step at which Dormand-Prince's formula is stable for all of them [s]
    stable_step: float


# -- measuring ----------------------------------------------------------------------------------


def curves() -> list[tuple[str, str]]:
    """Return library and method of every curve that can be measured here."""
    native = [("C", m) for m in NATIVE if m in native_methods()]
    return native + [("SciPy", m) for m in SCIPY]


def measure(
    case: Case,
    tolerances: Sequence[float] = TOLERANCES,
    *,
    passes: int = 3,
    budget: float = BUDGET,
    advance: Callable[[], None] = lambda: None,
) -> list[Point]:
    """Integrate with every method at every tolerance.

    Parameters
    ----------
    case : Case
    tolerances : sequence of float, optional
    passes : int, optional
        Everything is measured so many times in turn, so that a disturbance does not stay with one
        point.
    budget : float, optional
        In each pass, a point is repeated until it has taken this time, and once at least [s].
    advance : callable, optional
        Called after every point of every pass.

    Returns
    -------
    list of Point
    """
    keys = [(library, method, rtol) for library, method in curves() for rtol in tolerances]
    calls = {key: _call(case, *key) for key in keys}
    seconds: dict[tuple[str, str, float], list[float]] = {key: [] for key in keys}
    last: dict[tuple[str, str, float], dict[str, Any]] = {}
    for _ in range(passes):
        for key, call in calls.items():
            last[key] = _repeat(call, seconds[key], budget)
            advance()
    return [_point(case, key, last[key], seconds[key]) for key in keys]


def _call(case: Case, library: str, method: str, rtol: float) -> Callable[[], dict[str, Any]]:
    return (_native if library == "C" else _scipy)(case, method, rtol)


def _repeat(
    call: Callable[[], dict[str, Any]], seconds: list[float], budget: float
) -> dict[str, Any]:
    """Note the time of each repetition, and return the last result."""
    results: list[dict[str, Any]] = []
    spent = 0.0
    while not results or spent < budget:
        seconds.append(seconds_of(lambda: results.append(call())))
        spent += seconds[-1]
    return results[-1]


def _point(
    case: Case, key: tuple[str, str, float], result: dict[str, Any], seconds: list[float]
) -> Point:
    library, method, rtol = key
    return Point(
        library=library,
        method=method,
        rtol=rtol,
        error=case.error(result["arm_angle"]),
        steps=result["steps"],
        evaluations=result["nfev"],
        jacobians=result["njev"],
        seconds=timing_of(seconds),
    )


def _native(case: Case, method: str, rtol: float) -> Callable[[], dict[str, Any]]:
    integrate = native_call(case, method, case.times, rtol, stop_at_outputs=False)

    def call() -> dict[str, Any]:
        raw = integrate()
        return {**raw, "arm_angle": raw["output"][:, 1]}

    return call


def _scipy(case: Case, method: Any, rtol: float) -> Callable[[], dict[str, Any]]:
    model = case.model
    rhs, jacobian = model.equations.rhs_rack_held, model.equations.rhs_jacobian_rack_held
    inputs, constants = case.inputs, model.constants
    extra: dict[str, Any] = {}
    if method in _IMPLICIT:
        extra["jac"] = lambda _, y: jacobian(y, inputs, constants)

    def call() -> dict[str, Any]:
        solution = solve_ivp(
            lambda _, y: rhs(y, inputs, constants),
            (0.0, DURATION),
            case.start,
            method,
            t_eval=case.times,
            rtol=rtol,
            atol=rtol * ATOL_PER_RTOL,
            **extra,
        )
        if not solution.success:
            raise RuntimeError(f"{method}, rtol {rtol:g}: {solution.message}")
        counts = {"steps": 0, "nfev": int(solution.nfev), "njev": int(solution.njev)}
        return {**counts, "arm_angle": solution.y[0]}

    return call


def stiffness(case: Case) -> Stiffness:
    """Compare the eigenvalues at rest with the region where an explicit method is stable."""
    steps = np.linspace(1e-4, 0.2, 20_000)
    # of Dormand-Prince: exact to the fifth power, and 1/600 of the sixth
    terms = np.array([1.0 / 600.0, *(1.0 / factorial(k) for k in range(5, -1, -1))])
    moving = case.eigenvalues[np.abs(case.eigenvalues) > 1e-6]
    growth = np.abs(np.polyval(terms, np.outer(moving, steps)))
    unstable = np.any(growth > 1.0, axis=0)
    return Stiffness(case.eigenvalues, float(steps[np.argmax(unstable) - 1]))


# -- equal accuracy -----------------------------------------------------------------------------


@dataclass(frozen=True)
class Cost:
    """Cost of one method at an error of `ERROR_OF_COMPARISON`, between two tolerances."""

    library: str
    method: str
    evaluations: float
    seconds: float


def cost_at(points: Sequence[Point], error: float = ERROR_OF_COMPARISON) -> list[Cost]:
    """Interpolate between the tolerances, in logarithms, for a given error.

    Parameters
    ----------
    points : sequence of Point
    error : float, optional

    Returns
    -------
    list of Cost
        The methods that reach it within their tolerances, the fewest evaluations first.
    """
    costs = []
    for library, method in dict.fromkeys((p.library, p.method) for p in points):
        own = [p for p in points if (p.library, p.method) == (library, method)]
        for coarse, fine in pairwise(own):
            if coarse.error > error >= fine.error:
                part = np.log(coarse.error / error) / np.log(coarse.error / fine.error)
                evaluations = coarse.evaluations * (fine.evaluations / coarse.evaluations) ** part
                ratio = fine.seconds.least / coarse.seconds.least
                seconds = coarse.seconds.least * ratio**part
                costs.append(Cost(library, method, float(evaluations), float(seconds)))
                break
    return sorted(costs, key=lambda c: c.evaluations)


# -- writing ------------------------------------------------------------------------------------


def _name(method: str) -> str:
    return NAMES.get(method, method)


def points_table(points: Sequence[Point]) -> str:
    """Return a row for every method and tolerance."""
    header = ["method", "library", "rtol", "error", "steps", "evaluations", "Jacobians"]
    rows = [
        [
            _name(p.method),
            p.library,
            power(p.rtol),
            power(p.error),
            count(p.steps) if p.steps else "",
            count(p.evaluations),
            count(p.jacobians) if p.jacobians else "",
            milliseconds(p.seconds.least),
            f"+{100.0 * p.seconds.spread:.0f} %",
        ]
        for p in points
    ]
    return markdown_table([*header, "time [ms]", "spread"], rows)


def cost_table(costs: Sequence[Cost]) -> str:
    """Return what each method needs for the same error."""
    return markdown_table(
        ["method", "library", "evaluations", "time [ms]"],
        [
            [_name(c.method), c.library, count(c.evaluations), milliseconds(c.seconds)]
            for c in costs
        ],
    )


def stiffness_table(result: Stiffness, points: Sequence[Point]) -> str:
    """Return the eigenvalues, and the longest stable step beside the steps taken."""
    rows = [["eigenvalues at rest [1/s]", _eigenvalues(result.eigenvalues)]]
    rows.append(["longest stable step of Dormand-Prince [ms]", f"{1e3 * result.stable_step:.0f}"])
    rows += [
        [f"its mean step at rtol {power(p.rtol)} [ms]", f"{1e3 * DURATION / p.steps:.2g}"]
        for p in points
        if (p.library, p.method) == ("C", "DormandPrince") and p.rtol in _SHOWN
    ]
    return markdown_table(["", "value"], rows)


_SHOWN = (TOLERANCES[0], TOLERANCES[3])


def _eigenvalues(values: NDArray[np.complex128]) -> str:
    upper = sorted((v for v in values if v.imag > 1e-6), key=abs)
    single = [v.real for v in values if abs(v.imag) <= 1e-6]
    pairs = [f"{v.real:.2f} ± {v.imag:.2f} i" for v in upper]
    return ", ".join([*pairs, *(f"{v + 0.0:.3g}" for v in single)])


def draw(points: Sequence[Point], processor: str) -> Figure:
    """Draw both diagrams: evaluations and time against the error."""
    with rc_context(STYLE):
        figure = Figure(figsize=(9.0, 5.2), layout="constrained")
        evaluations, times = figure.subplots(1, 2)
        lines: dict[str, list[Line2D]] = {"C": [], "SciPy": []}
        for library, method in dict.fromkeys((p.library, p.method) for p in points):
            own = [p for p in points if (p.library, p.method) == (library, method)]
            lines[library].append(_curve(evaluations, own, [p.evaluations for p in own]))
            _curve(times, own, [1e3 * p.seconds.least for p in own])
        _axes(evaluations, "evaluations of the right-hand side")
        _axes(times, "processor time [ms]")
        _legend(figure, lines)
        figure.suptitle(
            "One second of the reference car, every method with its own steps\n"
            f"(one core of {processor})",
            fontsize=10,
        )
    return figure


def _curve(axes: Axes, points: Sequence[Point], values: Sequence[float]) -> Line2D:
    library, method = points[0].library, points[0].method
    colour, marker = LOOKS[library, method]
    native = library == "C"
    (line,) = axes.plot(
        [p.error for p in points],
        values,
        color=colour,
        marker=marker,
        markersize=5.5,
        markerfacecolor=colour if native else "white",
        linestyle="-" if native else (0, (4, 2)),
        linewidth=1.6 if native else 1.2,
        label=_name(method),
    )
    return line


def _axes(axes: Axes, label: str) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.invert_xaxis()
    axes.set_xlabel("error of the arm angle / its amplitude [-]")
    axes.set_ylabel(label)


def _legend(figure: Figure, lines: dict[str, list[Line2D]]) -> None:
    """Put one row for each library below the diagrams; Matplotlib fills column by column."""
    rows = []
    for library, own in lines.items():
        if own:
            title = Line2D([], [], linestyle="none", label=f"{library}:")
            empty = [Line2D([], [], linestyle="none", label="")] * (len(LOOKS) - len(own))
            rows.append([title, *own, *empty][: len(SCIPY) + 1])
    handles = [handle for column in zip(*rows, strict=True) for handle in column]
    figure.legend(
        handles=handles,
        loc="outside lower center",
        ncols=len(SCIPY) + 1,
        frameon=False,
        fontsize=9,
        columnspacing=1.2,
        handlelength=2.6,
    )


def write_figure(points: Sequence[Point], processor: str, folder: Path) -> list[Path]:
    """Write the diagrams as PNG and SVG.

    Parameters
    ----------
    points : sequence of Point
    processor : str
        Its name, for the line below.
    folder : Path

    Returns
    -------
    list of Path
    """
    figure = draw(points, processor)
    files = [folder / f"work_precision.{ending}" for ending in ("png", "svg")]
    with rc_context(STYLE):
        for file in files:
            metadata = {"Date": None} if file.suffix == ".svg" else None
            figure.savefig(file, dpi=130, metadata=metadata)
    return files
