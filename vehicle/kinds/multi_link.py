"""The multi-link suspension: five links guide the knuckle, one of them carries the spring."""

from collections.abc import Mapping
from types import ModuleType
from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from ...core.columns import least_singular_value, stacked
from ...core.named_types import Array
from ...core.vectors import Vector, components, cross, unit_vector
from ...generated import multi_link
from ..corner.base import Names
from ..corner.coil_sprung import ApartDamper, CoilSprung
from ..corner.corner import CarrierMotion, Plane
from ..corner.drawing import Axis, Drawing
from ..corner.structure import (
    FORCES_OF_A_DAMPER,
    LineForce,
    SphericalJoint,
    Structure,
    UniversalJoint,
    frame,
    steered,
)
from ..input.bodies import Bodies, Rack, RigidBody, TieRod
from ..input.hardpoints import Hardpoints, Pair
from ..input.section import Triple
from ..input.spring import SpringSection

LINKS = ("front_upper_link", "rear_upper_link", "front_lower_link", "rear_lower_link")
"""The links on the chassis; the fifth is the toe link, called tie rod in the files of all kinds."""
_WORDS = {name: name.replace("_", " ") for name in LINKS} | {"tie_rod": "toe link"}
_UP = np.array([0.0, 0.0, 1.0])

# The height sensor whose angle is the coordinate: its lever, and its height above the wheel [m].
_LEVER = 0.5
_ABOVE = 1.0
_BEARING = 0.1

# Greatest motion of the knuckle at constant height, per elongation of the links; rotations are
# measured by the displacement at this radius [m].
_LOOSEST = 100.0
_RADIUS = 0.1


def _ends(link: str) -> Pair:
    """Return the hardpoints of a link, the outer one first."""
    return f"{link}_outer", f"{link}_inner"


class MultiLinkHardpoints(Hardpoints):
    """The points that define a multi-link suspension, at the design position.

    Two links whose outer ends are the same point are an arm with a ball joint there. All points are
    in chassis axes (ISO 8855: x forward, y left, z up), in the unit that `unit` names.
    """

    CARRIERS: ClassVar[Mapping[str, str]] = {
        **{f"{link}_outer": "knuckle" for link in (*LINKS, "tie_rod")},
        "wheel_center": "knuckle",
        "tie_rod_inner": "rack",
        "spring_seat": "rear_lower_link",
        "damper_seat": "knuckle",
    }
    ARMS: ClassVar[Mapping[str, Pair]] = {}
    STEERING_AXIS: ClassVar[Pair | None] = None
    JOINTS: ClassVar[tuple[str, ...]] = (
        *(f"{link}_outer" for link in (*LINKS, "tie_rod")),
        "tie_rod_inner",
        "spring_seat",
        "damper_seat",
    )

    front_upper_link_inner: Triple = Field(description="front upper link on the chassis")
    front_upper_link_outer: Triple = Field(description="front upper link at the knuckle")
    rear_upper_link_inner: Triple = Field(description="rear upper link on the chassis")
    rear_upper_link_outer: Triple = Field(description="rear upper link at the knuckle")
    front_lower_link_inner: Triple = Field(description="front lower link on the chassis")
    front_lower_link_outer: Triple = Field(description="front lower link at the knuckle")
    rear_lower_link_inner: Triple = Field(description="rear lower link on the chassis")
    rear_lower_link_outer: Triple = Field(description="rear lower link at the knuckle")
    tie_rod_outer: Triple = Field(description="toe link at the knuckle")
    tie_rod_inner: Triple = Field(description="toe link at the rack, or on the chassis")
    spring_top: Triple = Field(description="upper end of the spring, on the chassis")
    spring_seat: Triple = Field(description="lower end of the spring, on the rear lower link")
    damper_top: Triple = Field(description="upper end of the damper, on the chassis")
    damper_seat: Triple = Field(description="lower end of the damper, on the knuckle")
    wheel_center: Triple = Field(description="centre of the wheel")

    def geometry_problems(self) -> list[str]:
        bodies = {words: _ends(link) for link, words in _WORDS.items()}
        coinciding = self.coinciding(
            bodies | {name: (f"{name}_seat", f"{name}_top") for name in ("spring", "damper")}
        )
        problems = self.coincidence_problems(coinciding)
        if problems:
            return problems
        for words, (outer, inner) in bodies.items():
            problems += self.cross_problems((inner, outer), words, _UP, "the vertical")
        return problems or self._loose()

    def directions(self) -> dict[str, Vector]:
        """Return the unit vectors outward along the links, by link."""
        return {
            link: unit_vector(self.metres(outer) - self.metres(inner))
            for link in _WORDS
            for outer, inner in [_ends(link)]
        }

    def _loose(self) -> list[str]:
        """Return a problem if the links hardly constrain the knuckle at constant height."""
        center = self.metres("wheel_center")
        held = [
            [*along, *(cross(self.metres(f"{link}_outer") - center, along) / _RADIUS)]
            for link, along in self.directions().items()
        ]
        rows = [*held, [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]]
        if least_singular_value(rows) * _LOOSEST >= 1.0:
            return []
        _, firm, free = np.linalg.svd(stacked(rows))
        shift, turn = free[-1, :3], free[-1, 3:]
        most = np.abs(free[-1]).argmax()
        words = f"turns about {'xyz'[most - 3]}" if most > 2 else f"moves along {'xyz'[most]}"
        times = "more than a million" if firm[-1] < 1e-9 else f"{1.0 / firm[-1]:.0f}"
        found = np.round([*shift, *turn], 2).tolist()
        problem = (
            f"{self.text(*(f'{link}_outer' for link in _WORDS))}: the five links do not hold the "
            f"knuckle, which {words} (x, y, z, roll, pitch and yaw as {found}): its displacement "
            f"is {times} times the elongation of a link, with the wheel at its height; at most "
            f"{_LOOSEST:g} times are allowed. Move the links: no two on one line, no three of a "
            "plane through one point, no four through one point, and the toe link at a distance "
            "from the steering axis."
        )
        return [problem]


