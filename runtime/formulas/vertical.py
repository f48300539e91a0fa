"""Vertical force, radii and relaxation lengths of tyres by the coefficients of property files.

Equations (A3...) are those of appendix 3 of H. B. Pacejka, Tire and Vehicle Dynamics, 3rd edition,
Butterworth-Heinemann 2012; camber is that of (4.E68).

In all functions `a` is an `Arithmetic`, `p` are coefficients, loads and forces are in N, `dfz` is
(load - nominal) / nominal, `pressure` is (p - p0) / p0, `inclination` is the sine of the
inclination.
"""

from typing import Any

from .arithmetic import Arithmetic, magnitude
from .magic_formula import Coefficients


def rates(a: Arithmetic, p: Coefficients) -> tuple[Any, Any]:
    """Return q_Fz1 and q_Fz2; q_Fz1 from the vertical stiffness if a file has none (A3.4).

    The load per nominal load is q_Fz1 rho / R0 + q_Fz2 (rho / R0)^2 at a deflection rho.
    """
    if p["Q_FZ1"]:
        return p["Q_FZ1"], p["Q_FZ2"]
    stiff = p["VERTICAL_STIFFNESS"] * p["UNLOADED_RADIUS"] / p["FNOMIN"]
    return a.sqrt(stiff * stiff - 4 * p["Q_FZ2"]), p["Q_FZ2"]


def factor(a: Arithmetic, p: Coefficients, fx: Any, fy: Any, speed: Any, pressure: Any) -> Any:
    """Return the factor of the load by speed of spin, forces and pressure (A3.3).

    `speed` is that of the circumference over V0.
    """
    along, across = p["Q_FCX"] * fx / p["FNOMIN"], p["Q_FCY"] * fy / p["FNOMIN"]
    moved = 1 + p["Q_V2"] * magnitude(a, speed) - along * along - across * across
    return moved * (1 + p["PFZ1"] * pressure) * p["LCZ"]


def free_radius(p: Coefficients, speed: Any) -> Any:
    """Return the radius of a spinning tyre without load [m] (A3.1)."""
    return p["UNLOADED_RADIUS"] * (p["Q_RE0"] + p["Q_V1"] * speed * speed)


def deflection(
    a: Arithmetic, p: Coefficients, load: Any, inclination: Any, moved: Any
) -> tuple[Any, Any]:
    """Return the deflection [m] of a load, and the vertical stiffness there [N/m].

    `moved` is the result of `factor`.
    """
    first, second = rates(a, p)
    first = first + p["Q_FZ3"] * inclination * inclination
    share = load / (p["FNOMIN"] * moved)
    # the root for a small deflection, in a form without a division by q_Fz2
    root = a.sqrt(first * first + 4 * second * share)
    scaled = 2 * share / (first + root)
    return p["UNLOADED_RADIUS"] * scaled, p["FNOMIN"] * moved * root / p["UNLOADED_RADIUS"]


def effective_radius(a: Arithmetic, p: Coefficients, load: Any, stiffness: Any, free: Any) -> Any:
    """Return the speed of a freely rolling wheel over its rate of spin [m] (A3.6).

    `stiffness` is vertical at the nominal load [N/m], `free` the radius without load [m].
    """
    share = load / p["FNOMIN"]
    part = p["DREFF"] * a.atan(p["BREFF"] * share) + p["FREFF"] * share
    return free - p["FNOMIN"] / stiffness * part


def relaxation_by_stiffness(
    p: Coefficients, dfz: Any, pressure: Any, slip: Any, cornering: Any
) -> tuple[Any, Any]:
    """Return both relaxation lengths [m], positive: slip stiffness over stiffness (A3.9, A3.10).

    `slip` and `cornering` are slip stiffness and cornering stiffness [N], the second negative; `p`
    has LONGITUDINAL_STIFFNESS and LATERAL_STIFFNESS [N/m].
    """
    along = 1 + dfz * (p["PCFX1"] + p["PCFX2"] * dfz)
    across = 1 + dfz * (p["PCFY1"] + p["PCFY2"] * dfz)
    along = along * (1 + p["PCFX3"] * pressure) * p["LONGITUDINAL_STIFFNESS"]
    across = across * (1 + p["PCFY3"] * pressure) * p["LATERAL_STIFFNESS"]
    return slip / along, -cornering / across


def relaxation_by_load(
    a: Arithmetic, p: Coefficients, load: Any, dfz: Any, inclination: Any
) -> tuple[Any, Any]:
    """Return both relaxation lengths [m] of PAC2002, by PTX and PTY."""
    nominal, radius = p["FNOMIN"] * p["LFZO"], p["UNLOADED_RADIUS"]
    along = (p["PTX1"] + p["PTX2"] * dfz) * a.exp(p["PTX3"] * dfz)
    along = load * along * radius / nominal * p["LSGKP"]
    across = p["PTY1"] * a.sin(2 * a.atan(load / (p["PTY2"] * nominal)))
    lean = 1 - p["PKY3"] * magnitude(a, inclination)
    return along, across * lean * radius * p["LFZO"] * p["LSGAL"]
