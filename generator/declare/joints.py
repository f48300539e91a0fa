"""Joints: their degrees of freedom, and their constraints on the two bodies.

Each joint names its relative coordinates (`coordinates`). The sense of a coordinate is that of the
motion of the second body relative to the first, along or about the axis of the joint.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar, Literal

from .bodies import Body
from .declared import DeclarationError, Name, declared
from .geometry import FORWARD, UP, Direction, Line, Point
from .parameters import Distance, Parameter
from .world import WORLD


@declared
@dataclass(frozen=True)
class Joint:
    """A joint between two bodies: the base of all joints.

    Parameters
    ----------
    name
        Name of the joint in reports and messages.
    first, second
        The two bodies; coordinates are those of the second relative to the first.
    """

    name: Name
    first: Body
    second: Body

    kind: ClassVar[str]
    common: ClassVar[str]
    coordinates: ClassVar[tuple[str, ...]]
    turns_about: ClassVar[tuple[str, ...]] = ()
    """Fields that hold axes of rotation."""

    def __post_init__(self) -> None:
        problems = []
        if self.first == self.second:
            problems = [f"it connects {self.first.name!r} with itself; give two bodies"]
        problems += _gear_problems(self)
        if problems:
            raise DeclarationError(f"{type(self).__name__} {self.name!r}", problems)

    @property
    def freedoms(self) -> int:
        """Number of degrees of freedom that the joint leaves."""
        return len(self.coordinates)

    @property
    def shared(self) -> str:
        """Its constraint, and the gear that it follows, for a table."""
        return f"{self.common}; {self.gear_words}" if self.gear else self.common

    @property
    def gear_words(self) -> str:
        """Its coordinate in terms of the gear that it follows, in words."""
        assert self.gear is not None
        own, (kind,) = self.coordinates[0], self.gear.joint.coordinates
        return f"{own} = {self.gear.ratio.name} x {kind} of {self.gear.joint.name}"

    @property
    def gear(self) -> Gear | None:
        """The gear that its coordinate follows, or None."""
        return getattr(self, "follows", None)

    @property
    def first_followed(self) -> Joint:
        """The joint that it follows, through all gears between; itself without a gear."""
        return self if self.gear is None else self.gear.joint.first_followed

    @property
    def bodies(self) -> tuple[str, str]:
        """Names of the two bodies."""
        return self.first.name, self.second.name

    @property
    def center(self) -> Point | None:
        """The point that both bodies share in every motion, or None."""
        return None

    def _coordinate(self, kind: str, name: str, meaning: str) -> RelativeCoordinate:
        return RelativeCoordinate(name, self, kind, meaning)

    def other(self, body: str) -> str:
        """Return the name of the body at the other side."""
        first, second = self.bodies
        return second if body == first else first


@declared
@dataclass(frozen=True)
class Gear:
    """A gear: the coordinate of a joint in a constant ratio to that of another joint.

    Examples are gear wheels, a rack and pinion, a screw thread and a belt.

    A hinge or guide with this gear as `follows` has no degree of freedom of its own. Both
    coordinates count from the design position, so a hinge at either end may have no ``angle_to``.
    There is no slip and no play, and the forces between the teeth do no work.

    Parameters
    ----------
    joint
        The hinge or guide that is followed: independent, prescribed, or one that follows another.
    ratio
        The coordinate of the joint that follows, divided by that of the other: a `Ratio` between
        two hinges or two guides, a `Lead` [m/rad] for a guide that follows a hinge, a
        `TurnPerTravel` [rad/m] for a hinge that follows a guide.
    """

    joint: Joint
    ratio: Parameter


class TurningJoint(Joint):
    """A joint whose coordinate is an angle."""

    def angle(self, name: Name, meaning: str) -> RelativeCoordinate:
        """Return its angle as a relative coordinate [rad].

        Parameters
        ----------
        name, meaning
            Of the coordinate: its name, and its description in the documentation of the code.
        """
        return self._coordinate("angle", name, meaning)


class SlidingJoint(Joint):
    """A joint whose coordinate is a slide."""

    def slide(self, name: Name, meaning: str) -> RelativeCoordinate:
        """Return its slide as a relative coordinate [m].

        Parameters
        ----------
        name, meaning
            Of the coordinate: its name, and its description in the documentation of the code.
        """
        return self._coordinate("slide", name, meaning)


@declared
@dataclass(frozen=True)
class Revolute(TurningJoint):
    """A hinge: one rotation about a line; its coordinate is an angle [rad].

    Parameters
    ----------
    name
        Name of the joint.
    first, second
        The two bodies; the coordinates are those of the second relative to the first.
    axis
        The hinge line; positive rotation of the second body is right-handed about it.
    angle_from, angle_to
        The angle is measured across the axis, from a direction fixed in the first body to a point
        of the second body. It lies between 0 and pi at the design position: where the axis as
        declared would make it negative, the axis is reversed. Without ``angle_to`` the angle is
        zero at the design position, the axis is as declared, and ``angle_from`` is ignored.
    follows
        A gear that gives its angle.
    """

    axis: Line
    angle_from: Direction = UP
    angle_to: Point | None = None
    follows: Gear | None = None

    kind: ClassVar[str] = "revolute"
    common: ClassVar[str] = "an axis"
    coordinates: ClassVar[tuple[str, ...]] = ("angle",)
    unit: ClassVar[str] = "rad"
    force_unit: ClassVar[str] = "N m"
    turns_about: ClassVar[tuple[str, ...]] = ("axis",)


@declared
@dataclass(frozen=True)
class Prismatic(SlidingJoint):
    """A guide: one displacement along a direction, zero at the design position [m].

    Between two links that are pinned to other bodies in the same plane it is a telescope, such as a
    hydraulic cylinder. Its line may lead from pin to pin (`between` of `Direction`), or beside
    them.

    Parameters
    ----------
    name
        Name of the joint.
    first, second
        The two bodies; the coordinates are those of the second relative to the first.
    direction
        The slide is positive when the second body moves along it.
    follows
        A gear that gives its slide.
    """

    direction: Direction
    follows: Gear | None = None

    kind: ClassVar[str] = "prismatic"
    common: ClassVar[str] = "a direction, without rotation"
    coordinates: ClassVar[tuple[str, ...]] = ("slide",)
    unit: ClassVar[str] = "m"
    force_unit: ClassVar[str] = "N"


@declared
@dataclass(frozen=True)
class Cylindrical(TurningJoint, SlidingJoint):
    """A telescope: displacement along [m] and rotation about [rad] a common line.

    Parameters
    ----------
    name
        Name of the joint.
    first, second
        The two bodies; the coordinates are those of the second relative to the first.
    axis
        The line, from a point of the second body to a point of the first. The slide is positive
        when the second body moves along it, that is, when the telescope shortens.
    length_at_zero_slide
        Distance between the two points at which the displacement counts as zero [m].
    angle_to
        Point of the second body that defines its rotation about the axis.
    """

    axis: Line
    length_at_zero_slide: Distance
    angle_to: Point

    kind: ClassVar[str] = "cylindrical"
    common: ClassVar[str] = "an axis"
    coordinates: ClassVar[tuple[str, ...]] = ("slide", "angle")


@declared
@dataclass(frozen=True)
class Universal(Joint):
    """A universal joint: a cross of two perpendicular axes through a point.

    Parameters
    ----------
    name
        Name of the joint.
    first, second
        The two bodies; the coordinates are those of the second relative to the first.
    at
        The centre.
    shaft
        Line of the second body through the centre. The second axis of the cross is fixed in the
        second body, perpendicular to its shaft and, at the design position, to the first axis.
    first_axis
        Direction fixed in the first body.

    Notes
    -----
    The two angles in reports are those of the shaft relative to the first body, in the z-x sequence
    of the paper: the y axis of ``Rz(azimuth) Rx(elevation)`` lies along the shaft. They are not
    those of the cross, which stays regular where this sequence is singular (shaft along z).
    """

    at: Point
    shaft: Line
    first_axis: Direction = FORWARD

    kind: ClassVar[str] = "universal"
    common: ClassVar[str] = "a point, and two perpendicular axes"
    coordinates: ClassVar[tuple[str, ...]] = ("azimuth", "elevation")

    @property
    def center(self) -> Point:
        return self.at

    def azimuth(self, name: Name, meaning: str) -> RelativeCoordinate:
        """Return its shaft's azimuth as a relative coordinate [rad].

        Parameters
        ----------
        name, meaning
            Of the coordinate: its name, and its description in the documentation of the code.
        """
        return self._coordinate("azimuth", name, meaning)

    def elevation(self, name: Name, meaning: str) -> RelativeCoordinate:
        """Return its shaft's elevation as a relative coordinate [rad].

        Parameters
        ----------
        name, meaning
            Of the coordinate: its name, and its description in the documentation of the code.
        """
        return self._coordinate("elevation", name, meaning)


@declared
@dataclass(frozen=True)
class Weld(Joint):
    """A rigid connection: the second body moves with the first, as a caliper with its knuckle.

    The second body has its own mass, and its own points for forces and outputs. Joints to other
    bodies are declared at the first body.

    Parameters
    ----------
    name
        Name of the joint.
    first, second
        The two bodies; the coordinates are those of the second relative to the first.
    """

    kind: ClassVar[str] = "weld"
    common: ClassVar[str] = "everything"
    coordinates: ClassVar[tuple[str, ...]] = ()


@declared
@dataclass(frozen=True)
class Free(Joint):
    """No constraint: a body moves freely in the world, with six degrees of freedom.

    The body is ``second``; ``first`` is the world. The state has the displacement of its centre of
    mass from design in the world, ``<body>_x`` to ``_z`` [m], and its unit quaternion,
    ``<body>_e0`` to ``_e3``, scalar first; then its velocity ``<body>_u``, ``_v``, ``_w`` [m/s] and
    its angular velocity ``<body>_p``, ``_q``, ``_r`` [rad/s] in its own axes, which are those of
    the world at design. Reported coordinates are that displacement, and the angles of the body in
    the z-y-x sequence (yaw, pitch, roll).
    """

    first: Body = field(default=WORLD, init=False)

    kind: ClassVar[str] = "free"
    common: ClassVar[str] = "nothing"
    coordinates: ClassVar[tuple[str, ...]] = ("x", "y", "z", "yaw", "pitch", "roll")

    def coordinate(
        self, kind: Literal["x", "y", "z", "yaw", "pitch", "roll"], name: Name, meaning: str
    ) -> RelativeCoordinate:
        """Return one of its coordinates as a relative coordinate [m or rad].

        Parameters
        ----------
        kind
            Kind of the coordinate.
        name, meaning
            Of the coordinate: its name, and its description in the documentation of the code.
        """
        return self._coordinate(kind, name, meaning)


@declared
@dataclass(frozen=True)
class Spherical(Joint):
    """A ball joint: three rotations about a common point.

    Parameters
    ----------
    name
        Name of the joint.
    first, second
        The two bodies; the coordinates are those of the second relative to the first.
    at
        The common point, the centre of the ball, at the design position.
    """

    at: Point

    kind: ClassVar[str] = "spherical"
    common: ClassVar[str] = "a point"
    coordinates: ClassVar[tuple[str, ...]] = ("x", "y", "z")

    @property
    def center(self) -> Point:
        return self.at


@declared
@dataclass(frozen=True)
class RelativeCoordinate:
    """A coordinate of a joint that reports show, such as the paper's beta2.

    Methods of joints, such as `Universal.azimuth`, return them.

    Attributes
    ----------
    joint, kind
        The joint, and the kind of its coordinate.
    meaning
        For the documentation of the generated code.
    """

    name: Name
    joint: Joint
    kind: str
    meaning: str

    def __post_init__(self) -> None:
        joint = self.joint
        if self.kind in joint.coordinates and not isinstance(joint, Spherical):
            return
        problem = f"kind {self.kind!r} is not a coordinate of {joint.name!r}, which is {joint.kind}"
        known = ", ".join(() if isinstance(joint, Spherical) else joint.coordinates)
        problem += f"; there are {known}" if known else "; its angles have no names to report"
        raise DeclarationError(f"RelativeCoordinate {self.name!r}", [problem])

    @property
    def unit(self) -> str:
        """Unit of its value."""
        return "m" if self.kind in ("slide", "x", "y", "z") else "rad"


def _gear_problems(joint: Joint) -> list[str]:
    """Return problems of a gear, which connects hinges or guides, in matching units."""
    if joint.gear is None:
        return []
    followed, ratio = joint.gear.joint, joint.gear.ratio
    if not isinstance(followed, Revolute | Prismatic):
        return [
            f"it follows {followed.name!r}, which is {followed.kind}; a hinge or guide is needed"
        ]
    problems = [
        f"the angle of {hinge.name!r} counts from {hinge.angle_from.name!r} to a point, and gears "
        "count from the design position; leave its angle_to away"
        for hinge in (joint, followed)
        if isinstance(hinge, Revolute) and hinge.angle_to is not None
    ]
    wanted, written = _RATIOS[type(joint), type(followed)]
    if ratio.unit != wanted:
        problems.append(
            f"ratio {ratio.name!r} is in {ratio.unit!r}; a {joint.kind} joint that follows a "
            f"{followed.kind} one needs {wanted!r}: write {written}(name, default, meaning)"
        )
    return problems


_RATIOS: dict[tuple[type[Joint], type[Joint]], tuple[str, str]] = {
    (Revolute, Revolute): ("1", "Ratio"),
    (Prismatic, Prismatic): ("1", "Ratio"),
    (Prismatic, Revolute): ("m/rad", "Lead"),
    (Revolute, Prismatic): ("rad/m", "TurnPerTravel"),
}
"""Unit and type of a gear's ratio, by the kinds of the follower and the followed joint."""
