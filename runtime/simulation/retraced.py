"""The steps of a motion by Dormand and Prince's method, evaluated again.

The integration does not keep the states at the stages; they follow from its steps.
"""

import numpy as np
from numpy.typing import NDArray

from ..core.named_types import Array
from ..systems.system import System
from . import _steps
from .result import Simulation
from .signals import TimeInputs

Indices = NDArray[np.intp]

# Dormand and Prince's method: nodes, stages, and weights of a step and of its polynomial
# (../native/dormand_prince.h has the same, Hairer, Norsett and Wanner II.5 and II.6).
NODES = np.array([0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0])
STAGES = np.zeros((7, 7))
STAGES[1, :1] = 0.2
STAGES[2, :2] = 3.0 / 40.0, 9.0 / 40.0
STAGES[3, :3] = 44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0
STAGES[4, :4] = 19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0
STAGES[5, :5] = 9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0
STAGES[6, :6] = 35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0
_LAST = np.array(
    [
        -12715105075.0 / 11282082432.0, 0.0, 87487479700.0 / 32700410799.0,
        -10690763975.0 / 1880347072.0, 701980252875.0 / 199316789632.0,
        -1453857185.0 / 822651844.0, 69997945.0 / 29380423.0,
    ]
)  # fmt: skip


class RetracedSteps:
    """The steps of a motion with their stages.

    `begin` and `length` have the shape (steps,) [s], states, inputs and rates (steps, stages, ...).
    `restarts` is whether inputs may jump before a step; the other steps begin with the last stage
    of the one before.
    """

    def __init__(self, system: System, motion: Simulation, profiles: TimeInputs) -> None:
        self.begin, self.length = motion.t[:-1], np.diff(motion.t)
        self._profiles = profiles
        self._of_segment = [
            slice(*np.searchsorted(self.begin, (part.start, part.end)))
            for part in profiles.segments
        ]
        self.restarts = np.zeros(self.begin.size, dtype=bool)
        self.restarts[[own.start for own in self._of_segment if own.start < own.stop]] = True
        self.inputs = self._inputs_at(self.begin[:, None] + NODES * self.length[:, None])
        self.states = np.repeat(motion.y.T[:-1, None], NODES.size, axis=1)
        self.rates = np.empty_like(self.states)
        # for functions over NumPy arrays, or to raise the error of a refused state
        if not self._compiled(system):
            self._at_once(system)

    def _inputs_at(self, times: Array) -> Array:
        """Return the inputs at times within each step, shape (steps, times, inputs)."""
        rows = [
            self._profiles.table(times[own].ravel(), part)
            for own, part in zip(self._of_segment, self._profiles.segments, strict=True)
        ]
        return np.concatenate(rows).reshape(*times.shape, self._profiles.constant.size)

    def _compiled(self, system: System) -> bool:
        """Fill states and rates of the stages step by step; return whether that succeeded."""
        rhs = system.equations.ADDRESSES.get("rhs")
        return rhs is not None and _steps.go_through(
            rhs, system.constants, STAGES, self.length, self.restarts.view(np.uint8), self.inputs,
            self.states, self.rates,
        )  # fmt: skip

    def _at_once(self, system: System) -> None:
        """Fill states and rates of the stages, of all steps together."""
        for stage, row in enumerate(STAGES):
            moved = np.tensordot(self.rates[:, :stage], row[:stage], (1, 0))
            self.states[:, stage] = self.states[:, 0] + self.length[:, None] * moved
            at = self.states[:, stage], self.inputs[:, stage]
            self.rates[:, stage] = system.evaluate("rhs", *at)

    def time(self, step: Indices, part: Array) -> Array:
        """Return times by their places: a step, and the part of it from 0 to 1."""
        return self.begin[step] + part * self.length[step]

    def places(self, times: Array) -> tuple[Indices, Array]:
        """Return for each time its step, and the part of it.

        A time between two steps is the end of the first one, as in `simulate` where inputs jump.
        """
        step = np.maximum(np.searchsorted(self.begin, times) - 1, 0)
        return step, (times - self.begin[step]) / self.length[step]

    def point(self, step: Indices, part: Array) -> tuple[Array, Array]:
        """Return states and inputs at places, by the polynomials of the steps."""
        moved = np.einsum("ts,tsn->tn", weights_within(part), self.rates[step])
        states = self.states[step, 0] + self.length[step, None] * moved
        times = self.time(step, part)
        inputs = np.empty((times.size, self.inputs.shape[-1]))
        for own, profile in zip(self._of_segment, self._profiles.segments, strict=True):
            rows = (step >= own.start) & (step < own.stop)
            inputs[rows] = self._profiles.table(times[rows], profile)
        return states, inputs

    def within(self, parts: Array) -> tuple[Array, Array]:
        """Return states and inputs of all steps at some parts, shape (steps, parts, size)."""
        count = self.begin.size
        step, part = np.repeat(np.arange(count), parts.size), np.tile(parts, count)
        states, inputs = self.point(step, part)
        return (
            states.reshape(count, parts.size, states.shape[-1]),
            inputs.reshape(count, parts.size, inputs.shape[-1]),
        )


def weights_within(part: Array) -> Array:
    """Return the weights of the stages in the interpolated state, shape (times, stages)."""
    rest = 1.0 - part
    bent, back, last = part * rest, part**2 * rest, part**2 * rest**2
    weights = np.outer(part - bent + 2.0 * back, STAGES[-1]) + np.outer(last, _LAST)
    weights[:, 0] += bent - back
    weights[:, -1] -= back
    return weights
