"""The section of a stop at the end of a strut or a damper."""

from pydantic import Field

from .section import NonNegative, Number, Section
from .units import in_metres


class StopSection(Section):
    """A progressive stop with the force ``rate x + progression x^3`` for the compression x.

    The clearance is the travel of strut or damper from the design position to first contact.
    """

    clearance_mm: Number = Field(
        description="travel of strut or damper from design to first contact"
    )
    rate_N_per_m: NonNegative = Field(  # noqa: N815
        description="rate at first contact"
    )
    progression_N_per_mm3: NonNegative = Field(  # noqa: N815
        default=0.0, description="cubic term: force / compression^3"
    )

    def parameters(self, side: str, design_length: float) -> dict[str, float]:
        """Return the parameters of the stop of a side, "bump" or "rebound", in SI units."""
        sense = -1.0 if side == "bump" else 1.0
        return {
            f"{side}_stop_length": design_length + sense * in_metres(self.clearance_mm, "mm"),
            f"{side}_stop_rate": self.rate_N_per_m,
            f"{side}_stop_progression": self.progression_N_per_mm3 * 1e9,
        }


NO_STOP = StopSection(clearance_mm=0.0, rate_N_per_m=0.0)
