"""Andrews' squeezer mechanism: seven bodies in a plane, one degree of freedom, three dyads.

Data and coordinates are those of the IVP test set (problem "andrews") and of Hairer & Wanner,
*Solving Ordinary Differential Equations II*, section VII.7. The classic formulation is a
differential-algebraic equation of index 3; here every loop is solved in closed form, and one
equation of second order is left.
"""

from __future__ import annotations

import sympy as sp

from .. import declare as d
from ..declare import flat, hinge

_DIGITS = 40  # so that defaults are rounded once, equally on every machine


def _number(text: str) -> sp.Float:
    return sp.Float(text, _DIGITS)


# Dimensions [m] and angles at the start [rad], by the names of the test set.
D, DA, E, EA = map(_number, ("0.028", "0.0115", "0.02", "0.01421"))
RR, RA, SS = map(_number, ("0.007", "0.00092", "0.035"))
SA, SB, SC, SD = map(_number, ("0.01874", "0.01043", "0.018", "0.02"))
TA, TB = map(_number, ("0.02308", "0.00916"))
U, UA, UB = map(_number, ("0.04", "0.01228", "0.00449"))
ZF, ZT, FA = map(_number, ("0.02", "0.04", "0.01421"))
XA, YA, XB, YB = map(_number, ("-0.06934", "-0.00227", "-0.03635", "0.03273"))
START = {
    "beta": _number("-0.0617138900142764496358948458001"),
    "theta": _number("0"),
    "gamma": _number("0.455279819163070380255912382449"),
    "phi": _number("0.222668390165885884674473185609"),
    "delta": _number("0.487364979543842550225598953530"),
    "omega": _number("-0.222668390165885884674473185609"),
    "epsilon": _number("1.23054744454982119249735015568"),
}
MASSES = ("0.04325", "0.00365", "0.02373", "0.00706", "0.07050", "0.00706", "0.05498")
INERTIAS = ("2.194e-6", "4.410e-7", "5.255e-6", "5.667e-7", "1.169e-5", "5.667e-7", "1.912e-5")


def _places() -> dict[str, tuple[sp.Expr, sp.Expr]]:
    """Return all points at the start, from the formulas of the test set."""
    beta, theta, gamma, phi, delta, omega, epsilon = START.values()
    cos, sin = sp.cos, sp.sin
    crank_x, crank_y = RR * cos(beta), RR * sin(beta)
    return {
        "crank_bearing": (sp.Integer(0), sp.Integer(0)),
        "crank_pin": (crank_x, crank_y),
        "knee": (crank_x - D * cos(beta + theta), crank_y - D * sin(beta + theta)),
        "pivot_a": (XA, YA),
        "pivot_b": (XB, YB),
        "pin_45": (XA + ZT * cos(delta), YA + ZT * sin(delta)),
        "pin_67": (XA + U * sin(epsilon), YA - U * cos(epsilon)),
        "spring_ground": (_number("0.014"), _number("0.072")),
        "spring_body": (
            XB + SD * cos(gamma) + SC * sin(gamma),
            YB + SD * sin(gamma) - SC * cos(gamma),
        ),
        "k1_com": (RA * cos(beta), RA * sin(beta)),
        "k2_com": (crank_x - DA * cos(beta + theta), crank_y - DA * sin(beta + theta)),
        "k3_com": (XB + SA * sin(gamma) + SB * cos(gamma), YB - SA * cos(gamma) + SB * sin(gamma)),
        "k4_com": (
            XA + ZT * cos(delta) + (E - EA) * sin(phi + delta),
            YA + ZT * sin(delta) - (E - EA) * cos(phi + delta),
        ),
        "k5_com": (XA + TA * cos(delta) - TB * sin(delta), YA + TA * sin(delta) + TB * cos(delta)),
        "k6_com": (
            XA + U * sin(epsilon) + (ZF - FA) * cos(omega + epsilon),
            YA - U * cos(epsilon) + (ZF - FA) * sin(omega + epsilon),
        ),
        "k7_com": (
            XA + UA * sin(epsilon) - UB * cos(epsilon),
            YA - UA * cos(epsilon) - UB * sin(epsilon),
        ),
    }


POINTS = {name: flat(name, (float(x), float(y)), name) for name, (x, y) in _places().items()}

GROUND = d.Ground("ground")
K1, K2, K3, K4, K5, K6, K7 = BODIES = tuple(
    d.Body(f"k{i}", float(mass), POINTS[f"k{i}_com"], float(moment))
    for i, (mass, moment) in enumerate(zip(MASSES, INERTIAS, strict=True), 1)
)

O = hinge("O", GROUND, K1, POINTS["crank_bearing"])
CRANK_PIN = hinge("crank_pin", K1, K2, POINTS["crank_pin"])
B = hinge("B", GROUND, K3, POINTS["pivot_b"])
KNEE_34 = hinge("knee_34", K3, K4, POINTS["knee"])
A_5 = hinge("A_5", GROUND, K5, POINTS["pivot_a"])
KNEE_36 = hinge("knee_36", K3, K6, POINTS["knee"])
A_7 = hinge("A_7", GROUND, K7, POINTS["pivot_a"])

SPRING = d.LinearSpring(
    rate=d.SpringRate("spring_rate", 4530.0, "rate of the spring (c0)"),
    free_length=d.Length("spring_free_length", 0.07785, "free length of the spring (l0)"),
)

SQUEEZER = d.Mechanism(
    name="andrews",
    title="Andrews' squeezer mechanism",
    joints=(
        O,
        CRANK_PIN,
        B,
        hinge("knee_23", K2, K3, POINTS["knee"]),
        KNEE_34,
        hinge("pin_45", K4, K5, POINTS["pin_45"]),
        A_5,
        KNEE_36,
        hinge("pin_67", K6, K7, POINTS["pin_67"]),
        A_7,
    ),
    forces=(
        d.ForceElement(
            "spring",
            d.AlongLine((GROUND, POINTS["spring_ground"]), (K3, POINTS["spring_body"])),
            (SPRING,),
        ),
        d.JointForce(
            O, d.Input("drive_torque", "N m", "torque on the crank; 0.033 N m in the test set")
        ),
    ),
    coordinates=(
        O.angle("beta", "angle of the crank from the start"),
        CRANK_PIN.angle("theta", "angle of body 2 on the crank"),
        B.angle("gamma", "angle of body 3 from the start"),
        A_5.angle("delta", "angle of body 5 from the start"),
        A_7.angle("epsilon", "angle of body 7 from the start"),
        KNEE_34.angle("knee_34", "angle of body 4 on body 3"),
        KNEE_36.angle("knee_36", "angle of body 6 on body 3"),
    ),
)

MODELS = (
    d.Formulation(
        name="andrews",
        title="Andrews' squeezer mechanism, driven by a torque on its crank",
        mechanism=SQUEEZER,
        independent=(O,),
        massive=BODIES,
    ),
)
