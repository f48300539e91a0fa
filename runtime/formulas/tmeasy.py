"""Forces of a rolling contact by TMeasy.

After G. Rill, Road Vehicle Dynamics, CRC Press 2012, chapter 3, and W. Hirschberg, G. Rill and
H. Weinfurter, Tire model TMeasy, Vehicle System Dynamics 45 (2007), S1, pp. 101-119. A curve is
described by its slope at zero slip, its greatest force and the force of sliding, with the slips of
both, at the nominal load and at twice that. Forces are those of steady state, without the bore
torque of a wheel that turns on the spot.

The slope at zero slip depends on the direction of the slip; without slip it is a mean.

There are no branches: each piece of a curve is a function of the part of the slip within it.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from .arithmetic import Arithmetic, at_most, magnitude
from .magic_formula import Contact, Forces

_SLOWEST = 1e-6  # added to the square of the speed of the tread over that of the wheel
_SMALL_SQUARE = 1e-18  # added to the square of a slip under a root

CURVES = ("slope", "maximum", "sliding", "slip_of_maximum", "slip_of_sliding")
"""Coefficients of a curve of force over slip."""
_QUADRATIC = frozenset(CURVES[:3])
TRAIL = ("trail", "slip_of_zero_trail", "slip_of_no_trail")
"""Coefficients of the trail over the lateral slip."""


COEFFICIENTS: Mapping[str, tuple[float, str, str]] = {
    "radius": (0.316, "m", "radius of the tyre without load"),
    "width": (0.205, "m", "width of the tyre"),
    "friction": (0.9, "1", "friction of the road"),
    "friction_measured": (0.9, "1", "friction at which the tyre was measured"),
    "nominal_load": (3500.0, "N", "load of the first of each two values"),
    "greatest_load": (9000.0, "N", "load above which curves do not grow"),
    "load_1": (1.7e5, "N/m", "load over deflection without load"),
    "load_2": (4.0e5, "N/m^2", "load over the square of the deflection"),
    "stiffness_x": (2.6e5, "N/m", "longitudinal stiffness of the carcass"),
    "stiffness_y": (1.5e5, "N/m", "lateral stiffness of the carcass"),
    **{
        f"{name}_{i}": (value, unit, f"{name.replace('_', ' ')} at {load} the nominal load")
        for name, unit, values in (
            ("x_slope", "N", (8.5e4, 1.55e5)),
            ("x_maximum", "N", (3900.0, 7100.0)),
            ("x_sliding", "N", (3000.0, 5800.0)),
            ("x_slip_of_maximum", "1", (0.11, 0.12)),
            ("x_slip_of_sliding", "1", (0.5, 0.6)),
            ("y_slope", "N", (6.2e4, 1.0e5)),
            ("y_maximum", "N", (3500.0, 6300.0)),
            ("y_sliding", "N", (3300.0, 6000.0)),
            ("y_slip_of_maximum", "1", (0.2, 0.22)),
            ("y_slip_of_sliding", "1", (0.7, 0.8)),
            ("trail", "1", (0.17, 0.15)),
            ("slip_of_zero_trail", "1", (0.25, 0.27)),
            ("slip_of_no_trail", "1", (0.5, 0.55)),
            ("rolling", "1", (0.375, 0.75)),
            ("resistance", "1", (0.011, 0.013)),
        )
        for i, value, load in zip((1, 2), values, ("", "twice"), strict=True)
    },
}
"""Coefficients of equations of motion: usual values, units and meanings."""


def by_load(load: Any, nominal: Any, once: Any, twice: Any, *, quadratic: bool) -> Any:
    """Return a value between those at the nominal load and at twice that; loads in N.

    A `quadratic` value is a parabola through zero at zero load, any other is linear.
    """
    share = load / nominal
    if quadratic:
        return share * (2 * once - twice / 2 - (once - twice / 2) * share)
    return once + (twice - once) * (share - 1)


@dataclass(frozen=True)
class _Curve:
    """A curve at a load."""

    slope: Any
    maximum: Any
    sliding: Any
    slip_of_maximum: Any
    slip_of_sliding: Any


def _curve(a: Arithmetic, p: Mapping[str, Any], load: Any, axis: str) -> _Curve:
    friction = p["friction"] / p["friction_measured"]
    found = {}
    for what in CURVES:
        once, twice = p[f"{axis}_{what}_1"], p[f"{axis}_{what}_2"]
        value = by_load(load, p["nominal_load"], once, twice, quadratic=what in _QUADRATIC)
        found[what] = a.define(f"{axis}_{what}", value if what == "slope" else value * friction)
    return _Curve(**found)


def forces(a: Arithmetic, p: Mapping[str, Any], c: Contact, length: Any) -> Forces:
    """Return forces and moments; the slip of `c` is a tangent, `length` that of the contact [m]."""
    c = _over_tread(a, c)
    # curves are known up to a load, and constant above it
    load = a.define("curve_load", at_most(a, c.load, p["greatest_load"]) + 1e-6)
    x, y = _curve(a, p, load, "x"), _curve(a, p, load, "y")
    slips = a.define("slips", x.slip_of_maximum + y.slip_of_maximum)
    steep_x, steep_y = (
        a.define(f"{axis}_steepness", each.maximum / each.slope)
        for axis, each in (("x", x), ("y", y))
    )
    steepness = a.define("steepness", steep_x + steep_y)
    norm_x = a.define("norm_x", x.slip_of_maximum / slips + steep_x / steepness)
    norm_y = a.define("norm_y", y.slip_of_maximum / slips + steep_y / steepness)
    along = a.define("norm_slip_x", c.longitudinal / norm_x)
    across = a.define("norm_slip_y", -c.lateral / norm_y)
    # without slip the direction is midway between the axes
    square_x, square_y = along * along + _SMALL_SQUARE, across * across + _SMALL_SQUARE
    size = a.define("combined_slip", a.sqrt(square_x + square_y))
    share_x = a.define("share_x", square_x / (size * size))
    share_y = a.define("share_y", square_y / (size * size))

    def both(name: str, one: Any, other: Any) -> Any:
        one, other = a.define(f"{name}_x", one), a.define(f"{name}_y", other)
        return a.define(name, a.sqrt(one * one * share_x + other * other * share_y))

    curve = _Curve(
        both("slope", x.slope * norm_x, y.slope * norm_y),
        both("maximum", x.maximum, y.maximum),
        both("sliding", x.sliding, y.sliding),
        both("slip_of_maximum", x.slip_of_maximum / norm_x, y.slip_of_maximum / norm_y),
        both("slip_of_sliding", x.slip_of_sliding / norm_x, y.slip_of_sliding / norm_y),
    )
    per_slip = a.define("force_over_slip", _force_over_slip(a, curve, size))
    # the inclination turns the contact, which slips to both sides
    induced = -length / 2 * c.inclination * c.rolling
    fx = per_slip * along
    fy = per_slip * (across + induced / (3 * norm_y))
    share = c.load / load
    fx, fy = a.define("fx", fx * share), a.define("fy", fy * share)
    trail = length * _trail(a, p, load, c.lateral) * c.rolling
    resistance = by_load(
        load, p["nominal_load"], p["resistance_1"], p["resistance_2"], quadratic=False
    )
    lean = p["width"] * p["width"] * p["load_1"] / 12
    return Forces(
        fx,
        fy,
        -lean * c.inclination,
        -resistance * c.load * p["radius"] * c.rolling,
        -trail * fy,
        _least_slope(a, x.slope, x.maximum / x.slip_of_maximum) * share,
        -_least_slope(a, y.slope, y.maximum / y.slip_of_maximum) * share,
        trail,
    )


def _over_tread(a: Arithmetic, c: Contact) -> Contact:
    """Return the contact with slips relative to the speed of the tread, not of the wheel.

    Near standstill, where `rolling` is between -1 and 1, that speed is smoothed in the same way.
    """
    tread = c.longitudinal + c.rolling
    tread = a.sqrt(tread * tread + 1 - c.rolling * c.rolling + _SLOWEST)
    tread = a.define("tread", tread)
    along, across = c.longitudinal / tread, c.lateral / tread
    return replace(c, longitudinal=a.define("slip_x", along), lateral=a.define("slip_y", across))


def load_of(p: Mapping[str, Any], deflection: Any) -> Any:
    """Return the load of a deflection [N], by the coefficients `load_1` and `load_2`."""
    return deflection * (p["load_1"] + p["load_2"] * deflection)


def deflection_of(a: Arithmetic, p: Mapping[str, Any], load: Any) -> tuple[Any, Any]:
    """Return the deflection of a load [m], and the vertical stiffness there [N/m]."""
    root = a.sqrt(p["load_1"] * p["load_1"] + 4 * p["load_2"] * load)
    return 2 * load / (p["load_1"] + root), root


def _least_slope(a: Arithmetic, slope: Any, secant: Any) -> Any:
    """Return the initial slope of a curve, which is at least twice the secant to its maximum."""
    return slope + a.positive(2 * secant - slope)


def _force_over_slip(a: Arithmetic, curve: _Curve, slip: Any) -> Any:
    """Return the force over the slip: adhesion, two parabolas or a cubic, sliding."""
    first = curve.slip_of_maximum
    steep = a.define("secant", curve.maximum / first)
    slope = a.define("adhesion_slope", _least_slope(a, curve.slope, steep))
    part = a.define("adhering", at_most(a, slip, first) / first)
    bent = a.define("adhesion_bent", 1 + part * (part + slope / steep - 2))
    adhesion = slope * first * part / bent
    width = a.define("width", curve.slip_of_sliding - first)
    beyond = a.define("beyond", at_most(a, a.positive(slip - first), width))
    curvature = a.define("curvature", steep * steep / (slope * first))
    fallen = _fallen(a, curve.maximum - curve.sliding, curvature, width, beyond)
    return (adhesion - a.define("fallen", fallen)) / slip


def _fallen(a: Arithmetic, fall: Any, curvature: Any, width: Any, beyond: Any) -> Any:
    """Return the difference of the maximum and the force, at a slip beyond that of the maximum.

    Two parabolas, the first with the curvature of adhesion at the maximum; a cubic if they do not
    meet before sliding.
    """
    meeting = a.define("meeting", fall / (curvature * width))
    meet = (1 + a.sign(width - meeting)) / 2  # one where they meet, zero where not
    before = at_most(a, beyond, meeting)
    rest = a.define("rest", a.positive(width - meeting) + (1 - meet) * width)
    left = a.define("left", a.positive(width - beyond) / rest)
    behind = curvature * meeting * rest * left * left
    first = curvature * before * before
    passed = (1 + a.sign(beyond - meeting)) / 2
    parabolas = (1 - passed) * first + passed * (fall - behind)
    share = a.define("share", beyond / width)
    return meet * parabolas + (1 - meet) * fall * share * share * (3 - 2 * share)


def _trail(a: Arithmetic, p: Mapping[str, Any], load: Any, lateral: Any) -> Any:
    """Return the trail divided by the length of the contact."""
    friction = p["friction"] / p["friction_measured"]
    values = [
        by_load(load, p["nominal_load"], p[f"{what}_1"], p[f"{what}_2"], quadratic=False)
        for what in TRAIL
    ]
    most, zero, none = values[0], values[1] * friction, values[2] * friction
    none = none + a.positive(zero - none)
    zero, none = a.define("trail_zero", zero), a.define("trail_none", none)
    weight = a.define("trail_weight", zero / none)
    slip = magnitude(a, lateral)
    part = a.define("trail_part", at_most(a, slip, zero) / zero)
    low = most * ((1 - weight) * (1 - part) + weight * (1 - (3 - 2 * part) * part * part))
    beyond = at_most(a, a.positive(slip - zero), none - zero)
    left = a.define("trail_left", (none - zero - beyond) / (none - zero + 1e-12))
    return low - most * (1 - weight) * beyond / zero * left * left