class FrontUpperLink(RigidBody):
    """The front upper link."""

    POINTS: ClassVar[tuple[str, ...]] = _ends("front_upper_link")


class RearUpperLink(RigidBody):
    """The rear upper link."""

    POINTS: ClassVar[tuple[str, ...]] = _ends("rear_upper_link")


class FrontLowerLink(RigidBody):
    """The front lower link."""

    POINTS: ClassVar[tuple[str, ...]] = _ends("front_lower_link")


class RearLowerLink(RigidBody):
    """The rear lower link, which carries the spring."""

    POINTS: ClassVar[tuple[str, ...]] = _ends("rear_lower_link")


class Carrier(RigidBody):
    """The knuckle between the links."""

    POINTS: ClassVar[tuple[str, ...]] = tuple(f"{link}_outer" for link in LINKS)


class MultiLinkBodies(Bodies):
    """All bodies. Only knuckle, rear lower link and wheel have mass in the equations."""

    MASSLESS: ClassVar[tuple[str, ...]] = (*LINKS[:3], "tie_rod", "rack")

    knuckle: Carrier = Field(description="the knuckle")
    rear_lower_link: RearLowerLink = Field(
        description="the rear lower link, which carries the spring"
    )
    front_upper_link: FrontUpperLink = Field(
        default=FrontUpperLink(mass_kg=0.0),
        description="the front upper link, whose mass must be 0",
    )
    rear_upper_link: RearUpperLink = Field(
        default=RearUpperLink(mass_kg=0.0), description="the rear upper link, whose mass must be 0"
    )
    front_lower_link: FrontLowerLink = Field(
        default=FrontLowerLink(mass_kg=0.0),
        description="the front lower link, whose mass must be 0",
    )
    tie_rod: TieRod = Field(
        default=TieRod(mass_kg=0.0), description="the toe link, whose mass must be 0"
    )
    rack: Rack = Field(default=Rack(mass_kg=0.0), description="the rack, whose mass must be 0")


