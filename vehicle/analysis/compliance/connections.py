"""Displacements and angles between bodies of a suspension, at joints, bushes, springs and stops.

Each is a condition of a rigid joint, or has a law of force of a bush, a spring or a stop.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ....core.named_types import Array
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

Pair = tuple[int, int]
Carried = Mapping[tuple[str, str, str], Array]
"""Force and moment on the second part of a joint, (6,), by first part, second part and point."""

GROUND = "chassis"
GUIDE = GROUND, RACK, "tie_rod_inner"
"""The joint that holds a compliant rack, as a key of `Carried`."""

# The first right angles of a wheel bearing are those with its axis, which tilts.
_TILTING = 2
# The last directions of a bush are those across its axis.
_ACROSS = 2


@dataclass(frozen=True)
class CompliantJoints:
    """Bushes and compliant rack of a suspension."""

    bushes: Mapping[str, Bush]  # by hardpoint
    rack: float  # compliance of the rack along its axis [m/N]; zero if it is rigid
    # loads on joints at the hardpoints; joints that are left out are relaxed there
    carried: Carried


class Connections:
    """All displacements and angles between the bodies of a suspension or an axle.

    The sides are in the same positions, with rigid joints; the compliance of their common rack, and
    the load on it, are those of the first. A bar is between the sides, on a rigid axle, or between
    two parts of one. Body 0 is the ground.
    """

    def __init__(
        self, sides: Sequence[tuple[PartPoses, CompliantJoints]], bar: AnyBar | None = None
    ) -> None:
        self._sides: list[_ConnectedSide] = []
        centers = [np.zeros((len(sides[0][0].states), 3))]
        for poses, soft in sides:
            begin = len(centers)
            parts = poses.structure.parts
            self._sides.append(
                _ConnectedSide(poses, soft, {p: begin + i for i, p in enumerate(parts)})
            )
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
        # lines are the last measures
        lines = [line for side in self._sides for line in side.lines]
        begin = len(self.laws) - len(lines)
        self.springs = [begin + i for i, line in enumerate(lines) if line.is_spring]
        self.bar = None if bar is None else len(self.laws)
        if bar is not None:
            self._groups.append(self._measured(bar))
            self.laws.append(LinearLaw(bar.rate, -bar.rate * bar.free_twist))

    def _measured(self, bar: AnyBar) -> Any:
        """Return the measure of the twist of a bar."""
        if isinstance(bar, Bar):
            feet = (side.foot(half) for side, half in zip(self._sides, bar.halves, strict=True))
            return Bars(*feet)
        if isinstance(bar, RollBar):
            return self._sides[0].inclination(bar.body)
        return self._sides[0].twist(bar)

    def index(self, side: int, body: str) -> int:
        """Return the index of a body; fixed ones belong to the ground."""
        return self._sides[side].index(body)

    def at(self, places: RigidDisplacements) -> BodyMeasures:
        """Return all measures with the bodies at some places."""
        return BodyMeasures.together([group.at(places) for group in self._groups])

    def deflected(self, places: RigidDisplacements) -> dict[str, Array]:
        """Return the largest deflection of bushes in any direction, by hardpoint [m]."""
        value, found = self.at(places).value, dict[str, Array]()
        for which, law in enumerate(self.laws):
            if isinstance(law, LinearLaw | CurvedLaw) and law.bush:
                far = np.abs(value[:, which] - law.start)
                found[law.bush] = np.maximum(far, found.get(law.bush, far))
        return found

    def strokes(self, places: RigidDisplacements) -> list[dict[str, Array]]:
        """Return the strokes of the stops of each side, by their signals [m]."""
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


class _ConnectedSide:
    """The measures between the bodies of one suspension."""

    centers: Array  # of all bodies with rigid joints, (n, bodies, 3) [m]

    def __init__(self, poses: PartPoses, soft: CompliantJoints, bodies: dict[str, int]) -> None:
        self.poses, self._soft, self.bodies = poses, soft, bodies
        self.joints, self.lines = list(poses.structure.joints), poses.structure.lines

    def index(self, body: str) -> int:
        """Return the index of a body; fixed ones belong to the ground."""
        return self.bodies.get(body, 0)

    def measures(self, name: str) -> Iterator[tuple[Pair, tuple[Array, ...], Law | None]]:
        """Yield the bodies, vectors and law of all measures of a kind, by the method's name."""
        for each in self.lines if name == "lengths" else self.joints:
            yield from getattr(self, name)(each)

    def foot(self, half: HalfBar) -> Foot:
        """Return the joint of the drop link of half a bar on its part."""
        poses = self.poses
        places = {"foot": (half.body, half.foot)}
        at = placed(poses.model, places, poses.states, poses.inputs)["foot"]
        which = self.index(half.body)
        return Foot(half, which, at - self.centers[:, which])

    def inclination(self, body: str) -> Inclinations:
        """Return the inclination of the direction of a body that points left at design."""
        return Inclinations(self.index(body), self.poses.turned[body][..., 1])

    def twist(self, bar: TwistBar) -> Torsions:
        """Return the rotation of the second part of a bar relative to the first one."""
        _, across, other = frame(bar.axis)
        twist = bar.twist_of(self.poses)[:, None]
        both = np.cos(twist) * across + np.sin(twist) * other
        further = np.cos(twist) * other - np.sin(twist) * across
        shape = both.shape
        first, first_other = (np.broadcast_to(way, shape)[:, None] for way in (across, other))
        # directions of the second part include its twist with rigid joints
        bodies = np.array([[self.index(bar.first), self.index(bar.second)]])
        return Torsions(bodies, first, first_other, both[:, None], further[:, None])

    # -- measures: bodies, vectors and law --------------------------------------------------------

    def distances(
        self, joint: PartJoint
    ) -> Iterator[tuple[Pair, tuple[Array, Array, Array], Law | None]]:
        parts = joint.first, joint.second
        kept = joint.directions(self.poses.points)
        for point in joint.at:
            bush, rows = self._bush(joint, point), kept
            laws: list[Law | None] = [None] * kept.shape[-2]
            if bush is not None:
                # no force along a free direction of the joint, such as the axis of a telescope
                rows = self._axes(bush, joint.first)[:, -len(laws) :]
                laws = self._laws(bush, joint)[-len(laws) :]
            start, end = (self._arm(body, point) for body in parts)
            for which, law in enumerate(laws):
                if not isinstance(law, CurvedLaw) or which < len(laws) - _ACROSS:
                    yield self._indices(*parts), (rows[:, which], start, end), law

    def radii(self, joint: PartJoint) -> Iterator[tuple[Pair, tuple[Array, ...], Law | None]]:
        """Yield the radial displacement of bushes with a radial curve."""
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
            yield (
                self._indices(joint.first, joint.second),
                (rows[:, 1], rows[:, 2], *arms, before),
                CurvedLaw(curve, bush=bush.point, start=far * size),
            )

    def angles(self, joint: PartJoint) -> Iterator[tuple[Pair, tuple[Array, Array], Law | None]]:
        poses = self.poses
        wheels = poses.wheels
        # a part that is fixed to another in all directions needs no axis of its own
        spin = wheels.get(joint.second, next(iter(wheels.values()))).design_axis
        pairs = joint.right_angles(poses.points, poses.turned, poses.design, spin)
        bush = self._bush(joint, joint.at[0])
        carried = self._soft.carried.get((joint.first, joint.second, joint.at[0]), np.zeros(6))
        for which, (first, second) in enumerate(pairs):
            law, ways = None, (first, second)
            if bush is not None and bush.tilt.any() and which < _TILTING:
                # a direction across the wheel's axis turns with the bush, and measures the rotation
                # about the other one
                turned, across = poses.turned[joint.first], bush.tilts_about[which]
                ways = np.broadcast_to(turned @ across, first.shape), first
                # the moment on the bush, in the axes of design
                moment = carried[3:] @ cross(turned[0].T @ first[0], across)
                law = LinearLaw(1.0 / bush.tilt[1 - which], -float(moment))
            yield self._indices(joint.first, joint.second), ways, law

    def tilts(self, joint: PartJoint) -> Iterator[tuple[Pair, tuple[Array, Array], Law | None]]:
        """Yield the tilting of bushes with tilting stiffness."""
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
        """Yield the torsion of bushes with torsional stiffness."""
        for bush in self._bushes(joint):
            if stiffness := bush.turning[0]:
                first, second = self._axes(bush, joint.first), self._axes(bush, joint.second)
                yield (
                    self._indices(joint.first, joint.second),
                    (first[:, 1], first[:, 2], second[:, 1], second[:, 2]),
                    LinearLaw(stiffness),
                )

    def lengths(self, line: LineForce) -> Iterator[tuple[Pair, tuple[Array, Array], Law]]:
        """Yield the length of a spring or a stop."""
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
        """Return the bush at a point of a joint, if there is one; a compliant rack has one, too."""
        if joint is not _RACK_IN_ITS_GUIDE:
            return self._soft.bushes.get(point)
        axis = self.poses.rack_axis
        assert axis is not None  # there is a rack
        soft = np.array([self._soft.rack, 0.0, 0.0])
        axes = np.stack(frame(axis))
        none = np.zeros(2), axes[1:], (0.0, 0.0, 0.0), (None, None, None)
        return Bush(point, axes, soft, *none)

    def _bushes(self, joint: PartJoint) -> list[Bush]:
        found = (self._bush(joint, point) for point in joint.at)
        return [bush for bush in found if bush is not None]

    def _axes(self, bush: Bush, part: str) -> Array:
        """Return the axes of a bush, which turn with a part, as rows, (n, 3, 3)."""
        rows = bush.axes @ np.swapaxes(self.poses.turned.get(part, np.eye(3)), -1, -2)
        return np.broadcast_to(rows, (len(self.poses.states), 3, 3))

    def _laws(self, bush: Bush, joint: PartJoint) -> list[Law | None]:
        """Return the law of a bush along each of its axes; None where it is rigid."""
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
        """Return the vector from the centre of a body to a hardpoint, (n, 3) [m]."""
        return self.poses.carried_by(body, point) - self.centers[:, self.index(body)]

    def _indices(self, first: str, second: str) -> Pair:
        return self.index(first), self.index(second)


_RACK_IN_ITS_GUIDE = FixedJoint(GROUND, RACK, GUIDE[2:])
# Kinds of measures, and the methods of a side that yield them.
_KINDS: tuple[tuple[Any, str], ...] = (
    (Distances, "distances"), (Angles, "angles"), (Angles, "tilts"), (Torsions, "twists"),
    (Radii, "radii"), (Lengths, "lengths"),
)  # fmt: skip
