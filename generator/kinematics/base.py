r"""A body that moves freely in the world, as the base of bodies that hang on it.

These are solved in the axes of the base, as on the ground, and no closed form depends on its
motion; `carried` adds the motion of the base. With R its axes in the world, ``(u, v, w)`` the
velocity of its centre of mass O and ``(p, q, r)`` its angular velocity, both in its own axes:

    r_O' = R (u, v, w),    e' = 1/2 e o (0, p, q, r) + k (1 - |e|^2) e.

The unit quaternion e = (e0, e1, e2, e3), scalar first, turns the body from design. R is that of e /
|e|, so that its columns are orthonormal for any norm, and the motion does not depend on the norm.
The second term is along e: it keeps the norm near one, against the drift of numerical integration,
and does not change the rotation.

Source: P. E. Nikravesh, Computer-Aided Analysis of Mechanical Systems, Prentice Hall, 1988 (Euler
parameters and their rates); the second term is a choice of this project.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import sympy as sp

from ..declare.states import free_states
from ..program.floors import SMALLEST
from ..program.vectors import IDENTITY, NO_TWIST, ZERO, Axes, Twist, Vector, from_axes, to_axes

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from ..declare.geometry import Point
    from ..declare.joints import Free
    from ..program.program import Program

KEEPS_NORM = sp.Integer(1)
"""Half of the rate at which the norm of the quaternion returns to one [1/s].

Slow beside any motion, so that it shortens no step, and fast beside the drift by integration.
"""

NONE = sp.Integer(0)


class Base(ABC):
    """A body that moves in the world and carries others."""

    program: Program  # has the steps
    axes: Axes  # axes in the world; at design those of the world

    @property
    @abstractmethod
    def body(self) -> str:
        """Its name."""

    @property
    @abstractmethod
    def point(self) -> Point:
        """Its centre of mass."""

    @property
    def center(self) -> Vector:
        """Its centre of mass at design."""
        return self.point.position

    @property
    @abstractmethod
    def position(self) -> Vector:
        """Position of its centre of mass in the world."""

    @property
    @abstractmethod
    def velocity(self) -> Vector:
        """Velocity of its centre of mass, in its own axes."""

    @property
    @abstractmethod
    def omega(self) -> Vector:
        """Its angular velocity, in its own axes."""

    @property
    @abstractmethod
    def twists(self) -> Mapping[str, Twist]:
        """The twist of its centre of mass per unit rate of each coordinate, in its own axes."""

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Names of the coordinates that move it."""
        return tuple(self.twists)

    @property
    def turns(self) -> bool:
        """Whether it turns in the world."""
        return not all(twist.angular.is_zero for twist in self.twists.values())

    @property
    @abstractmethod
    def bias(self) -> Twist:
        """Rate of its twist in its own axes, without accelerations of the coordinates."""

    def shares(self, wrench: Twist) -> dict[str, sp.Expr]:
        """Return the power of a wrench at its centre of mass per unit rate of each coordinate."""
        return {k: twist.dot(wrench) for k, twist in self.twists.items()}

    # -- world and base ---------------------------------------------------------------------------

    def to_world(self, v: Vector) -> Vector:
        """Return the components in the world of a vector in its axes."""
        return from_axes(self.axes, v)

    def from_world(self, v: Vector) -> Vector:
        """Return the components in its axes of a vector in the world."""
        return to_axes(self.axes, v)

    def place(self, at: Vector) -> Vector:
        """Return the position in the world of a point, given by its design position."""
        return self.position + self.to_world(at - self.center)


