"""The base of suspensions with a coil spring, and a damper with a rate or a curve."""

from collections.abc import Mapping
from types import ModuleType
from typing import Any, ClassVar, Self

from pydantic import Field

from ...core.errors import InputError
from ...systems.allowed import LengthLimit
from ..input.curve import WAYS, Interpolation, Numbers
from ..input.damper import Damper, curve_problems
from ..input.hardpoints import Pair
from ..input.section import NonNegative, Positive, Section
from ..input.spring import SEATS, SpringSection
from ..input.units import in_metres
from .base import Suspension
from .corner import SpringForce, Stroke, Strokes


class CoilDamper(Section):
    """The damper, between the same two points as the spring.

    It has a rate, or a curve through measured points: velocities are positive in bump, forces if
    they resist bump (see `input.damper.Damper`). Its friction is ``friction v / sqrt(v^2 +
    friction_velocity^2)``.
    """

    ENDS: ClassVar[Pair] = SEATS  # hardpoints between which it acts

    rate_N_s_per_m: NonNegative | None = Field(  # noqa: N815 (N is the newton)
        default=None,
        description="rate of a linear damper in bump and rebound, unless it has a curve",
    )
    velocity_m_per_s: Numbers | None = Field(
        default=None, description="curve instead of a rate: velocities, rising; positive in bump"
    )
    force_N: Numbers | None = Field(  # noqa: N815
        default=None,
        description="forces at these velocities; positive if they resist bump",
    )
    interpolation: Interpolation | None = Field(
        default=None, description=f"{WAYS}; by default cubic"
    )
    friction_N: NonNegative = Field(  # noqa: N815
        default=0.0, description="friction of the damper in full sliding"
    )
    friction_velocity_m_per_s: Positive = Field(
        default=0.01, description="velocity at which 71 % of the friction is reached"
    )
    length_min_mm: Positive | None = Field(
        default=None,
        description="distance of spring_seat and spring_top with the damper fully compressed; no "
        "position beyond it is returned",
    )
    length_max_mm: Positive | None = Field(
        default=None, description="the same distance with the damper fully extended"
    )

    @property
    def curve(self) -> Damper | None:
        """The curve; None if the damper has a rate."""
        if self.velocity_m_per_s is None or self.force_N is None:
            return None
        return Damper(
            velocity_m_per_s=self.velocity_m_per_s,
            force_N=self.force_N,
            interpolation=self.interpolation or "cubic",
        )

    def problems(self) -> list[str]:
        keys = ("velocity_m_per_s", "force_N", "interpolation")
        by_curve = [key for key in keys if getattr(self, key) is not None]
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
        """Return the problems of the length of the damper at the design position [m]."""
        length = 1e3 * at_design
        ends = (
            ("length_min_mm", self.length_min_mm, 1.0, "or more", "Lower"),
            ("length_max_mm", self.length_max_mm, -1.0, "or less", "Raise"),
        )
        return [
            f"[damper] {key} = {end:g} mm, and at design the damper is {length:.1f} mm long, the "
            f"distance of {' and '.join(self.ENDS)}; {end:g} mm {needed} is needed. {change} "
            f"{key}, or correct these hardpoints."
            for key, end, sense, needed, change in ends
            if end is not None and sense * (length - end) < 0.0
        ]

    def allowed_lengths(self, signal: str) -> tuple[LengthLimit, ...]:
        """Return the limits of a signal by the least and the greatest length in the file."""
        ends = (("min", 1.0, "least"), ("max", -1.0, "greatest"))
        given = ((getattr(self, f"length_{end}_mm"), end, sign, name) for end, sign, name in ends)
        return tuple(
            LengthLimit(
                signal,
                sign * in_metres(value, "mm"),
                "damper",
                f"{name} length, [damper] length_{end}_mm = {value:g} mm",
            )
            for value, end, sign, name in given
            if value is not None
        )


