"""What loads do when the suspension swings: virtual work, without what the joints carry."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...assembly.load import Load
from ...assembly.poses import Poses
from ...core.vectors import cross
from ...suspension.structure import GROUND

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Swing:
    """A suspension in many positions whose arm turns at unit rate, the rack held.

    Attributes
    ----------
    poses : Poses
    twists : ndarray, shape (n, bodies, 6)
        Angular velocity and velocity of the centre of mass of each part, per rate of the arm.
    """

    poses: Poses
    twists: Array

    @classmethod
    def of(cls, poses: Poses) -> "Swing":
        """Return the motion at some positions."""
        model, states = poses.model, poses.states.copy()
        states[..., model.state_names.index(f"{model.names.arm}_rate")] = 1.0
        return cls(poses, model.evaluate("velocities", states, poses.inputs))

    def power(self, loads: Sequence[Load]) -> Array:
        """Return what loads do together, (n,) [N m/rad]."""
        total = np.zeros(len(self.twists))
        for load in (load for load in loads if load.part not in GROUND):
            total += (load.force * self.velocity(load.part, load.at)).sum(-1)
            if load.moment.any():
                total += (load.moment * self.turning(load.part)).sum(-1)
        return total

    def turning(self, part: str) -> Array:
        """Return the angular velocity of a part, (n, 3) [rad/rad]."""
        return self.twists[:, self.poses.model.equations.BODIES.index(part), :3]

    def velocity(self, part: str, at: Array) -> Array:
        """Return the velocity of a point of a part, (n, 3) [m/rad]."""
        own = self.twists[:, self.poses.model.equations.BODIES.index(part), 3:]
        moved: Array = own + cross(self.turning(part), at - self.poses.centers[part])
        return moved
