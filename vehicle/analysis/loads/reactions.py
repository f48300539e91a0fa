"""Loads on the joints: Newton's and Euler's equations of all parts, linear in these loads.

Source: P. E. Nikravesh, Computer-Aided Analysis of Mechanical Systems, Prentice Hall, 1988
(equations of motion of constrained bodies).
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from ....core.named_types import Array
from ...assembly.load import Load, along_line
from ...assembly.part_poses import CONTACT, PartPoses, touching, wrench_about
from ...corner.corner import UP
from ...corner.structure import GROUND
from ...models.reach import PositionError
from .balance import DEAD_POINT, balanced

# Positions whose equations are in memory together: 0.1 GB for the two wheels of an axle.
_TOGETHER = 2000


class BalanceEquations:
    """Equilibrium of all parts in many positions, for any loads.

    The lines along which forces hold the suspension are its springs; by default a vertical force at
    the contact of each wheel holds it. The unknowns are the loads of the joints, then the forces
    that hold the suspension, which are zero if the loads are in equilibrium.

    ``indeterminate``, (n, unknowns, k), are unknowns in equilibrium without loads, if supports are
    redundant, as the five rods of a rigid axle. Solutions have no part in these directions.
    """

    def __init__(self, poses: PartPoses, holding: Sequence[str] = ()) -> None:
        self.poses = poses
        structure = poses.structure
        self.joints, self.lines, self.parts = structure.joints, structure.lines, structure.parts
        self._rows = {part: slice(6 * i, 6 * i + 6) for i, part in enumerate(self.parts)}
        self._units = [
            joint.unit_loads(poses.points, poses.turned, poses.design) for joint in self.joints
        ]
        upward = (
            [Load(part, CONTACT, "road", UP, np.zeros(3), touching(wheel))]
            for part, wheel in poses.wheels.items()
        )
        held = [self.pushed(line) for line in holding] or [*upward]
        rows, unknowns = 6 * len(self.parts), sum(u.shape[-1] for u in self._units) + len(held)
        self._shape = (rows, unknowns)
        self._held = [self.applied(loads) for loads in held]
        self.indeterminate = np.zeros((len(poses.states), unknowns, 0))
        if unknowns > rows:
            self.indeterminate = np.linalg.svd(self._matrix(slice(None)))[2][..., rows:, :].mT

    def _matrix(self, some: slice) -> Array:
        """Return the matrices at some positions, (n, 6 parts, unknowns)."""
        matrix = np.zeros((len(self.poses.states[some]), *self._shape))
        first = 0
        for joint, units in zip(self.joints, self._units, strict=True):
            columns = slice(first, first + units.shape[-1])
            for i, point in enumerate(joint.at):
                at, loads = self.poses.points[point][some, None], units[some, i].mT
                for part, sign in ((joint.second, 1.0), (joint.first, -1.0)):
                    if part not in GROUND:
                        center = self.poses.centers[part][some, None]
                        moved = wrench_about(center, at, loads[..., :3], loads[..., 3:])
                        matrix[:, self._rows[part], columns] += sign * moved.mT
            first = columns.stop
        for column, held in enumerate(self._held, first):
            matrix[..., column] = held[some]
        return matrix

    def solve(self, applied: Array) -> Array:
        """Return the unknowns under loads on the parts, (n, 6 parts) or (n, 6 parts, cases).

        Loads are force and moment about the centre of mass of each part. A dead point, where loads
        are unbounded, is a `PositionError`.
        """
        found, sound = self.solved(applied)
        if not sound.all():
            centers = [wheel.center[~sound][0, 2] for wheel in self.poses.wheels.values()]
            height = " and ".join(f"{1e3 * float(center):.6g} mm" for center in centers)
            raise PositionError(f"at a wheel height of {height}: {DEAD_POINT}")
        return found

    def solved(self, applied: Array) -> tuple[Array, NDArray[np.bool_]]:
        """Return the unknowns under loads on the parts, NaN at dead points, and where they hold."""
        pieces = [
            slice(begin, begin + _TOGETHER) for begin in range(0, max(len(applied), 1), _TOGETHER)
        ]
        found, sound = zip(*(self._solved(applied[some], some) for some in pieces), strict=True)
        return np.concatenate(found), np.concatenate(sound)

    def _solved(self, applied: Array, some: slice) -> tuple[Array, NDArray[np.bool_]]:
        """Return the same at some positions, for loads at these."""
        besides = self.indeterminate[some].mT
        matrix = np.concatenate([self._matrix(some), besides], axis=-2)
        none = np.zeros((len(applied), besides.shape[-2], *applied.shape[2:]))
        return balanced(matrix, np.concatenate([applied, none], axis=1))

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
        """Return the loads of the joints, on both parts of each."""
        loads = []
        for joint, at_points in zip(self.joints, self.at_joints(unknowns[..., None]), strict=True):
            for i, point in enumerate(joint.at):
                wrench, at = at_points[..., i, :, 0], self.poses.points[point]
                force, moment = wrench[..., :3], wrench[..., 3:]
                loads.append(Load(joint.second, point, joint.first, force, moment, at))
                loads.append(Load(joint.first, point, joint.second, -force, -moment, at))
        return loads

    def at_joints(self, unknowns: Array) -> Iterator[Array]:
        """Yield the loads of each joint on its second part, (n, touching points, 6, cases).

        The unknowns have the shape (n, unknowns, cases).
        """
        column = 0
        for units in self._units:
            carried = unknowns[:, column : column + units.shape[-1]]
            column += units.shape[-1]
            yield np.einsum("npru,nuc->nprc", units, carried)
