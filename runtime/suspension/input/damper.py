"""A damper curve: force over velocity from a table, smooth in between."""

from itertools import pairwise
from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator, Field
from scipy.interpolate import PchipInterpolator

from .section import Number, Section

# As many segments as the generated equations have.
SEGMENTS = 10


def _numbers(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray) else value


Numbers = Annotated[tuple[Number, ...], BeforeValidator(_numbers)]


def curve_problems(v: tuple[float, ...], force: tuple[float, ...]) -> list[str]:
    """Say why velocities [m/s] and forces [N] are no curve of a damper that takes energy."""
    if len(v) != len(force):
        problem = (
            f"velocity_m_per_s has {len(v)} values and force_N {len(force)}; as many are "
            "needed. Give one force for each velocity."
        )
        return [problem]
    if not 2 <= len(v) <= SEGMENTS + 1:
        problem = (
            f"velocity_m_per_s has {len(v)} values; allowed are 2 to {SEGMENTS + 1}. Leave out "
            "points where the curve is nearly straight."
        )
        return [problem]
    falling = [(a, b) for a, b in pairwise(v) if not b > a]
    if falling:
        a, b = falling[0]
        problem = (
            f"velocity_m_per_s: {b} m/s follows {a} m/s; velocities must rise. Sort the points "
            "and keep one force for each velocity."
        )
        return [problem]
    wrong = [(a, f) for a, f in ((v[0], force[0]), (v[-1], force[-1])) if a * f < 0.0]
    return [
        f"force_N = {f} N at {a} m/s pushes along with the motion; a damper resists it. Enter "
        "forces that are positive in bump and negative in rebound, as the velocities are."
        for a, f in wrong
    ]


class Damper(Section):
    """A curve through measured points.

    Between the points the curve is a monotone cubic (Fritsch and Carlson), outside them it goes on
    straight. Velocity is positive in bump, force positive where it resists bump.
    """

    velocity_m_per_s: Numbers = Field(description="velocities, rising; positive in bump")
    force_N: Numbers = Field(  # noqa: N815 (N is the newton)
        description="forces at these velocities; positive where they resist bump"
    )

    def problems(self) -> list[str]:
        """See that the points are a curve, and that the damper takes energy."""
        return curve_problems(self.velocity_m_per_s, self.force_N)

    def parameters(self) -> dict[str, float]:
        """Return the coefficients of the curve by the names in the equations, in SI units.

        Returns
        -------
        dict of str to float
            For each segment knot, inverse width and the three coefficients of its cubic in the
            part of the segment that is passed; segments without need have no force.
        """
        v, force = np.array(self.velocity_m_per_s), np.array(self.force_N)
        slope = PchipInterpolator(v, force).derivative()(v)
        width, rise = np.diff(v), np.diff(force)
        first, last = width * slope[:-1], width * slope[1:]
        table = {
            "knot": v,
            "inverse_width": 1.0 / width,
            "linear": first,
            "quadratic": 3.0 * rise - 2.0 * first - last,
            "cubic": first + last - 2.0 * rise,
        }
        values = {
            "first_force": force[0],
            "first_slope": slope[0],
            "last_slope": slope[-1],
        }
        values |= {f"{key}_{i}": x for key, row in table.items() for i, x in enumerate(row)}
        for i in range(len(width), SEGMENTS):  # segments that nothing is left for
            values |= dict.fromkeys((f"{key}_{i}" for key in table if key != "knot"), 0.0)
            values[f"knot_{i + 1}"] = v[-1]
        return {f"damper_table_{key}": float(x) for key, x in values.items()}


NO_CURVE = dict.fromkeys(Damper(velocity_m_per_s=(0.0, 1.0), force_N=(0.0, 0.0)).parameters(), 0.0)
"""The coefficients of none: no force at any velocity, and knots between which nothing lies."""
