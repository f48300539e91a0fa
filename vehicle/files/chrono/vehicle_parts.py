"""Parts of a whole vehicle of Project Chrono: chassis, wheel, steering, bar, brake, driveline.

Points are in the axes of each part, whose position and orientation are in the vehicle's file.
"""

from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import Field

from ....core.named_types import Array
from ....core.physical import inertia_tensor
from ....equations import layout
from ...input.bodies import impossible_inertia
from .keys import Part
from .parts import Finite, Point, elements, millimetres

_Quaternion = tuple[Finite, Finite, Finite, Finite]
_Positive = Annotated[Finite, Field(gt=0.0)]

_FORMAL = frozenset({"Name", "Output", "Visualization", "Contact"})
# Tolerance of unit vectors and unit quaternions [1].
_ALIKE = 1e-3


class _File(Part):
    UNREAD: ClassVar[frozenset[str]] = _FORMAL


class _Frame(Part):
    location: Point = Field(alias="Location")
    orientation: _Quaternion = Field(default=(1.0, 0.0, 0.0, 0.0), alias="Orientation")


class _Component(Part):
    frame: _Frame = Field(alias="Centroidal Frame")
    mass: Finite = Field(alias="Mass", ge=0.0)
    moments: Point = Field(alias="Moments of Inertia")
    products: Point = Field(alias="Products of Inertia")
    void: bool = Field(default=False, strict=True, alias="Void")


class DriverPlace(Part):
    """The position of the driver."""

    UNREAD: ClassVar[frozenset[str]] = frozenset({"Orientation"})

    location: Point = Field(alias="Location")


class Chassis(_File):
    """A rigid chassis, of one body or more."""

    type: Literal["Chassis"] = Field(alias="Type")
    template: Literal["RigidChassis"] = Field(alias="Template")
    components: tuple[_Component, ...] = Field(alias="Components", min_length=1)
    driver: DriverPlace | None = Field(default=None, alias="Driver Position")

    def body(self) -> tuple[float, Array, Array]:
        """Return mass [kg], centre of mass [m] and inertia about it [kg m^2], in its axes."""
        mass, moment = 0.0, np.zeros(3)
        for one in self.components:
            part = -one.mass if one.void else one.mass
            mass, moment = mass + part, moment + part * np.array(one.frame.location)
        com = moment / mass if mass else moment
        inertia = np.zeros((3, 3))
        for one in self.components:
            turned = rotation(one.frame.orientation)
            own = turned @ inertia_tensor([*one.moments, *one.products]) @ turned.T
            away = np.array(one.frame.location) - com
            own = own + one.mass * (away @ away * np.eye(3) - np.outer(away, away))
            inertia = inertia - own if one.void else inertia + own
        return mass, com, inertia

    def problems(self) -> list[str]:
        """Return the problems of orientations, mass and inertia."""
        lines = [
            f'"Components > Centroidal Frame > Orientation" = {list(one.frame.orientation)} is not '
            "a unit quaternion. Correct it."
            for one in self.components
            if not is_rotation(one.frame.orientation)
        ]
        if lines:
            return lines
        mass, _, inertia = self.body()
        if mass <= 0.0:
            return [f'"Components > Mass" add to {mass:g} kg; more than 0 kg is needed.']
        reason = impossible_inertia(elements(inertia))
        return [f'"Components" have together an inertia of which {reason}.'] if reason else []

    def section(self, origin: Array) -> dict[str, Any]:
        """Return the section of a car's body, for axes with another origin [m]."""
        mass, com, inertia = self.body()
        return {
            "mass_kg": mass,
            "com_mm": [rounded(value) for value in com - origin],
            **{f"inertia_{name}_kg_m2": value for name, value in elements(inertia).items()},
        }


class WheelFile(_File):
    """A rim."""

    type: Literal["Wheel"] = Field(alias="Type")
    template: Literal["Wheel"] = Field(alias="Template")
    mass: Finite = Field(alias="Mass", ge=0.0)
    inertia: Point = Field(alias="Inertia")


class _BarArm(Part):
    UNREAD: ClassVar[frozenset[str]] = frozenset({"Mass", "Inertia", "Radius"})

    length: _Positive = Field(alias="Length")
    width: Finite = Field(alias="Width")


class _DropLink(Part):
    height: Finite = Field(alias="Height")


class _BarSpring(Part):
    UNREAD: ClassVar[frozenset[str]] = frozenset({"Damping Coefficient"})

    rate: _Positive = Field(alias="Spring Coefficient")


class BarFile(_File):
    """An anti-roll bar of two halves, which a torsional spring joins in its middle."""

    type: Literal["Antirollbar"] = Field(alias="Type")
    template: Literal["AntirollBarRSD"] = Field(alias="Template")
    arm: _BarArm = Field(alias="Arm")
    link: _DropLink = Field(alias="Droplink")
    spring: _BarSpring = Field(alias="RSD")

    def section(self, at: Array, linked: str) -> dict[str, Any]:
        """Return the section of an axle's file, from its middle [m] and the part of drop links."""
        top = np.add(at, [self.arm.width, self.arm.length, 0.0])
        points = {
            "bush": np.add(at, [0.0, 0.5 * self.arm.length, 0.0]),
            "link_top": top,
            "link_foot": np.add(top, [0.0, 0.0, self.link.height]),
        }
        return {
            "unit": "mm",
            **{name: [rounded(x) for x in point] for name, point in points.items()},
            "link_on": linked,
            "axis": [0.0, 1.0, 0.0],
            "rate_Nm_per_deg": np.deg2rad(1.0) * self.spring.rate,
        }


