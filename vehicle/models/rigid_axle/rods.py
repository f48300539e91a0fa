"""What rods hold of a beam that has to heave and roll.

A rod of fixed length takes one of the six degrees of freedom of a beam, if it does not repeat what
others do. Its row says how fast it would grow in a motion of the beam: along the rod, and the
moment of that direction about the middle of the axle. The rank of the rows is how many degrees of
freedom are taken.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....core.vectors import cross, unit_vector

Array = NDArray[np.float64]
Ends = tuple[Array, Array]
"""Where a rod is at design: on the chassis, on the axle [m]."""

NEEDED = 4
"""As many rods leave a beam two degrees of freedom: heave and roll."""

# Turns are measured by what they move at this distance from the middle of the axle [m].
_RADIUS = 0.5
# Held at its height and inclination, the beam may move so many times what a rod grows.
_LOOSEST = 100.0
# A singular value below this is nothing: rods that repeat others exactly, as files can say it.
_NOTHING = 1e-6
_MOTIONS = ("forward", "to the left", "up", "about x (roll)", "about y (pitch)", "about z (yaw)")
_HEAVE, _ROLL = np.eye(6)[2], np.eye(6)[3]
_FREEDOMS = 6


@dataclass(frozen=True)
class Hold:
    """What some rods hold.

    Attributes
    ----------
    names : tuple of str
    rows : ndarray, shape (rods, 6)
        Growth of each rod by shifts of the beam along x, y, z, and by turns about them, those in
        units of what they move at half a metre.
    """

    names: tuple[str, ...]
    rows: Array

    @classmethod
    def of(cls, rods: Mapping[str, Ends], center: Array) -> "Hold":
        """Return what rods hold of a beam whose middle is at some place [m]."""
        rows = []
        for chassis, axle in rods.values():
            along = unit_vector(axle - chassis)
            rows.append([*along, *(cross(axle - center, along) / _RADIUS)])
        return cls(tuple(rods), np.array(rows).reshape(-1, _FREEDOMS))

    @property
    def sizes(self) -> Array:
        """Return the singular values of the rows, the largest first."""
        return np.asarray(np.linalg.svd(self.rows, compute_uv=False))

    @property
    def rank(self) -> int:
        """Return how many degrees of freedom are taken."""
        return int((self.sizes > _NOTHING).sum())

    def guides(self) -> tuple[str, ...]:
        """Return the four rods that close the loops of the equations: those that hold firmest.

        Of five that leave one degree of freedom, the other one deflects with all of them on their
        bushes. None, where no four of them hold the axle.
        """
        if len(self.names) != NEEDED + 1 or self.rank != NEEDED + 1:
            return self.names
        parts = [self._without(which) for which in range(len(self.names))]
        fine = [part for part in parts if not part.problems()]
        return max(fine, key=lambda part: part.firmness).names if fine else ()

    @property
    def firmness(self) -> float:
        """What a rod grows by, at least, for a unit motion at a height and an inclination."""
        return self._at_rest()[0]

    def _without(self, which: int) -> "Hold":
        names = tuple(name for i, name in enumerate(self.names) if i != which)
        return Hold(names, np.delete(self.rows, which, axis=0))

    def problems(self) -> list[str]:
        """Say why these rods do not leave heave and roll, and nothing else."""
        if len(self.names) != NEEDED:
            return [self._miscounted()]
        firm, free = self._at_rest()
        if firm * _LOOSEST >= 1.0:
            return []
        times = "infinitely many" if firm < _NOTHING else f"{1.0 / firm:.0f}"
        problem = (
            f"[rods] {', '.join(self.names)} hardly hold the axle, which moves {_said(free)}: "
            f"its displacement is {times} times the elongation of a rod, at constant height and "
            f"inclination; at most {_LOOSEST:g} times are allowed. Two or more rods must hold the "
            "axle along x and in pitch; a Panhard rod, or upper links that meet, must hold it "
            "along y."
        )
        return [problem]

    def _at_rest(self) -> tuple[float, Array]:
        """Return how firmly the beam is held at its height and inclination, and what is loosest."""
        _, sizes, directions = np.linalg.svd(np.array([*self.rows, _HEAVE, _ROLL]))
        return float(sizes[-1]), directions[-1]

    def _miscounted(self) -> str:
        """Say what these rods, more or fewer than four, leave of a beam's degrees of freedom."""
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
    """Return a motion of the beam in words: its largest part, and all of it in figures."""
    most = int(np.abs(motion).argmax())
    figures = (np.round(motion / motion[most], 2) + 0.0).tolist()
    return f"{_MOTIONS[most]} (x, y, z, roll, pitch and yaw as {figures})"
