"""Derivatives of a motion with respect to parameters, its start and inputs: forward in time.

Dormand and Prince's method integrates the motion as in `simulate`, with steps that are short enough
for derivatives (see `backwards`). A small change is integrated with it through the same steps and
stages: the tangent of the method, each direction in a lane of its own. So it is exact for the
numbers which the integration returns, and is the transpose of `motion_gradient`.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..core.memory import refuse_beyond
from ..core.named_types import Array, ArrayLike
from ..core.validator import Validator
from ..systems.derivatives import checked_directions, direction_of, kept_together
from ..systems.state import inputs_of
from ..systems.system import System
from .accuracy import accuracy_of
from .backwards import MOST_STEPS, followed, forward_span, output_times_of
from .input_profiles import Signal
from .lanes.directions import Along
from .lanes.directions import followed as in_lanes
from .result import Simulation
from .retraced import NODES, STAGES, RetracedSteps, weights_within
from .signals import time_inputs


@dataclass(frozen=True)
class MotionSensitivity:
    """A motion, and its derivatives by variable or direction.

    Attributes
    ----------
    t : ndarray, shape (n,)
        Times [s].
    values : dict of str to ndarray, shape (n,)
        Elements of the state and signals at these times, by name, SI units.
    by : dict of str to dict of str to ndarray, shape (n,)
        Their derivatives: by direction, then by name, in SI units over those of the direction.
    motion : Simulation
        The motion, at every step of the integration.
    """

    t: Array
    values: dict[str, Array]
    by: dict[str, dict[str, Array]]
    motion: Simulation


def motion_sensitivity(
    system: System,
    t_span: tuple[float, float],
    y0: ArrayLike,
    by: Sequence[str] | Mapping[str, Mapping[str, float]],
    *,
    signals: Sequence[str] | None = None,
    inputs: Mapping[str, Signal] | None = None,
    t_eval: ArrayLike | None = None,
    rtol: float = 1e-6,
    atol: ArrayLike = 1e-9,
    max_step: float = np.inf,
) -> MotionSensitivity:
    """Return the exact derivatives of a motion with respect to parameters, start and inputs.

    Parameters
    ----------
    system : System
        Equations that were compiled with ``parameter_derivatives=True``.
    t_span, y0, inputs, rtol, atol, max_step
        Time span [s], initial state, inputs and tolerances, as for `simulate` with the method
        'DormandPrince'; the motion runs forward in time.
    by : sequence of str, or mapping
        Variables: names of parameters, of elements of the initial state, and of inputs that are
        constant in time. Or a mapping of directions: for each, under any name, the changes of
        variables by name, SI units. A change of a parameter does not change the initial state.
    signals : sequence of str, optional
        Names of the signals whose derivatives are needed; by default all.
    t_eval : array_like, optional
        Times of the outputs [s], by default 201 from the first to the last.

    Returns
    -------
    MotionSensitivity

    Raises
    ------
    InputError
        If an argument cannot be used, a direction breaks an assumption of the equations, or the
        rates jump during the motion.
    SimulationError
        If the integration does not reach the end; the message has the time and the reason.

    Notes
    -----
    Steps are short enough for the derivatives to be as accurate as the motion, and become shorter
    towards kinks, as for `motion_gradient`. This function is for few directions and many results,
    `motion_gradient` for one number and many variables.

    Directions are integrated in the lanes of vectors. The equations are compiled for lanes at first
    use, which takes some seconds, and are cached. The bits of a direction do not depend on the
    others. Without a compiler NumPy does the same, slower and with other rounding errors.

    Examples
    --------
    >>> import kintrafo
    >>> from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
    >>> four_bar = kintrafo.System(kintrafo.compile(FOUR_BAR, parameter_derivatives=True))
    >>> start = four_bar.state(crank_angle=0.3)
    >>> found = kintrafo.motion_sensitivity(four_bar, (0.0, 0.5), start, ["crank_mass"])
    >>> round(float(found.by["crank_mass"]["crank_angle"][-1]), 4)  # rad/kg, at the end
    -0.5398
    """
    with Validator("motion_sensitivity") as given:
        checked_directions(given, system)
        span = forward_span(given, t_span)
        if not given.failed:
            times = output_times_of(given, t_eval, span)
            along = _along(given, system, by)
            chosen = system.signal_names
            if signals is not None:
                chosen = given.names("signals", signals, system.signal_names)
            given.array("y0", y0, dimensions=[1], last=len(system.state_names), empty=True)
            accuracy = accuracy_of(
                given, len(system.state_names), rtol=rtol, atol=atol, max_step=max_step,
                first_step=None, max_steps=MOST_STEPS,
            )  # fmt: skip
            # twice: as they are computed, and in rows for each signal
            needed = 16.0 * times.size * len(along) * (len(chosen) + len(system.state_names))
            what = f"derivatives of {times.size:,} outputs along {len(along)} directions"
            refuse_beyond(given, needed, what, "Ask for fewer outputs, by t_eval, or signals.")
    tangents = _Tangents(system, along)
    held = inputs_of(y0, system.names_of_states)
    profiles = time_inputs(system, inputs, span, held=held, max_step=max_step)
    vary = {t for part in profiles.segments for spline in part.splines for t in spline.targets}
    _refuse_varying(system, along, {system.input_names[place] for place in vary})
    motion, steps = followed(system, profiles, np.array(y0, dtype=float), accuracy)
    states, at_inputs = steps.point(*steps.places(times))
    values = dict(zip(system.state_names, states.T, strict=True))
    shown = system.signals(states, at_inputs)
    values |= {name: shown[name] for name in chosen}
    names = (*system.signal_names, *system.state_names)
    moved = tangents.at(steps, times, [names.index(name) for name in values])
    by_direction = {
        label: dict(zip(values, np.ascontiguousarray(rows.T), strict=True))
        for label, rows in zip(along, moved, strict=True)
    }
    return MotionSensitivity(times, values, by_direction, motion)


def _along(given: Validator, system: System, by: Any) -> dict[str, Mapping[str, float]]:
    """Return the directions by name."""
    known = (*system.parameters, *system.state_names, *system.input_names)
    found: dict[str, Mapping[str, float]] = {}
    if not isinstance(by, Mapping):
        found = {name: {name: 1.0} for name in given.names("by", by, known)}
        by = {}
    for label, direction in given.mapping("by", by, "names and directions").items():
        given.text("label in by", label)
        named = given.mapping(f"by {label!r}", direction, "names and numbers")
        found[str(label)] = {
            given.among("name", name, known): given.number(f"by {label!r} {name}", value)
            for name, value in named.items()
        }
    if not (found or given.failed):
        given.fail("by is empty: one name or direction is needed.")
    return found


def _refuse_varying(
    system: System, along: Mapping[str, Mapping[str, float]], vary: set[str]
) -> None:
    """Refuse directions of inputs that vary with time."""
    with Validator("motion_sensitivity") as given:
        for name in sorted({n for direction in along.values() for n in direction} & vary):
            given.fail(
                f"by {name!r}: this input of {system.equations.NAME} varies with time and has no "
                "single value to change. Name inputs that do not vary."
            )


class _Tangents:
    """Directions in which a system changes, by name, integrated along the steps of a motion."""

    def __init__(self, system: System, along: Mapping[str, Mapping[str, float]]) -> None:
        self._system, self._directions = system, system.equations.DIRECTIONS
        parts = [direction_of(system, direction) for direction in along.values()]
        of_parameters, start, inputs = (np.array(p) for p in zip(*parts, strict=True))
        parameters = kept_together(system, self._directions, of_parameters)
        constants = self._directions.of_parameters(
            "prepare_tangent", parameters, of_parameters, system.constants.size
        )
        self._along = Along(constants, start, inputs)

    def at(self, steps: RetracedSteps, times: Array, items: Sequence[int]) -> Array:
        """Return derivatives of some items, shape (directions, times, items).

        Items are indices of signals, followed by those of elements of the state.
        """
        found = in_lanes(self._system, steps, times, self._along, items)
        # without lanes, or to raise the error of a refused state
        return self._one_by_one(steps, times)[..., items] if found is None else found

    def _one_by_one(self, steps: RetracedSteps, times: Array) -> Array:
        """Return derivatives of all signals and the state, shape (directions, times, items)."""
        stages, after = self._through(steps)
        count, size = steps.length.size, self._along.start.shape[1]
        before = np.empty((count, size, len(self._along.start)))
        moved = self._along.start.T
        for which in range(count):
            before[which] = moved
            moved = after[which, :, :size] @ moved + after[which, :, size:]
        rates = stages[..., :size] @ before[:, None] + stages[..., size:]
        step, part = steps.places(times)
        within = np.einsum("ts,tsnd->tnd", weights_within(part), rates[step])
        found = np.moveaxis(before[step] + steps.length[step, None, None] * within, -1, 0)
        return np.concatenate([self._of_signals(*steps.point(step, part), found), found], axis=-1)

    def _each(self) -> Iterator[tuple[Array, Array]]:
        return zip(self._along.constants, self._along.inputs, strict=True)

    def _through(self, steps: RetracedSteps) -> tuple[Array, Array]:
        """Return derivatives of rates at the stages, and of states after steps.

        The first columns are with respect to the elements of the state before a step; one more for
        each direction has the effect of parameters and inputs within the step.
        """
        system = self._system
        jacobians = system.evaluate("rhs_jacobian", steps.states, steps.inputs)
        still = np.zeros_like(steps.states)
        values = (system.constants, steps.states, steps.inputs)
        own = [
            self._directions.tangent("rhs", values, (constants, still, inputs))
            for constants, inputs in self._each()
        ]
        size = still.shape[-1]
        columns = np.eye(size, size + len(own))
        pushed = np.zeros((*still.shape, size + len(own)))
        pushed[..., size:] = np.stack(own, axis=-1)
        length, rates = steps.length[:, None, None], np.zeros_like(pushed)
        for stage in range(NODES.size):
            earlier = np.tensordot(rates[:, :stage], STAGES[stage, :stage], (1, 0))
            moved = columns + length * earlier
            rates[:, stage] = jacobians[:, stage] @ moved + pushed[:, stage]
        return rates, columns + length * np.tensordot(rates, STAGES[-1], (1, 0))

    def _of_signals(self, states: Array, inputs: Array, moved: Array) -> Array:
        """Return the derivatives of all signals at some times, (directions, times, signals)."""
        if not self._system.signal_names:
            return np.zeros((*moved.shape[:2], 0))
        values = (self._system.constants, states, inputs)
        pairs = zip(self._each(), moved, strict=True)
        return np.array(
            [
                self._directions.tangent("signals", values, (constants, own, by_input))
                for (constants, by_input), own in pairs
            ]
        )
