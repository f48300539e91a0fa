"""A damper curve: force over velocity from a table."""

import numpy as np
from pydantic import Field

from .curve import WAYS, Curve, Interpolation, Numbers, no_curve, point_problems
from .section import Section

TABLE = "damper_table"
"""The name of the curve in the equations."""


def curve_problems(v: tuple[float, ...], force: tuple[float, ...]) -> list[str]:
    """Return the problems of velocities [m/s] and forces [N] of a dissipative damper."""
    problems = point_problems("velocity_m_per_s", "m/s", v, force)
    if problems:
        return problems
    wrong = [(a, f) for a, f in ((v[0], force[0]), (v[-1], force[-1])) if a * f < 0.0]
    return [
        f"force_N = {f} N at {a} m/s pushes along with the motion; a damper resists it. Enter "
        "forces that are positive in bump and negative in rebound, as the velocities are."
        for a, f in wrong
    ]


class Damper(Section):
    """A curve through measured points.

    Between the points the curve is a monotone cubic (Fritsch and Carlson), or linear with
    `interpolation`; outside them it is linear. Velocity is positive in bump, force positive if it
    resists bump.
    """

    velocity_m_per_s: Numbers = Field(description="velocities, rising; positive in bump")
    force_N: Numbers = Field(  # noqa: N815 (N is the newton)
        description="forces at these velocities; positive if they resist bump"
    )
    interpolation: Interpolation = Field(default="cubic", description=WAYS)

    def problems(self) -> list[str]:
        return curve_problems(self.velocity_m_per_s, self.force_N)

    def parameters(self) -> dict[str, float]:
        """Return the coefficients of the curve by the names in the equations, in SI units."""
        v, force = np.array(self.velocity_m_per_s), np.array(self.force_N)
        return Curve(v, force, self.interpolation, as_secants=False).parameters(TABLE)


NO_CURVE = no_curve(TABLE)
"""The coefficients of a damper without a curve."""