@dataclass(frozen=True)
class FreeBase(Base):
    """A body that moves freely, in the world."""

    program: Program
    joint: Free  # free joint
    axes: Axes
    speed_of: Callable[[str], sp.Expr]  # returns the speed of one of its coordinates

    @classmethod
    def of(cls, program: Program, joint: Free, speed_of: Callable[[str], sp.Expr]) -> FreeBase:
        """Append the axes of a body, from its quaternion."""
        body = joint.second.name
        program.section(f"{body}: free in the world")
        _, _, _, *names = (entry.name for entry in free_states(joint).positions)
        e0, e1, e2, e3 = map(sp.Symbol, names)
        squared = program.guarded(
            f"{body}_quaternion_squared",
            e0 * e0 + e1 * e1 + e2 * e2 + e3 * e3,
            f"the quaternion of {body} is zero and turns it nowhere",
            "1",
            SMALLEST,
        )
        twice = program.define(f"{body}_twice", 2 / squared)
        x, y, z = program.vector(f"{body}_twice_e", Vector(e1, e2, e3) * twice, "123")
        xx, xy, xz, yy, yz, zz = (
            program.define(f"{body}_e{i}{j}", one * other)
            for i, j, one, other in (
                (1, 1, e1, x), (1, 2, e1, y), (1, 3, e1, z),
                (2, 2, e2, y), (2, 3, e2, z), (3, 3, e3, z),
            )
        )  # fmt: skip
        wx, wy, wz = (program.define(f"{body}_e0{i}", e0 * e) for i, e in ((1, x), (2, y), (3, z)))
        columns = (
            Vector(1 - yy - zz, xy + wz, xz - wy),
            Vector(xy - wz, 1 - xx - zz, yz + wx),
            Vector(xz + wy, yz - wx, 1 - xx - yy),
        )
        axes = program.axes((f"{body}_forward", f"{body}_left", f"{body}_up"), columns)
        return cls(program, joint, axes, speed_of)

    @property
    def body(self) -> str:
        return self.joint.second.name

    @cached_property
    def _positions(self) -> list[sp.Symbol]:
        return [sp.Symbol(entry.name) for entry in free_states(self.joint).positions]

    @property
    def _speeds(self) -> dict[str, sp.Expr]:
        return {k: self.speed_of(k) for k in self.coordinates}

    @property
    def point(self) -> Point:
        return self.joint.second.center

    @cached_property
    def twists(self) -> Mapping[str, Twist]:
        """Three velocities, then three angular velocities."""
        six = (*(Twist(ZERO, e) for e in IDENTITY), *(Twist(e, ZERO) for e in IDENTITY))
        return dict(zip(free_states(self.joint).coordinates, six, strict=True))

    @property
    def bias(self) -> Twist:
        """Zero: its speeds are in its own axes."""
        return NO_TWIST

    @property
    def position(self) -> Vector:
        x, y, z = self._positions[:3]
        return self.center + Vector(x, y, z)

    @property
    def velocity(self) -> Vector:
        return Vector(*list(self._speeds.values())[:3])

    @property
    def omega(self) -> Vector:
        return Vector(*list(self._speeds.values())[3:])

    # -- positions and speeds ---------------------------------------------------------------------

    def directions(self) -> dict[str, dict[sp.Symbol, sp.Expr]]:
        """Return the columns of N(q): rates of the positions per unit of each speed."""
        x, y, z, e0, e1, e2, e3 = self._positions
        half = sp.Rational(1, 2)
        moved = ({x: a.x, y: a.y, z: a.z} for a in self.axes)
        turned = (
            {e0: -half * e1, e1: half * e0, e2: half * e3, e3: -half * e2},
            {e0: -half * e2, e1: -half * e3, e2: half * e0, e3: half * e1},
            {e0: -half * e3, e1: half * e2, e2: -half * e1, e3: half * e0},
        )
        return dict(zip(self.coordinates, (*moved, *turned), strict=True))

    def rates(self) -> dict[str, sp.Expr]:
        """Return the rates of its positions, by their names."""
        columns, speeds = self.directions(), self._speeds
        body, quaternion = self.body, self._positions[3:]
        squared = sum((e * e for e in quaternion), NONE)
        norm = self.program.define(f"{body}_norm_rate", KEEPS_NORM * (1 - squared))
        found = {}
        for s in self._positions:
            rate = sum((columns[k].get(s, NONE) * v for k, v in speeds.items()), NONE)
            back = norm * s if s in quaternion else NONE
            found[s.name] = self.program.define(f"{s}_rate", rate + back)
        return found

    def reported(self, kind: str) -> sp.Expr:
        """Return a displacement or an angle of its joint, as reports have it."""
        (x, y, z, *_), (forward, left, up) = self._positions, self.axes
        return {
            "x": lambda: x,
            "y": lambda: y,
            "z": lambda: z,
            "yaw": lambda: sp.atan2(forward.y, forward.x),
            "pitch": lambda: sp.atan2(-forward.z, sp.sqrt(left.z**2 + up.z**2)),
            "roll": lambda: sp.atan2(left.z, up.z),
        }[kind]()
