"""What joints, bushes, springs and stops of a suspension measure between its bodies.

What a joint keeps is a condition; what a bush gives way to has a force over the displacement.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....core.vectors import cross, unit_vector
from ....suspension.bushes import RACK, Bush
from ....suspension.structure import Fixed, Joint, Line, frame
from ...characteristics.from_model import design_axis
from ..poses import Poses
from .laws import Bent, Coil, Law, Stops, Straight
from .places import Angles, Distances, Lengths, Measured, Places, Radii, Twists

Array = NDArray[np.float64]
Pair = tuple[int, int]
Carried = Mapping[tuple[str, str, str], Array]
"""Force and moment on a joint's second part, by both of its parts and the point, each (6,)."""

GROUND = "chassis"

# The pairs of directions of a wheel bearing that have its axis: what tilts.
_TILTING = 2
# The last directions of a bush are those across its axis.
_ACROSS = 2


@dataclass(frozen=True)
class Soft:
    """What gives way.

    Attributes
    ----------
    bushes : mapping of str to Bush
        By hardpoint.
    rack : float
        How far the rack gives way along its axis for a unit force; zero where it is held [m/N].
    carried : mapping
        What joints carry where the hardpoints are; those that are not there are relaxed.
    """

    bushes: Mapping[str, Bush]
    rack: float
    carried: Carried


