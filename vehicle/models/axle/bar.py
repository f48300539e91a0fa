"""The anti-roll bar: its section of the file, and the rotation of its halves with the wheels.

Half a bar turns about its axis in its bushes on the chassis; a drop link of fixed length joins the
end of its lever to a part of the suspension. With the part's point F, the bush P, the axis a, the
lever t = T - P and the length L of the link, the angle phi of the half solves ::

    |P + R(a, phi) t - F|^2 = L^2,    A cos(phi) + B sin(phi) = C

in closed form, on the branch of the design position.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import pi
from typing import Annotated, Any, get_args

import numpy as np
from pydantic import Field

from ....core.named_types import Array
from ....core.vectors import (
    MIRROR,
    angle_between_lines,
    cross,
    directions,
    distance_from_line,
    unit_vector,
)
from ...input.hardpoints import SMALLEST_CROSS_ANGLE, SMALLEST_DISTANCE
from ...input.section import CHECK_UNIT, NonNegative, Number, Remedy, Section, Triple
from ...input.units import LengthUnit, in_metres, point_in_metres

# Steel: shear modulus [GPa], and Young's modulus over it, 2 (1 + nu) with nu = 0.3.
_STEEL, _YOUNG = 79.3, 2.6
_RADIANS = pi / 180.0
# A larger coordinate has the wrong unit [m].
_LARGEST_COORDINATE = 20.0

_Rate = Annotated[Number, Field(gt=0.0, le=1e5), CHECK_UNIT]
_Diameter = Annotated[Number, Field(gt=0.0, le=500.0), CHECK_UNIT]
_Length = Annotated[Number, Field(gt=0.0, le=1e4), CHECK_UNIT]
_Modulus = Annotated[Number, Field(gt=0.0, le=1e3), CHECK_UNIT]
_Stiffness = Annotated[Number, Field(gt=0.0, le=1e7), Remedy("Leave the key out for a rigid part.")]
_Twist = Annotated[Number, Field(ge=-60.0, le=60.0), Remedy("Check its sign and unit.")]


# Bars are some 20 mm thick and 1 m long [m].
_THINNEST, _SHORTEST_BAR = 0.0006, 0.03


class AntiRollBar(Section):
    """An anti-roll bar, by its rate or by its dimensions.

    The points are those of the side that the axle's file names with ``side``, or of the right one;
    the other half is the mirror image.
    """

    unit: LengthUnit = Field(description='the unit of the points of this section, "mm" or "m"')
    bush: Triple = Field(description="bearing of the bar on the chassis, on the bar's axis")
    link_top: Triple = Field(description="drop link at the bar")
    link_foot: Triple = Field(description="drop link at the part of the suspension")
    link_on: str = Field(
        description="the part that the drop link is joined to: control_arm, lower_arm, knuckle, ..."
    )
    axis: Triple = Field(
        default=(0.0, 1.0, 0.0), description="axis of the bar in its bearing, pointing left"
    )
    rate_Nm_per_deg: _Rate | None = Field(  # noqa: N815 (N is the newton)
        default=None,
        description="torque per twist between the bar's arms, unless the dimensions are given",
    )
    diameter_mm: _Diameter | None = Field(
        default=None, description="diameter of the bar, instead of its rate"
    )
    inner_diameter_mm: NonNegative = Field(default=0.0, description="inner diameter of a tube")
    length_mm: _Length | None = Field(
        default=None, description="length of the twisted part of the bar, between its arms"
    )
    shear_modulus_GPa: _Modulus = Field(  # noqa: N815 (Pa is the pascal)
        default=_STEEL, description="shear modulus; Young's modulus is 2.6 times this value"
    )
    bush_radial_N_per_mm: _Stiffness | None = Field(  # noqa: N815 (N is the newton)
        default=None,
        description="stiffness of each bearing across the bar; rigid by default",
    )
    link_axial_N_per_mm: _Stiffness | None = Field(  # noqa: N815
        default=None,
        description="stiffness of each drop link along it, its joints included; rigid by default",
    )
    free_twist_deg: _Twist = Field(
        default=0.0, description="twist at which the bar is free, left half less right half"
    )

    @classmethod
    def unit_of_key(cls, key: str, table: Mapping[str, Any]) -> str:
        """Return the unit of a key; that of the points is the section's `unit`."""
        unit = str(table.get("unit"))
        if key in ("bush", "link_top", "link_foot") and unit in get_args(LengthUnit):
            return unit
        return super().unit_of_key(key, table)

    def problems(self) -> list[str]:
        problems = self._problems_of_rate()
        if not 1e-6 < np.linalg.norm(self.axis) < np.inf or self.axis[1] <= 0.0:
            problem = (
                f"axis = {list(self.axis)} (without unit) does not point to the left: its second "
                "component must be positive. Enter [0.0, 1.0, 0.0] for a bar across the car."
            )
            return [*problems, problem]
        bush, top, foot = (self.metres(name) for name in ("bush", "link_top", "link_foot"))
        if max(np.abs([bush, top, foot]).max(), 0.0) > _LARGEST_COORDINATE:
            problem = (
                f"bush = {list(self.bush)}, link_top = {list(self.link_top)} and link_foot = "
                f"{list(self.link_foot)} {self.unit}: out of range, allowed is "
                f"-{_LARGEST_COORDINATE:g} m to {_LARGEST_COORDINATE:g} m. Correct the points or "
                f'`unit = "{self.unit}"`.'
            )
            return [*problems, problem]
        lever = distance_from_line(top, bush, bush + unit_vector(self.axis))
        short = (
            (lever, f"link_top = {list(self.link_top)} {self.unit} is", "from the bar's axis"),
            (float(np.linalg.norm(top - foot)), "link_top and link_foot are", "apart"),
        )
        close = [
            f"{what} {1e3 * length:.3f} mm {where}; at least {1e3 * SMALLEST_DISTANCE:g} mm are "
            "needed. Move one of these points."
            for length, what, where in short
            if length < SMALLEST_DISTANCE
        ]
        return problems + (
            close or [*self._problems_of_link(bush, top, foot), *self._problems_of_bushes(bush)]
        )

    def _problems_of_rate(self) -> list[str]:
        sizes = {"diameter_mm": self.diameter_mm, "length_mm": self.length_mm}
        given = [key for key, value in sizes.items() if value is not None]
        if self.rate_Nm_per_deg is not None:
            usual = {"inner_diameter_mm": 0.0, "shear_modulus_GPa": _STEEL}
            given += [key for key, value in usual.items() if getattr(self, key) != value]
            both = f"rate_Nm_per_deg = {self.rate_Nm_per_deg} N m/deg and"
            return [f"{both} {given[0]} both give its rate. Remove one of them."] if given else []
        missing = [key for key in sizes if key not in given]
        if missing:
            problem = (
                f"{' and '.join(missing)} missing: a bar needs rate_Nm_per_deg, or both "
                "diameter_mm and length_mm."
            )
            return [problem]
        if self.diameter_mm is not None and self.inner_diameter_mm >= self.diameter_mm:
            problem = (
                f"inner_diameter_mm = {self.inner_diameter_mm} mm is not less than diameter_mm = "
                f"{self.diameter_mm} mm. Correct one of them."
            )
            return [problem]
        return []

    def _problems_of_link(self, bush: Array, top: Array, foot: Array) -> list[str]:
        problems = []
        tilt = angle_between_lines(top - foot, np.array([1.0, 0.0, 0.0]))
        if tilt < SMALLEST_CROSS_ANGLE:
            problems.append(
                f"the drop link from link_foot to link_top is {tilt:.3f} deg from the x axis; at "
                f"least {SMALLEST_CROSS_ANGLE:g} deg are needed. Move one of the two points."
            )
        axis = unit_vector(self.axis)
        pull = abs(float(cross(axis, top - bush) @ unit_vector(top - foot)))
        if pull < SMALLEST_DISTANCE:
            problems.append(
                f"the drop link pulls with a lever of {1e3 * pull:.3f} mm about the bar's axis; at "
                f"least {1e3 * SMALLEST_DISTANCE:g} mm are needed, or it is at its dead centre. "
                "Move link_foot or link_top, so that the link is not in line with the bar's lever."
            )
        return problems

    def _problems_of_bushes(self, bush: Array) -> list[str]:
        """Return a problem if soft bushes, the bar's and its image, are too near to each other."""
        if self.bush_radial_N_per_mm is None or abs(bush[1]) >= SMALLEST_DISTANCE:
            return []
        problem = (
            f"bush = {list(self.bush)} {self.unit} is {1e3 * abs(bush[1]):.3f} mm from the middle "
            f"of the car; at least {1e3 * SMALLEST_DISTANCE:g} mm are needed where it is soft. "
            "Move it, or remove bush_radial_N_per_mm."
        )
        return [problem]

    def metres(self, name: str) -> Array:
        """Return a point of the file, chassis axes [m]."""
        return point_in_metres(getattr(self, name), self.unit)

    def rate(self) -> float:
        """Return the torque per twist between the feet of the drop links [N m/rad].

        Bar, bushes and drop links are springs in series. For a unit torque a link with the lever r
        about the axis carries 1 / r, and a bush a radial force R; by the unit-load theorem, with
        the levers at design ::

            1 / rate = 1 / rate_of_bar + 2 / (link r^2) + 2 R^2 / bush
        """
        soft = 1.0 / self.rate_of_bar()
        if self.link_axial_N_per_mm is not None:
            soft += 2.0 * float(self._pull() @ self._pull()) / (1e3 * self.link_axial_N_per_mm)
        if self.bush_radial_N_per_mm is not None:
            radial = self._radial_force()
            soft += 2.0 * float(radial @ radial) / (1e3 * self.bush_radial_N_per_mm)
        return 1.0 / soft

    def _pull(self) -> Array:
        """Return the force of a drop link on the bar for a unit torque, at design [1/m]."""
        half = self.half()
        direction, lever = half.lever(half.foot, np.zeros(()))
        return -direction / lever

    def _radial_force(self) -> Array:
        """Return the radial force of a bush for a unit torque, at design [1/m].

        The load of the other half is the opposite of the mirror image. From the equilibrium of both
        links and bushes about the middle of the bushes, with the force f at the arm r, and the bush
        at the distance b from the middle plane, it is ``(f_y r - r_y f) / b`` in this plane, and
        ``-f_y`` normal to it.
        """
        half, pull = self.half(), self._pull()
        arm = half.top - half.bush * (1.0, 0.0, 1.0)
        held = (pull[1] * arm - arm[1] * pull) / half.bush[1] - pull[1] * np.array([0.0, 1.0, 0.0])
        return held - (held @ half.axis) * half.axis

    def rate_of_bar(self) -> float:
        """Return the torque per twist between the bar's arms, on rigid bearings [N m/rad].

        From the dimensions: the twist between the arms and the bending of the two arms, assumed
        straight and of the same section. With the lever r of the drop link about the axis,
        ``1 / rate = length / (G J) + 2 r / (3 E I)``, J = 2 I = pi (D^4 - d^4) / 32.
        """
        if self.rate_Nm_per_deg is not None:
            return self.rate_Nm_per_deg / _RADIANS
        assert self.diameter_mm is not None
        assert self.length_mm is not None
        outer, inner = in_metres(self.diameter_mm, "mm"), in_metres(self.inner_diameter_mm, "mm")
        polar = pi * (outer**4 - inner**4) / 32.0
        shear = 1e9 * self.shear_modulus_GPa
        bush = self.metres("bush")
        lever = distance_from_line(self.metres("link_top"), bush, bush + unit_vector(self.axis))
        twist = in_metres(self.length_mm, "mm") / (shear * polar)
        bending = 2.0 * lever / (3.0 * _YOUNG * shear * polar / 2.0)
        return float(1.0 / (twist + bending))

    def gives_way(self) -> bool:
        """Return whether its bushes or drop links are soft."""
        return self.bush_radial_N_per_mm is not None or self.link_axial_N_per_mm is not None

    def free_twist(self) -> float:
        """Return the twist at which the bar is free, left half less right half [rad]."""
        return self.free_twist_deg * _RADIANS

    def half(self, *, mirrored: bool = False) -> "HalfBar":
        """Return the half that the file describes, or the other one."""
        image = MIRROR if mirrored else np.ones(3)
        # the image of a rotation about an axis is one about the opposite of the axis' image
        sense = -1.0 if mirrored else 1.0
        return HalfBar(
            axis=sense * image * unit_vector(self.axis),
            bush=image * self.metres("bush"),
            top=image * self.metres("link_top"),
            foot=image * self.metres("link_foot"),
            body=self.link_on,
        )


