"""The double wishbone suspension: two arms, of which the lower one carries spring and damper.

Its hardpoints, sections, bodies and checks, its equations and their parameters, what its
characteristics are computed from, and how it is drawn.
"""

from collections.abc import Mapping
from types import ModuleType
from typing import Any, ClassVar, Literal, Self

import numpy as np
from pydantic import Field

from ...core.errors import InputError
from ...generated import double_wishbone, double_wishbone_general
from ..base import Suspension
from ..corner import Array, Plane, Stroke
from ..corner import Spring as SpringStroke
from ..drawing import Axis, Drawing
from ..facts import Allowed, Names
from ..input.bodies import Bodies, Rack, RigidBody, TieRod
from ..input.damper import Damper, Numbers, curve_problems
from ..input.hardpoints import SMALLEST_DISTANCE, Hardpoints, Pair
from ..input.section import NonNegative, Number, Positive, Section, Triple
from ..input.units import in_metres
from ..input.vectors import Vector, distance_from_line, unit_vector
from ..strokes import Strokes
from ..structure import FORCES_OF_A_DAMPER, Ball, Hinge, Line, Structure, steered

_UP = np.array([0.0, 0.0, 1.0])

# The points that belong to one body, or to the spring.
_LOWER_ARM = ("lower_arm_front", "lower_arm_rear", "lower_ball_joint")
_UPPER_ARM = ("upper_arm_front", "upper_arm_rear", "upper_ball_joint")
_KNUCKLE = ("lower_ball_joint", "upper_ball_joint", "tie_rod_outer", "wheel_center")
_TIE_ROD = ("tie_rod_inner", "tie_rod_outer")
_SPRING = ("spring_seat", "spring_top")
_POINTS_OF_BODIES = {
    "lower arm": _LOWER_ARM,
    "upper arm": _UPPER_ARM,
    "knuckle": _KNUCKLE,
    "tie rod": _TIE_ROD,
    "spring": _SPRING,
}

# Bodies that the equations leave without mass.
_MASSLESS = ("tie_rod", "rack")


