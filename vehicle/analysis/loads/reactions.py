"""The forces in the joints: Newton and Euler for every part, linear in what the joints carry."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from ....core.vectors import cross
from ...assembly.load import Load, along_line
from ...assembly.part_poses import CONTACT, PartPoses, touching, wrench_about
from ...corner.corner import UP
from ...corner.structure import GROUND, PartJoint
from ...models.reach import PositionError
from .balance import DEAD_POINT, balanced, balanced_at_many, dense

Array = NDArray[np.float64]

# From so many positions on, one elimination for all of them takes less time than one for each.
_MANY = 200


class BalanceEquations:
    """Equilibrium of all parts in many positions, for any loads.

    Parameters
    ----------
    poses : PartPoses
    holding : sequence of str, optional
        The lines of what holds the suspension where it is, by a force along each: its springs. By
        default a vertical force on each wheel at its contact does.

    Attributes
    ----------
    indeterminate : ndarray, shape (n, unknowns, k)
        States of the unknowns that need no load, where parts are held more often than they move,
        as by the five rods of a rigid axle. What is solved has none of them.

    Notes
    -----
    The unknowns are what the joints carry and, last, the forces that hold the suspension; they are
    zero where the loads are in equilibrium.
    """

    def __init__(self, poses: PartPoses, holding: Sequence[str] = ()) -> None:
        self.poses = poses
        structure = poses.structure
        self.joints, self.lines, self.parts = structure.joints, structure.lines, structure.parts
        self._rows = {part: slice(6 * i, 6 * i + 6) for i, part in enumerate(self.parts)}
        self._units = [
            joint.unit_loads(poses.points, poses.turned, poses.design) for joint in self.joints
        ]
        held = [self.pushed(line) for line in holding] or self._upward()
        rows, unknowns = 6 * len(self.parts), sum(u.shape[-1] for u in self._units) + len(held)
        self._shape = (rows, unknowns)
        self._entries = self._of_joints() | self._last([self.applied(loads) for loads in held])
        self.indeterminate = np.zeros((len(poses.states), unknowns, 0))
        if unknowns > rows:
            self.indeterminate = np.linalg.svd(self._dense())[2][..., rows:, :].mT

    def _upward(self) -> list[list[Load]]:
        """Return a vertical force of 1 N on each wheel at its contact, or else at its centre."""
        return [
            [Load(part, CONTACT, "road", UP, np.zeros(3), touching(wheel))]
            for part, wheel in self.poses.wheels.items()
        ]

    def _of_joints(self) -> dict[tuple[int, int], Array]:
        """Return what a unit of what each joint carries does: the entries that are not zero."""
        found: dict[tuple[int, int], Array] = {}
        first = 0
        for joint, units in zip(self.joints, self._units, strict=True):
            for i, point in enumerate(joint.at):
                at_point = np.ascontiguousarray(np.moveaxis(units[:, i], 0, -1))
                for part, sign in ((joint.second, 1.0), (joint.first, -1.0)):
                    if part in GROUND:
                        continue
                    moved = sign * _about(self.poses, part, point, at_point)
                    begin = self._rows[part].start
                    for row, column in np.argwhere(moved.any(axis=-1)).tolist():
                        at, values = (begin + row, first + column), moved[row, column]
                        found[at] = found[at] + values if at in found else values
            first += units.shape[-1]
        return found

    def _last(self, held: list[Array]) -> dict[tuple[int, int], Array]:
        """Return the entries of the last columns, of loads that hold what is loaded."""
        first = self._shape[1] - len(held)
        return {
            (int(row), first + place): loads[:, row]
            for place, loads in enumerate(held)
            for row in np.flatnonzero(loads.any(axis=0))
        }

    def solve(self, applied: Array) -> Array:
        """Return the unknowns under loads on the parts.

        Parameters
        ----------
        applied : ndarray, shape (n, 6 parts) or (n, 6 parts, cases)
            Force and moment about the centre of mass of each part.

        Raises
        ------
        PositionError
            At a dead point, where what is carried has no bound.
        """
        found, sound = self.solved(applied)
        if not sound.all():
            centers = [wheel.center[~sound][0, 2] for wheel in self.poses.wheels.values()]
            height = " and ".join(f"{1e3 * float(center):.6g} mm" for center in centers)
            raise PositionError(f"at a wheel height of {height}: {DEAD_POINT}")
        return found

    def solved(self, applied: Array) -> tuple[Array, NDArray[np.bool_]]:
        """Return the unknowns under loads on the parts, and where they mean something.

        Where they do not is a dead point: there they are no numbers.
        """
        if self.indeterminate.shape[-1] == 0 and len(applied) >= _MANY:
            return balanced_at_many(self._entries, applied)
        matrix = np.concatenate([self._dense(), self.indeterminate.mT], axis=-2)
        shape = list(applied.shape)
        shape[1] = self.indeterminate.shape[-1]
        return balanced(matrix, np.concatenate([applied, np.zeros(shape)], axis=1))

    def _dense(self) -> Array:
        """Return the matrices, (n, 6 parts, unknowns)."""
        return dense(self._entries, self._shape)

    def applied(self, loads: list[Load]) -> Array:
        """Return loads as a vector, (n, 6 parts)."""
        total = np.zeros((*self.poses.states.shape[:-1], 6 * len(self.parts)))
        for load in loads:
            if load.part not in GROUND:
                center = self.poses.centers[load.part]
                wrench = wrench_about(center, load.at, load.force, load.moment)
                total[..., self._rows[load.part]] += wrench
        return total

    def pushed(self, line: str) -> list[Load]:
        """Return a unit force along a line, on both of its parts."""
        (found,) = (known for known in self.lines if known.name == line)
        return along_line(self.poses, found, np.ones(self.poses.states.shape[:-1]))

    def carried(self, unknowns: Array) -> list[Load]:
        """Return what the joints carry, on both of the parts of each."""
        loads = []
        for joint, at_points in zip(self.joints, self.at_joints(unknowns[..., None]), strict=True):
            for i, point in enumerate(joint.at):
                wrench = at_points[..., i, :, 0]
                loads += _on_both(joint, point, wrench, self.poses.points[point])
        return loads

    def at_joints(self, unknowns: Array) -> Iterator[Array]:
        """Yield what each joint carries on its second part.

        Parameters
        ----------
        unknowns : ndarray, shape (n, unknowns, cases)

        Yields
        ------
        ndarray, shape (n, touching points, 6, cases)
        """
        column = 0
        for units in self._units:
            carried = unknowns[:, column : column + units.shape[-1]]
            column += units.shape[-1]
            yield np.einsum("npru,nuc->nprc", units, carried)


def _on_both(joint: PartJoint, point: str, wrench: Array, at: Array) -> list[Load]:
    """Return what a joint carries at a point as loads on both parts."""
    force, moment = wrench[..., :3], wrench[..., 3:]
    return [
        Load(joint.second, point, joint.first, force, moment, at),
        Load(joint.first, point, joint.second, -force, -moment, at),
    ]


def _about(poses: PartPoses, part: str, point: str, units: Array) -> Array:
    """Return unit loads at a point, (6, units, n), as forces and moments about a centre of mass."""
    arm = poses.points[point] - poses.centers[part]
    forces, moments = units[:3], units[3:]
    turning = cross(arm, np.moveaxis(forces, 0, -1))
    return np.concatenate([forces, moments + np.moveaxis(turning, -1, 0)])
