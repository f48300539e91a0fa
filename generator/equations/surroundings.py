"""What a force sees of the mechanism in motion, in the steps of its kinematics."""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

from ..declare.geometry import UP
from ..declare.joints import Revolute
from ..kinematics.hinge_angles import angle_of, turning_rates
from ..kinematics.motion import from_axes, to_axes

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from ..declare.geometry import Direction, Point
    from ..declare.surroundings import Motion
    from ..program.vectors import Twist, Vector
    from .parts import Parts

Momenta = dict[tuple[str, str], "Vector"]
"""Linear momentum per unit rate, in body axes, by body and coordinate."""


class Seen:
    """The surroundings of all forces of a model; see `declare.surroundings.Surroundings`.

    Parameters
    ----------
    kin
        The bodies in motion.
    momenta
        Those of the bodies that carry mass.
    accelerations
        Of the independent coordinates; empty until they are known.
    """

    def __init__(self, kin: Parts, momenta: Momenta, accelerations: Mapping[str, sp.Expr]) -> None:
        self.kin = kin
        self.program, self.mechanism = kin.program, kin.mechanism
        self.independent, self.coordinates = kin.independent, kin.moving
        self._momenta, self._accelerations = momenta, accelerations

    # -- coordinates ------------------------------------------------------------------------------

    def coordinate(self, joint: str) -> str:
        """Return the coordinate of a driven joint."""
        return self.kin.coordinate_of(self.mechanism.joint(joint))

    def rate(self, coordinate: str) -> sp.Expr:
        """Return the rate of a coordinate."""
        return self.kin.true_rate(coordinate)

    def acceleration(self, coordinate: str) -> sp.Expr:
        """Return the acceleration of a coordinate; that of a prescribed one is in the bias."""
        return self._accelerations.get(coordinate, sp.Integer(0))

    # -- bodies -----------------------------------------------------------------------------------

    def local(self, body: str, point: Point) -> Vector:
        """Return the constant coordinates of a point, in body axes."""
        return self.kin.local(self.kin.placed[body], point)

    def direction(self, body: str, direction: Direction) -> Vector:
        """Return the constant components of a direction fixed in a body, in body axes."""
        return self.kin.local_direction(self.kin.placed[body], direction)

    def up(self, body: str) -> Vector:
        """Return the upward unit vector of the world, in body axes."""
        placed = self.kin.placed[body]
        up = to_axes(placed.axes, self.kin.of(body).design_direction(UP))
        return self.program.vector(f"{body}_up", up, "123")

    def twists(self, body: str) -> Mapping[str, Twist]:
        """Return the twist per unit rate of each coordinate that moves a body, in body axes."""
        return self.kin.placed[body].motion

    def momenta(self) -> Iterator[tuple[str, str, Vector]]:
        """Yield body, coordinate and linear momentum per unit rate, in body axes, where mass is."""
        yield from ((*key, momentum) for key, momentum in self._momenta.items())

    def height(self, body: str, local: Vector) -> sp.Expr:
        """Return the height of a point of a body in the world."""
        placed, part = self.kin.placed[body], self.kin.of(body)
        origin = placed.origin.dot(part.design_direction(UP)) + part.work_origin.z
        return origin + local.dot(self.up(body))

    def place(self, body: str, local: Vector) -> Vector:
        """Return the position of a point of a body in the world."""
        placed, part = self.kin.placed[body], self.kin.of(body)
        work = placed.origin + from_axes(placed.axes, local)
        return part.to_chassis(work) + part.work_origin

    def in_world(self, body: str, vector: Vector) -> Vector:
        """Return the components in the world of a vector in body axes."""
        return self.kin.of(body).to_chassis(from_axes(self.kin.placed[body].axes, vector))

    def rising(self, body: str, local: Vector) -> sp.Expr:
        """Return the upward acceleration of a point that the coordinates' own leave over."""
        placed = self.kin.placed[body]
        own = self.up(body).dot(self.kin.point_bias(placed, local))
        return own * self.kin.pace_of(placed) ** 2

    # -- paths ------------------------------------------------------------------------------------

    def telescope(self, joint: str) -> tuple[sp.Expr, Motion, sp.Expr]:
        """Return length of a telescope, its rate per unit rate, and its slide."""
        line = self.kin.telescopes[joint]
        return line.length, line.length_motion, self.kin.slides[joint]

    def hinge(self, joint: str) -> tuple[sp.Expr, Motion]:
        """Return the angle of a hinge, and its rate per unit rate of each coordinate."""
        hinge = self.mechanism.joint(joint)
        assert isinstance(hinge, Revolute)  # checked with the mechanism
        part = self.kin.of_joint(hinge)
        return angle_of(part, hinge), turning_rates(part, hinge)

    def between(
        self, first: tuple[str, Point], second: tuple[str, Point]
    ) -> tuple[Vector, Mapping[str, Vector]]:
        """Return the way from one point to another, and its rate per unit rate, in equal axes."""
        relative = self.kin.relative_motion(first, second)
        return relative.position, relative.motion

    def extent(self, body: str, point: Point) -> Vector:
        """Return where a point is at the design position: a measure of size."""
        return self.kin.of(body).design(point)
