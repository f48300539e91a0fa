"""What joints, bushes, springs and stops of a suspension measure between its bodies.

What a joint keeps is a condition; a bush has a force over the displacement.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....core.vectors import cross
from ...assembly.anti_roll_bar import AnyBar, Bar, RollBar, TwistBar
from ...assembly.part_poses import PartPoses
from ...corner.bushes import RACK, Bush
from ...corner.structure import FixedJoint, LineForce, PartJoint, frame
from ...models.axle.bar import HalfBar
from ...models.points import carried as placed
from .bars import Bars, Foot, Inclinations
from .laws import CurvedLaw, Law, LinearLaw, SpringLaw, StopLaw
from .rigid_displacements import (
    Angles,
    BodyMeasures,
    Distances,
    Lengths,
    Radii,
    RigidDisplacements,
    Torsions,
)

Array = NDArray[np.float64]
Pair = tuple[int, int]
Carried = Mapping[tuple[str, str, str], Array]
"""Force and moment on a joint's second part, by both of its parts and the point, each (6,)."""

GROUND = "chassis"
GUIDE = GROUND, RACK, "tie_rod_inner"
"""The joint that holds a rack that deflects, of those that carry."""

# The pairs of directions of a wheel bearing that have its axis: what tilts.
_TILTING = 2
# The last directions of a bush are those across its axis.
_ACROSS = 2


@dataclass(frozen=True)
class CompliantJoints:
    """What deflects.

    Attributes
    ----------
    bushes : mapping of str to Bush
        By hardpoint.
    rack : float
        How far the rack deflects along its axis for a unit force; zero where it is held [m/N].
    carried : mapping
        What joints carry where the hardpoints are; those that are not there are relaxed.
    """

    bushes: Mapping[str, Bush]
    rack: float
    carried: Carried


class Connections:
    """Everything that is measured between the bodies of a suspension, or of both of an axle.

    Parameters
    ----------
    sides : sequence of tuple of PartPoses and CompliantJoints
        Each in as many positions, with rigid joints. They have one rack: its deflection and
        carries is that of the first.
    bar : AnyBar, optional
        Between the two sides, on a rigid axle, or between two parts of one.

    Attributes
    ----------
    start : RigidDisplacements
        Where the bodies are with rigid joints; the ground is the first.
    laws : list of Law or None
        What each measure has of a force; None for a condition.
    springs : list of int
        Which measures are the lengths of the springs, by wheel.
    bar : int or None
        Which measure is the twist of the bar.
    wheels : list of int
        Which bodies are the wheels.
    """

    def __init__(
        self, sides: Sequence[tuple[PartPoses, CompliantJoints]], bar: AnyBar | None = None
    ) -> None:
        self._sides: list[_Side] = []
        centers = [np.zeros((len(sides[0][0].states), 3))]
        for poses, soft in sides:
            begin = len(centers)
            parts = poses.structure.parts
            self._sides.append(_Side(poses, soft, {p: begin + i for i, p in enumerate(parts)}))
            centers += [poses.centers[part] for part in parts]
        if sides[0][1].rack:
            for side in self._sides:
                side.bodies[RACK] = len(centers)
            centers.append(sides[0][0].points["tie_rod_inner"])
            self._sides[0].joints.append(_RACK_IN_ITS_GUIDE)
        self.start = RigidDisplacements.at(np.stack(centers, axis=1))
        for side in self._sides:
            side.centers = self.start.centers
        self.wheels = [side.bodies[part] for side in self._sides for part in side.poses.wheels]
        self._groups: list[Any] = []
        self.laws: list[Law | None] = []
        for kind, name in _KINDS:
            found = [each for side in self._sides for each in side.measures(name)]
            if not found:
                continue
            bodies, vectors, laws = zip(*found, strict=True)
            of_each = (np.stack(same, axis=1) for same in zip(*vectors, strict=True))
            self._groups.append(kind(np.array(bodies), *of_each))
            self.laws += laws
        # the lines are the last
        lines = [line for side in self._sides for line in side.lines]
        begin = len(self.laws) - len(lines)
        self.springs = [begin + i for i, line in enumerate(lines) if line.is_spring]
        self.bar = None if bar is None else len(self.laws)
        if isinstance(bar, Bar):
            feet = (side.foot(half) for side, half in zip(self._sides, bar.halves, strict=True))
            self._groups.append(Bars(*feet))
            self.laws.append(LinearLaw(bar.rate, -bar.rate * bar.free_twist))
        elif isinstance(bar, RollBar):
            self._groups.append(self._sides[0].inclination(bar.body))
            self.laws.append(LinearLaw(bar.rate))
        elif bar is not None:
            self._groups.append(self._sides[0].twist(bar))
            self.laws.append(LinearLaw(bar.rate))

    def index(self, side: int, body: str) -> int:
        """Return which body it is; what does not move is the ground."""
        return self._sides[side].index(body)

    def at(self, places: RigidDisplacements) -> BodyMeasures:
        """Return all that is measured somewhere."""
        return BodyMeasures.together([group.at(places) for group in self._groups])

    def given_way(self, places: RigidDisplacements) -> dict[str, Array]:
        """Return how far bushes are displaced from their hardpoints, the most in any direction [m].

        By their hardpoints; of both sides of an axle the farther.
        """
        value, found = self.at(places).value, dict[str, Array]()
        for which, law in enumerate(self.laws):
            if isinstance(law, LinearLaw | CurvedLaw) and law.bush:
                far = np.abs(value[:, which] - law.start)
                found[law.bush] = np.maximum(far, found.get(law.bush, far))
        return found

    def strokes(self, places: RigidDisplacements) -> list[dict[str, Array]]:
        """Return what the stops of each side count by somewhere, by their signals [m]."""
        value = self.at(places).value
        strokes = (
            law.stroke + value[:, which] - law.length
            for which, law in enumerate(self.laws)
            if isinstance(law, StopLaw)
        )
        return [
            {
                side.poses.counted_by(line): next(strokes)
                for line in side.lines
                if not line.is_spring
            }
            for side in self._sides
        ]


