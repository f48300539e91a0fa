"""The degrees of freedom of a beam on rods, which must be heave and roll.

A rod of fixed length removes one of the six degrees of freedom of a beam, unless it is redundant.
Its row is the rate of its length in motions of the beam: its direction, and the moment of this
direction about the middle of the axle. The rank of the rows is the number of removed degrees of
freedom.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ....core.named_types import Array
from ....core.vectors import cross, unit_vector

Ends = tuple[Array, Array]
"""The ends of a rod at design: on the chassis, on the axle [m]."""

NEEDED = 4
"""The number of rods that leave a beam two degrees of freedom, heave and roll."""

# Rotations are measured by the displacement at this distance from the middle of the axle [m].
_RADIUS = 0.5
# Greatest motion of the beam at constant height and inclination, per elongation of a rod.
_LOOSEST = 100.0
# A smaller singular value is zero: of rods that are exactly redundant, to the digits of a file.
_NOTHING = 1e-6
_MOTIONS = ("forward", "to the left", "up", "about x (roll)", "about y (pitch)", "about z (yaw)")
_HEAVE, _ROLL = np.eye(6)[2], np.eye(6)[3]
_FREEDOMS = 6


@dataclass(frozen=True)
class Hold:
    """The constraints of some rods."""

    names: tuple[str, ...]
    # elongation of each rod per displacement of the beam along x, y, z, and per rotation about
    # them, measured by the displacement at half a metre, (rods, 6)
    rows: Array

    @classmethod
    def of(cls, rods: Mapping[str, Ends], center: Array) -> "Hold":
        """Return the constraints of rods on a beam with a given middle [m]."""
        rows = []
        for chassis, axle in rods.values():
            along = unit_vector(axle - chassis)
            rows.append([*along, *(cross(axle - center, along) / _RADIUS)])
        return cls(tuple(rods), np.array(rows).reshape(-1, _FREEDOMS))

    @property
    def sizes(self) -> Array:
        """The singular values of the rows, the largest first."""
        return np.asarray(np.linalg.svd(self.rows, compute_uv=False))

    @property
    def rank(self) -> int:
        """The number of removed degrees of freedom."""
        return int((self.sizes > _NOTHING).sum())

    def guides(self) -> tuple[str, ...]:
        """Return the four rods that close the loops of the equations: the firmest ones.

        With five rods, which leave one degree of freedom, the axle heaves and rolls on their
        bushes. It is empty if no four of them constrain the axle.
        """
        if len(self.names) != NEEDED + 1 or self.rank != NEEDED + 1:
            return self.names
        parts = [self._without(which) for which in range(len(self.names))]
        fine = [part for part in parts if not part.problems()]
        return max(fine, key=lambda part: part.firmness).names if fine else ()

    @property
    def firmness(self) -> float:
        """The least elongation of a rod for a unit motion at constant height and inclination."""
        return self._at_rest()[0]

    def _without(self, which: int) -> "Hold":
        names = tuple(name for i, name in enumerate(self.names) if i != which)
        return Hold(names, np.delete(self.rows, which, axis=0))

    def problems(self) -> list[str]:
        """Return a problem if the degrees of freedom are not heave and roll alone."""
        if len(self.names) != NEEDED:
            return [self._miscounted()]
        firm, free = self._at_rest()
        if firm * _LOOSEST >= 1.0:
            return []
        times = "more than a million" if firm < _NOTHING else f"{1.0 / firm:.0f}"
        problem = (
            f"[rods] {', '.join(self.names)} do not hold the axle, which moves {_said(free)}: "
            f"its displacement is {times} times the elongation of a rod, at constant height and "
            f"inclination; at most {_LOOSEST:g} times are allowed. Two or more rods must hold the "
            "axle along x and in pitch; a Panhard rod, or upper links that meet, must hold it "
            "along y."
        )
        return [problem]

    def _at_rest(self) -> tuple[float, Array]:
        """Return the firmness at constant height and inclination, and the loosest motion."""
        _, sizes, directions = np.linalg.svd(np.array([*self.rows, _HEAVE, _ROLL]))
        return float(sizes[-1]), directions[-1]

    def _miscounted(self) -> str:
        """Return the problem of more or fewer than four rods, with the degrees of freedom left."""
        given, rank = len(self.names), self.rank
        begin = (
            f"[rods] {given} rod{'s' if given != 1 else ''}, {', '.join(self.names) or 'none'}: "
            f"{NEEDED} are needed. A beam has six degrees of freedom, an axle keeps two of "
            f"them, heave and roll, and each rod removes one. These remove {rank}"
        )
        if given < NEEDED:
            missing = "rod" if given == NEEDED - 1 else "rods"
            return f"{begin}, and {_FREEDOMS - rank} remain. Add the missing {missing}."
        sizes = ", ".join(f"{size:.3g}" for size in self.sizes)
        begin += f" (the singular values of their constraints are {sizes}), and "
        if rank == NEEDED:
            return (
                f"{begin}2 remain: the rods are redundant, and would be strained against each "
                "other. Leave one of them out."
            )
        if rank == _FREEDOMS:
            return f"{begin}none remains: the axle cannot move. Leave rods out."
        _, _, directions = np.linalg.svd(self.rows)
        return (
            f"{begin}one remains, {_said(directions[-1])}: such an axle heaves and rolls only "
            "because its bushes deflect, and these rods are rigid. Leave one of the rods out: "
            "three links and a Panhard rod, or four links of which two are triangulated. Or "
            "describe bushes in [bushings]: compliance takes all five."
        )


def _said(motion: Array) -> str:
    """Return a motion of the beam as text: its largest part, and all parts in figures."""
    most = int(np.abs(motion).argmax())
    figures = (np.round(motion / motion[most], 2) + 0.0).tolist()
    return f"{_MOTIONS[most]} (x, y, z, roll, pitch and yaw as {figures})"
