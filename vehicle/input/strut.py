"""The section of a strut: its spring and damper."""

from pydantic import Field

from .damper import Damper
from .section import NonNegative, Number, Positive, Section
from .units import in_metres

_RATE = "spring_rate_N_per_m"
_FREE = (
    "spring_free_slide_mm",
    "spring_free_length_mm",
    "spring_preload_N",
    "spring_force_at_design_N",
)


class StrutSection(Section):
    """Spring and damper in the strut.

    The slide of the strut is ``length_max - length``, which grows as the wheel rises. The force
    that pushes knuckle and chassis apart is ``spring_rate (slide - spring_free_slide) +
    damper_rate * slide velocity``, less the friction. The free length of the spring is given in one
    of four ways; slide and preload are for a spring that is concentric with the strut.
    """

    length_max_mm: Number = Field(
        description="distance of strut_lower (or else ball_joint) and strut_top, strut extended"
    )
    length_min_mm: Positive | None = Field(
        default=None,
        description="the same distance with the strut fully compressed; no position beyond it is "
        "returned",
    )
    spring_rate_N_per_m: NonNegative | None = Field(  # noqa: N815 (N is the newton)
        default=None, description="rate of the spring; a curve is in [spring]"
    )
    spring_free_slide_mm: Number | None = Field(
        default=None, description="slide of the strut at which the force of the spring is zero"
    )
    spring_free_length_mm: Positive | None = Field(
        default=None, description="distance of the seats at which the force of the spring is zero"
    )
    spring_preload_N: NonNegative | None = Field(  # noqa: N815
        default=None, description="force of the spring with the strut fully extended"
    )
    spring_force_at_design_N: Number | None = Field(  # noqa: N815
        default=None, description="force of the spring at the design position"
    )
    damper_rate_N_s_per_m: NonNegative | None = Field(  # noqa: N815
        default=None, description="rate of a linear damper; a curve is in [damper]"
    )
    friction_N: NonNegative = Field(  # noqa: N815
        default=0.0, description="friction of the strut in full sliding"
    )
    friction_velocity_m_per_s: Positive = Field(
        default=0.01, description="velocity at which 71 % of the friction is reached"
    )

    def problems(self) -> list[str]:
        given = [key for key in _FREE if getattr(self, key) is not None]
        if self.spring_rate_N_per_m is None:
            return []  # `spring_problems` checks that there is a [spring] instead
        if len(given) != 1:
            found = f"{' and '.join(given)} are given. Keep" if given else "none is given. Add"
            problem = f"exactly one of {', '.join(_FREE)} is needed; {found} one."
            return [problem]
        by_force = given[0].endswith("_N")
        if by_force and self.spring_rate_N_per_m == 0.0:
            problem = (
                f"{given[0]} = {getattr(self, given[0])} N needs a spring, but spring_rate_N_per_m "
                "= 0.0 N/m; more than 0 N/m is needed. Enter the rate, or a free length."
            )
            return [problem]
        return []

    @property
    def _rate(self) -> float:
        assert self.spring_rate_N_per_m is not None  # refused with the section
        return self.spring_rate_N_per_m

    @property
    def length_max(self) -> float:
        """The length of the extended strut [m]."""
        return in_metres(self.length_max_mm, "mm")

    def free_slide(self, seats: float) -> float:
        """Return the slide without force of a concentric spring, from its length at design [m]."""
        if self.spring_free_slide_mm is not None:
            return in_metres(self.spring_free_slide_mm, "mm")
        return self.length_max - self.free_length(seats)

    def free_length(self, seats: float) -> float:
        """Return the length of the spring without force, from its length at design [m]."""
        if self.spring_free_length_mm is not None:
            return in_metres(self.spring_free_length_mm, "mm")
        if self.spring_force_at_design_N is not None:
            return seats + self.spring_force_at_design_N / self._rate
        if self.spring_preload_N is not None:
            return self.length_max + self.spring_preload_N / self._rate
        return self.length_max - self.free_slide(seats)

    def spring_problems(self, *, own_seats: bool, described: bool) -> list[str]:
        """Return the problem of a spring that is described twice, or not, or not by its own seats.

        It has seats of its own if `own_seats`; if `described`, another section describes it.
        """
        keys = [key for key in (_RATE, *_FREE) if getattr(self, key) is not None]
        if described and keys:
            problem = (
                f"[strut] {keys[0]} and [spring] both describe the spring; one is allowed. Remove "
                "the other."
            )
            return [problem]
        if self.spring_rate_N_per_m is None and not described:
            problem = (
                "[strut] spring_rate_N_per_m is missing: rate of the spring, unless a section "
                "[spring] describes it. Add a line `spring_rate_N_per_m = ...`, in N/m."
            )
            return [problem]
        given = self.spring_free_slide_mm if self.spring_preload_N is None else 0.0
        if given is None or not own_seats:
            return []
        key = "spring_preload_N" if self.spring_preload_N is not None else _FREE[0]
        problem = (
            f"[strut] {key} describes a spring that is concentric with the strut, but spring_top "
            "and spring_seat are given. Use spring_free_length_mm or spring_force_at_design_N."
        )
        return [problem]

    def parameters(self, damper: Damper | None) -> dict[str, float]:
        """Return the parameters of the strut without its spring, in SI units."""
        linear = self.damper_rate_N_s_per_m
        return {
            "strut_length_max": self.length_max,
            "damper_rate": 0.0 if linear is None or damper is not None else linear,
        }
