"""The gradient of what a motion is judged by: backwards through the steps of its integration.

The motion is integrated by Dormand and Prince's method as by `simulate`. Its steps are then gone
through from the last one to the first (the discrete adjoint of a Runge-Kutta method, reverse mode:
Hairer, Lubich and Wanner, Geometric Numerical Integration, VI.1.4), with their lengths as they
are. So the gradient is that of the numbers which the integration gives, by everything at once, and
takes a few times as long as the motion.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ..core.named_types import ArrayLike
from ..core.validator import Validator, shown
from ..systems.derivatives import checked_directions
from ..systems.state import inputs_of
from ..systems.system import System
from .accuracy import Accuracy, accuracy_of, outputs_of, span_of
from .courses import Signal
from .kinks import ended_at_kinks
from .result import Simulation
from .retraced import RetracedSteps
from .signals import TimeInputs, time_inputs
from .simulate import simulate_inputs
from .sweep import Sweep

Array = NDArray[np.float64]
Measure = Literal["mean", "rms"]

OUTPUTS = 201
MOST_STEPS = 10_000_000
# Steps whose Jacobian is looked at, and by how much they may be longer than it allows.
_LOOKS = 32
_MORE = 1.2
# Part of a signal that is rounding of the sums that it is made of.
_STAYS = 64.0 * np.finfo(float).eps


@dataclass(frozen=True)
class MotionGradient:
    """Objectives of a motion and their gradients.

    Attributes
    ----------
    value : float
        The sum that was asked for.
    by : dict of str to float
        Its derivatives with respect to parameters, elements of the state at the start, and inputs
        that do not vary, by name, SI units. Parameters move by themselves: the start stays. NaN by
        a parameter that cannot move alone, see `kintrafo.gradient`.
    motion : Simulation
        With every step.
    """

    value: float
    by: dict[str, float]
    motion: Simulation


def motion_gradient(
    system: System,
    t_span: tuple[float, float],
    y0: ArrayLike,
    of: Mapping[str, Measure | ArrayLike],
    *,
    inputs: Mapping[str, Signal] | None = None,
    t_eval: ArrayLike | None = None,
    rtol: float = 1e-6,
    atol: ArrayLike = 1e-9,
    max_step: float = np.inf,
) -> MotionGradient:
    """Return the exact gradient of a number that a motion is judged by.

    Parameters
    ----------
    system : System
        With equations that were compiled with ``parameter_derivatives=True``.
    t_span, y0, inputs, rtol, atol, max_step
        As for `simulate`, by the method 'DormandPrince'; time goes forward.
    of : mapping of str to str or array_like
        Signals, or elements of the state, and what is made of each: 'mean', 'rms' (about the
        mean), both over the times ``t_eval``, or weights of its values at these times. The number
        is the sum of it all.
    t_eval : array_like, optional
        Times at which signals are looked at, by default 201 from the first to the last [s].

    Returns
    -------
    MotionGradient

    Raises
    ------
    InputError
        If an argument cannot be used, or the rates jump on the way.
    SimulationError
        As of `simulate`.

    Notes
    -----
    The lengths of steps are taken as they are. They change with parameters, too, which changes
    the result by no more than the integration errs. No step is so long that what is at rest, and a
    parameter would move, is not followed as accurately: its length times the size of any eigenvalue
    of the Jacobian is at most (3600 rtol)^(1/6), so that stiff members make it slow.

    Where a stop is touched, or a curve has a kink, the derivatives change at once; steps grow
    shorter towards such a moment, so that only one of some root of `rtol` of the longest passes
    over it. What rests on a kink has the derivative of one side. Where rates jump, as where a tyre
    with damping meets the road, there is no gradient and an error says so.

    Examples
    --------
    >>> import kintrafo
    >>> from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
    >>> four_bar = kintrafo.System(kintrafo.compile(FOUR_BAR, parameter_derivatives=True))
    >>> start = four_bar.state(crank_angle=0.3)
    >>> found = kintrafo.motion_gradient(four_bar, (0.0, 0.5), start, {"crank_angle": "mean"})
    >>> round(found.by["crank_mass"], 4)
    -0.0005
    """
    with Validator("motion_gradient") as given:
        directions = checked_directions(given, system)
        span = forward_span(given, t_span)
        if not given.failed:
            times = output_times_of(given, t_eval, span)
            asked = _asked(given, system, of, times)
            given.array("y0", y0, dimensions=[1], last=len(system.state_names), empty=True)
            accuracy = accuracy_of(
                given, len(system.state_names), rtol=rtol, atol=atol, max_step=max_step,
                first_step=None, max_steps=MOST_STEPS,
            )  # fmt: skip
    held = inputs_of(y0, system.names_of_states)
    courses = time_inputs(system, inputs, span, held=held, max_step=max_step)
    motion, steps = followed(system, courses, np.array(y0, dtype=float), accuracy)
    places = steps.places(times)
    point = steps.point(*places)
    value, weights = _judged(system, asked, times, *point)
    swept = Sweep(system, steps).backwards(places, point, weights)
    return MotionGradient(value, _named(system, directions, courses, *swept), motion)


def forward_span(given: Validator, t_span: Any) -> tuple[float, float]:
    """Check first and last time, which must be the later one [s]."""
    span = span_of(given, t_span)
    if span[1] < span[0]:
        given.fail(f"t_span = {shown(t_span)}: the last time must be the later one.")
    return span


def output_times_of(given: Validator, t_eval: Any, span: tuple[float, float]) -> Array:
    """Check the times at which a motion is looked at, `OUTPUTS` of them by default [s]."""
    return outputs_of(given, np.linspace(*span, OUTPUTS) if t_eval is None else t_eval, span)


def followed(
    system: System, courses: TimeInputs, state: Array, accuracy: Accuracy
) -> tuple[Simulation, RetracedSteps]:
    """Return a motion whose steps are fit for derivatives, and the steps."""
    begin = np.array([courses.segments[0].start])
    longest = min(accuracy.max_step, _longest(system, courses, accuracy.rtol, begin, state[None]))

    def again(inputs: TimeInputs) -> Simulation:
        shorter = replace(accuracy, max_step=longest)
        return simulate_inputs(system, inputs, state, None, shorter, method="DormandPrince")

    while True:
        motion = again(courses)
        allowed = _longest(system, courses, accuracy.rtol, *_looked_at(motion))
        if np.diff(motion.t).max() <= _MORE * allowed:
            return ended_at_kinks(system, motion, courses, again, accuracy.rtol)
        longest = min(longest, allowed)


def _looked_at(motion: Simulation) -> tuple[Array, Array]:
    """Return times and states of some steps: all along, and where they are longest."""
    count = motion.t.size - 1
    lengths = np.diff(motion.t)
    along = np.linspace(0, count - 1, min(count, _LOOKS)).astype(int)
    rows = np.union1d(along, np.argsort(lengths)[-_LOOKS:])
    return motion.t[rows], motion.y.T[rows]


def _longest(
    system: System, courses: TimeInputs, rtol: float, times: Array, states: Array
) -> float:
    """Return how long steps may be for what moves beside the motion to be followed, too.

    Where nothing moves a step errs by nothing, however long it is; but a small disturbance, such as
    a parameter makes, would grow by all that the polynomial of the method is beside exp(h l), for
    an eigenvalue l of the Jacobian. That is (h l)^6 / 3600 at first.
    """
    inputs = np.empty((times.size, len(system.input_names)))
    for part in courses.segments:
        rows = (times >= part.start) & (times <= part.end)
        inputs[rows] = courses.table(times[rows], part)
    jacobians = system.evaluate("rhs_jacobian", states, inputs)
    fastest = float(np.abs(np.linalg.eigvals(jacobians)).max(initial=0.0))
    return (3600.0 * rtol) ** (1.0 / 6.0) / fastest if fastest > 0.0 else np.inf


def _asked(given: Validator, system: System, of: Any, times: Array) -> dict[str, Any]:
    """Return what is asked of each signal: a word, or weights."""
    known = (*system.signal_names, *system.state_names)
    found: dict[str, Any] = {}
    for name, wanted in given.mapping("of", of, "signals and what is made of them").items():
        given.among("signal", name, known)
        if isinstance(wanted, str):
            given.among(f"of {name!r}", wanted, ("mean", "rms"))
            if times.size < 2:
                given.fail(f"of {name!r}: {wanted!r} needs two times or more.")
            found[str(name)] = wanted
            continue
        weights = given.array(f"of {name!r}", wanted, dimensions=[1])
        if weights.shape != times.shape:
            given.fail(f"of {name!r}: {weights.size} weights are given for {times.size} times.")
        found[str(name)] = weights
    if not (found or given.failed):
        given.fail("of is empty: one signal or more is needed.")
    return found


def _judged(
    system: System, asked: Mapping[str, Any], times: Array, states: Array, inputs: Array
) -> tuple[float, dict[str, Array]]:
    """Return the number that is asked for, and its derivatives by the signals at all times."""
    signals = system.signals(states, inputs)
    share = np.diff(times, prepend=times[0], append=times[-1])
    share = (share[:-1] + share[1:]) / 2.0 / max(float(times[-1] - times[0]), np.finfo(float).tiny)
    value, weights = 0.0, {}
    for name, wanted in asked.items():
        own = signals[name] if name in signals else states[:, system.state_names.index(name)]
        if not isinstance(wanted, str):
            number, by = float(wanted @ own), wanted
        elif wanted == "mean":
            number, by = float(share @ own), share
        else:
            moved = own - share @ own
            number = float(np.sqrt(share @ moved**2))
            # what stays but for rounding has no slope
            stays = number <= _STAYS * float(np.abs(own).max())
            by = 0.0 * share if stays else share * moved / number
        value, weights[name] = value + number, by
    return value, weights


def _named(
    system: System,
    directions: Any,
    courses: TimeInputs,
    constants: Array,
    start: Array,
    held: Array,
) -> dict[str, float]:
    """Return derivatives by name: by parameters, the start, and inputs that do not vary."""
    parameters = np.array([*system.parameters.values()])
    by = directions.of_parameters("prepare_adjoint", parameters, constants, parameters.size)
    by[directions.bound(parameters)] = np.nan
    vary = {target for spline in courses.segments[0].splines for target in spline.targets}
    inputs = {
        name: value
        for place, (name, value) in enumerate(zip(system.input_names, held, strict=True))
        if place not in vary
    }
    found = {**dict(zip(system.parameters, by, strict=True)), **inputs}
    found |= dict(zip(system.state_names, start, strict=True))
    return {name: float(value) for name, value in found.items()}
