"""The adjoint of the steps of a motion, from the last to the first.

For a step from y to z = y + h sum b_i k_i, with k_i = f(y + h sum a_ij k_j), let l be the
derivative of the result with respect to z. With J the Jacobian of f at a stage, from the last stage
on, K_i = h b_i l + h sum a_ji M_j and M_i = J_i' K_i, the derivative with respect to y is l + sum
M_i. Contributions of signals within the step are added at y and at the stages.

Compiled equations are called stage after stage: M_i comes together with the derivatives with
respect to constants and inputs. Functions over NumPy arrays are called for all stages at once,
since each call takes long.
"""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ..core.named_types import Array
from ..systems.system import System
from . import _steps
from .retraced import NODES, STAGES, RetracedSteps, weights_within

Indices = NDArray[np.intp]

# Rows that are differentiated together: some MB.
_ROWS = 4096


class Sweep:
    """The adjoint of a motion: derivatives with respect to its constants, its start, and inputs.

    The system has derivatives with respect to parameters; `steps` are those of its motion.
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

        `places` and `point` are steps and parts of the evaluated times, with states and inputs
        there, see `RetracedSteps`; `weights` are those of signals and elements of the state at
        these times, by name.
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
        # for functions over NumPy arrays, or to raise the error of a refused state
        found = self._compiled(*pushed_within) or self._at_once(*pushed_within)
        return constants + found[0], found[1], held + found[2]

    def _compiled(self, at_begin: Array, at_stages: Array) -> tuple[Array, Array, Array] | None:
        """Return derivatives by constants, the start, and inputs; None if C cannot compute them."""
        steps, system = self._steps, self._system
        adjoint = system.equations.ADDRESSES.get("rhs_adjoint")
        if adjoint is None:
            return None
        sizes = system.constants.size, steps.states.shape[-1], steps.inputs.shape[-1]
        constants, start, held = map(np.zeros, sizes)
        done = _steps.go_back(
            adjoint, system.constants, STAGES, steps.length, steps.restarts.view(np.uint8),
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
        if not weights.shape[-1]:  # a model without signals has no such function
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
        """Return contributions of states at places to the begin of steps, and to the stages."""
        weights = weights_within(part)
        count, size = self._steps.length.size, pushed.shape[-1]
        at_begin, at_stages = np.zeros((count, size)), np.zeros((count, NODES.size, size))
        np.add.at(at_begin, step, pushed)
        lengths = self._steps.length[step, None, None]
        np.add.at(at_stages, step, lengths * weights[:, :, None] * pushed[:, None])
        # the last stage of a step is the first of the next, unless inputs jump between them
        ends = np.flatnonzero(~self._steps.restarts[1:])
        at_stages[ends + 1, 0] += at_stages[ends, -1]
        at_stages[ends, -1] = 0.0
        return at_begin, at_stages

    def _at_once(self, at_begin: Array, at_stages: Array) -> tuple[Array, Array, Array]:
        """Return the same as `_compiled`, for all steps together."""
        steps, size = at_begin.shape
        # for each direction of l; the last column has the contributions within steps
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
        """Return K of each stage, and l before each step, for columns of l after it."""
        states, length = self._steps.states, self._steps.length[:, None, None]
        jacobians = self._system.evaluate("rhs_jacobian", states, self._steps.inputs)
        stages, back = np.empty(at_stages.shape), np.zeros(at_stages.shape)
        for i in reversed(range(NODES.size)):
            later = np.tensordot(STAGES[i + 1 :, i], back[:, i + 1 :], (0, 1))
            stages[:, i] = length * (STAGES[-1, i] * counts + later) + at_stages[:, i]
            back[:, i] = jacobians[:, i].swapaxes(-1, -2) @ stages[:, i]
        return stages, counts + back.sum(1)
