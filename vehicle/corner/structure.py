"""The joints of a suspension, and its forces along lines.

A joint has the forces and moments that it can carry as unit loads on its second part; those on the
first part are opposite. Arrays have any leading dimensions, one element for each position.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from ...core.named_types import Array
from ...core.vectors import cross, directions

Points = Mapping[str, Array]

GROUND = ("chassis", "rack", "relay_rod", "pitman_arm")
"""Parts that do not move under loads."""

FORCES_OF_A_DAMPER = ("damper_force", "friction_force", "bump_stop_force", "rebound_stop_force")
"""Signals of the forces along a damper, which not all equations have."""


@dataclass(frozen=True)
class PartJoint(ABC):
    """A joint of two parts at hardpoints."""

    first: str
    second: str
    at: tuple[str, ...]  # hardpoints

    RULE: ClassVar[str] = ""
    """The assumption that resolves its statical indeterminacy, if any."""

    @abstractmethod
    def unit_loads(self, points: Points, turned: Mapping[str, Array], design: Points) -> Array:
        """Return the loads that the joint can carry, (..., touching points, 6, unknowns).

        They are force and moment on the second part at each point. `points` are hardpoints by name,
        (..., 3) [m], `turned` rotations of the parts from design, (..., 3, 3), `design` hardpoints
        at design, (3,) [m].
        """

    def axis(self, points: Points) -> Array | None:
        """Return the default axis of its bushes, if any."""
        return None

    def tensions(self, points: Points) -> Array:
        """Return the self-equilibrated loads of the joint, (..., touching points, 6, tensions)."""
        return np.zeros((*points[self.at[0]].shape[:-1], len(self.at), 6, 0))

    def directions(self, points: Points) -> Array:
        """Return the constrained directions of its points, (..., k, 3)."""
        return np.broadcast_to(np.eye(3), (*points[self.at[0]].shape[:-1], 3, 3))

    def right_angles(
        self, points: Points, turned: Mapping[str, Array], design: Points, spin: Array
    ) -> list[tuple[Array, Array]]:
        """Return directions of the first and of the second part that remain normal to each other.

        Arguments are as in `unit_loads`; `spin` is the spin axis of the wheel at design, (3,).
        """
        return []


@dataclass(frozen=True)
class SphericalJoint(PartJoint):
    """A ball joint, with a force."""

    end: str = ""  # other end of a rod that ends at the joint, if any

    def axis(self, points: Points) -> Array | None:
        """Return the axis of the rod."""
        return directions(points[self.end] - points[self.at[0]]) if self.end else None

    def unit_loads(self, points: Points, turned: Mapping[str, Array], design: Points) -> Array:
        """Return the three forces."""
        return _spread(np.eye(6)[:, :3], points[self.at[0]])


class FixedJoint(PartJoint):
    """A rigid connection, such as a wheel bearing with closed brake, with force and moment."""

    def unit_loads(self, points: Points, turned: Mapping[str, Array], design: Points) -> Array:
        """Return three forces and three moments."""
        return _spread(np.eye(6), points[self.at[0]])

    def right_angles(
        self, points: Points, turned: Mapping[str, Array], design: Points, spin: Array
    ) -> list[tuple[Array, Array]]:
        """Return the spin axis with both directions normal to it, and these two."""
        shape = points[self.at[0]].shape
        along, across, other = (
            np.broadcast_to(turned.get(self.first, np.eye(3)) @ direction, shape)
            for direction in frame(spin)
        )
        return [(along, across), (along, other), (across, other)]


@dataclass(frozen=True)
class UniversalJoint(PartJoint):
    """A universal joint, with a force, and a moment normal to both of its axes."""

    shaft: str  # other end of the second part
    first_axis: tuple[float, float, float]  # axis in the first part, at design

    def axis(self, points: Points) -> Array | None:
        """Return the axis of the shaft."""
        return directions(points[self.shaft] - points[self.at[0]])

    def unit_loads(self, points: Points, turned: Mapping[str, Array], design: Points) -> Array:
        """Return three forces and a moment."""
        (center,) = self.at
        loads = np.zeros((*points[center].shape[:-1], 1, 6, 4))
        loads[..., 0, :3, :3] = np.eye(3)
        loads[..., 0, 3:, 3] = directions(cross(*self._axes(turned, design)))
        return loads

    def right_angles(
        self, points: Points, turned: Mapping[str, Array], design: Points, spin: Array
    ) -> list[tuple[Array, Array]]:
        """Return its axes."""
        first, second = self._axes(turned, design)
        return [(np.broadcast_to(directions(first), second.shape), directions(second))]

    def _axes(self, turned: Mapping[str, Array], design: Points) -> tuple[Array, Array]:
        first, (center,) = np.array(self.first_axis), self.at
        second = cross(design[self.shaft] - design[center], first)
        return turned.get(self.first, np.eye(3)) @ first, turned[self.second] @ second


class HingeJoint(PartJoint):
    """Two bearings on an axis, with forces normal to it at each, and equal forces along it."""

    RULE = "two bearings on an axis share the force along it equally"

    def axis(self, points: Points) -> Array | None:
        """Return the axis through both bearings."""
        return directions(points[self.at[1]] - points[self.at[0]])

    def unit_loads(self, points: Points, turned: Mapping[str, Array], design: Points) -> Array:
        """Return two forces normal to the axis at each bearing, and one along it at both."""
        along, across, other = frame(points[self.at[1]] - points[self.at[0]])
        loads = np.zeros((*along.shape[:-1], 2, 6, 5))
        for bearing in (0, 1):
            loads[..., bearing, :3, 2 * bearing] = across
            loads[..., bearing, :3, 2 * bearing + 1] = other
            loads[..., bearing, :3, 4] = 0.5 * along
        return loads

    def tensions(self, points: Points) -> Array:
        """Return a force along the axis at one bearing, and its opposite at the other."""
        along, _, _ = frame(points[self.at[1]] - points[self.at[0]])
        loads = np.zeros((*along.shape[:-1], 2, 6, 1))
        loads[..., 0, :3, 0], loads[..., 1, :3, 0] = along, -along
        return loads


@dataclass(frozen=True)
class TelescopeJoint(PartJoint):
    """A tube and a rod, with forces and moments normal to their axis, about a point on it."""

    end: str  # another point on the axis

    RULE = "the moment of a telescope is about its lower end"

    def axis(self, points: Points) -> Array | None:
        """Return the axis of sliding."""
        return directions(points[self.end] - points[self.at[0]])

    def unit_loads(self, points: Points, turned: Mapping[str, Array], design: Points) -> Array:
        """Return two forces and two moments."""
        (center,) = self.at
        _, across, other = frame(points[self.end] - points[center])
        loads = np.zeros((*across.shape[:-1], 1, 6, 4))
        for rows in (slice(0, 3), slice(3, 6)):
            column = 0 if rows.start == 0 else 2
            loads[..., 0, rows, column] = across
            loads[..., 0, rows, column + 1] = other
        return loads

    def directions(self, points: Points) -> Array:
        return np.stack(frame(points[self.end] - points[self.at[0]])[1:], axis=-2)

    def right_angles(
        self, points: Points, turned: Mapping[str, Array], design: Points, spin: Array
    ) -> list[tuple[Array, Array]]:
        """Return both directions normal to its axis with the axis."""
        along, across, other = frame(points[self.end] - points[self.at[0]])
        return [(across, along), (other, along)]


@dataclass(frozen=True)
class LineForce:
    """A force on two parts along the line of two hardpoints: of a spring, a damper, a stop."""

    name: str  # 'spring' or 'damper', followed by a side if there are two
    # signals or inputs of the equations whose sum is the force, positive when it pushes; missing
    # ones are zero
    signals: tuple[str, ...]
    first: str
    second: str
    at: tuple[str, str]  # hardpoints, of the first part and of the second one

    @property
    def is_spring(self) -> bool:
        """Whether it is a spring; otherwise it is a damper with its stops."""
        return self.name.startswith("spring")

    def direction(self, points: Points) -> Array:
        """Return the unit vector from the first to the second point, (..., 3)."""
        return directions(points[self.at[1]] - points[self.at[0]])


@dataclass(frozen=True)
class Structure:
    """The joints and force elements between the parts of a suspension."""

    joints: Sequence[PartJoint]
    lines: Sequence[LineForce]  # springs and dampers
    # points on the chassis that belong to a mount at another point
    mounted: Mapping[str, str] = field(default_factory=dict)

    @property
    def parts(self) -> tuple[str, ...]:
        """The moving parts."""
        found = dict.fromkeys(part for j in self.joints for part in (j.first, j.second))
        return tuple(part for part in found if part not in GROUND)

    @property
    def springs(self) -> tuple[str, ...]:
        """The names of the springs."""
        return tuple(line.name for line in self.lines if line.is_spring)

    @property
    def dampers(self) -> tuple[str, ...]:
        """The names of the dampers, with their stops."""
        return tuple(line.name for line in self.lines if not line.is_spring)

    @property
    def rules(self) -> tuple[str, ...]:
        """The assumptions that resolve statical indeterminacy."""
        return tuple(dict.fromkeys(joint.RULE for joint in self.joints if joint.RULE))


def steered(*joints: PartJoint, by: str) -> tuple[PartJoint, ...]:
    """Return joints with those of every steered wheel: tie rod and wheel bearing.

    `by` is the part that the tie rod is joined to.
    """
    return (
        *joints,
        SphericalJoint("knuckle", "tie_rod", ("tie_rod_outer",), "tie_rod_inner"),
        UniversalJoint(by, "tie_rod", ("tie_rod_inner",), "tie_rod_outer", (0.0, 0.0, 1.0)),
        FixedJoint("knuckle", "wheel", ("wheel_center",)),
    )


def _spread(loads: Array, point: Array) -> Array:
    """Return loads at one point for every position."""
    return np.broadcast_to(loads, (*point.shape[:-1], 1, *loads.shape))


def frame(axis: Array) -> tuple[Array, Array, Array]:
    """Return a unit vector along an axis, (..., 3), and two normal to it."""
    along = directions(axis)
    # the chassis axis with the largest angle to it
    aside = np.eye(3)[np.abs(along).argmin(axis=-1)]
    across = directions(cross(along, aside))
    return along, across, cross(along, across)
