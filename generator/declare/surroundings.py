"""Surroundings of a force: the mechanism in motion."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    import sympy as sp

    from ..program.program import Program
    from ..program.vectors import Twist, Vector
    from .geometry import Direction, Point
    from .whole import Whole

Motion = dict[str, "sp.Expr"]
"""The rate of a quantity per unit rate of each coordinate that changes it."""


class UnseenError(LookupError):
    """A force asks for a thing that does not exist."""

    def __str__(self) -> str:
        """Return the request, and the possible ones."""
        return str(self.args[0])


class Surroundings(Protocol):
    """The moving mechanism for a force: positions, twists and directions of bodies, as expressions.

    Vectors are in the axes of the named body, or in those of the world: x forward, y left, z up.
    Axes of a body that hangs on a rotating base, such as the body of a car, are those of the base.
    Twists are linear and angular velocities. Coordinates are the independent and the prescribed
    ones; "per unit rate" means divided by the rate of a coordinate. Bodies, joints and coordinates
    are given by their names; for an unknown name, `UnseenError` lists the known ones.
    """

    @property
    def program(self) -> Program:
        """The program that receives the steps."""

    @property
    def mechanism(self) -> Whole:
        """The mechanism."""

    @property
    def independent(self) -> Sequence[str]:
        """Names of the independent coordinates."""

    @property
    def coordinates(self) -> Sequence[str]:
        """Names of all coordinates that move."""

    # -- coordinates --

    def coordinate(self, joint: str) -> str:
        """Return the coordinate of a driven joint: one that is independent or prescribed.

        A joint that follows it through gears has none of its own: `hinge` and `guide` return its
        rate per unit rate of that coordinate.
        """

    def rate(self, coordinate: str) -> sp.Expr:
        """Return the rate of a coordinate."""

    def acceleration(self, coordinate: str) -> sp.Expr:
        """Return the acceleration of a coordinate, for signals: `Force.act` may not read it.

        That of a prescribed coordinate is an input, and zero here.
        """

    # -- bodies --

    def local(self, body: str, point: Point) -> Vector:
        """Return the vector from the origin of a body to its point, in its axes.

        Parameters
        ----------
        body, point
            The body, and the point by its place at the design position.
        """

    def direction(self, body: str, direction: Direction) -> Vector:
        """Return the components of a direction fixed in a body, in its axes.

        Parameters
        ----------
        body, direction
            The body, and the direction at the design position.
        """

    def line(self, body: str, direction: Direction, follows: bool) -> Vector:
        """Return a unit vector in the axes of a body, fixed in it if it follows, or in the world.

        Parameters
        ----------
        body, direction
            The body, and the direction at the design position.
        follows
            Whether it is fixed in the body, else in the world.
        """

    def up(self, body: str) -> Vector:
        """Return the upward unit vector of the world, in the axes of a body."""

    def twists(self, body: str) -> Mapping[str, Twist]:
        """Return the twist per unit rate of each coordinate that moves a body, in its axes."""

    def momenta(self) -> Iterator[tuple[str, str, Vector]]:
        """Yield body with mass, coordinate and linear momentum per unit rate, in body axes."""

    def height(self, body: str, local: Vector) -> sp.Expr:
        """Return the height of a point of a body in the world.

        Parameters
        ----------
        body, local
            The body, and the point in its axes.
        """

    def place(self, body: str, local: Vector) -> Vector:
        """Return the position of a point of a body in the world.

        Parameters
        ----------
        body, local
            The body, and the point in its axes.
        """

    def in_world(self, body: str, vector: Vector) -> Vector:
        """Return the components in the world of a vector in the axes of a body.

        Parameters
        ----------
        body, vector
            The body, and a vector in its axes.
        """

    def rising(self, body: str, local: Vector) -> sp.Expr:
        """Return the upward acceleration of a point at constant rates of the coordinates.

        Parameters
        ----------
        body, local
            The body, and the point in its axes.
        """

    # -- paths --

    def telescope(self, joint: str) -> tuple[sp.Expr, Motion, sp.Expr]:
        """Return length of a telescope, its rate per unit rate, and its slide."""

    def hinge(self, joint: str) -> tuple[sp.Expr, Motion]:
        """Return the angle of a hinge, and its rate per unit rate of each coordinate."""

    def guide(self, joint: str) -> tuple[sp.Expr, Motion]:
        """Return the slide of a guide, and its rate per unit rate of each coordinate."""

    def between(
        self, first: tuple[str, Point], second: tuple[str, Point]
    ) -> tuple[Vector, Mapping[str, Vector]]:
        """Return the vector from one point to another, and its rate per unit rate, in equal axes.

        Parameters
        ----------
        first, second
            Body and point at either end.
        """

    def extent(self, body: str, point: Point) -> Vector:
        """Return the design position of a point: a measure of size.

        Parameters
        ----------
        body, point
            The body, and the point by its place at the design position.
        """
