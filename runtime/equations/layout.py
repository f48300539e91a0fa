"""The state of a mechanism: positions q, then speeds v, with q' = N(q) v, then internal states."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Of a free body: its displacement and its unit quaternion; velocity and angular velocity.
_POSITIONS, _QUATERNION, _SPEEDS, _AXES = 7, slice(3, 7), 6, 3


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
    free : tuple of tuple of int
        Of each free body, the places of its first position and of its first speed among the speeds.
    """

    positions: int
    speeds: int
    free: tuple[tuple[int, int], ...]

    @classmethod
    def of(cls, described: Mapping[str, Any]) -> "StateLayout":
        """Return the layout that a manifest describes."""
        free = tuple((body["position"], body["speed"]) for body in described["free"])
        return cls(described["positions"], described["speeds"], free)

    @property
    def own(self) -> tuple[tuple[int, int], ...]:
        """Places of the positions whose rate is a speed, and of that speed among the speeds."""
        positions = set(range(self.positions)) - {
            at + i for at, _ in self.free for i in range(_POSITIONS)
        }
        speeds = set(range(self.speeds)) - {at + i for _, at in self.free for i in range(_SPEEDS)}
        return tuple(zip(sorted(positions), sorted(speeds), strict=True))

    @property
    def partners(self) -> tuple[int, ...]:
        """Of each speed, the place of the position that it changes most directly.

        The coordinate whose rate it is; of u, v and w of a free body the displacements x, y and z,
        and of p, q and r the components e1, e2 and e3 of its quaternion.
        """
        found = {speed: position for position, speed in self.own}
        for position, speed in self.free:
            found |= {speed + i: position + i + (i >= _AXES) for i in range(_SPEEDS)}
        return tuple(found[speed] for speed in range(self.speeds))

    def normalised(self, positions: Array) -> Array:
        """Return positions with quaternions of length one.

        Parameters
        ----------
        positions : ndarray, shape (..., positions)
        """
        found = positions.copy()
        for at, _ in self.free:
            quaternion = found[..., at : at + _POSITIONS][..., _QUATERNION]
            quaternion /= np.linalg.norm(quaternion, axis=-1, keepdims=True)
        return found