class _Pinion(Part):
    radius: _Positive = Field(alias="Radius")
    greatest: _Positive = Field(alias="Maximum Angle (deg)")


class RackPinion(_File):
    """A rack, which moves along the y axis of its frame."""

    UNREAD: ClassVar[frozenset[str]] = _FORMAL | {"Steering Link"}

    type: Literal["Steering"] = Field(alias="Type")
    template: Literal["RackPinion"] = Field(alias="Template")
    pinion: _Pinion = Field(alias="Pinion")

    def steering(self, turned: Array, at: Array) -> tuple[dict[str, Any], str]:
        """Return the section of a rack in a rotated frame, and its assumptions.

        Its origin `at` has no effect.
        """
        most = np.deg2rad(self.pinion.greatest) * self.pinion.radius
        section = {
            "axis": direction(turned @ [0.0, 1.0, 0.0]),
            "travel_per_turn_mm": rounded(2.0 * np.pi * self.pinion.radius),
        }
        words = (
            f"steering wheel: turns the pinion, of {1e3 * self.pinion.radius:g} mm of radius; in "
            f"Chrono up to {self.pinion.greatest:g} deg, {1e3 * most:.1f} mm of rack, to each side"
        )
        return {"rack": section}, words


class _Revolute(Part):
    location: Point = Field(alias="Location")
    direction: Point = Field(alias="Direction")
    greatest: _Positive = Field(alias="Maximum Angle (deg)")


class _Universal(Part):
    UNREAD: ClassVar[frozenset[str]] = frozenset({"Direction Arm", "Direction Link"})

    location: Point = Field(alias="Location")


class _Idler(Part):
    chassis: Point = Field(alias="Location Chassis")
    link: Point = Field(alias="Location Link")
    direction: Point = Field(alias="Direction")


class _TieRods(Part):
    pitman: Point = Field(alias="Pitman Side")
    idler: Point = Field(alias="Idler Side")


class PitmanArm(_File):
    """A steering link on a Pitman arm and an idler arm."""

    UNREAD: ClassVar[frozenset[str]] = _FORMAL | {
        "Steering Link",
        "Pitman Arm",
        "Vehicle-Frame Inertia",
    }

    type: Literal["Steering"] = Field(alias="Type")
    template: Literal["PitmanArm"] = Field(alias="Template")
    revolute: _Revolute = Field(alias="Revolute Joint")
    universal: _Universal = Field(alias="Universal Joint")
    idler: _Idler = Field(alias="Revolute-Spherical Joint")
    tie_rods: _TieRods = Field(alias="Tierod Locations")

    def steering(self, turned: Array, at: Array) -> tuple[dict[str, Any], str]:
        """Return the section of a Pitman arm in a rotated frame, and its assumptions.

        `at` is the origin of the frame, (3,) [m].
        """

        def place(own: Point) -> list[float]:
            return [rounded(value) for value in turned @ own + at]

        section = {
            "pivot_mm": place(self.revolute.location),
            "axis": direction(turned @ self.revolute.direction),
            "ball_mm": place(self.universal.location),
            "idler_pivot_mm": place(self.idler.chassis),
            "idler_axis": direction(turned @ self.idler.direction),
            "idler_ball_mm": place(self.idler.link),
        }
        words = (
            f"steering: a Pitman arm, in Chrono up to {self.revolute.greatest:g} deg to each side. "
            "The ratio of the steering gear is not in Chrono's files: enter gear_ratio"
        )
        return {"pitman_arm": section}, words

    def problems(self) -> list[str]:
        """Return the problem of an axis without direction."""
        axes = {
            "Revolute Joint": self.revolute.direction,
            "Revolute-Spherical Joint": self.idler.direction,
        }
        return [
            f'"{key} > Direction" = {list(axis)} has no direction. Correct it.'
            for key, axis in axes.items()
            if not any(axis)
        ]


class Brake(_File):
    """The brake of a wheel."""

    UNREAD: ClassVar[frozenset[str]] = _FORMAL | {"Shaft Inertia"}

    type: Literal["Brake"] = Field(alias="Type")
    template: Literal["BrakeSimple", "BrakeShafts"] = Field(alias="Template")
    torque: Finite = Field(alias="Maximum Torque", ge=0.0)


class Driveline(_File):
    """The driveline, which leads the torque to the wheels."""

    UNREAD: ClassVar[frozenset[str]] = _FORMAL | {"Shaft Direction", "Shaft Inertia", "Gear Ratio"}

    type: Literal["Driveline"] = Field(alias="Type")
    template: Literal["ShaftsDriveline2WD", "ShaftsDriveline4WD", "SimpleDriveline"] = Field(
        alias="Template"
    )
    to_front: Finite = Field(default=0.5, ge=0.0, le=1.0, alias="Front Torque Fraction")


def rotation(quaternion: _Quaternion) -> Array:
    """Return the matrix of a rotation from its quaternion, scalar first."""
    return layout.rotation(np.array(quaternion) / np.linalg.norm(quaternion))


def is_rotation(quaternion: _Quaternion) -> bool:
    """Return whether a quaternion has the length 1."""
    return bool(abs(np.linalg.norm(quaternion) - 1.0) < _ALIKE)


def rounded(metres: Any) -> float:
    """Return a length in millimetres, without digits from rounding."""
    return millimetres(round(float(metres), 9)) + 0.0


def direction(vector: Array) -> list[float]:
    """Return a unit vector without digits from rounding."""
    return [round(float(x), 9) + 0.0 for x in vector]