class DoubleWishboneHardpoints(Hardpoints):
    """The points that define a double wishbone suspension, at the design position.

    All are in chassis axes (ISO 8855: x forward, y left, z up), in the unit that `unit` names.
    """

    CARRIERS: ClassVar[Mapping[str, str]] = {
        "lower_ball_joint": "knuckle",
        "upper_ball_joint": "knuckle",
        "tie_rod_outer": "knuckle",
        "wheel_center": "knuckle",
        "tie_rod_inner": "rack",
        "spring_seat": "lower_arm",
    }
    ARMS: ClassVar[Mapping[str, Pair]] = {
        "lower_ball_joint": ("lower_arm_front", "lower_arm_rear"),
        "upper_ball_joint": ("upper_arm_front", "upper_arm_rear"),
    }
    JOINTS: ClassVar[tuple[str, ...]] = (
        "lower_ball_joint",
        "upper_ball_joint",
        "tie_rod_outer",
        "tie_rod_inner",
    )
    STEERING_AXIS: ClassVar[Pair] = ("lower_ball_joint", "upper_ball_joint")

    lower_arm_front: Triple = Field(description="front bearing of the lower arm")
    lower_arm_rear: Triple = Field(description="rear bearing of the lower arm")
    upper_arm_front: Triple = Field(description="front bearing of the upper arm")
    upper_arm_rear: Triple = Field(description="rear bearing of the upper arm")
    lower_ball_joint: Triple = Field(description="ball joint of lower arm and knuckle")
    upper_ball_joint: Triple = Field(description="ball joint of upper arm and knuckle")
    tie_rod_outer: Triple = Field(description="ball joint of tie rod and knuckle")
    tie_rod_inner: Triple = Field(description="joint of tie rod and rack")
    spring_top: Triple = Field(description="upper end of spring and damper, on the chassis")
    spring_seat: Triple = Field(description="lower end of spring and damper, on the lower arm")
    wheel_center: Triple = Field(description="centre of the wheel")

    def steering_axis(self) -> Vector | None:
        """Return the unit vector from the lower to the upper ball joint; None if they coincide."""
        if self.distance(*self.STEERING_AXIS) < SMALLEST_DISTANCE:
            return None
        low, high = map(self.metres, self.STEERING_AXIS)
        return unit_vector(high - low)

    def geometry_problems(self) -> list[str]:
        """Say why the mechanism cannot move, or cannot be told from its mirror image.

        Returns
        -------
        list of str
            One text for each problem.
        """
        coinciding = self.coinciding(_POINTS_OF_BODIES)
        problems = self.coincidence_problems(coinciding)
        # The other checks need the directions that these pairs of points define.
        bad = set(coinciding.values())
        axis = self.steering_axis()
        for body, points in (("lower arm", _LOWER_ARM), ("upper arm", _UPPER_ARM)):
            if body not in bad:
                problems += self.hinge_problems(*points)
        if "tie rod" not in bad:
            problems += self.cross_problems(_TIE_ROD, "tie rod", _UP, "the vertical")
        if axis is not None:
            problems += self._upside_down()
            if "upper arm" not in bad:
                problems += self._dead_centre(axis)
            if not bad & {"knuckle", "tie rod"}:
                problems += self.steering_problems()
        return problems

    def _upside_down(self) -> list[str]:
        """Check that the upper ball joint is above the lower one."""
        low, high = map(self.metres, self.STEERING_AXIS)
        rise = float(high[2] - low[2])
        if rise >= SMALLEST_DISTANCE:
            return []
        problem = (
            f"{self.text(*self.STEERING_AXIS)}: the upper ball joint is {1000 * rise:.3f} mm above "
            f"the lower one; at least {1000 * SMALLEST_DISTANCE:g} mm are needed. Swap the arms, "
            "or correct z."
        )
        return [problem]

    def _dead_centre(self, axis: Vector) -> list[str]:
        """Check that the knuckle can turn the upper arm, as it has to when the wheel moves."""
        hinge = self.metres("upper_arm_front") - self.metres("upper_arm_rear")
        arm = self.metres("upper_ball_joint") - self.metres("upper_arm_rear")
        lever = abs(float(np.cross(arm, axis) @ unit_vector(hinge)))
        if lever >= SMALLEST_DISTANCE:
            return []
        problem = (
            f"{self.text(*self.STEERING_AXIS)}: the knuckle pulls the upper arm with a lever of "
            f"{1000 * lever:.3f} mm about its hinge; at least {1000 * SMALLEST_DISTANCE:g} mm are "
            "needed, or the linkage is at its dead centre. Move lower_ball_joint out of the plane "
            "of the upper arm."
        )
        return [problem]


class Spring(Section):
    """The spring between chassis and lower arm.

    Its force, positive when it pushes its ends apart, is ``rate (free_length - length)``. Where it
    is free of force is said in one of two ways.
    """

    rate_N_per_m: NonNegative = Field(  # noqa: N815 (N is the newton)
        description="rate of the spring"
    )
    free_length_mm: Positive | None = Field(
        default=None,
        description="distance of spring_seat and spring_top with the spring force-free",
    )
    force_at_design_N: Number | None = Field(  # noqa: N815
        default=None, description="force of the spring at the design position"
    )

    def problems(self) -> list[str]:
        """See that the spring's free state is given once, and can be found."""
        given = [
            key for key in ("free_length_mm", "force_at_design_N") if getattr(self, key) is not None
        ]
        if len(given) != 1:
            found = "both are given" if given else "neither is given"
            problem = (
                "where the spring is free of force is said by one of free_length_mm and "
                f"force_at_design_N; {found}. Keep one."
            )
            return [problem]
        if self.force_at_design_N is not None and self.rate_N_per_m == 0.0:
            problem = (
                f"force_at_design_N = {self.force_at_design_N} N needs a spring, but rate_N_per_m "
                "= 0.0 N/m; more than 0 N/m is needed. Enter the rate, or a free length."
            )
            return [problem]
        return []

    def free_length(self, at_design: float) -> float:
        """Return the length at which the spring is free of force [m].

        Parameters
        ----------
        at_design : float
            Its length at the design position [m].
        """
        if self.force_at_design_N is not None:
            return at_design + self.force_at_design_N / self.rate_N_per_m
        if self.free_length_mm is None:  # refused with the section
            return at_design
        return in_metres(self.free_length_mm, "mm")


