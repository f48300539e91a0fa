"""Andrews' squeezer mechanism: seven bodies in a plane, one degree of freedom, three dyads.

Data and coordinates are those of the IVP test set (problem "andrews") and of Hairer & Wanner,
*Solving Ordinary Differential Equations II*, section VII.7. The classic formulation is a
differential-algebraic equation of index 3; here every loop is solved in closed form, and one
equation of second order is left.
"""

from __future__ import annotations

import sympy as sp

from ..declare.assembly import Body, Parameter, RelativeCoordinate
from ..declare.forces.force_element import ForceElement
from ..declare.forces.joint_force import JointForce
from ..declare.inputs import Input
from ..declare.laws import LinearSpring
from ..declare.mechanism import Mechanism
from ..declare.model import Model
from ..declare.paths import AlongLine
from .planar import flat, hinge, inertia, places

_DIGITS = 40  # so that defaults are rounded once, on every machine alike


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
        "k3_com": (
            XB + SA * sin(gamma) + SB * cos(gamma),
            YB - SA * cos(gamma) + SB * sin(gamma),
        ),
        "k4_com": (
            XA + ZT * cos(delta) + (E - EA) * sin(phi + delta),
            YA + ZT * sin(delta) - (E - EA) * cos(phi + delta),
        ),
        "k5_com": (
            XA + TA * cos(delta) - TB * sin(delta),
            YA + TA * sin(delta) + TB * cos(delta),
        ),
        "k6_com": (
            XA + U * sin(epsilon) + (ZF - FA) * cos(omega + epsilon),
            YA - U * cos(epsilon) + (ZF - FA) * sin(omega + epsilon),
        ),
        "k7_com": (
            XA + UA * sin(epsilon) - UB * cos(epsilon),
            YA - UA * cos(epsilon) - UB * sin(epsilon),
        ),
    }


def _parameters() -> tuple[Parameter, ...]:
    return (
        *places({name: ((float(x), float(y)), name) for name, (x, y) in _places().items()}),
        *(
            parameter
            for i, (mass, moment) in enumerate(zip(MASSES, INERTIAS, strict=True), 1)
            for parameter in inertia(f"k{i}", float(mass), float(moment))
        ),
        Parameter("spring_rate", 4530.0, "N/m", "rate of the spring (c0)"),
        Parameter("spring_free_length", 0.07785, "m", "free length of the spring (l0)"),
    )


_BODIES = tuple(f"k{i}" for i in range(1, 8))

SQUEEZER = Mechanism(
    name="andrews",
    fixed="ground",
    title="Andrews' squeezer mechanism",
    bodies=(
        Body("ground", 0, center=flat("crank_bearing")),
        *(Body(name, i, center=flat(f"{name}_com")) for i, name in enumerate(_BODIES, 1)),
    ),
    joints=(
        hinge("O", "ground", "k1", "crank_bearing"),
        hinge("crank_pin", "k1", "k2", "crank_pin"),
        hinge("B", "ground", "k3", "pivot_b"),
        hinge("knee_23", "k2", "k3", "knee"),
        hinge("knee_34", "k3", "k4", "knee"),
        hinge("pin_45", "k4", "k5", "pin_45"),
        hinge("A_5", "ground", "k5", "pivot_a"),
        hinge("knee_36", "k3", "k6", "knee"),
        hinge("pin_67", "k6", "k7", "pin_67"),
        hinge("A_7", "ground", "k7", "pivot_a"),
    ),
    forces=(
        ForceElement(
            name="spring",
            path=AlongLine(("ground", flat("spring_ground")), ("k3", flat("spring_body"))),
            laws=(LinearSpring(rate="spring_rate", free_length="spring_free_length"),),
        ),
        JointForce(joint="O", input="drive_torque"),
    ),
    parameters=_parameters(),
    coordinates=(
        RelativeCoordinate("beta", "O", "angle", "rad", "angle of the crank from the start"),
        RelativeCoordinate("theta", "crank_pin", "angle", "rad", "angle of body 2 on the crank"),
        RelativeCoordinate("gamma", "B", "angle", "rad", "angle of body 3 from the start"),
        RelativeCoordinate("delta", "A_5", "angle", "rad", "angle of body 5 from the start"),
        RelativeCoordinate("epsilon", "A_7", "angle", "rad", "angle of body 7 from the start"),
        RelativeCoordinate("knee_34", "knee_34", "angle", "rad", "angle of body 4 on body 3"),
        RelativeCoordinate("knee_36", "knee_36", "angle", "rad", "angle of body 6 on body 3"),
    ),
    inputs=(Input("drive_torque", "N m", "torque on the crank; 0.033 N m in the test set"),),
)

MODELS = (
    Model(
        name="andrews",
        title="Andrews' squeezer mechanism, driven by a torque on its crank",
        mechanism=SQUEEZER,
        independent=("O",),
        massive=_BODIES,
    ),
)
