"""Motions near a state, counted in as many coordinates as there are speeds.

A quaternion has four elements and three degrees of freedom: linear equations of all elements of a
state have an eigenvalue that belongs to the norm and to no motion. Motions near a state are these
instead: of coordinates whose rate is a speed, the coordinate; of a free body, a displacement s and
a small turn t in its own axes. With V its velocity and W its angular velocity there, by ``r' = R
V`` and ``R' = R [W]x``,

    s' = -W x s + t x V + v,    t' = -W x t + w,

where v and w are what the speeds change by. In these axes a steady motion along a circle has
constant coefficients.
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
    def at(cls, jacobian: Array, state: Array, layout: StateLayout) -> "Tangent":
        """Return them from the derivative of the rates of a state.

        Parameters
        ----------
        jacobian : ndarray, shape (states, states)
        state : ndarray, shape (states,)
        layout : StateLayout
        """
        positions, speeds = layout.positions, layout.speeds
        if not layout.free:
            return cls(jacobian, None)
        count = len(jacobian) - positions + speeds
        lift = np.zeros((len(jacobian), count))
        lift[:positions, :speeds] = jacobian[:positions, positions : positions + speeds]
        lift[positions:, speeds:] = np.eye(len(jacobian) - positions)
        found = np.zeros((count, count))
        found[:speeds, :speeds] = _turning(state[positions:], layout)
        found[:speeds, speeds : 2 * speeds] = np.eye(speeds)
        found[speeds:] = jacobian[positions:] @ lift
        return cls(found, lift)


def _turning(speeds: Array, layout: StateLayout) -> Array:
    """Return what the motion of free bodies does to displacements and turns in their axes."""
    found = np.zeros((layout.speeds, layout.speeds))
    for _, at in layout.free:
        moving, turning = slice(at, at + 3), slice(at + 3, at + 6)
        found[moving, moving] = found[turning, turning] = -_cross(speeds[turning])
        found[moving, turning] = -_cross(speeds[moving])
    return found


def _cross(v: Array) -> Array:
    """Return the matrix of the vector product with v from the left."""
    x, y, z = v
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
