"""Virtual work of loads in the motions of a mechanism, without the forces of joints."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ....core.named_types import Array
from ....core.vectors import cross
from ...assembly.load import Load
from ...assembly.part_poses import PartPoses, touching, wheel_axes
from ...corner.structure import GROUND


@dataclass(frozen=True)
class VirtualWork:
    """Power of loads in n positions and k motions at unit rate, for an assembly with k wheels."""

    own: Array  # power of all loads but those on the wheels, (n, k)
    # by wheel and motion, power of unit loads on a wheel as in `Case.vector`, (n, k, k, 12)
    units: Array
    rise: Array  # by wheel and motion, power of a vertical unit force at its contact, (n, k, k)

    @classmethod
    def of(
        cls, poses: Mapping[str, PartPoses], acting: Mapping[str, Sequence[Load]]
    ) -> "VirtualWork":
        """Return the power in the motions of all wheels, with loads on each group of parts."""
        count = len(next(iter(poses.values())).states)
        size = sum(len(group.wheels) for group in poses.values())
        own, rise = np.zeros((count, size)), np.zeros((count, size, size))
        units = np.zeros((count, size, size, 12))
        first = 0
        for suffix, group in poses.items():
            twists = group.twists()
            motions = slice(first, first + len(group.wheels))
            own[:, motions] = _power(group, twists, acting[suffix])
            for row, (part, wheel) in enumerate(group.wheels.items(), first):
                contact = _velocity(group, twists, part, touching(wheel))
                center = _velocity(group, twists, part, wheel.center)
                turning = twists[part][..., :3]
                moved = np.stack([contact, turning, center, turning], axis=2)
                turned = np.einsum("nij,nmpj->nmpi", wheel_axes(wheel), moved)
                units[:, row, motions] = turned.reshape(*turned.shape[:2], 12)
                rise[:, row, motions] = contact[..., 2]
            first += len(group.wheels)
        return cls(own, units, rise)

    def missing(self, loads: Array | None = None) -> Array:
        """Return the missing vertical force of the road on each wheel, (n, k) [N].

        Loads on the wheels have the shape (n or 1, k, 12), as in `Case.vector`. The result is NaN
        at a dead point, where a vertical force does no work.
        """
        power = self.own
        if loads is not None:
            power = power + (loads[:, :, None] * self.units).sum(axis=(1, 3))
        with np.errstate(divide="ignore", invalid="ignore"):
            found: Array = -power / self.rise[:, 0] if power.shape[1] == 1 else self._solved(power)
        return np.where(np.isfinite(found), found, np.nan)

    def _solved(self, power: Array) -> Array:
        dead = ~(np.abs(np.linalg.det(self.rise)) > 0.0)
        rise = np.where(dead[:, None, None], np.eye(power.shape[1]), self.rise)
        found = np.asarray(-np.linalg.solve(rise.mT, power[..., None])[..., 0], dtype=float)
        return np.where(dead[:, None], np.nan, found)


def _velocity(group: PartPoses, twists: Mapping[str, Array], part: str, at: Array) -> Array:
    """Return the velocity of a point of a part in each motion, (n, motions, 3)."""
    arm = (at - group.centers[part])[:, None]
    return twists[part][..., 3:] + cross(twists[part][..., :3], arm)


def _power(group: PartPoses, twists: Mapping[str, Array], loads: Sequence[Load]) -> Array:
    """Return the power of loads in each motion, (n, motions)."""
    total = np.zeros((len(group.states), len(group.wheels)))
    for load in (load for load in loads if load.part not in GROUND):
        total += (load.force[..., None, :] * _velocity(group, twists, load.part, load.at)).sum(-1)
        if load.moment.any():
            total += (load.moment[..., None, :] * twists[load.part][..., :3]).sum(-1)
    return total
