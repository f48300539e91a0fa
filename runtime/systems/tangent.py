"""Motions near a state in independent coordinates.

A quaternion has four elements and three degrees of freedom: linear equations of all elements of a
state have an eigenvalue of its norm, which is no motion. Here the coordinates of motions near a
state are: for a hinge or a guide its coordinate; for a free body a displacement and a small
rotation in its own axes. With T the derivatives of the state with respect to them, ``x = T y`` in
``x' = A x`` leads to

    y' = T^+ (A T - T') y,

where T' is the rate of T along the motion. In these coordinates a steady motion along a circle has
constant coefficients.
"""

from dataclasses import dataclass

import numpy as np

from ..core.named_types import Array
from ..equations.layout import StateLayout


@dataclass(frozen=True)
class Tangent:
    """Linear equations of the motions near a state."""

    A: Array  # their matrix
    # matrix from their coordinates to changes of the state; None for the identity, (states, len(A))
    lift: Array | None

    @classmethod
    def at(cls, jacobian: Array, rate: Array, state: Array, layout: StateLayout) -> "Tangent":
        """Return the equations from the Jacobian of the rates of a state, (states, states).

        Rate and state are at the same point, with quaternions of length one.
        """
        if not layout.free:
            return cls(jacobian, None)
        lift = _of_all(layout.basis(state), len(state), 1.0)
        turning = _of_all(layout.turned(state, rate), len(state), 0.0)
        return cls(np.linalg.pinv(lift) @ (jacobian @ lift - turning), lift)


def _of_all(positions: Array, size: int, others: float) -> Array:
    """Return directions of all elements of a state, from those of its positions."""
    count, directions = positions.shape
    found = np.zeros((size, size - count + directions))
    found[:count, :directions] = positions
    found[count:, directions:] = others * np.eye(size - count)
    return found
