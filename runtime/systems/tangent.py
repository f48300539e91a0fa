"""Motions near a state, counted in as many coordinates as it can move.

A quaternion has four elements and three degrees of freedom: linear equations of all elements of a
state have an eigenvalue that belongs to the norm and to no motion. Motions near a state are these
instead: of a hinge or a guide, its coordinate; of a free body, a displacement and a small turn in
its own axes. With T the directions in which elements of the state change then, ``x = T y`` in
``x' = A x`` leaves

    y' = T^+ (A T - T') y,

where T' is how these axes turn on the way. In them a steady motion along a circle has constant
coefficients.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..equations.layout import StateLayout

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Tangent:
    """Linear equations of the motions near a state.

    Attributes
    ----------
    A : ndarray
        Their matrix.
    lift : ndarray, shape (states, len(A)), or None
        From what it is about to changes of the elements of the state; None: they are the same.
    """

    A: Array
    lift: Array | None

    @classmethod
    def at(cls, jacobian: Array, rate: Array, state: Array, layout: StateLayout) -> "Tangent":
        """Return them from the derivative of the rates of a state.

        Parameters
        ----------
        jacobian : ndarray, shape (states, states)
        rate, state : ndarray, shape (states,)
            With quaternions of length one, as that of the derivative.
        layout : StateLayout
        """
        if not layout.free:
            return cls(jacobian, None)
        lift = _of_all(layout.basis(state), len(state), 1.0)
        turning = _of_all(layout.turned(state, rate), len(state), 0.0)
        return cls(np.linalg.pinv(lift) @ (jacobian @ lift - turning), lift)


def _of_all(positions: Array, size: int, others: float) -> Array:
    """Return directions of all elements of the state: positions have some, others their own."""
    count, directions = positions.shape
    found = np.zeros((size, size - count + directions))
    found[:count, :directions] = positions
    found[count:, directions:] = others * np.eye(size - count)
    return found
