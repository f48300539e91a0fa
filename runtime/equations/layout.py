"""The state of a mechanism: positions q, then speeds v, with q' = N(q) v, then internal states."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Of a free body: its displacement, and then its unit quaternion.
_AXES, _POSITIONS = 3, 7


@dataclass(frozen=True)
class StateLayout:
    """How a state is made up.

    Most coordinates are positions whose rates are speeds. A body that moves freely in the world has
    seven positions, of which the last four are a quaternion, and six speeds in its own axes. Behind
    the speeds come internal states of forces.

    Attributes
    ----------
    positions, speeds : int
        How many there are; they come in this order.
    speed_of : tuple of int or None
        Of each position, the place among the speeds of the one that changes it most directly: the
        rate of a coordinate, the velocity along the same axis of a free body, its angular velocity
        about it for a component of the quaternion. None where there is none: of the scalar part,
        and where constraints give the speed.
    free : tuple of int
        Where the seven positions of each free body begin.
    """

    positions: int
    speeds: int
    speed_of: tuple[int | None, ...]
    free: tuple[int, ...]

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
        """Whether each speed is the rate of the position in its place."""
        return self.speed_of == tuple(range(self.speeds)) and not self.free

    @property
    def joints(self) -> tuple[int, ...]:
        """Places of the positions that belong to no free body."""
        of_free = {at + i for at in self.free for i in range(_POSITIONS)}
        return tuple(i for i in range(self.positions) if i not in of_free)

    @property
    def directions(self) -> dict[int, int]:
        """Of each position, its place among the directions of `basis`; the scalar part has none."""
        scalar = {at + _AXES for at in self.free}
        found = (i for i in range(self.positions) if i not in scalar)
        return {position: place for place, position in enumerate(found)}

    def normalised(self, state: Array) -> Array:
        """Return a state, or positions, with quaternions of length one.

        Zeros stay as they are: equations refuse them.

        Parameters
        ----------
        state : ndarray, shape (..., positions or more)
        """
        found = state.copy()
        for at in self.free:
            quaternion = found[..., at + _AXES : at + _POSITIONS]
            length = np.linalg.norm(quaternion, axis=-1, keepdims=True)
            quaternion /= np.where(length > 0.0, length, 1.0)
        return found

    def basis(self, state: Array) -> Array:
        """Return in which directions positions can change.

        Displacements and small turns of free bodies are in their own axes.

        Parameters
        ----------
        state : ndarray, shape (states,)
            With quaternions of length one.

        Returns
        -------
        ndarray, shape (positions, directions)
        """
        found = self._of_free(
            (at, rotation(e), turning(e)) for at in self.free for e in [self._quaternion(state, at)]
        )
        for position in self.joints:
            found[position, self.directions[position]] = 1.0
        return found

    def turned(self, state: Array, rate: Array) -> Array:
        """Return how fast `basis` changes, given the rate of the state."""

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
    """Return how a quaternion changes with small turns about the axes that it turns, 4 x 3."""
    e0, e1, e2, e3 = 0.5 * quaternion
    return np.array([[-e1, -e2, -e3], [e0, -e3, e2], [e3, e0, -e1], [-e2, e1, e0]])


def _cross(v: Array) -> Array:
    """Return the matrix of the vector product with v from the left."""
    x, y, z = v
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
