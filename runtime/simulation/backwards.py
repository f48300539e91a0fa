"""The gradient of what a motion is judged by: backwards through the steps of its integration.

The motion is integrated by Dormand and Prince's method as by `simulate`. Its steps are then gone
through from the last one to the first (the discrete adjoint of a Runge-Kutta method, reverse mode:
Hairer, Lubich and Wanner, Geometric Numerical Integration, VI.1.4), with their lengths as they
are. So the gradient is that of the numbers which the integration gives, by everything at once, and
takes a few times as long as the motion.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.arguments import Arguments, shown
from ..systems.derivatives import checked_directions
from ..systems.state import inputs_of
from ..systems.system import System
from .accuracy import outputs_of, span_of
from .courses import Signal
from .result import Simulation
from .signals import TimeInputs, time_inputs
from .simulate import simulate

Array = NDArray[np.float64]
Measure = Literal["mean", "rms"]

_OUTPUTS = 201
# Rows that are differentiated at a time: some MB.
_ROWS = 4096
# Steps whose Jacobian is looked at, and by how much they may be longer than it allows.
_LOOKS = 32
_MORE = 1.2

# Dormand and Prince's method: nodes, stages, and weights of a step and of its polynomial
# (../native/dormand_prince.h has the same, Hairer, Norsett and Wanner II.5 and II.6).
_NODES = np.array([0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0])
_STAGES = np.zeros((7, 7))
_STAGES[1, :1] = 0.2
_STAGES[2, :2] = 3.0 / 40.0, 9.0 / 40.0
_STAGES[3, :3] = 44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0
_STAGES[4, :4] = 19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0
_STAGES[5, :5] = 9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0
_STAGES[6, :6] = 35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0
_LAST = np.array(
    [
        -12715105075.0 / 11282082432.0, 0.0, 87487479700.0 / 32700410799.0,
        -10690763975.0 / 1880347072.0, 701980252875.0 / 199316789632.0,
        -1453857185.0 / 822651844.0, 69997945.0 / 29380423.0,
    ]
)  # fmt: skip


@dataclass(frozen=True)
class MotionGradient:
    """What a motion is judged by, and how that changes.

    Attributes
    ----------
    value : float
        The sum that was asked for.
    by : dict of str to float
        Its derivatives by parameters, by elements of the state at the start, and by inputs that
        do not vary, by name, SI units. Parameters move by themselves: the start stays. NaN by a
        parameter that cannot move alone, see `kintrafo.gradient`.
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
        If an argument cannot be used.
    SimulationError
        As of `simulate`.

    Notes
    -----
    The lengths of steps are taken as they are. They change with parameters, too, which changes
    the result by no more than the integration errs. No step is so long that what is at rest, and a
    parameter would move, is not followed as accurately: h abs(l) is at most (3600 rtol)^(1/6) for
    all eigenvalues l of the Jacobian, so that stiff members make it slow. Where a stop or a curve
    has a kink, the derivative is that of one side.

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
    with Arguments("motion_gradient") as given:
        directions = checked_directions(given, system)
        span = span_of(given, t_span)
        if span[1] < span[0]:
            given.refuse(f"t_span = {shown(t_span)}: the last time must be the later one.")
        if not given.refused:
            times = outputs_of(
                given, np.linspace(*span, _OUTPUTS) if t_eval is None else t_eval, span
            )
            asked = _asked(given, system, of, times)
            given.array("y0", y0, dimensions=[1], last=len(system.state_names), empty=True)
    held = inputs_of(y0, system.names_of_states)
    courses = time_inputs(system, inputs, span, held=held, max_step=max_step)
    longest = min(max_step, _longest(system, courses, rtol, np.array([span[0]]), np.atleast_2d(y0)))
    while True:
        motion = simulate(
            system, span, y0, inputs=inputs, method="DormandPrince", rtol=rtol, atol=atol,
            max_step=longest,
        )  # fmt: skip
        allowed = _longest(system, courses, rtol, *_looked_at(motion))
        if np.diff(motion.t).max() <= _MORE * allowed:
            break
        longest = min(longest, allowed)
    steps = _Steps(system, motion, courses)
    value, weights = _judged(system, asked, times, *steps.at(times))
    swept = _Sweep(system, directions, steps).backwards(times, weights)
    return MotionGradient(value, _named(system, directions, courses, *swept), motion)


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
    """Return how long steps may be for what moves beside the motion to be followed as well.

    Where nothing moves a step errs by nothing, however long it is; but a small disturbance, such as
    a parameter makes, would grow by all that the polynomial of the method is beside exp(h l), for
    an eigenvalue l of the Jacobian. That is (h l)^6 / 3600 at first.
    """
    inputs = np.empty((times.size, len(system.input_names)))
    for part in courses.segments:
        rows = (times >= part.start) & (times <= part.end)
        inputs[rows] = courses.table(times[rows], part)
    fastest = float(
        np.abs(np.linalg.eigvals(system.evaluate("rhs_jacobian", states, inputs))).max()
    )
    return (3600.0 * rtol) ** (1.0 / 6.0) / fastest if fastest > 0.0 else np.inf


