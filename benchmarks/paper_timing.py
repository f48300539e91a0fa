"""The paper's protocol: one second, output every 1e-4 s, Runge-Kutta against Gear's method.

IMSL's DIVPRK (Verner's formulas of order 5 and 6) steps onto every output; DIVPAG (Gear's formulas)
takes steps of its own and interpolates. Here C does both, with the same compiled equations.
The four combinations that the paper does not have show what makes the difference.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from kintrafo import simulate, state_at_height
from kintrafo.simulation.dead_points import meanings
from kintrafo.simulation.solvers import NATIVE_METHODS, sundials
from kintrafo.vehicle.analysis.paper import (
    DURATION,
    OUTPUT_INTERVAL,
    PAPER_GEAR_S,
    PAPER_RUNGE_KUTTA_S,
    SPIN_RATE,
    START_HEIGHT,
    rest,
)
from kintrafo.vehicle.models.model import Model
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from .report import Timing, count, markdown_table, milliseconds, power, seconds_of, timing_of

Array = NDArray[np.float64]

RTOL = 1e-6
ATOL_PER_RTOL = 1e-3  # absolute tolerance [rad, rad/s], as a part of the relative one
REFERENCE_RTOL = 1e-13
ERROR_POINTS = 101

NAMES = {"BDF": "Gear (BDF)", "DormandPrince": "Dormand-Prince 5(4)", "Verner": "Verner 6(5)"}
# Method, and whether it steps onto every output. The first two are the paper's.
CONTENDERS = (
    ("Verner", True),
    ("BDF", False),
    ("DormandPrince", True),
    ("BDF", True),
    ("Adams", False),
    ("DormandPrince", False),
)


@dataclass(frozen=True)
class Case:
    """The motion of the paper: one second from 0.325 m, the wheel spinning at 14.8 rev/s."""

    model: Model
    start: Array  # initial state
    inputs: Array  # held at zero
    eigenvalues: NDArray[np.complex128]  # at rest [1/s]
    # where errors are taken [s], and the arm angle there [rad]
    times: Array
    reference: Array
    amplitude: float  # greatest distance of the arm angle from its value at rest [rad]

    def error(self, arm_angle: Array) -> float:
        """Return the greatest error of the arm angle at `times`, as a part of the amplitude."""
        return float(np.max(np.abs(arm_angle - self.reference)) / self.amplitude)


def standard_case() -> Case:
    """Return the paper's case with the reference car, and its reference solution."""
    model = Model("reference_car")
    start = state_at_height(model, START_HEIGHT, spin_rate=SPIN_RATE)
    times = np.linspace(0.0, DURATION, ERROR_POINTS)
    at_rest = rest(model).state
    arm_angle = _reference(model, start, times)
    return Case(
        model=model,
        start=start,
        inputs=model.inputs(),
        eigenvalues=model.eigenvalues(at_rest),
        times=times,
        reference=arm_angle,
        amplitude=float(np.max(np.abs(arm_angle - at_rest[0]))),
    )


def _reference(model: Model, start: Array, times: Array) -> Array:
    """Integrate with DOP853 from point to point, so that nothing is interpolated."""
    inputs, states = model.inputs(), [start]
    for begin, end in pairwise(times):
        solution = solve_ivp(
            lambda _, y: model.equations.rhs_rack_held(y, inputs, model.constants),
            (begin, end),
            states[-1],
            "DOP853",
            rtol=REFERENCE_RTOL,
            atol=REFERENCE_RTOL * ATOL_PER_RTOL,
        )
        states.append(solution.y[:, -1])
    return np.array(states)[:, 0]


def native_call(
    case: Case, method: str, times: Array, rtol: float, *, stop_at_outputs: bool
) -> Callable[[], dict[str, Any]]:
    """Return a function that integrates in C, with nothing of `simulate` around it."""
    equations = case.model.equations
    names = ("rhs_rack_held", "rhs_jacobian_rack_held", "signals", "margins")
    addresses = tuple(equations.ADDRESSES[name] for name in names)
    atol = np.full(case.start.shape, rtol * ATOL_PER_RTOL)
    none = np.zeros(1, dtype=np.int32)

    def call() -> dict[str, Any]:
        raw: dict[str, Any] = sundials.integrate(
            addresses,
            case.model.layout,
            case.model.constants,
            case.inputs,
            [],
            np.zeros(0),  # milestones
            np.zeros((2, 0)),  # turns of inputs
            case.start,
            times,
            method=NATIVE_METHODS[method],
            rtol=rtol,
            atol=atol,
            first_step=0.0,
            max_step=0.0,
            max_steps=1_000_000,
            every_step=False,
            stop_at_outputs=stop_at_outputs,
            dense=False,
            signal_count=len(case.model.signal_names),
            events=[],
            roots=(),
            directions=none,
            terminal=none,
            guards=np.append(meanings(equations), np.int32(0)),
            usual_margins=case.model.usual_margins,
        )
        if raw["outcome"] != "done":
            raise RuntimeError(f"{method}, rtol {rtol:g}: {raw['outcome']}")
        return raw

    return call


# -- measuring ----------------------------------------------------------------------------------


