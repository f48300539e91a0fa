"""Equilibrium of a rigid axle: what its rods, its bearings and the road carry.

Rods have no mass and joints at both ends, so that each carries a force along it. The axle with its
wheels has six equations: four for the rods, and two for vertical forces at the contacts, which are
zero where the loads are in equilibrium. A wheel has its own six, for what its bearing carries.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...assembly.beam import SIDES
from ...assembly.load import Load
from ...assembly.parts import Parts
from ...assembly.poses import CENTER, CONTACT, wrench_about
from ...suspension.corner import UP
from ...suspension.reach import PositionError
from ...suspension.rigid.structure import BEAM, CHASSIS
from ..loads.balance import DEAD_POINT, balanced

Array = NDArray[np.float64]

_STILL = np.zeros(3)


class Balance:
    """Equilibrium of the parts of a rigid axle in many positions.

    Parameters
    ----------
    parts : Parts
    loads : sequence of Load
        What acts on its parts.

    Attributes
    ----------
    pulls : dict of str to ndarray
        Of each rod the force along it, positive when it pulls, (n,) [N].
    missing : dict of str to ndarray
        By its side the vertical force of the road that each wheel needs besides, (n,) [N].
    sound : ndarray of bool, shape (n,)
        False at a dead point, where all of them are no numbers.
    """

    def __init__(self, parts: Parts, loads: Sequence[Load]) -> None:
        self.parts, self.loads = parts, loads
        about, rods = parts.centers[BEAM], tuple(parts.axle.rods)
        columns = [
            *(wrench_about(about, parts.points[f"{name}_axle"], parts.rod(name)) for name in rods),
            *(wrench_about(about, parts.contact(side), UP) for side in SIDES),
        ]
        applied = _sum([load for load in loads if load.part != CHASSIS], about)
        found, self.sound = balanced(np.stack(columns, axis=-1), applied)
        self.pulls = dict(zip(rods, found.T[: len(rods)], strict=True))
        self.missing = dict(zip(SIDES, found.T[len(rods) :], strict=True))

    def refuse_dead_points(self) -> None:
        """Refuse positions in which what is carried has no bound.

        Raises
        ------
        PositionError
        """
        if not self.sound.all():
            row = int(np.flatnonzero(~self.sound)[0])
            heights = [1e3 * float(self.parts.points[f"{CENTER}_{s}"][row, 2]) for s in SIDES]
            where = " and ".join(f"{height:.6g} mm" for height in heights)
            raise PositionError(f"at wheel heights of {where}: {DEAD_POINT}")

    def upward(self, side: str, force: Array) -> Load:
        """Return a vertical force of the road on a wheel."""
        at, vertical = self.parts.contact(side), force[:, None] * UP
        return Load(f"wheel_{side}", f"{CONTACT}_{side}", f"road_{side}", vertical, _STILL, at)

    def carried(self) -> list[Load]:
        """Return what rods and bearings carry, on both of the parts of each."""
        loads = []
        for name, pull in self.pulls.items():
            along = pull[:, None] * self.parts.rod(name)
            loads += [
                *self._on_both(name, CHASSIS, f"{name}_{CHASSIS}", along, _STILL),
                *self._on_both(name, BEAM, f"{name}_axle", -along, _STILL),
            ]
        for side in SIDES:
            wheel, point = f"wheel_{side}", f"{CENTER}_{side}"
            own = [load for load in self.loads if load.part == wheel]
            own.append(self.upward(side, self.missing[side]))
            wrench = -_sum(own, self.parts.points[point])
            loads += self._on_both(wheel, BEAM, point, wrench[:, :3], wrench[:, 3:])
        return loads

    def _on_both(
        self, part: str, other: str, point: str, force: Array, moment: Array
    ) -> list[Load]:
        """Return a load of one part by another, and its opposite."""
        at = self.parts.points[point]
        return [
            Load(part, point, other, force, moment, at),
            Load(other, point, part, -force, -moment, at),
        ]


def _sum(loads: Sequence[Load], about: Array) -> Array:
    """Return force and moment of loads about a point, (n, 6)."""
    wrenches = [wrench_about(about, load.at, load.force, load.moment) for load in loads]
    total: Array = np.sum(np.broadcast_arrays(*wrenches, np.zeros((len(about), 6))), axis=0)
    return total
