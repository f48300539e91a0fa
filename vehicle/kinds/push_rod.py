"""The double wishbone suspension with push rod and rocker: spring and damper lie on the chassis.

The classes for any rod that moves the rocker know it by its name alone.
"""

from collections.abc import Mapping
from dataclasses import replace
from types import ModuleType
from typing import ClassVar, Literal

from pydantic import Field

from ...core.columns import number
from ...core.vectors import cross, distance_from_line, unit_vector
from ...generated import push_rod
from ..corner.drawing import Drawing
from ..corner.structure import HingeJoint, SphericalJoint, Structure, UniversalJoint
from ..input.bodies import RigidBody
from ..input.hardpoints import SMALLEST_DISTANCE, Pair
from ..input.section import Triple
from ..input.spring import SpringSection
from .double_wishbone import DoubleWishbone, DoubleWishboneBodies, DoubleWishboneHardpoints

_ROCKER = ("rocker_front", "rocker_rear")
_PUSH_ROD = ("push_rod_outer", "push_rod_inner")


class RockerHardpoints(DoubleWishboneHardpoints):
    """The points of a double wishbone suspension whose spring a rocker moves."""

    ROD: ClassVar[Pair]  # ends of the rod that moves the rocker, the outer one first
    ROD_WORDS: ClassVar[str]  # name in messages

    rocker_front: Triple = Field(description="one bearing of the rocker on the chassis")
    rocker_rear: Triple = Field(description="the other bearing of the rocker on the chassis")
    spring_top: Triple = Field(description="end of spring and damper on the chassis")
    spring_seat: Triple = Field(description="end of spring and damper on the rocker")

    def geometry_problems(self) -> list[str]:
        coinciding = self.coinciding({"rocker": _ROCKER, self.ROD_WORDS: self.ROD})
        problems = super().geometry_problems() + self.coincidence_problems(coinciding)
        return problems if coinciding else problems + self._problems_of_rocker()

    def _problems_of_rocker(self) -> list[str]:
        """Return problems of rod and spring without a lever about the rocker's axis."""
        found = []
        for words, (place, end) in (
            (self.ROD_WORDS, self.ROD[::-1]),
            ("spring", ("spring_seat", "spring_top")),
        ):
            lever = self._lever(place, end)
            if lever < SMALLEST_DISTANCE:
                found.append(
                    f"{self.text(place, end)}: the {words} acts with a lever of "
                    f"{1000 * lever:.3f} mm about the rocker's axis; at least "
                    f"{1000 * SMALLEST_DISTANCE:g} mm are needed, or the rocker is at its dead "
                    f"centre. Move {place}, or the bearings of the rocker."
                )
        return found

    def _lever(self, place: str, end: str) -> float:
        """Return the lever of a force along a line about the rocker's axis [m]."""
        axis = unit_vector(self.metres("rocker_front") - self.metres("rocker_rear"))
        at, to = self.metres(place), self.metres(end)
        if self.distance(place, end) < SMALLEST_DISTANCE:
            return 0.0
        arm = at - self.metres("rocker_rear")
        return abs(number(cross(arm, unit_vector(to - at)) @ axis))


class PushRodHardpoints(RockerHardpoints):
    """The points that define a double wishbone suspension with push rod, at the design position.

    All are in chassis axes (ISO 8855: x forward, y left, z up), in the unit that `unit` names.
    """

    ROD: ClassVar[Pair] = _PUSH_ROD
    ROD_WORDS: ClassVar[str] = "push rod"
    CARRIERS: ClassVar[Mapping[str, str]] = {
        **DoubleWishboneHardpoints.CARRIERS,
        "spring_seat": "rocker",
        "push_rod_outer": "lower_arm",
        "push_rod_inner": "rocker",
    }
    JOINTS: ClassVar[tuple[str, ...]] = (
        *DoubleWishboneHardpoints.JOINTS,
        *_PUSH_ROD,
        "spring_seat",
    )

    push_rod_outer: Triple = Field(description="ball joint of push rod and lower arm")
    push_rod_inner: Triple = Field(description="joint of push rod and rocker")


class RockerBody(RigidBody):
    """The rocker."""

    POINTS: ClassVar[tuple[str, ...]] = _ROCKER


class PushRodBody(RigidBody):
    """The push rod."""

    POINTS: ClassVar[tuple[str, ...]] = _PUSH_ROD