def mirrored_points(section: Mapping[str, Any]) -> dict[str, Any]:
    """Return the section of a bar with the points of the other side and its axis to the left."""
    x, y, z = section["axis"]
    points = {
        name: [section[name][0], 0.0 - section[name][1], section[name][2]]
        for name in ("bush", "link_top", "link_foot")
    }
    return {**section, **points, "axis": [0.0 - x, y, 0.0 - z]}


@dataclass(frozen=True)
class HalfBar:
    """Half a bar with its drop link, at design; chassis axes [m]."""

    axis: Array  # unit vector along the bar, pointing left, (3,)
    # bearing, and the two ends of the drop link, (3,)
    bush: Array
    top: Array
    foot: Array
    body: str  # part that carries the foot

    @property
    def _across(self) -> Array:
        """The lever across the axis."""
        lever = self.top - self.bush
        return lever - (lever @ self.axis) * self.axis

    def _equation(self, foot: Array) -> tuple[Array, Array, Array]:
        """Return A, B and C of the loop's equation."""
        lever, link = self.top - self.bush, self.top - self.foot
        away = foot - self.bush
        along = (lever @ self.axis) * (away @ self.axis)
        reach = 0.5 * (lever @ lever + np.einsum("...i,...i", away, away) - link @ link) - along
        across = self._across
        return away @ across, away @ cross(self.axis, across), reach

    def turn(self, foot: Array) -> Array:
        """Return the angle of the half from design, right-handed about its axis [rad].

        `foot` is the position of the foot of the drop link, (..., 3) [m]. The angle is NaN if the
        link does not reach.
        """
        cosine, sine, reach = self._equation(foot)
        amplitude = np.hypot(cosine, sine)
        with np.errstate(invalid="ignore", divide="ignore"):
            opening = np.arccos(reach / amplitude)
        # at design the angle is zero: cos(0) A = C, and the sign of B selects the solution
        _, at_design, _ = self._equation(self.foot)
        angle = np.arctan2(sine, cosine) - np.copysign(1.0, at_design) * opening
        return np.arctan2(np.sin(angle), np.cos(angle))

    def top_at(self, turn: Array) -> Array:
        """Return the position of the upper end of the drop link, (..., 3) [m]."""
        across = self._across
        cosine, sine = np.cos(turn)[..., None], np.sin(turn)[..., None]
        fixed = self.top - across
        return fixed + cosine * across + sine * cross(self.axis, across)

    def lever(self, foot: Array, turn: Array) -> tuple[Array, Array]:
        """Return direction and lever of the drop link.

        The direction is the unit vector along the link from the foot to the bar, (..., 3); the
        lever of a force in this direction about the bar's axis is signed [m].
        """
        top = self.top_at(turn)
        direction = directions(top - foot)
        arm = cross(self.axis, top - self.bush)
        return direction, np.einsum("...i,...i->...", arm, direction)

    def rate_of_turn(self, foot: Array, turn: Array, velocity: Array) -> Array:
        """Return the rate of the angle for a velocity of the foot, with the link's length fixed."""
        direction, lever = self.lever(foot, turn)
        return np.einsum("...i,...i->...", velocity, direction) / lever


def unlikely_bar(bar: AntiRollBar) -> Iterator[str]:
    """Yield problems of the dimensions of an anti-roll bar that are in metres."""
    for name, least, usual in (
        ("diameter_mm", _THINNEST, "10 to 40"),
        ("length_mm", _SHORTEST_BAR, "500 to 1500"),
    ):
        value = getattr(bar, name)
        if value is not None and 1e-3 * value < least:
            yield f"[anti_roll_bar] {name} = {value:g} mm: bars have {usual} mm. Is it in metres?"
