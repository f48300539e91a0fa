"""Forces and moments of a rolling tyre by the Magic Formula, without turn slip.

Equations and their numbers (4.E..) are those of H. B. Pacejka, Tire and Vehicle Dynamics, 3rd
edition, Butterworth-Heinemann 2012, section 4.3.2; (A..) are those of I. J. M. Besselink,
A. J. C. Schmeitz and H. B. Pacejka, An improved Magic Formula/Swift tyre model that can handle
inflation pressure changes, Vehicle System Dynamics 48 (2010), S1. The two differ in the pneumatic
trail: property files have the coefficients of the second (QBZ4, QDZ3: camber with its sign), which
is used. PAC2002 has another shift by camber and another force in the aligning moment, those of the
book's first edition (2002).

No expression is singular. Stiffnesses and peaks are computed per load, so that a load of zero does
not divide; even functions of a slip are written with its square, without its sign.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .arithmetic import Arithmetic, at_most, magnitude

_TWO_OVER_PI = 0.6366197723675814
_DEGRESSION = 10  # A_mu of (4.E8)
_SMALL_LOAD = 1e-6  # added to a load that divides [N]
_SMALL_SQUARE = 1e-16  # added to the square of a slip under a root
_NEAR_ZERO = 1e-4  # slip at which a force over its slip passes into the slope at zero

Coefficients = Mapping[str, Any]
"""Numbers or symbols by their names in property files."""


@dataclass(frozen=True)
class Contact:
    """The state of a contact in its axes (ISO 8855): x forward, y left, z up."""

    load: Any  # force of the road on the tyre along its normal [N], zero or more
    longitudinal: Any  # kappa = -Vsx / |Vcx| (4.E5): positive in driving
    # Vcy / |Vcx|, or its angle [rad] (see `Form`): positive where the contact moves to the left. It
    # is alpha* of (4.E3), whose y axis points to the right.
    lateral: Any
    # sine of the inclination about x (4.E4): positive with the top of the wheel to the right
    inclination: Any
    direction: Any  # cos'(alpha) = Vcx / |Vc| (4.E6): negative rolling backward
    rolling: Any  # sign of Vcx; near standstill a smooth value between -1 and 1
    speed: Any  # Vcx / V0 with its sign
    pressure: Any  # (p - p0) / p0 (4.E2b)


@dataclass(frozen=True)
class Form:
    """The variant of the formulas for a property file."""

    # MF 6.1 and 6.2: camber shifts the lateral slip by its own stiffness (4.E27), and the aligning
    # moment has the lateral force of an upright wheel (4.E74). Else PAC2002: the shift is PHY3
    # times inclination, and the moment has the lateral force without the part that slip induces.
    newer: bool = True
    # combined slip by weighting functions (4.E50 to 4.E67), else by the friction ellipse of
    # Adams/Tire, for files without their coefficients
    weighted: bool = True
    # lateral slip is the angle, as in PAC2002 of Adams/Tire; else its tangent (4.E3)
    angle: bool = False


@dataclass(frozen=True)
class Forces:
    """Forces and moments of the road on the tyre at the contact, and stiffnesses at zero slip."""

    # forces along x and y [N]
    fx: Any
    fy: Any
    # overturning, rolling-resistance and aligning moment [N m]
    mx: Any
    my: Any
    mz: Any
    # dFx/dkappa and dFy/dalpha at zero slip [N]; the latter is negative
    slip_stiffness: Any
    cornering_stiffness: Any
    trail: Any  # pneumatic trail: distance of the lateral force behind the contact [m]


def forces(a: Arithmetic, p: Coefficients, c: Contact, form: Form) -> Forces:
    """Return forces and moments of a contact by one variant of the formulas."""
    dfz = a.define("load_change", (c.load - _nominal(p)) / _nominal(p))  # (4.E2a)
    x = _longitudinal(a, p, c, dfz, form)
    y = _lateral(a, p, c, dfz, c.inclination * p["LGAY"], form, "y")
    combined = _weighted if form.weighted else _ellipse
    gx, gy, induced = combined(a, p, c, dfz, x, y, form)
    fx = a.define("fx", c.load * (x.force * gx))
    aligned = a.define("fy_at_zero_slip", c.load * (y.force * gy))
    fy = a.define("fy", aligned + induced)
    if form.newer:
        upright = _lateral(a, p, c, dfz, 0, form, "upright")
        aligned = c.load * (upright.force * gy)  # (4.E74)
    trail, residual = _aligning(a, p, c, dfz, x, y, form)
    arm = p["SSZ3"] + p["SSZ4"] * dfz
    arm = p["SSZ1"] + p["SSZ2"] / _nominal(p) * fy + arm * c.inclination
    arm = arm * (p["UNLOADED_RADIUS"] * p["LS"])  # (4.E76)
    return Forces(
        fx,
        fy,
        _overturning(a, p, c, fy),
        _rolling_resistance(a, p, c, fx),
        residual - trail * aligned + arm * fx,  # (4.E71)
        c.load * x.stiffness,
        c.load * y.stiffness,
        trail,
    )


def stiffnesses(a: Arithmetic, p: Coefficients, c: Contact) -> tuple[Any, Any]:
    """Return slip stiffness and cornering stiffness of a contact at zero slip [N]."""
    dfz = a.define("load_change", (c.load - _nominal(p)) / _nominal(p))
    leaning = c.inclination * p["LGAY"]
    along = a.define("x_stiffness", _slip_stiffness(a, p, c, dfz))
    across = a.define("y_stiffness", _cornering(a, p, c, leaning, leaning * leaning))
    return c.load * along, c.load * across


@dataclass(frozen=True)
class _PureSlip:
    """A force at pure slip along one axis; forces are per load."""

    # K / Fz and mu
    stiffness: Any
    peak: Any
    bend: Any  # B C: the slope of the argument of the sine, as stiffness over peak
    # slip with its horizontal shift, and that shift
    slip: Any
    shift: Any
    # sine term and the vertical shift; the force is their sum
    friction: Any
    vertical: Any

    @property
    def force(self) -> Any:
        """The force, per load."""
        return self.friction + self.vertical


def _nominal(p: Coefficients) -> Any:
    """Return the nominal load, scaled (4.E1)."""
    return p["FNOMIN"] * p["LFZO"]


def _of_pressure(p: Coefficients, c: Contact, first: str, second: str) -> Any:
    """Return the factor of inflation pressure, 1 + p1 dpi + p2 dpi^2."""
    return 1 + c.pressure * (p[first] + p[second] * c.pressure)


def _of_shift(p: Coefficients, name: str, form: Form) -> Any:
    """Return the scale of friction for a vertical shift, which is less on slippery roads (4.E8)."""
    scale = p[name]
    return _DEGRESSION * scale / (1 + (_DEGRESSION - 1) * scale) if form.newer else scale


def _bent(a: Arithmetic, name: str, x: Any, curvature: Any, shape: Any) -> Any:
    """Return C arctan{x - E (x - arctan x)}."""
    x = a.define(f"{name}_argument", x)
    bent = a.define(f"{name}_bent", x - curvature * (x - a.atan(x)))
    return a.define(f"{name}_angle", shape * a.atan(bent))


def _longitudinal(a: Arithmetic, p: Coefficients, c: Contact, dfz: Any, form: Form) -> _PureSlip:
    """Return the longitudinal force at pure slip (4.E9 to 4.E18)."""
    shape, inclination = p["PCX1"] * p["LCX"], c.inclination * p["LGAX"]
    peak = (p["PDX1"] + p["PDX2"] * dfz) * (1 - p["PDX3"] * inclination * inclination)
    peak = a.define("x_peak", peak * (_of_pressure(p, c, "PPX3", "PPX4") * p["LMUX"]))
    stiffness = a.define("x_stiffness", _slip_stiffness(a, p, c, dfz))
    moving = c.rolling * c.rolling
    shift = (p["PHX1"] + p["PHX2"] * dfz) * p["LHX"] * moving
    vertical = (p["PVX1"] + p["PVX2"] * dfz) * (p["LVX"] * _of_shift(p, "LMUX", form)) * moving
    slip = a.define("x_slip", c.longitudinal + shift)
    curvature = (p["PEX1"] + dfz * (p["PEX2"] + p["PEX3"] * dfz)) * p["LEX"]
    curvature = at_most(a, curvature * (1 - p["PEX4"] * a.sign(slip)), 1)
    bend = a.define("x_bend", stiffness / (shape * peak))
    angle = _bent(a, "x", bend * slip, a.define("x_curvature", curvature), shape)
    friction = a.define("x_friction", peak * a.sin(angle))
    return _PureSlip(stiffness, peak, bend, slip, shift, friction, vertical)


def _lateral(
    a: Arithmetic, p: Coefficients, c: Contact, dfz: Any, inclination: Any, form: Form, name: str
) -> _PureSlip:
    """Return the lateral force at pure slip (4.E19 to 4.E30)."""
    shape, square = p["PCY1"] * p["LCY"], inclination * inclination
    peak = (p["PDY1"] + p["PDY2"] * dfz) * (1 - p["PDY3"] * square)
    peak = a.define(f"{name}_peak", peak * (_of_pressure(p, c, "PPY3", "PPY4") * p["LMUY"]))
    stiffness = a.define(f"{name}_stiffness", _cornering(a, p, c, inclination, square))
    moving = c.rolling * c.rolling
    scale = _of_shift(p, "LMUY", form)
    of_inclination = (p["PVY3"] + p["PVY4"] * dfz) * inclination * (p["LKYC"] * scale)  # (4.E28)
    vertical = (p["PVY1"] + p["PVY2"] * dfz) * (p["LVY"] * scale) + of_inclination  # (4.E29)
    vertical = a.define(f"{name}_vertical", vertical * moving)
    shift = (p["PHY1"] + p["PHY2"] * dfz) * p["LHY"]
    if form.newer:
        own = (p["PKY6"] + p["PKY7"] * dfz) * (1 + p["PPY5"] * c.pressure) * p["LKYC"]  # (4.E30)
        shift = shift + (own * inclination - of_inclination) / stiffness  # (4.E27)
    else:
        shift = shift + p["PHY3"] * inclination
    shift = a.define(f"{name}_shift", shift * moving)
    slip = a.define(f"{name}_slip", c.lateral + shift)
    uneven = (p["PEY3"] + p["PEY4"] * inclination) * a.sign(slip)
    curvature = (p["PEY1"] + p["PEY2"] * dfz) * p["LEY"] * (1 + p["PEY5"] * square - uneven)
    curvature = a.define(f"{name}_curvature", at_most(a, curvature, 1))
    bend = a.define(f"{name}_bend", stiffness / (shape * peak))
    angle = _bent(a, name, bend * slip, curvature, shape)
    friction = a.define(f"{name}_friction", peak * a.sin(angle))
    return _PureSlip(stiffness, peak, bend, slip, shift, friction, vertical)


def _slip_stiffness(a: Arithmetic, p: Coefficients, c: Contact, dfz: Any) -> Any:
    """Return the slip stiffness per load (4.E15)."""
    stiffness = (p["PKX1"] + p["PKX2"] * dfz) * a.exp(p["PKX3"] * dfz)
    return stiffness * (_of_pressure(p, c, "PPX1", "PPX2") * p["LKX"])


def _cornering(a: Arithmetic, p: Coefficients, c: Contact, inclination: Any, square: Any) -> Any:
    """Return the cornering stiffness per load (4.E25)."""
    where = (p["PKY2"] + p["PKY5"] * square) * ((1 + p["PPY2"] * c.pressure) * _nominal(p))
    stiffness = p["PKY1"] * _nominal(p) * ((1 + p["PPY1"] * c.pressure) * p["LKY"])
    stiffness = stiffness * a.sin(p["PKY4"] * a.atan((c.load + _SMALL_LOAD) / where))
    return stiffness * (1 - p["PKY3"] * magnitude(a, inclination)) / (c.load + _SMALL_LOAD)


def _weighted(
    a: Arithmetic, p: Coefficients, c: Contact, dfz: Any, x: _PureSlip, y: _PureSlip, form: Form
) -> tuple[Any, Any, Any]:
    """Return both weights of combined slip, and the lateral force that slip induces [N]."""
    del x, form
    square = c.inclination * c.inclination
    width = (p["RBX1"] + p["RBX3"] * square) * p["LXAL"] * _cosine(a, p["RBX2"] * c.longitudinal)
    gx = _weight(a, "gx", width, c.lateral, p["RHX1"], p["REX1"] + p["REX2"] * dfz, p["RCX1"])
    width = (p["RBY1"] + p["RBY4"] * square) * p["LYKA"]
    width = width * _cosine(a, p["RBY2"] * (c.lateral - p["RBY3"]))
    shift = p["RHY1"] + p["RHY2"] * dfz
    gy = _weight(a, "gy", width, c.longitudinal, shift, p["REY1"] + p["REY2"] * dfz, p["RCY1"])
    share = p["RVY1"] + p["RVY2"] * dfz + p["RVY3"] * c.inclination
    share = share * _cosine(a, p["RVY4"] * c.lateral) * p["LVYKA"]
    angle = p["RVY5"] * a.atan(p["RVY6"] * c.longitudinal)
    return gx, gy, a.define("fy_induced", c.load * y.peak * share * a.sin(angle))  # (4.E66)


def _weight(
    a: Arithmetic, name: str, width: Any, slip: Any, shift: Any, curvature: Any, shape: Any
) -> Any:
    """Return a weighting function: a cosine, divided by its value at zero slip."""
    width = a.define(f"{name}_width", width)
    curvature = a.define(f"{name}_curvature", at_most(a, curvature, 1))
    here = a.cos(_bent(a, name, width * (slip + shift), curvature, shape))
    return a.define(
        name, here / a.cos(_bent(a, f"{name}_at_zero", width * shift, curvature, shape))
    )


def _cosine(a: Arithmetic, tangent: Any) -> Any:
    """Return the cosine of an angle that is given by its tangent."""
    return 1 / a.sqrt(1 + tangent * tangent)


def _ellipse(
    a: Arithmetic, p: Coefficients, c: Contact, dfz: Any, x: _PureSlip, y: _PureSlip, form: Form
) -> tuple[Any, Any, Any]:
    """Return both weights by the friction ellipse of Adams/Tire, which induces no force.

    With k and s the slips measured from the zeros of the forces, each force is that of pure slip
    times k / sqrt(k^2 + (s mu_x / mu_y,max)^2), and the same with the axes exchanged. Below slips
    of some 1e-3 the ratio of force and slip passes into the stiffness, so that the result is
    smooth.
    """
    del p, c, dfz
    along = a.define("ellipse_x", x.slip + x.vertical / x.stiffness)
    across = y.slip + y.vertical / y.stiffness
    across = a.sin(across) if form.angle else across * _cosine(a, across)
    across = a.define("ellipse_y", across)
    gx = _share(a, _per_slip(x, along) / y.peak * across)
    gy = _share(a, _per_slip(y, across) / x.peak * along)
    return a.define("gx", gx), a.define("gy", gy), 0


def _per_slip(side: _PureSlip, slip: Any) -> Any:
    """Return a force per load over its slip; at zero slip the stiffness."""
    small = _NEAR_ZERO * _NEAR_ZERO
    return (side.friction * slip + side.stiffness * small) / (slip * slip + small)


def _share(a: Arithmetic, ratio: Any) -> Any:
    return 1 / a.sqrt(1 + ratio * ratio)


def _aligning(
    a: Arithmetic, p: Coefficients, c: Contact, dfz: Any, x: _PureSlip, y: _PureSlip, form: Form
) -> tuple[Any, Any]:
    """Return pneumatic trail and residual moment (4.E33 to 4.E47, 4.E73 to 4.E78)."""
    inclination = c.inclination * p["LGAZ"]
    lean = magnitude(a, inclination)
    moving = c.rolling * c.rolling
    load, radius = c.load / _nominal(p), p["UNLOADED_RADIUS"]
    shift = p["QHZ1"] + p["QHZ2"] * dfz + (p["QHZ3"] + p["QHZ4"] * dfz) * inclination  # (4.E35)
    slip = a.define("trail_slip", c.lateral + shift * moving)
    width = (p["QBZ1"] + dfz * (p["QBZ2"] + p["QBZ3"] * dfz)) * (p["LKY"] / p["LMUY"])
    width = width * (1 + p["QBZ4"] * inclination + p["QBZ5"] * lean)  # (A58)
    width = a.define("trail_width", width)
    peak = (p["QDZ1"] + p["QDZ2"] * dfz) * (1 - p["PPZ1"] * c.pressure)
    peak = peak * (1 + inclination * (p["QDZ3"] + p["QDZ4"] * inclination))  # (A60)
    peak = a.define("trail_peak", peak * load * (radius * p["LTR"]))
    uneven = (p["QEZ4"] + p["QEZ5"] * inclination) * a.atan(width * slip * p["QCZ1"]) * _TWO_OVER_PI
    curvature = (p["QEZ1"] + dfz * (p["QEZ2"] + p["QEZ3"] * dfz)) * (1 + uneven)  # (4.E44)
    curvature = a.define("trail_curvature", at_most(a, curvature, 1))
    driven = x.stiffness / y.stiffness * c.longitudinal if form.weighted else 0
    driven = a.define("equivalent_slip", driven * driven)
    turned = a.sqrt(_squared(a, slip, form) + driven + _SMALL_SQUARE)  # (4.E77)
    turned = a.atan(turned) if form.angle else turned
    trail = a.cos(_bent(a, "trail", width * turned, curvature, p["QCZ1"]))
    trail = a.define("trail", peak * trail * c.direction)
    slip = a.define("residual_slip", c.lateral + y.shift + y.vertical / y.stiffness)
    width = p["QBZ9"] * (p["LKY"] / p["LMUY"]) + p["QBZ10"] * (p["PCY1"] * p["LCY"]) * y.bend
    peak = (p["QDZ8"] + p["QDZ9"] * dfz) * (1 + p["PPZ2"] * c.pressure)
    peak = (peak + (p["QDZ10"] + p["QDZ11"] * dfz) * lean) * inclination * p["LKZC"]
    peak = peak + (p["QDZ6"] + p["QDZ7"] * dfz) * p["LRES"]  # (4.E47)
    peak = peak * c.load * (radius * p["LMUY"]) * (c.rolling * c.direction)
    turned = _squared(a, slip, form) + driven  # (4.E78)
    if form.angle:
        turned = a.atan(a.sqrt(turned + _SMALL_SQUARE))
        turned = turned * turned
    return trail, a.define("residual_moment", peak / a.sqrt(1 + width * width * turned))


def _squared(a: Arithmetic, slip: Any, form: Form) -> Any:
    """Return the square of the tangent of a slip."""
    tangent = a.sin(slip) / a.cos(slip) if form.angle else slip
    return tangent * tangent


def _overturning(a: Arithmetic, p: Coefficients, c: Contact, fy: Any) -> Any:
    """Return the overturning moment (4.E69), with QSX12 to QSX14 of MF 6.2."""
    load, side = c.load / p["FNOMIN"], fy / p["FNOMIN"]
    lean = magnitude(a, c.inclination)
    by_inclination = p["QSX2"] * (1 + p["PPMX1"] * c.pressure) + p["QSX12"] * lean
    by_inclination = by_inclination - p["QSX10"] * a.atan(p["QSX11"] * load)
    turned = a.sin(p["QSX7"] * c.inclination + p["QSX8"] * a.atan(p["QSX9"] * side))
    squared = p["QSX6"] * load * p["QSX6"] * load
    moment = p["QSX1"] * p["LVMX"] - by_inclination * c.inclination + p["QSX3"] * side
    moment = moment + p["QSX4"] * a.cos(p["QSX5"] * a.atan(squared)) * turned
    moment = c.load * moment + fy * (p["QSX13"] + p["QSX14"] * lean)
    return moment * (p["UNLOADED_RADIUS"] * p["LMX"])


def _rolling_resistance(a: Arithmetic, p: Coefficients, c: Contact, fx: Any) -> Any:
    """Return the moment of rolling resistance, negative rolling forward.

    The factor is the nominal load, as in the paper of 2010, and the load to the power QSY7, which
    is near one in property files. (4.E70) has the load itself as a factor before that power.
    """
    load, square = c.load / p["FNOMIN"], c.speed * c.speed
    share = p["QSY1"] + p["QSY2"] * fx / p["FNOMIN"] + p["QSY3"] * magnitude(a, c.speed)
    share = share + p["QSY4"] * square * square
    share = share + (p["QSY5"] + p["QSY6"] * load) * c.inclination * c.inclination
    share = a.define("resistance", share) * _load_power(a, p, c)
    scale = p["UNLOADED_RADIUS"] * p["FNOMIN"] * p["LMY"]
    return -share * scale * c.rolling


def _load_power(a: Arithmetic, p: Coefficients, c: Contact) -> Any:
    """Return the powers of load and pressure of rolling resistance."""
    by_load, by_pressure = c.load / p["FNOMIN"], 1
    if p["QSY7"] != 1:
        power = p["QSY7"] * a.log((c.load + _SMALL_LOAD) / p["FNOMIN"])
        # a step of its own: SymPy writes the exponential of a product with a logarithm as a power
        by_load = a.exp(a.define("load_power", power))
    if p["QSY8"] != 0:
        power = p["QSY8"] * a.log(1 + c.pressure)
        by_pressure = a.exp(a.define("pressure_power", power))
    return by_load * by_pressure
