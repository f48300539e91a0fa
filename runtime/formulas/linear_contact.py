"""Forces of a rolling contact that are linear in small slips and approach the friction limit.

With F = (C_x kappa, -C_y tan(alpha) - C_gamma sin(gamma)), the force is
F / sqrt(1 + |F|^2 / (mu F_z)^2): about F where that is small, and about mu F_z in its direction
where it is large.
"""

from collections.abc import Mapping
from typing import Any

from .arithmetic import Arithmetic
from .magic_formula import Contact, Forces

_SMALL_SQUARE = 1e-12  # added to the square of a force under a root [N^2]

COEFFICIENTS: Mapping[str, tuple[str, str]] = {
    "slip_stiffness": ("N", "dFx over longitudinal slip"),
    "cornering_stiffness": ("N", "-dFy over the tangent of the slip angle"),
    "camber_stiffness": ("N", "-dFy over the sine of the inclination"),
    "trail": ("m", "how far behind the contact the lateral force is without sliding"),
    "friction": ("1", "greatest horizontal force over the load"),
    "rolling_resistance": ("1", "longitudinal force that rolling takes, over the load"),
}
"""Units and meanings."""


def forces(a: Arithmetic, p: Mapping[str, Any], c: Contact, radius: Any) -> Forces:
    """Return forces and moments; the slip of `c` is a tangent, `radius` that of the tyre [m]."""
    fx = a.define("fx_linear", p["slip_stiffness"] * c.longitudinal)
    fy = -p["cornering_stiffness"] * c.lateral - p["camber_stiffness"] * c.inclination * c.rolling
    fy = a.define("fy_linear", fy)
    most = a.define("most", p["friction"] * c.load)
    size = a.sqrt(most * most + fx * fx + fy * fy + _SMALL_SQUARE)
    share = a.define("share", most / size)
    # the trail vanishes as the contact slides
    trail = a.define("trail", p["trail"] * share * share * share * c.rolling)
    fx, fy = a.define("fx", fx * share), a.define("fy", fy * share)
    my = -p["rolling_resistance"] * c.load * radius * c.rolling
    return Forces(
        fx, fy, 0.0, my, -trail * fy, p["slip_stiffness"], -p["cornering_stiffness"], trail
    )