def _asked(given: Arguments, system: System, of: Any, times: Array) -> dict[str, Any]:
    """Return what is asked of each signal: a word, or weights."""
    known = (*system.signal_names, *system.state_names)
    found: dict[str, Any] = {}
    for name, wanted in given.mapping("of", of, "signals and what is made of them").items():
        given.among("signal", name, known)
        if isinstance(wanted, str):
            given.among(f"of {name!r}", wanted, ("mean", "rms"))
            if times.size < 2:
                given.refuse(f"of {name!r}: {wanted!r} needs two times or more.")
            found[str(name)] = wanted
            continue
        weights = given.array(f"of {name!r}", wanted, dimensions=[1])
        if weights.shape != times.shape:
            given.refuse(f"of {name!r}: {weights.size} weights are given for {times.size} times.")
        found[str(name)] = weights
    if not (found or given.refused):
        given.refuse("of is empty: one signal or more is needed.")
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
            by = share * moved / number if number > 0.0 else 0.0 * share
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


class _Steps:
    """The steps of a motion, and what its stages were, evaluated again for all of them at once."""

    def __init__(self, system: System, motion: Simulation, courses: TimeInputs) -> None:
        self.begin, self.length = motion.t[:-1], np.diff(motion.t)
        self._courses = courses
        self._of_segment = [
            slice(*np.searchsorted(self.begin, (part.start, part.end))) for part in courses.segments
        ]
        self.states = np.repeat(motion.y.T[:-1, None], _NODES.size, axis=1)
        self.inputs = np.empty((*self.states.shape[:2], len(system.input_names)))
        for node, part in enumerate(_NODES):
            self.inputs[:, node] = self._inputs_at(self.begin + part * self.length)
        self.rates = np.empty_like(self.states)
        for stage, row in enumerate(_STAGES):
            moved = np.tensordot(self.rates[:, :stage], row[:stage], (1, 0))
            self.states[:, stage] += self.length[:, None] * moved
            at = self.states[:, stage], self.inputs[:, stage]
            self.rates[:, stage] = system.evaluate("rhs", *at)

    def _inputs_at(self, times: Array) -> Array:
        """Return the inputs at a time within each step."""
        rows = [
            self._courses.table(times[own], part)
            for own, part in zip(self._of_segment, self._courses.segments, strict=True)
        ]
        return np.concatenate(rows)

    def places(self, times: Array) -> tuple[NDArray[np.int_], Array]:
        """Return in which step each time is, and the weights of the stages there, of one second.

        A time between two steps is the end of the one before, as `simulate` has it where inputs
        jump.
        """
        step = np.maximum(np.searchsorted(self.begin, times) - 1, 0)
        part = (times - self.begin[step]) / self.length[step]
        return step, _weights_within(part)

    def at(self, times: Array) -> tuple[Array, Array]:
        """Return states and inputs at times, by the polynomials of the steps."""
        step, weights = self.places(times)
        moved = np.einsum("ts,tsn->tn", weights, self.rates[step])
        states = self.states[step, 0] + self.length[step, None] * moved
        inputs = np.empty((times.size, self.inputs.shape[-1]))
        for own, part in zip(self._of_segment, self._courses.segments, strict=True):
            rows = (step >= own.start) & (step < own.stop)
            inputs[rows] = self._courses.table(times[rows], part)
        return states, inputs


def _weights_within(part: Array) -> Array:
    """Return the weights of the stages in the interpolated state, shape (times, stages)."""
    rest = 1.0 - part
    bent, back, last = part * rest, part**2 * rest, part**2 * rest**2
    weights = np.outer(part - bent + 2.0 * back, _STAGES[-1]) + np.outer(last, _LAST)
    weights[:, 0] += bent - back
    weights[:, -1] -= back
    return weights