@dataclass(frozen=True)
class Entry:
    """One method of the protocol."""

    method: str
    stops: bool  # whether it steps onto every output; it interpolates otherwise
    steps: int
    evaluations: int
    jacobians: int
    factorisations: int
    error_test_failures: int
    error: float  # of the arm angle, as a part of its amplitude
    integration: Timing  # in C, from the first step to the last output
    # what a user of `simulate` waits for: with the physical signals at every output
    simulate: Timing


@dataclass(frozen=True)
class PaperTiming:
    """The result of the protocol."""

    rtol: float
    atol: float
    output_interval: float
    outputs: int  # number of outputs after the initial state
    entries: list[Entry]  # the first two are the paper's: Runge-Kutta, and Gear
    # of the first two entries
    time_ratio: float
    simulate_ratio: float
    evaluation_ratio: float
    paper_ratio: float  # of the times that the paper gives


def measure(
    case: Case,
    *,
    interval: float = OUTPUT_INTERVAL,
    rounds: int = 25,
    advance: Callable[[], None] = lambda: None,
) -> PaperTiming:
    """Run the protocol.

    Parameters
    ----------
    case : Case
    interval : float, optional
        Between outputs [s].
    rounds : int, optional
        Each method once in every round, so that a disturbance meets all of them; a fifth of the
        rounds for `simulate`.
    advance : callable, optional
        Called after every round.

    Returns
    -------
    PaperTiming
    """
    times = np.linspace(0.0, DURATION, round(DURATION / interval) + 1)
    calls = [native_call(case, m, times, RTOL, stop_at_outputs=s) for m, s in CONTENDERS]
    whole = [_simulation(case, m, times, stops=s) for m, s in CONTENDERS]
    inner: list[list[float]] = [[] for _ in calls]
    outer: list[list[float]] = [[] for _ in calls]
    for turn in range(rounds):
        for call, seconds in zip(calls, inner, strict=True):
            seconds.append(seconds_of(call))
        if turn % 5 == 0:
            for call, seconds in zip(whole, outer, strict=True):
                seconds.append(seconds_of(call))
        advance()
    entries = [
        _entry(case, m, s, call(), timing_of(a), timing_of(b))
        for (m, s), call, a, b in zip(CONTENDERS, calls, inner, outer, strict=True)
    ]
    return _result(entries, interval, times.size - 1)


def _simulation(case: Case, method: Any, times: Array, *, stops: bool) -> Callable[[], Any]:
    def call() -> dict[str, Array]:
        result = simulate(
            case.model,
            (0.0, DURATION),
            case.start,
            method=method,
            t_eval=times,
            rtol=RTOL,
            atol=RTOL * ATOL_PER_RTOL,
            stop_at_outputs=stops,
        )
        return dict(result.signals)  # computed here, when they are asked for

    return call


def _entry(
    case: Case, method: str, stops: bool, raw: dict[str, Any], integration: Timing, whole: Timing
) -> Entry:
    every = (len(raw["output"]) - 1) // (case.times.size - 1)
    return Entry(
        method=method,
        stops=stops,
        steps=raw["steps"],
        evaluations=raw["nfev"],
        jacobians=raw["njev"],
        factorisations=raw["nlu"],
        error_test_failures=raw["error_test_failures"],
        error=case.error(raw["output"][::every, 1]),
        integration=integration,
        simulate=whole,
    )


def _result(entries: list[Entry], interval: float, outputs: int) -> PaperTiming:
    runge_kutta, gear = entries[:2]
    return PaperTiming(
        rtol=RTOL,
        atol=RTOL * ATOL_PER_RTOL,
        output_interval=interval,
        outputs=outputs,
        entries=entries,
        time_ratio=runge_kutta.integration.least / gear.integration.least,
        simulate_ratio=runge_kutta.simulate.least / gear.simulate.least,
        evaluation_ratio=runge_kutta.evaluations / gear.evaluations,
        paper_ratio=PAPER_RUNGE_KUTTA_S / PAPER_GEAR_S,
    )


# -- writing ------------------------------------------------------------------------------------


def methods_table(result: PaperTiming) -> str:
    """Return a row for every method."""
    header = [
        "method",
        "outputs",
        "steps",
        "evaluations",
        "per output",
        "error",
        "time [ms]",
        "spread",
        "simulate [ms]",
    ]
    return markdown_table(header, [_row(e, result.outputs) for e in result.entries])


def _row(entry: Entry, outputs: int) -> list[str]:
    return [
        NAMES.get(entry.method, entry.method),
        "stops at" if entry.stops else "interpolates",
        count(entry.steps),
        count(entry.evaluations),
        f"{entry.evaluations / outputs:.2f}",
        power(entry.error),
        milliseconds(entry.integration.least),
        f"+{100.0 * entry.integration.spread:.0f} %",
        milliseconds(entry.simulate.least),
    ]


def ratio_table(result: PaperTiming) -> str:
    """Return the ratios of the paper's two methods, beside the paper's."""
    return markdown_table(
        ["Runge-Kutta over Gear", "ratio"],
        [
            ["time, paper: more than 6 min over 13 s", f"{result.paper_ratio:.1f}"],
            ["time, integration in C", f"{result.time_ratio:.1f}"],
            ["time, `simulate` with its signals", f"{result.simulate_ratio:.1f}"],
            ["evaluations", f"{result.evaluation_ratio:.1f}"],
        ],
    )