class RockerBodies(DoubleWishboneBodies):
    """The bodies of a double wishbone suspension with a rocker, without the rod that moves it."""

    rocker: RockerBody = Field(default=RockerBody(mass_kg=0.0), description="the rocker")


class PushRodBodies(RockerBodies):
    """All bodies. Tie rod, rack and push rod have no mass in the equations of this suspension."""

    MASSLESS: ClassVar[tuple[str, ...]] = ("tie_rod", "rack", "push_rod")

    push_rod: PushRodBody = Field(
        default=PushRodBody(mass_kg=0.0), description="the push rod, whose mass must be 0"
    )


class PushRod(DoubleWishbone):
    """A double wishbone suspension with push rod and rocker at its design position.

    The push rod leads from the lower arm to the rocker; spring and damper act between the rocker
    and the chassis. See `Suspension`.
    """

    GENERAL: ClassVar[ModuleType] = push_rod
    ADDITION: ClassVar[str] = "push rod"
    TITLE: ClassVar[str] = "push-rod suspension"
    STARTER: ClassVar[str] = "push_rod_car"
    PAGE: ClassVar[str] = """: a double wishbone whose spring lies on the chassis.

The push rod leads from the lower arm to the rocker, which turns about the line through its two
bearings and compresses spring and damper. The free length of the spring is given directly
(`free_length_mm`) or by the force at the design position (`force_at_design_N`). The damper has a
rate or a curve; the stops depend on its length."""

    # a kind of its own, which inherits nearly everything
    suspension: Literal["push_rod"] = Field(  # type: ignore[assignment]
        description="the kind of suspension"
    )
    hardpoints: PushRodHardpoints = Field(description="the points that define the geometry")
    spring: SpringSection = Field(description="the spring, between chassis and rocker")
    bodies: PushRodBodies = Field(description="masses and inertia")

    @property
    def _rod(self) -> tuple[str, str, str, str]:
        """The names of the rod, of its outer and inner end, and of its arm."""
        outer, inner = self.hardpoints.ROD
        return outer.removesuffix("_outer"), outer, inner, self.hardpoints.CARRIERS[outer]

    def lengths(self) -> dict[str, float]:
        points, (rod, outer, inner, _) = self.hardpoints, self._rod
        axis = [points.metres(name) for name in _ROCKER]
        return super().lengths() | {
            f"{rod}_length": points.distance(outer, inner),
            "rocker_length": distance_from_line(points.metres(inner), *axis),
        }

    def drawing(self) -> Drawing:
        (rod, outer, inner, arm), words = self._rod, self.hardpoints.ROD_WORDS
        rocker = {
            "rocker_front_rod": ("rocker_front", inner),
            "rocker_rear_rod": ("rocker_rear", inner),
            "rocker_front_spring": ("rocker_front", "spring_seat"),
            "rocker_rear_spring": ("rocker_rear", "spring_seat"),
            "rocker_across": (inner, "spring_seat"),
        }
        foot = (outer, arm.replace("arm", "ball_joint"), f"{arm}_front")
        plain = super().drawing()
        return replace(
            plain,
            links={
                **plain.links,
                words: (outer, inner, "push rod"),
                "rocker": ("rocker_front", inner, "rocker"),
                "rocker at the spring": ("rocker_front", "spring_seat", "rocker"),
            },
            legend={**plain.legend, "arm": f"control arms, {words} and rocker"},
            brackets={
                f"{rod}_bracket": (foot, outer),
                rod: (outer, inner),
                **rocker,
            },
        )

    def structure(self) -> Structure:
        """Return the joints; spring, damper and stops act between chassis and rocker."""
        axis = unit_vector(
            self.hardpoints.metres("rocker_front") - self.hardpoints.metres("rocker_rear")
        )
        # the first axis of a universal joint is fixed, and so is the axis of a hinge on the chassis
        first_axis = (float(axis[0]), float(axis[1]), float(axis[2]))
        rod, outer, inner, arm = self._rod
        joints = (
            *super().structure().joints,
            HingeJoint("chassis", "rocker", _ROCKER),
            SphericalJoint(arm, rod, (outer,), inner),
            UniversalJoint("rocker", rod, (inner,), outer, first_axis),
        )
        return Structure(joints, self._lines("rocker"))
