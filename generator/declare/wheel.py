"""Wheels: position, and the signals of attitude and motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import sympy as sp

from ..program.floors import DIRECTION
from ..program.functions import SignOf
from ..program.vectors import Vector
from .bodies import Body
from .declared import declared
from .geometry import FORWARD, Direction, Point
from .shown import Shown

if TYPE_CHECKING:
    from collections.abc import Iterator

    from .joints import Revolute
    from .surroundings import Surroundings


@dataclass(frozen=True)
class WheelAttitude:
    """Position and attitude of a wheel on the ground, in the axes of its carrier."""

    # unit vectors up and along the spin axis
    up: Vector
    axis: Vector
    # part of the upward direction in the plane of the wheel; its length is the cosine of the camber
    pull: Vector
    squared: sp.Expr  # square of that length, guarded


@declared
@dataclass(frozen=True)
class Wheel:
    """A wheel that may spin, with or without a tyre.

    Parameters
    ----------
    carrier
        Body that carries the wheel's bearing.
    center
        The wheel centre.
    spin
        Direction of the spin axis, fixed in the carrier; it points to the left of the vehicle, so
        that the wheel rolls forward with a positive rate.
    heading
        Body whose x axis, projected on the ground, is the reference of camber, toe and steer;
        without it, that of the world.
    """

    carrier: Body
    center: Point
    spin: Direction
    heading: Body | None = None

    turns_about: ClassVar[tuple[str, ...]] = ("spin",)

    @property
    def _body(self) -> str:
        return self.carrier.name

    def bearing_problems(self, hinge: Revolute) -> list[str]:
        """Return the reasons why a hinge is not the wheel's bearing on its carrier."""
        problems = []
        if hinge.first.name != self._body:
            problems.append(
                f"hinge {hinge.name!r} leads from {hinge.first.name!r}, and the wheel is carried "
                f"by {self._body!r}; give the wheel's bearing"
            )
        if hinge.axis.towards != self.spin or hinge.angle_to is not None:
            problems.append(
                f"hinge {hinge.name!r} does not turn about the wheel's spin axis "
                f"{self.spin.name!r}; give its bearing the same Direction, and no angle_to"
            )
        return problems

    def velocity(self, at: Surroundings, coordinate: str) -> Vector:
        """Return the velocity of the centre per unit rate, in the carrier's axes.

        Parameters
        ----------
        at
            Surroundings of the wheel.
        coordinate
            The coordinate.
        """
        twist, center = at.twists(self._body)[coordinate], at.local(self._body, self.center)
        return at.program.vector(
            f"{self._body}_wheel_velocity_{coordinate}",
            twist.linear + twist.angular.cross(center),
            "123",
        )

    def upright(self, at: Surroundings, prefix: str) -> WheelAttitude:
        """Append position and attitude of the wheel; names of steps begin with the prefix.

        Parameters
        ----------
        at
            Surroundings of the wheel.
        prefix
            Prefix of the names of the steps.
        """
        program, up = at.program, at.up(self._body)
        axis = at.direction(self._body, self.spin)
        lean = program.define(f"{prefix}wheel_axis_up", axis.dot(up))
        pull = program.vector(f"{prefix}tyre_pull", up - axis * lean, "123")
        # not 1 - lean^2: for a wheel that lies flat, rounding could leave a positive value
        squared = program.guarded(
            f"{prefix}cos_camber_squared",
            pull.dot(pull),
            "the wheel lies flat on the road",
            "1",
            DIRECTION,
        )
        return WheelAttitude(up, axis, pull, squared)

    def signals(self, at: Surroundings, prefix: str) -> Iterator[Shown]:
        """Yield the signals of position, attitude and motion of the wheel, with a prefix.

        Parameters
        ----------
        at
            Surroundings of the wheel.
        prefix
            Prefix of the names of the signals.
        """
        yield from self._motion(at, prefix)
        yield from self._angles(at, prefix)

    def _motion(self, at: Surroundings, prefix: str) -> Iterator[Shown]:
        center, up = at.local(self._body, self.center), at.up(self._body)
        for axis, value in zip("xyz", at.place(self._body, center), strict=True):
            yield Shown(f"{prefix}wheel_center_{axis}", value, "m", f"wheel centre, {axis}")
        velocity = acceleration = sp.Integer(0)
        for k in at.twists(self._body):
            share = up.dot(self.velocity(at, k))
            velocity += share * at.rate(k)
            acceleration += share * at.acceleration(k)
        acceleration += at.rising(self._body, center)
        yield Shown(
            f"{prefix}wheel_velocity",
            velocity,
            "m/s",
            "vertical velocity of the wheel centre, positive up",
        )
        yield Shown(
            f"{prefix}wheel_acceleration",
            acceleration,
            "m/s^2",
            "vertical acceleration of the wheel centre, positive up",
        )

    def _angles(self, at: Surroundings, prefix: str) -> Iterator[Shown]:
        axis = at.in_world(self._body, at.direction(self._body, self.spin))
        if self.heading is not None:
            axis = self._ahead(at, prefix, self.heading.name, axis)
        a = at.program.vector(f"{prefix}spin_axis_now", axis)
        side = at.program.define(f"{prefix}wheel_side", SignOf(self.center.position.y))
        camber, toe = sp.atan2(-side * a.z, a.y), sp.atan2(side * a.x, a.y)
        top = "camber, positive with the top of the wheel outboard"
        yield Shown(f"{prefix}camber", camber, "rad", top)
        yield Shown(f"{prefix}toe", toe, "rad", "toe angle, positive toe-in")
        steer = sp.atan2(-a.x, a.y)
        yield Shown(f"{prefix}steer", steer, "rad", "steer angle, positive to the left")

    @staticmethod
    def _ahead(at: Surroundings, prefix: str, body: str, vector: Vector) -> Vector:
        """Return a vector in axes that have turned about the vertical with a body."""
        ahead = at.in_world(body, at.direction(body, FORWARD))
        level = at.program.define(
            f"{prefix}heading_level", sp.sqrt(ahead.x * ahead.x + ahead.y * ahead.y)
        )
        cosine, sine = ahead.x / level, ahead.y / level
        return Vector(
            vector.x * cosine + vector.y * sine, vector.y * cosine - vector.x * sine, vector.z
        )