class CoilDamper(Section):
    """The damper, between the same two points as the spring.

    It has a rate, or a curve through measured points: velocities are positive in bump, forces where
    they resist bump (see `input.damper.Damper`). Its friction is ``friction v / sqrt(v^2 +
    friction_velocity^2)``.
    """

    rate_N_s_per_m: NonNegative | None = Field(  # noqa: N815 (N is the newton)
        default=None,
        description="rate of a linear damper, the same in bump and rebound; or else a curve",
    )
    velocity_m_per_s: Numbers | None = Field(
        default=None, description="of a curve instead: velocities, rising; positive in bump"
    )
    force_N: Numbers | None = Field(  # noqa: N815
        default=None,
        description="forces at these velocities; positive where they resist bump",
    )
    friction_N: NonNegative = Field(  # noqa: N815
        default=0.0, description="friction of the damper in full sliding"
    )
    friction_velocity_m_per_s: Positive = Field(
        default=0.01, description="velocity at which 71 % of the friction is reached"
    )
    length_min_mm: Positive | None = Field(
        default=None,
        description="distance of spring_seat and spring_top with the damper pressed in as far as "
        "it goes; no position beyond it is returned",
    )
    length_max_mm: Positive | None = Field(
        default=None, description="the same with the damper drawn out as far as it goes"
    )

    @property
    def curve(self) -> Damper | None:
        """The curve; None where the damper has a rate."""
        if self.velocity_m_per_s is None or self.force_N is None:
            return None
        return Damper(velocity_m_per_s=self.velocity_m_per_s, force_N=self.force_N)

    def problems(self) -> list[str]:
        """See that the damper is given once, and as a curve by both of its keys."""
        by_curve = [
            key for key in ("velocity_m_per_s", "force_N") if getattr(self, key) is not None
        ]
        if self.rate_N_s_per_m is not None and by_curve:
            problem = (
                f"rate_N_s_per_m = {self.rate_N_s_per_m} N s/m and {by_curve[0]} both describe the "
                "damper; one is allowed. Remove the other."
            )
            return [problem]
        if self.velocity_m_per_s is not None and self.force_N is not None:
            return curve_problems(self.velocity_m_per_s, self.force_N)
        if self.rate_N_s_per_m is None:
            problem = (
                "rate_N_s_per_m is missing: rate of the damper, unless velocity_m_per_s and "
                "force_N give its curve. Add a line `rate_N_s_per_m = ...`, in N s/m."
            )
            return [problem]
        return []

    def length_problems(self, at_design: float) -> list[str]:
        """Say why the damper cannot be as long as it is at the design position [m]."""
        length = 1e3 * at_design
        ends = (
            ("length_min_mm", self.length_min_mm, 1.0, "or more", "Lower"),
            ("length_max_mm", self.length_max_mm, -1.0, "or less", "Raise"),
        )
        return [
            f"[damper] {key} = {end:g} mm, and at design the damper is {length:.1f} mm long, the "
            f"distance of spring_seat and spring_top; {end:g} mm {needed} is needed. {change} "
            f"{key}, or correct these hardpoints."
            for key, end, sense, needed, change in ends
            if end is not None and sense * (length - end) < 0.0
        ]


class LowerArm(RigidBody):
    """The lower arm."""

    def default_centre_of_mass(self, points: Hardpoints) -> Vector:
        """Return the centroid of the arm's three hardpoints, in m."""
        return _centroid(points, _LOWER_ARM)


class UpperArm(RigidBody):
    """The upper arm."""

    def default_centre_of_mass(self, points: Hardpoints) -> Vector:
        """Return the centroid of the arm's three hardpoints, in m."""
        return _centroid(points, _UPPER_ARM)


class Upright(RigidBody):
    """The knuckle between the ball joints."""

    def default_centre_of_mass(self, points: Hardpoints) -> Vector:
        """Return the midpoint of the two ball joints, in m."""
        return _centroid(points, DoubleWishboneHardpoints.STEERING_AXIS)


def _centroid(points: Hardpoints, names: tuple[str, ...]) -> Vector:
    total: Vector = np.sum([points.metres(name) for name in names], axis=0)
    return total / len(names)


