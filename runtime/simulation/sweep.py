"""The way back through the steps of a motion.

Of a step from y to z = y + h sum b_i k_i, with k_i = f(y + h sum a_ij k_j), what z counts for the
result, l, becomes what y does: with J the Jacobian of f at a stage, from the last stage on,
K_i = h b_i l + h sum a_ji M_j, M_i = J_i' K_i, and l + sum M_i. What signals within the step push
at y and at the stages is added to these.

Compiled equations are called stage after stage: M_i comes with what the constants and inputs count.
Functions over NumPy arrays are called for all stages at once, since each call takes long.
"""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ..systems.system import System
from . import _steps
from .retraced import NODES, STAGES, RetracedSteps, weights_within

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

# Rows that are differentiated at a time: some MB.
_ROWS = 4096


class Sweep:
    """What numbers along a motion change by: its constants, its start, and inputs.

    Parameters
    ----------
    system : System
        With derivatives by parameters.
    steps : RetracedSteps
        Of its motion.
    """

    def __init__(self, system: System, steps: RetracedSteps) -> None:
        self._system, self._steps = system, steps

    def backwards(
        self,
        places: tuple[Indices, Array],
        point: tuple[Array, Array],
        weights: Mapping[str, Array],
    ) -> tuple[Array, Array, Array]:
        """Return the derivatives of a weighted sum by constants, the start, and inputs.

        Parameters
        ----------
        places, point : tuple of ndarray
            When the motion is looked at, and states and inputs there, see `RetracedSteps`.
        weights : mapping
            Of signals and elements of the state at these times, by name.
        """
        system, (states, inputs) = self._system, point
        of_signals = np.zeros((len(states), len(system.signal_names)))
        pushed = np.zeros_like(states)
        for name, row in weights.items():
            if name in system.signal_names:
                of_signals[:, system.signal_names.index(name)] = row
            else:
                pushed[:, system.state_names.index(name)] = row
        constants, by_states, held = self._summed("signals", states, inputs, of_signals)
        pushed_within = self._within(*places, pushed + by_states)
        # functions over NumPy arrays; and refusals, which are raised here
        found = self._compiled(*pushed_within) or self._at_once(*pushed_within)
        return constants + found[0], found[1], held + found[2]

    def _compiled(self, at_begin: Array, at_stages: Array) -> tuple[Array, Array, Array] | None:
        """Return derivatives by constants, the start, and inputs; nothing if it cannot be done."""
        steps, system = self._steps, self._system
        adjoint = system.equations.ADDRESSES.get("rhs_adjoint")
        if adjoint is None:
            return None
        sizes = system.constants.size, steps.states.shape[-1], steps.inputs.shape[-1]
        constants, start, held = map(np.zeros, sizes)
        done = _steps.go_back(
            adjoint, system.constants, STAGES, steps.length, steps.anew.view(np.uint8),
            steps.inputs, steps.states, at_begin, at_stages, constants, start, held,
        )  # fmt: skip
        return (constants, start, held) if done else None

    def _summed(
        self, function: str, states: Array, inputs: Array, weights: Array
    ) -> tuple[Array, Array, Array]:
        """Return derivatives of a weighted sum: by constants, by each state, and by inputs."""
        # states and inputs may have no elements: their rows cannot be counted by their size
        count = math.prod(states.shape[:-1])
        rows = [array.reshape(count, array.shape[-1]) for array in (states, inputs, weights)]
        constants, found = np.zeros(self._system.constants.size), np.zeros_like(rows[0])
        held = np.zeros(rows[1].shape[-1])
        if not weights.shape[-1]:  # there is no such function
            return constants, found, held
        for first in range(0, len(rows[0]), _ROWS):
            part = slice(first, first + _ROWS)
            of_rows, found[part], of_inputs = self._system.equations.DIRECTIONS.adjoint(
                function, (self._system.constants, rows[0][part], rows[1][part]), rows[2][part]
            )
            constants += of_rows.sum(0)
            held += of_inputs.sum(0)
        return constants, found, held

    def _within(self, step: Indices, part: Array, pushed: Array) -> tuple[Array, Array]:
        """Return what states at places push at the begin of their steps, and at the stages."""
        weights = weights_within(part)
        count, size = self._steps.length.size, pushed.shape[-1]
        at_begin, at_stages = np.zeros((count, size)), np.zeros((count, NODES.size, size))
        np.add.at(at_begin, step, pushed)
        lengths = self._steps.length[step, None, None]
        np.add.at(at_stages, step, lengths * weights[:, :, None] * pushed[:, None])
        # the last stage of a step is the first one of the next, where that does not begin anew
        ends = np.flatnonzero(~self._steps.anew[1:])
        at_stages[ends + 1, 0] += at_stages[ends, -1]
        at_stages[ends, -1] = 0.0
        return at_begin, at_stages

    def _at_once(self, at_begin: Array, at_stages: Array) -> tuple[Array, Array, Array]:
        """Return the same, all steps at once."""
        steps, size = at_begin.shape
        # for each direction of l; the last column is what is pushed within
        columns = np.broadcast_to(np.eye(size, size + 1), (steps, size, size + 1))
        pushed = np.zeros((*at_stages.shape, size + 1))
        pushed[..., -1] = at_stages
        by_end, before = self._through(columns, pushed)
        before[..., -1] += at_begin
        counts = np.zeros((steps + 1, size))
        for step in reversed(range(steps)):
            matrix = before[step]
            counts[step] = matrix[:, :-1] @ counts[step + 1] + matrix[:, -1]
        stages = (by_end[..., :-1] @ counts[1:, None, :, None])[..., 0] + by_end[..., -1]
        constants, _, held = self._summed("rhs", self._steps.states, self._steps.inputs, stages)
        return constants, counts[0], held

    def _through(self, counts: Array, at_stages: Array) -> tuple[Array, Array]:
        """Return K of each stage, and l before each step, for columns of l behind it."""
        states, length = self._steps.states, self._steps.length[:, None, None]
        jacobians = self._system.evaluate("rhs_jacobian", states, self._steps.inputs)
        stages, back = np.empty(at_stages.shape), np.zeros(at_stages.shape)
        for i in reversed(range(NODES.size)):
            later = np.tensordot(STAGES[i + 1 :, i], back[:, i + 1 :], (0, 1))
            stages[:, i] = length * (STAGES[-1, i] * counts + later) + at_stages[:, i]
            back[:, i] = jacobians[:, i].swapaxes(-1, -2) @ stages[:, i]
        return stages, counts + back.sum(1)
