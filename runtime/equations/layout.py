"""The state of a mechanism: positions q, speeds v with q' = N(q) v, and internal states."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..core.named_types import Array

# Numbers of displacements, and of all positions, of a free body: a unit quaternion follows.
_AXES, _POSITIONS = 3, 7


@dataclass(frozen=True)
class StateLayout:
    """The order of the elements of a state.

    Most coordinates are positions whose rates are speeds. A body that moves freely in the world has
    seven positions, of which the last four are a quaternion, and six speeds in its own axes.
    Internal states of forces follow the speeds.
    """

    # their numbers; they come in this order
    positions: int
    speeds: int
    # for each position the index of the speed that changes it most directly: the rate of a
    # coordinate, the velocity of a free body along the same axis, its angular velocity about it for
    # a component of the quaternion. None for the scalar part, and where constraints determine the
    # rate.
    speed_of: tuple[int | None, ...]
    free: tuple[int, ...]  # index of the first of the seven positions of each free body

    @classmethod
    def of(cls, described: Mapping[str, Any]) -> "StateLayout":
        """Return the layout that a manifest describes."""
        return cls(
            described["positions"],
            described["speeds"],
            tuple(described["speed_of"]),
            tuple(described["free"]),
        )

    @property
    def rates_are_speeds(self) -> bool:
        """Whether each speed is the rate of the position with the same index."""
        return self.speed_of == tuple(range(self.speeds)) and not self.free

    @property
    def joints(self) -> tuple[int, ...]:
        """Indices of the positions that belong to no free body."""
        of_free = {at + i for at in self.free for i in range(_POSITIONS)}
        return tuple(i for i in range(self.positions) if i not in of_free)

    @property
    def directions(self) -> dict[int, int]:
        """Index of each position among the directions of `basis`; scalar parts have none."""
        scalar = {at + _AXES for at in self.free}
        found = (i for i in range(self.positions) if i not in scalar)
        return {position: place for place, position in enumerate(found)}

    def normalised(self, state: Array) -> Array:
        """Return a state or positions, shape (..., n), with quaternions of length one.

        A quaternion of zeros is unchanged: equations refuse it.
        """
        found = state.copy()
        for at in self.free:
            quaternion = found[..., at + _AXES : at + _POSITIONS]
            length = np.linalg.norm(quaternion, axis=-1, keepdims=True)
            quaternion /= np.where(length > 0.0, length, 1.0)
        return found

    def basis(self, state: Array) -> Array:
        """Return the directions in which positions can change, shape (positions, directions).

        Displacements and small turns of free bodies are in their own axes. The state, (states,),
        has quaternions of length one.
        """
        found = self._of_free(
            (at, rotation(e), turning(e)) for at in self.free for e in [self._quaternion(state, at)]
        )
        for position in self.joints:
            found[position, self.directions[position]] = 1.0
        return found

    def turned(self, state: Array, rate: Array) -> Array:
        """Return the time derivative of `basis`, given the rate of the state."""

        def blocks(at: int) -> tuple[int, Array, Array]:
            e, change = self._quaternion(state, at), self._quaternion(rate, at)
            omega = 4.0 * turning(e).T @ change
            return at, rotation(e) @ _cross(omega), turning(change)

        return self._of_free(map(blocks, self.free))

    @staticmethod
    def _quaternion(state: Array, at: int) -> Array:
        return state[at + _AXES : at + _POSITIONS]

    def _of_free(self, blocks: Iterable[tuple[int, Array, Array]]) -> Array:
        places = self.directions
        found = np.zeros((self.positions, len(places)))
        for at, moved, turned in blocks:
            first = places[at]
            found[at : at + _AXES, first : first + _AXES] = moved
            found[at + _AXES : at + _POSITIONS, first + _AXES : first + 2 * _AXES] = turned
        return found


def rotation(quaternion: Array) -> Array:
    """Return the matrix of a unit quaternion, scalar first."""
    e0, e1, e2, e3 = quaternion
    return np.array(
        [
            [1 - 2 * (e2 * e2 + e3 * e3), 2 * (e1 * e2 - e0 * e3), 2 * (e1 * e3 + e0 * e2)],
            [2 * (e1 * e2 + e0 * e3), 1 - 2 * (e1 * e1 + e3 * e3), 2 * (e2 * e3 - e0 * e1)],
            [2 * (e1 * e3 - e0 * e2), 2 * (e2 * e3 + e0 * e1), 1 - 2 * (e1 * e1 + e2 * e2)],
        ]
    )


def turning(quaternion: Array) -> Array:
    """Return the derivative of a quaternion with respect to small turns about body axes, 4 x 3."""
    e0, e1, e2, e3 = 0.5 * quaternion
    return np.array([[-e1, -e2, -e3], [e0, -e3, e2], [e3, e0, -e1], [-e2, e1, e0]])


def _cross(v: Array) -> Array:
    """Return the matrix of the vector product with v on the left."""
    x, y, z = v
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
