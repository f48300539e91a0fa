"""The gradient of a functional of a motion: backwards through the steps of its integration.

Dormand and Prince's method integrates the motion as in `simulate`. Its steps are then processed
from the last to the first (the discrete adjoint of a Runge-Kutta method, reverse mode: Hairer,
Lubich and Wanner, Geometric Numerical Integration, VI.1.4), with fixed lengths. So the gradient is
that of the numbers which the integration returns, with respect to all variables together, and takes
a few times as long as the motion.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from ..core.named_types import Array, ArrayLike
from ..core.validator import Validator, shown
from ..systems.derivatives import checked_directions
from ..systems.state import inputs_of
from ..systems.system import System
from .accuracy import Accuracy, accuracy_of, outputs_of, span_of
from .input_profiles import Signal
from .kinks import ended_at_kinks
from .result import Simulation
from .retraced import RetracedSteps
from .signals import TimeInputs, time_inputs
from .simulate import simulate_inputs
from .sweep import Sweep

Measure = Literal["mean", "rms"]

OUTPUTS = 201
MOST_STEPS = 10_000_000
# Number of steps whose Jacobian is evaluated, and the allowed factor of their length.
_LOOKS = 32
_MORE = 1.2
# Rounding error of the sums in a signal, relative to the signal.
_STAYS = 64.0 * np.finfo(float).eps


@dataclass(frozen=True)
class MotionGradient:
    """A number of a motion, and its gradient.

    Attributes
    ----------
    value : float
        The sum over the signals in ``of``.
    by : dict of str to float
        Its derivatives with respect to parameters, elements of the initial state, and inputs that
        do not vary, by name, SI units. Those with respect to parameters are for a fixed initial
        state. NaN for a parameter that cannot change alone, see `kintrafo.gradient`.
    motion : Simulation
        The motion, at every step of the integration.
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
    """Return the exact gradient of one number of a motion, such as the RMS of a signal.

    Parameters
    ----------
    system : System
        Equations that were compiled with ``parameter_derivatives=True``.
    t_span, y0, inputs, rtol, atol, max_step
        Time span [s], initial state, inputs and tolerances, as for `simulate` with the method
        'DormandPrince'; the motion runs forward in time.
    of : mapping of str to str or array_like
        The number is a sum over signals, or elements of the state, by name: of each the 'mean' or
        'rms' (about the mean) over the times ``t_eval``, or the sum of its values at these times,
        multiplied by the given weights.
    t_eval : array_like, optional
        Times at which signals are evaluated [s], by default 201 from the first to the last.

    Returns
    -------
    MotionGradient

    Raises
    ------
    InputError
        If an argument cannot be used, or the rates jump during the motion.
    SimulationError
        If the integration does not reach the end; the message has the time and the reason.

    Notes
    -----
    The derivatives are those at fixed lengths of steps. Lengths depend on parameters, too, but this
    changes the result by no more than the error of the integration. A disturbance of a system at
    rest is integrated as accurately: the length of a step times the size of any eigenvalue of the
    Jacobian is at most (3600 rtol)^(1/6), which makes the integration of stiff motions slow.

    Where a stop is touched, or a curve has a kink, the derivatives jump. Steps become shorter
    towards such a time: the step that passes it is about sqrt(rtol) times as long as the longest
    one. A part that rests on a kink has the derivative of one side. If rates jump, for example
    where a tyre with damping meets the road, there is no gradient, and an error is raised.

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
    profiles = time_inputs(system, inputs, span, held=held, max_step=max_step)
    motion, steps = followed(system, profiles, np.array(y0, dtype=float), accuracy)
    places = steps.places(times)
    point = steps.point(*places)
    value, weights = _judged(system, asked, times, *point)
    swept = Sweep(system, steps).backwards(places, point, weights)
    return MotionGradient(value, _named(system, directions, profiles, *swept), motion)


def forward_span(given: Validator, t_span: Any) -> tuple[float, float]:
    """Return the checked first and last time, which must be the later one [s]."""
    span = span_of(given, t_span)
    if span[1] < span[0]:
        given.fail(f"t_span = {shown(t_span)}: the last time must be the later one.")
    return span


def output_times_of(given: Validator, t_eval: Any, span: tuple[float, float]) -> Array:
    """Return the checked times of outputs, `OUTPUTS` of them by default [s]."""
    return outputs_of(given, np.linspace(*span, OUTPUTS) if t_eval is None else t_eval, span)


def followed(
    system: System, profiles: TimeInputs, state: Array, accuracy: Accuracy
) -> tuple[Simulation, RetracedSteps]:
    """Return a motion whose steps are short enough for derivatives, and the steps."""
    begin = np.array([profiles.segments[0].start])
    longest = min(accuracy.max_step, _longest(system, profiles, accuracy.rtol, begin, state[None]))

    def again(inputs: TimeInputs) -> Simulation:
        shorter = replace(accuracy, max_step=longest)
        return simulate_inputs(system, inputs, state, None, shorter, method="DormandPrince")

    while True:
        motion = again(profiles)
        allowed = _longest(system, profiles, accuracy.rtol, *_looked_at(motion))
        if np.diff(motion.t).max() <= _MORE * allowed:
            return ended_at_kinks(system, motion, profiles, again, accuracy.rtol)
        longest = min(longest, allowed)


def _looked_at(motion: Simulation) -> tuple[Array, Array]:
    """Return times and states of some steps: over the whole motion, and of the longest."""
    count = motion.t.size - 1
    lengths = np.diff(motion.t)
    along = np.linspace(0, count - 1, min(count, _LOOKS)).astype(int)
    rows = np.union1d(along, np.argsort(lengths)[-_LOOKS:])
    return motion.t[rows], motion.y.T[rows]


def _longest(
    system: System, profiles: TimeInputs, rtol: float, times: Array, states: Array
) -> float:
    """Return the longest steps with which small disturbances are integrated accurately.

    At rest a step of any length has no error; but a small disturbance, such as a change of a
    parameter, grows in a step by the error of the polynomial of the method beside exp(h l), for an
    eigenvalue l of the Jacobian: about (h l)^6 / 3600.
    """
    inputs = np.empty((times.size, len(system.input_names)))
    for part in profiles.segments:
        rows = (times >= part.start) & (times <= part.end)
        inputs[rows] = profiles.table(times[rows], part)
    jacobians = system.evaluate("rhs_jacobian", states, inputs)
    fastest = float(np.abs(np.linalg.eigvals(jacobians)).max(initial=0.0))
    return (3600.0 * rtol) ** (1.0 / 6.0) / fastest if fastest > 0.0 else np.inf


def _asked(given: Validator, system: System, of: Any, times: Array) -> dict[str, Any]:
    """Return for each signal 'mean', 'rms' or weights."""
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
    """Return the functional, and its derivatives with respect to the signals at all times."""
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
            # a signal that varies by rounding only has no slope
            stays = number <= _STAYS * float(np.abs(own).max())
            by = 0.0 * share if stays else share * moved / number
        value, weights[name] = value + number, by
    return value, weights


def _named(
    system: System,
    directions: Any,
    profiles: TimeInputs,
    constants: Array,
    start: Array,
    held: Array,
) -> dict[str, float]:
    """Return derivatives by name: of parameters, the start, and inputs that do not vary."""
    parameters = np.array([*system.parameters.values()])
    by = directions.of_parameters("prepare_adjoint", parameters, constants, parameters.size)
    by[directions.bound(parameters)] = np.nan
    vary = {target for spline in profiles.segments[0].splines for target in spline.targets}
    inputs = {
        name: value
        for place, (name, value) in enumerate(zip(system.input_names, held, strict=True))
        if place not in vary
    }
    found = {**dict(zip(system.parameters, by, strict=True)), **inputs}
    found |= dict(zip(system.state_names, start, strict=True))
    return {name: float(value) for name, value in found.items()}