class _Sweep:
    """The way back through the steps.

    Of a step from y to z = y + h sum b_i k_i, with k_i = f(y + h sum a_ij k_j), what z counts for
    the result, l, becomes what y does: with J the Jacobian of f at a stage, from the last stage on,
    K_i = h b_i l + h sum a_ji M_j, M_i = J_i' K_i, and l + sum M_i. What signals within the step
    push at y and at the stages is added to these.
    """

    def __init__(self, system: System, directions: Any, steps: _Steps) -> None:
        self._system, self._directions, self._steps = system, directions, steps
        jacobians = system.evaluate("rhs_jacobian", steps.states, steps.inputs)
        self._back = jacobians.swapaxes(-1, -2)

    def backwards(self, times: Array, weights: Mapping[str, Array]) -> tuple[Array, Array, Array]:
        """Return the derivatives of a weighted sum by constants, the start, and inputs."""
        system, steps = self._system, self._steps
        states, inputs = steps.at(times)
        of_signals = np.zeros((times.size, len(system.signal_names)))
        pushed = np.zeros_like(states)
        for name, row in weights.items():
            if name in system.signal_names:
                of_signals[:, system.signal_names.index(name)] = row
            else:
                pushed[:, system.state_names.index(name)] = row
        constants, by_states, held = self._summed("signals", states, inputs, of_signals)
        at_begin, at_stages = self._within(times, pushed + by_states)
        stages, start = self._counted(at_begin, at_stages)
        more, _, more_held = self._summed("rhs", steps.states, steps.inputs, stages)
        return constants + more, start, held + more_held

    def _summed(
        self, function: str, states: Array, inputs: Array, weights: Array
    ) -> tuple[Array, Array, Array]:
        """Return derivatives of a weighted sum: by constants, by each state, and by inputs."""
        rows = [array.reshape(-1, array.shape[-1]) for array in (states, inputs, weights)]
        constants, found = np.zeros(self._system.constants.size), np.empty_like(rows[0])
        held = np.zeros(rows[1].shape[-1])
        for first in range(0, len(rows[0]), _ROWS):
            part = slice(first, first + _ROWS)
            of_rows, found[part], of_inputs = self._directions.adjoint(
                function, (self._system.constants, rows[0][part], rows[1][part]), rows[2][part]
            )
            constants += of_rows.sum(0)
            held += of_inputs.sum(0)
        return constants, found, held

    def _within(self, times: Array, pushed: Array) -> tuple[Array, Array]:
        """Return what states at times push at the begin of their steps, and at the stages."""
        step, weights = self._steps.places(times)
        count, size = self._steps.length.size, pushed.shape[-1]
        at_begin, at_stages = np.zeros((count, size)), np.zeros((count, _NODES.size, size))
        np.add.at(at_begin, step, pushed)
        lengths = self._steps.length[step, None, None]
        np.add.at(at_stages, step, lengths * weights[:, :, None] * pushed[:, None])
        return at_begin, at_stages

    def _counted(self, at_begin: Array, at_stages: Array) -> tuple[Array, Array]:
        """Return K of every stage, and what the state at the start counts."""
        steps, size = at_begin.shape
        # all steps at once, for each direction of l; the last column is what is pushed within
        columns = np.broadcast_to(np.eye(size, size + 1), (steps, size, size + 1))
        pushed = np.zeros((*at_stages.shape, size + 1))
        pushed[..., -1] = at_stages
        stages, before = self._through(columns, pushed)
        before[..., -1] += at_begin
        counts = np.zeros((steps + 1, size))
        for step in reversed(range(steps)):
            matrix = before[step]
            counts[step] = matrix[:, :-1] @ counts[step + 1] + matrix[:, -1]
        found = stages[..., :-1] @ counts[1:, None, :, None]
        return found[..., 0] + stages[..., -1], counts[0]

    def _through(self, counts: Array, at_stages: Array) -> tuple[Array, Array]:
        """Return K of each stage, and l before each step, for columns of l behind it."""
        length = self._steps.length[:, None, None]
        stages, back = np.empty(at_stages.shape), np.zeros(at_stages.shape)
        for i in reversed(range(_NODES.size)):
            later = np.tensordot(_STAGES[i + 1 :, i], back[:, i + 1 :], (0, 1))
            stages[:, i] = length * (_STAGES[-1, i] * counts + later) + at_stages[:, i]
            back[:, i] = self._back[:, i] @ stages[:, i]
        return stages, counts + back.sum(1)