class MultiLink(CoilSprung):
    """A multi-link suspension at its design position: five links guide the knuckle.

    The spring acts between the chassis and the rear lower link, the damper between the chassis and
    the knuckle. See `Suspension`.
    """

    TITLE: ClassVar[str] = "multi-link suspension"
    NAMES: ClassVar[Names] = Names(
        "sensor_angle", "spin_angle", "rack_displacement", "spring_actuator"
    )
    GENERAL: ClassVar[ModuleType] = multi_link
    ADDITION: ClassVar[str] = "multi link"
    STARTER: ClassVar[str] = "multi_link_car"
    STOPPED: ClassVar[str] = "damper"
    PAGE: ClassVar[str] = """: five links between chassis and knuckle.

Two upper and two lower links and a toe link (`tie_rod`) hold the knuckle; two links that meet at a
point of the knuckle are an arm. The spring acts on the rear lower link, the damper on the knuckle.
The free length of the spring is given directly (`free_length_mm`) or by the force at the design
position (`force_at_design_N`). The stops depend on the length of the damper."""

    suspension: Literal["multi_link"] = Field(description="the kind of suspension")
    hardpoints: MultiLinkHardpoints = Field(description="the points that define the geometry")
    spring: SpringSection = Field(description="the spring, between chassis and rear lower link")
    damper: ApartDamper = Field(description="the damper, between chassis and knuckle")
    bodies: MultiLinkBodies = Field(description="masses and inertia")

    # -- its equations --------------------------------------------------------------------------

    def parameters(self) -> dict[str, float]:
        """Return the parameters of `CoilSprung` and the points of the height sensor [m].

        The sensor is a lever of 0.5 m above the wheel, whose tip a rod of 1 m connects with the
        wheel centre.
        """
        tip = self.hardpoints.metres("wheel_center") + _ABOVE * _UP
        hinge = tip - np.array([0.0, self.vehicle.sign * _LEVER, 0.0])
        along = np.array([_BEARING, 0.0, 0.0])
        return {
            **super().parameters(),
            **components("sensor_front", hinge + along),
            **components("sensor_rear", hinge - along),
            **components("sensor_tip", tip),
        }

    # -- its geometry ---------------------------------------------------------------------------

    def lengths(self) -> dict[str, float]:
        points = self.hardpoints
        links = {f"{link}_length": points.distance(*_ends(link)) for link in LINKS}
        return links | {
            "spring_length": points.distance("spring_seat", "spring_top"),
            "damper_length": points.distance("damper_seat", "damper_top"),
        }

    def drawing(self) -> Drawing:
        return Drawing(
            links={
                **{
                    _WORDS[link]: (inner, outer, "upper arm" if "upper" in link else "arm")
                    for link in LINKS
                    for outer, inner in [_ends(link)]
                },
                "spring": ("spring_top", "spring_seat", "strut"),
                "damper": ("damper_top", "damper_seat", "strut"),
                "toe link": ("tie_rod_inner", "tie_rod_outer", "rod"),
            },
            knuckle=(
                "tie_rod_outer",
                "rear_lower_link_outer",
                "rear_upper_link_outer",
                "front_upper_link_outer",
                "wheel_center",
                "front_lower_link_outer",
                "rear_lower_link_outer",
            ),
            legend={"arm": "links", "strut": "damper"},
            damper=Axis("damper_seat", "damper_top", 0.5),
            spring=Axis("spring_seat", "spring_top", 0.0),
            upright=("rear_lower_link_outer", "rear_upper_link_outer"),
            brackets={
                **{link: _ends(link) for link in LINKS},
                "seat": (("spring_seat", *_ends("rear_lower_link")), "spring_seat"),
            },
        )

    # -- its structure --------------------------------------------------------------------------

    def structure(self) -> Structure:
        """Return the joints; the spring acts on the rear lower link, the damper on the knuckle."""
        links = [
            joint
            for link in LINKS
            for outer, inner in [_ends(link)]
            for joint in (
                SphericalJoint("knuckle", link, (outer,), inner),
                UniversalJoint("chassis", link, (inner,), outer, (0.0, 0.0, 1.0)),
            )
        ]
        spring = LineForce(
            "spring",
            ("spring_force", self.NAMES.actuator),
            "chassis",
            "rear_lower_link",
            ("spring_top", "spring_seat"),
        )
        damper = LineForce(
            "damper", FORCES_OF_A_DAMPER, "chassis", "knuckle", ("damper_top", "damper_seat")
        )
        return Structure(steered(*links, by=self.steering_gear.TIE_RODS_ON), (spring, damper))

    # -- its characteristics --------------------------------------------------------------------

    def links_at(self, points: Mapping[str, Array], travel: CarrierMotion) -> tuple[Plane, Plane]:
        """Return two planes through the axis about which the knuckle turns over wheel travel.

        The links are not in two planes: the axis is the screw axis of the motion, with the toe link
        held.
        """
        nearest = travel.axis_nearest(points["wheel_center"])
        _, across, other = frame(travel.turning)
        return Plane(nearest, across), Plane(nearest, other)