class _Side:
    """What is measured between the bodies of one suspension.

    Attributes
    ----------
    poses : PartPoses
    bodies : dict of str to int
        Those that move.
    joints : list of PartJoint
    lines : sequence of LineForce
    centers : ndarray, shape (n, bodies, 3)
        Of all bodies, with rigid joints [m].
    """

    centers: Array

    def __init__(self, poses: PartPoses, soft: CompliantJoints, bodies: dict[str, int]) -> None:
        self.poses, self._soft, self.bodies = poses, soft, bodies
        self.joints, self.lines = list(poses.structure.joints), poses.structure.lines

    def index(self, body: str) -> int:
        """Return which body it is; what does not move is the ground."""
        return self.bodies.get(body, 0)

    def measures(self, name: str) -> Iterator[tuple[Pair, tuple[Array, ...], Law | None]]:
        """Yield all of a kind: what the method of that name has of joints, or of lines."""
        for each in self.lines if name == "lengths" else self.joints:
            yield from getattr(self, name)(each)

    def foot(self, half: HalfBar) -> Foot:
        """Return where the drop link of half a bar is joined to its part."""
        poses = self.poses
        places = {"foot": (half.body, half.foot)}
        at = placed(poses.model, places, poses.states, poses.inputs)["foot"]
        which = self.index(half.body)
        return Foot(half, which, at - self.centers[:, which])

    def inclination(self, body: str) -> Inclinations:
        """Return how far what points left of a body at design has its end up."""
        return Inclinations(self.index(body), self.poses.turned[body][..., 1])

    def twist(self, bar: TwistBar) -> Torsions:
        """Return how far the second part of a bar has turned against its first one."""
        _, across, other = frame(bar.axis)
        twist = bar.twist_of(self.poses)[:, None]
        both = np.cos(twist) * across + np.sin(twist) * other
        further = np.cos(twist) * other - np.sin(twist) * across
        shape = both.shape
        first, first_other = (np.broadcast_to(way, shape)[:, None] for way in (across, other))
        # at rest with rigid joints they are turned by the twist that they have there
        bodies = np.array([[self.index(bar.first), self.index(bar.second)]])
        return Torsions(bodies, first, first_other, both[:, None], further[:, None])

    # -- what is measured: bodies, vectors, and the law ------------------------------------------

    def distances(
        self, joint: PartJoint
    ) -> Iterator[tuple[Pair, tuple[Array, Array, Array], Law | None]]:
        parts = joint.first, joint.second
        kept = joint.directions(self.poses.points)
        for point in joint.at:
            bush, rows = self._bush(joint, point), kept
            laws: list[Law | None] = [None] * kept.shape[-2]
            if bush is not None:
                # along what a joint does not keep, the axis of a telescope, a bush does nothing
                rows = self._axes(bush, joint.first)[:, -len(laws) :]
                laws = self._laws(bush, joint)[-len(laws) :]
            start, end = (self._arm(body, point) for body in parts)
            for which, law in enumerate(laws):
                if not isinstance(law, CurvedLaw) or which < len(laws) - _ACROSS:
                    yield self._indices(*parts), (rows[:, which], start, end), law

    def radii(self, joint: PartJoint) -> Iterator[tuple[Pair, tuple[Array, ...], Law | None]]:
        """Yield what bushes measure across their axes that are curved there."""
        for bush in self._bushes(joint):
            curve = bush.curves[-1]
            if curve is None:
                continue
            rows = self._axes(bush, joint.first)
            key = joint.first, joint.second, bush.point
            carried = -bush.axes[1:] @ self._soft.carried.get(key, np.zeros(6))[:3]
            size = float(np.linalg.norm(carried))
            far = curve.place(size) / size if size else 0.0
            before = np.broadcast_to(far * carried, (len(rows), _ACROSS))
            arms = (self._arm(part, bush.point) for part in (joint.first, joint.second))
            parts = self._indices(joint.first, joint.second)
            yield (
                parts,
                (rows[:, 1], rows[:, 2], *arms, before),
                CurvedLaw(curve, bush=bush.point, start=far * size),
            )

    def angles(self, joint: PartJoint) -> Iterator[tuple[Pair, tuple[Array, Array], Law | None]]:
        poses = self.poses
        wheels = poses.wheels
        # what else is held in every direction needs no axis of its own
        spin = wheels.get(joint.second, next(iter(wheels.values()))).design_axis
        pairs = joint.right_angles(poses.points, poses.turned, poses.design, spin)
        bush = self._bush(joint, joint.at[0])
        carried = self._soft.carried.get((joint.first, joint.second, joint.at[0]), np.zeros(6))
        for which, (first, second) in enumerate(pairs):
            law, ways = None, (first, second)
            if bush is not None and bush.tilt.any() and which < _TILTING:
                # what is across the wheel's axis turns with the bush, and measures the rotation
                # about the other direction across it
                turned, across = poses.turned[joint.first], bush.tilts_about[which]
                ways = np.broadcast_to(turned @ across, first.shape), first
                # where the bush stands, in axes that are those of design
                moment = carried[3:] @ cross(turned[0].T @ first[0], across)
                law = LinearLaw(1.0 / bush.tilt[1 - which], -float(moment))
            yield self._indices(joint.first, joint.second), ways, law

    def tilts(self, joint: PartJoint) -> Iterator[tuple[Pair, tuple[Array, Array], Law | None]]:
        """Yield what of its axis leaves that of a bush which resists tilting."""
        for bush in self._bushes(joint):
            if any(bush.turning[1:]):
                rows, axis = self._axes(bush, joint.first), self._axes(bush, joint.second)[:, 0]
                # each direction across the axis measures the rotation about the other one
                for across, stiffness in zip((2, 1), bush.turning[1:], strict=True):
                    yield (
                        self._indices(joint.first, joint.second),
                        (rows[:, across], axis),
                        LinearLaw(stiffness),
                    )

    def twists(self, joint: PartJoint) -> Iterator[tuple[Pair, tuple[Array, ...], Law | None]]:
        """Yield the torsion of bushes that resist it."""
        for bush in self._bushes(joint):
            if stiffness := bush.turning[0]:
                first, second = self._axes(bush, joint.first), self._axes(bush, joint.second)
                yield (
                    self._indices(joint.first, joint.second),
                    (first[:, 1], first[:, 2], second[:, 1], second[:, 2]),
                    LinearLaw(stiffness),
                )

    def lengths(self, line: LineForce) -> Iterator[tuple[Pair, tuple[Array, Array], Law]]:
        """Yield the length of a spring, or of what is beside it."""
        poses = self.poses
        first, second = (poses.points[point] for point in line.at)
        length = np.linalg.norm(second - first, axis=-1)
        force, parameters = poses.forces_along_lines()[line.name], poses.parameters_of(line)
        law: Law
        if line.is_spring:
            law = SpringLaw(length, force, parameters)
        else:
            law = StopLaw(length, force, poses.signals()[poses.counted_by(line)], parameters)
        ends = self._arm(line.first, line.at[0]), self._arm(line.second, line.at[1])
        yield self._indices(line.first, line.second), ends, law

    # -- bushes -----------------------------------------------------------------------------------

    def _bush(self, joint: PartJoint, point: str) -> Bush | None:
        """Return what deflects at a point of a joint, if anything does."""
        if joint is not _RACK_IN_ITS_GUIDE:
            return self._soft.bushes.get(point)
        axis = self.poses.rack_axis
        assert axis is not None  # where there is a rack
        soft = np.array([self._soft.rack, 0.0, 0.0])
        axes = np.stack(frame(axis))
        none = np.zeros(2), axes[1:], (0.0, 0.0, 0.0), (None, None, None)
        return Bush(point, axes, soft, *none)

    def _bushes(self, joint: PartJoint) -> list[Bush]:
        found = (self._bush(joint, point) for point in joint.at)
        return [bush for bush in found if bush is not None]

    def _axes(self, bush: Bush, part: str) -> Array:
        """Return the axes of a bush as rows, which turn with a part, (n, 3, 3)."""
        turned = self.poses.turned.get(part, np.eye(3))
        rows = bush.axes @ np.swapaxes(turned, -1, -2)
        return np.broadcast_to(rows, (len(self.poses.states), 3, 3))

    def _laws(self, bush: Bush, joint: PartJoint) -> list[Law | None]:
        """Return the force of a bush along each of its axes; none where it is rigid."""
        key = joint.first, joint.second, bush.point
        carried = -bush.axes @ self._soft.carried.get(key, np.zeros(6))[:3]
        name = RACK if joint is _RACK_IN_ITS_GUIDE else bush.point
        found: list[Law | None] = []
        for soft, curve, force in zip(bush.soft, bush.curves, carried.tolist(), strict=True):
            if curve is not None:
                found.append(CurvedLaw(curve, curve.place(force), name))
            else:
                found.append(LinearLaw(1.0 / soft, force, name) if soft else None)
        return found

    # -- bodies -----------------------------------------------------------------------------------

    def _arm(self, body: str, point: str) -> Array:
        """Return a hardpoint from the centre of a body, (n, 3) [m]."""
        arm: Array = self.poses.carried_by(body, point) - self.centers[:, self.index(body)]
        return arm

    def _indices(self, first: str, second: str) -> Pair:
        return self.index(first), self.index(second)


_RACK_IN_ITS_GUIDE = FixedJoint(GROUND, RACK, GUIDE[2:])
# What is measured, and which method of a side has it.
_KINDS: tuple[tuple[Any, str], ...] = (
    (Distances, "distances"), (Angles, "angles"), (Angles, "tilts"), (Torsions, "twists"),
    (Radii, "radii"), (Lengths, "lengths"),
)  # fmt: skip