class DoubleWishboneBodies(Bodies):
    """All bodies. Tie rod and rack have no mass in the equations of this suspension."""

    MASSLESS: ClassVar[tuple[str, ...]] = _MASSLESS

    lower_arm: LowerArm = Field(description="the lower arm")
    upper_arm: UpperArm = Field(description="the upper arm")
    knuckle: Upright = Field(description="the knuckle")
    tie_rod: TieRod = Field(default=TieRod(mass_kg=0.0), description="the tie rod, without mass")
    rack: Rack = Field(default=Rack(mass_kg=0.0), description="the rack, without mass")

    def problems(self) -> list[str]:
        """Refuse mass that the equations would leave out."""
        heavy = {name: getattr(self, name).mass_kg for name in self.MASSLESS}
        return [
            f"{name}.mass_kg = {mass} kg: the equations of a double wishbone leave this body "
            "without mass; allowed is 0 kg. Set it to 0, and add what moves with the knuckle there."
            for name, mass in heavy.items()
            if mass > 0.0
        ]


class DoubleWishbone(Suspension):
    """A double wishbone suspension with a tie rod at its design position; see `Suspension`.

    Spring and damper act between the chassis and the lower arm.
    """

    TITLE: ClassVar[str] = "double wishbone suspension"
    NAMES: ClassVar[Names] = Names(
        "arm_angle", "spin_angle", "rack_displacement", "spring_actuator"
    )
    STARTER: ClassVar[str] = "double_wishbone_car"
    STOPPED: ClassVar[str] = "spring"
    PAGE: ClassVar[str] = """.

Where the spring is free of force is said by the distance of its ends (`free_length_mm`) or by its
force at the design position (`force_at_design_N`). Spring and damper are on the lower arm. The
damper has a rate or a curve; the stops are touched by its length."""

    suspension: Literal["double_wishbone"] = Field(description="the kind of suspension")
    hardpoints: DoubleWishboneHardpoints = Field(description="the points that define the geometry")
    spring: Spring = Field(description="the spring, between chassis and lower arm")
    damper: CoilDamper = Field(description="the damper, on the spring's axis")
    bodies: DoubleWishboneBodies = Field(description="masses and inertia")

    # -- its equations --------------------------------------------------------------------------

    def equations(self, *, free_rack: bool) -> ModuleType:
        """Return the equations, in which the rack is prescribed."""
        if free_rack:
            problem = f"free_rack=True: the rack of a {self.TITLE} is prescribed. Leave that out."
            raise InputError([problem], "Model")
        return double_wishbone_general if self.beyond_the_plain() else double_wishbone

    def without_friction(self) -> Self:
        """Return the same suspension without the friction of its damper."""
        return self.with_changes({"damper.friction_N": 0.0}) if self.damper.friction_N else self

    def beyond_the_plain(self) -> list[str]:
        """Return what this suspension has that the plain equations leave out.

        Returns
        -------
        list of str
            Sections and keys; empty for spring and damper alone.

        Examples
        --------
        >>> from kintrafo import Suspension
        >>> car = Suspension.load("double_wishbone_car")
        >>> car.beyond_the_plain(), car.with_changes({"tyre.lifts_off": True}).beyond_the_plain()
        ([], ['[tyre] lifts_off'])
        """
        own = {
            "[damper] friction_N": self.damper.friction_N > 0.0,
            "[damper] velocity_m_per_s": self.damper.curve is not None,
        }
        return [name for name, is_present in own.items() if is_present] + self.extras()

    def parameters(self) -> dict[str, float]:
        """Return everything that the equations of motion need, in SI units.

        Returns
        -------
        dict of str to float
            Besides `shared_parameters`: ``spring_rate`` in N/m, ``spring_free_length`` in m and
            ``damper_rate`` in N s/m; with anything of `beyond_the_plain` what
            ``generated.double_wishbone_general`` lists besides.
        """
        length, damper = self.hardpoints.distance(*_SPRING), self.damper
        values = self.shared_parameters() | {
            "spring_rate": self.spring.rate_N_per_m,
            "spring_free_length": self.spring.free_length(length),
            "damper_rate": damper.rate_N_s_per_m or 0.0,
        }
        if not self.beyond_the_plain():
            return values
        friction = {
            "damper_friction": damper.friction_N,
            "damper_friction_speed": damper.friction_velocity_m_per_s,
        }
        return values | friction | self.parameters_of_extras(length, damper.curve)

    # -- its geometry ---------------------------------------------------------------------------

    def lengths(self) -> dict[str, float]:
        """Return the lengths of the arms and of the spring at design [m]."""
        points = self.hardpoints
        arms = {
            f"{ball.removesuffix('_ball_joint')}_arm_length": distance_from_line(
                *(points.metres(name) for name in (ball, *bearings))
            )
            for ball, bearings in points.ARMS.items()
        }
        return arms | {"spring_length": points.distance(*_SPRING)}

    def allowed_lengths(self) -> tuple[Allowed, ...]:
        """Return the least and the greatest length of the damper, where they are given."""
        ends = (("min", 1.0, "least"), ("max", -1.0, "greatest"))
        given = ((getattr(self.damper, f"length_{end}_mm"), end, sign, n) for end, sign, n in ends)
        return tuple(
            Allowed(
                "spring_length",
                sign * in_metres(value, "mm"),
                f"the damper is at its {name} length, [damper] length_{end}_mm = {value:g} mm",
            )
            for value, end, sign, name in given
            if value is not None
        )

    def drawing(self) -> Drawing:
        """Return how arms, spring and tie rod are drawn; the lower arm holds the spring."""
        held = {
            f"{end}_bracket": ("spring_seat", "lower_ball_joint", f"lower_arm_{end}")
            for end in ("front", "rear")
        }
        return Drawing(
            links={
                "lower arm": ("lower_arm_front", "lower_ball_joint", "arm"),
                "upper arm": ("upper_arm_front", "upper_ball_joint", "upper arm"),
                "spring and damper": ("spring_top", "spring_seat", "strut"),
                "tie rod": ("tie_rod_inner", "tie_rod_outer", "rod"),
            },
            knuckle=(
                "tie_rod_outer",
                "lower_ball_joint",
                "upper_ball_joint",
                "wheel_center",
                "lower_ball_joint",
            ),
            legend={"arm": "control arms", "strut": "damper"},
            damper=Axis("spring_seat", "spring_top", 0.5),
            spring=Axis("spring_seat", "spring_top", 0.32),
            upright=self.hardpoints.STEERING_AXIS,
            brackets={name: (place, "spring_seat") for name, place in held.items()},
        )

    # -- what holds it together -----------------------------------------------------------------

    def structure(self) -> Structure:
        """Return the joints; spring, damper and stops act between chassis and lower arm."""
        arms = [
            joint
            for ball, bearings in self.hardpoints.ARMS.items()
            for arm in [ball.replace("ball_joint", "arm")]
            for joint in (Hinge("chassis", arm, bearings), Ball(arm, "knuckle", (ball,)))
        ]
        ends = ("chassis", "lower_arm", ("spring_top", "spring_seat"))
        damper = (*FORCES_OF_A_DAMPER, self.NAMES.actuator)
        lines = (Line("spring", ("spring_force",), *ends), Line("damper", damper, *ends))
        return Structure(steered(*arms), lines)

    # -- what its characteristics are computed from ---------------------------------------------

    def links_at(self, points: Mapping[str, Array]) -> tuple[Plane, Plane]:
        """Return the planes of the lower and of the upper arm."""
        lower, upper = (
            Plane(points[ball], np.cross(points[front] - points[rear], points[ball] - points[rear]))
            for ball, (front, rear) in self.hardpoints.ARMS.items()
        )
        return lower, upper

    def spring_at(self, strokes: Strokes) -> SpringStroke:
        """Return the spring, which acts on the lower arm."""
        return strokes.spring("spring_force", "spring")

    def damper_at(self, strokes: Strokes) -> Stroke:
        """Return the stroke of the damper, which is on the spring's axis."""
        return strokes.stroke("spring")

    # -- its checks -----------------------------------------------------------------------------

    @classmethod
    def further_problems(cls, sections: Mapping[str, Any]) -> list[str]:
        """Say what is wrong with the damper together with the hardpoints."""
        damper, points = sections.get("damper"), sections["hardpoints"]
        return [] if damper is None else damper.length_problems(points.distance(*_SPRING))