class ApartDamper(CoilDamper):
    """The damper, with ends of its own.

    It has a rate, or a curve through measured points: velocities are positive in bump, forces if
    they resist bump (see `input.damper.Damper`). Its friction is ``friction v / sqrt(v^2 +
    friction_velocity^2)``.
    """

    ENDS: ClassVar[Pair] = ("damper_seat", "damper_top")

    length_min_mm: Positive | None = Field(
        default=None,
        description="distance of damper_seat and damper_top with the damper fully compressed; no "
        "position beyond it is returned",
    )


class CoilSprung(Suspension):
    """A suspension with a coil spring and a damper, each between two hardpoints."""

    # equations with spring and damper alone, and with everything of `beyond_the_plain`
    PLAIN: ClassVar[ModuleType]
    GENERAL: ClassVar[ModuleType]
    # element that is beyond plain equations in every file of the kind, which has no others
    ADDITION: ClassVar[str] = ""

    spring: SpringSection = Field(description="the spring")
    damper: CoilDamper = Field(description="the damper")

    # -- its equations --------------------------------------------------------------------------

    def equations(self, *, free_rack: bool) -> ModuleType:
        """Return the equations, in which the rack is prescribed."""
        if free_rack:
            rack = f"the rack of a {self.TITLE} is prescribed"
            problem = rack if self.steered() else f"a {self.TITLE} is not steered"
            raise InputError([f"free_rack=True: {problem}. Leave it out."], "Model")
        return self.GENERAL if self.beyond_the_plain() else self.PLAIN

    def without_friction(self) -> Self:
        return self.with_changes({"damper.friction_N": 0.0}) if self.damper.friction_N else self

    def beyond_the_plain(self) -> list[str]:
        """Return the sections and keys that plain equations do not have.

        Examples
        --------
        >>> from kintrafo import Suspension
        >>> car = Suspension.load("double_wishbone_car")
        >>> car.beyond_the_plain(), car.with_changes({"tyre.lifts_off": True}).beyond_the_plain()
        ([], ['[tyre] lifts_off'])
        """
        own = {
            self.ADDITION: bool(self.ADDITION),
            "[damper] friction_N": self.damper.friction_N > 0.0,
            "[damper] velocity_m_per_s": self.damper.curve is not None,
            "[spring] force_N": self.spring.by_curve,
        }
        return [name for name, is_present in own.items() if is_present] + self.extras()

    def parameters(self) -> dict[str, float]:
        """Return the parameters of the equations of motion, in SI units.

        They are `shared_parameters`, ``spring_rate`` in N/m, ``spring_free_length`` in m and
        ``damper_rate`` in N s/m; with anything of `beyond_the_plain` the further ones of
        ``generated.double_wishbone_general``.
        """
        damper, points = self.damper, self.hardpoints
        general = bool(self.beyond_the_plain())
        values = {
            **self.shared_parameters(),
            **self.spring.parameters(points.distance(*SEATS), general=general),
            "damper_rate": damper.rate_N_s_per_m or 0.0,
        }
        if not general:
            return values
        friction = {
            "damper_friction": damper.friction_N,
            "damper_friction_speed": damper.friction_velocity_m_per_s,
        }
        length = points.distance(*damper.ENDS)
        return values | friction | self.parameters_of_extras(length, damper.curve)

    # -- its geometry ---------------------------------------------------------------------------

    def allowed_lengths(self) -> tuple[LengthLimit, ...]:
        return self.damper.allowed_lengths(f"{self.STOPPED}_length")

    # -- its characteristics --------------------------------------------------------------------

    def spring_at(self, strokes: Strokes) -> SpringForce:
        return strokes.spring("spring_force", "spring")

    def damper_at(self, strokes: Strokes) -> Stroke:
        return strokes.stroke(self.STOPPED)

    # -- its checks -----------------------------------------------------------------------------

    @classmethod
    def further_problems(cls, sections: Mapping[str, Any]) -> list[str]:
        damper, points = sections.get("damper"), sections["hardpoints"]
        return [] if damper is None else damper.length_problems(points.distance(*damper.ENDS))