class Connections:
    """Everything that is measured between the bodies of a suspension in many positions.

    Parameters
    ----------
    poses : Poses
        With rigid joints.
    soft : Soft

    Attributes
    ----------
    bodies : tuple of str
        The ground first.
    start : Places
        Where the bodies are with rigid joints.
    laws : list of Law or None
        What each measure has of a force; None for a condition.
    spring : int
        Which measure is the length of the spring.
    """

    def __init__(self, poses: Poses, soft: Soft) -> None:
        self._poses, self._soft = poses, soft
        structure = poses.model.suspension.structure()
        joints = list(structure.joints)
        self.bodies: tuple[str, ...] = (GROUND, *structure.parts)
        if soft.rack:
            self.bodies += (RACK,)
            joints.append(_RACK_IN_ITS_GUIDE)
        self.start = Places.at(np.stack([self._center(body) for body in self.bodies], axis=1))
        distances = [found for joint in joints for found in self._distances(joint)]
        angles = [found for joint in joints for found in self._angles(joint)]
        angles += [found for joint in joints for found in self._tilts(joint)]
        twists = [found for joint in joints for found in self._twists(joint)]
        radii = [found for joint in joints for found in self._radii(joint)]
        lengths = [self._length(line) for line in structure.lines]
        groups: tuple[tuple[Any, list[Any]], ...] = (
            (Distances, distances), (Angles, angles), (Twists, twists), (Radii, radii),
            (Lengths, lengths),
        )  # fmt: skip
        self._groups: list[Distances | Angles | Twists | Radii | Lengths] = []
        for kind, found in groups:
            if not found:
                continue
            bodies, vectors, _ = zip(*found, strict=True)
            of_each = (np.stack(same, axis=1) for same in zip(*vectors, strict=True))
            self._groups.append(kind(np.array(bodies), *of_each))
        self.laws: list[Law | None] = [law for _, found in groups for _, _, law in found]
        self.spring = len(self.laws) - len(lengths)

    def at(self, places: Places) -> Measured:
        """Return all that is measured somewhere."""
        return Measured.together([group.at(places) for group in self._groups])

    def stroke(self, places: Places) -> Array:
        """Return what the stops count by somewhere, the length of damper or strut, (n,) [m]."""
        value = self.at(places).value
        for which, law in enumerate(self.laws):
            if isinstance(law, Stops):
                stroke: Array = law.stroke + value[:, which] - law.length
                return stroke
        raise AssertionError("every suspension has a damper")

    def index(self, body: str) -> int:
        """Return which body it is; what does not move is the ground."""
        return self.bodies.index(body) if body in self.bodies else 0

    # -- what is measured: bodies, vectors, and the law ------------------------------------------

    def _distances(
        self, joint: Joint
    ) -> Iterator[tuple[Pair, tuple[Array, Array, Array], Law | None]]:
        parts = joint.first, joint.second
        kept = joint.directions(self._poses.points)
        for point in joint.at:
            bush, rows = self._bush(joint, point), kept
            laws: list[Law | None] = [None] * kept.shape[-2]
            if bush is not None:
                # along what a joint does not keep, the axis of a telescope, a bush does nothing
                rows = self._axes(bush, joint.first)[:, -len(laws) :]
                laws = self._laws(bush, joint)[-len(laws) :]
            start, end = (self._arm(body, point) for body in parts)
            for which, law in enumerate(laws):
                if not isinstance(law, Bent) or which < len(laws) - _ACROSS:
                    yield self._indices(*parts), (rows[:, which], start, end), law

    def _radii(self, joint: Joint) -> Iterator[tuple[Pair, tuple[Array, ...], Law | None]]:
        """Yield what bushes measure across their axes that are curved there."""
        for bush in self._bushes(joint):
            curve = bush.curves[-1]
            if curve is None:
                continue
            rows = self._axes(bush, joint.first)
            key = joint.first, joint.second, bush.point
            carried = -bush.axes[1:] @ self._soft.carried.get(key, np.zeros(6))[:3]
            size = float(np.linalg.norm(carried))
            far = curve.displacement(size) / size if size else 0.0
            before = np.broadcast_to(far * carried, (len(rows), _ACROSS))
            arms = (self._arm(part, bush.point) for part in (joint.first, joint.second))
            parts = self._indices(joint.first, joint.second)
            yield parts, (rows[:, 1], rows[:, 2], *arms, before), Bent(curve)

    def _angles(self, joint: Joint) -> Iterator[tuple[Pair, tuple[Array, Array], Law | None]]:
        poses = self._poses
        spin = design_axis(poses.model.suspension)
        pairs = joint.right_angles(poses.points, poses.turned, poses.design, spin)
        bush = self._bush(joint, joint.at[0])
        carried = self._soft.carried.get((joint.first, joint.second, joint.at[0]), np.zeros(6))
        for which, (first, second) in enumerate(pairs):
            law = None
            if bush is not None and bush.tilt and which < _TILTING:
                # in axes that turn with the bush, where it stands; they are those of design
                back = poses.turned[joint.first][0].T
                moment = carried[3:] @ cross(back @ second[0], back @ first[0])
                law = Straight(1.0 / bush.tilt, -float(moment))
            yield self._indices(joint.first, joint.second), (first, second), law

    def _tilts(self, joint: Joint) -> Iterator[tuple[Pair, tuple[Array, Array], Law | None]]:
        """Yield what of its axis leaves that of a bush which resists tilting."""
        for bush in self._bushes(joint):
            if stiffness := bush.turning[1]:
                rows, axis = self._axes(bush, joint.first), self._axes(bush, joint.second)[:, 0]
                for across in (1, 2):
                    yield (
                        self._indices(joint.first, joint.second),
                        (rows[:, across], axis),
                        Straight(stiffness),
                    )

    def _twists(self, joint: Joint) -> Iterator[tuple[Pair, tuple[Array, ...], Law | None]]:
        """Yield the torsion of bushes that resist it."""
        for bush in self._bushes(joint):
            if stiffness := bush.turning[0]:
                first, second = self._axes(bush, joint.first), self._axes(bush, joint.second)
                yield (
                    self._indices(joint.first, joint.second),
                    (first[:, 1], first[:, 2], second[:, 1], second[:, 2]),
                    Straight(stiffness),
                )

    def _length(self, line: Line) -> tuple[Pair, tuple[Array, Array], Law]:
        poses, model = self._poses, self._poses.model
        first, second = (poses.points[point] for point in line.at)
        length = np.linalg.norm(second - first, axis=-1)
        force = poses.forces_along_lines()[line.name]
        law: Law = Coil(length, force, model.parameters["spring_rate"])
        if line.name != "spring":
            name = f"{model.suspension.STOPPED}_length"
            stroke = model.signals(poses.states, poses.inputs)[name]
            law = Stops(length, force, stroke, model.parameters)
        ends = self._arm(line.first, line.at[0]), self._arm(line.second, line.at[1])
        return self._indices(line.first, line.second), ends, law

    # -- bushes -----------------------------------------------------------------------------------

    def _bush(self, joint: Joint, point: str) -> Bush | None:
        """Return what gives way at a point of a joint, if anything does."""
        if joint is not _RACK_IN_ITS_GUIDE:
            return self._soft.bushes.get(point)
        axis = unit_vector(self._poses.model.suspension.rack.axis)
        soft = np.array([self._soft.rack, 0.0, 0.0])
        return Bush(point, np.stack(frame(axis)), soft, 0.0, (0.0, 0.0), axis, (None, None, None))

    def _bushes(self, joint: Joint) -> list[Bush]:
        found = (self._bush(joint, point) for point in joint.at)
        return [bush for bush in found if bush is not None]

    def _axes(self, bush: Bush, part: str) -> Array:
        """Return the axes of a bush as rows, which turn with a part, (n, 3, 3)."""
        turned = self._poses.turned.get(part, np.eye(3))
        rows = bush.axes @ np.swapaxes(turned, -1, -2)
        return np.broadcast_to(rows, (len(self._poses.axis), 3, 3))

    def _laws(self, bush: Bush, joint: Joint) -> list[Law | None]:
        """Return the force of a bush along each of its axes; none where it is rigid."""
        key = joint.first, joint.second, bush.point
        carried = -bush.axes @ self._soft.carried.get(key, np.zeros(6))[:3]
        found: list[Law | None] = []
        for soft, curve, force in zip(bush.soft, bush.curves, carried.tolist(), strict=True):
            if curve is not None:
                found.append(Bent(curve, curve.displacement(force)))
            else:
                found.append(Straight(1.0 / soft, force) if soft else None)
        return found

    # -- bodies -----------------------------------------------------------------------------------

    def _center(self, body: str) -> Array:
        points = self._poses.points
        if body == GROUND:
            return np.zeros_like(points["wheel_center"])
        return points["tie_rod_inner"] if body == RACK else self._poses.centers[body]

    def _arm(self, body: str, point: str) -> Array:
        """Return a hardpoint from the centre of a body, (n, 3) [m]."""
        arm: Array = self._poses.points[point] - self.start.centers[:, self.index(body)]
        return arm

    def _indices(self, first: str, second: str) -> Pair:
        return self.index(first), self.index(second)


_RACK_IN_ITS_GUIDE = Fixed(GROUND, RACK, ("tie_rod_inner",))
