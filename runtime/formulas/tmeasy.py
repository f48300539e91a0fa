"""Forces of a rolling contact by TMeasy.

After G. Rill, Road Vehicle Dynamics, CRC Press 2012, chapter 3, and W. Hirschberg, G. Rill and
H. Weinfurter, Tire model TMeasy, Vehicle System Dynamics 45 (2007), S1, pp. 101-119. Curves are
described by their slope at zero slip, their greatest force and the force of sliding, with the slips
of both, at the nominal load and at twice that. Steady state, without the bore torque of a wheel
that turns on the spot.

All of it is without branches: pieces of a curve are functions of the parts of the slip in them.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .arithmetic import Arithmetic, at_most, magnitude
from .magic_formula import Contact, Forces

_SMALL_SQUARE = 1e-18  # added to the square of a slip under a root

CURVES = ("slope", "maximum", "sliding", "slip_of_maximum", "slip_of_sliding")
"""What describes a curve of force over slip."""
_QUADRATIC = frozenset(CURVES[:3])
TRAIL = ("trail", "slip_of_zero_trail", "slip_of_no_trail")
"""What describes the trail over the lateral slip."""


def by_load(load: Any, nominal: Any, once: Any, twice: Any, *, quadratic: bool) -> Any:
    """Return a value between those at the nominal load and at twice that.

    Parameters
    ----------
    load, nominal
        [N].
    once, twice
        Values at the nominal load, and at twice that.
    quadratic
        Whether it goes through zero with the load, by a parabola; else it is linear.
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
    """Return forces and moments.

    Parameters
    ----------
    a
        Functions.
    p
        Coefficients.
    c
        What the tyre rolls with; slips are those of TMeasy, over the speed of the tread.
    length
        Of the contact [m].
    """
    # curves are known up to a load, above which they do not grow
    load = a.define("curve_load", at_most(a, c.load, p["greatest_load"]) + 1e-6)
    x, y = _curve(a, p, load, "x"), _curve(a, p, load, "y")
    slips = x.slip_of_maximum + y.slip_of_maximum
    steepness = x.maximum / x.slope + y.maximum / y.slope
    norm_x = a.define("norm_x", x.slip_of_maximum / slips + x.maximum / x.slope / steepness)
    norm_y = a.define("norm_y", y.slip_of_maximum / slips + y.maximum / y.slope / steepness)
    along, across = c.longitudinal / norm_x, -c.lateral / norm_y
    # without slip the direction is that of both axes alike
    square_x, square_y = along * along + _SMALL_SQUARE, across * across + _SMALL_SQUARE
    size = a.define("combined_slip", a.sqrt(square_x + square_y))
    share_x, share_y = square_x / (size * size), square_y / (size * size)

    def both(one: Any, other: Any) -> Any:
        return a.sqrt(one * one * share_x + other * other * share_y)

    slope = both(x.slope * norm_x, y.slope * norm_y)
    most, least = both(x.maximum, y.maximum), both(x.sliding, y.sliding)
    first = both(x.slip_of_maximum / norm_x, y.slip_of_maximum / norm_y)
    last = both(x.slip_of_sliding / norm_x, y.slip_of_sliding / norm_y)
    curve = _Curve(slope, most, least, first, last)
    per_slip = a.define("force_over_slip", _force_over_slip(a, curve, size))
    # the inclination turns the contact, which slips to both sides
    induced = -length / 2 * c.inclination * c.rolling
    fx = per_slip * along
    fy = per_slip * (across + induced / (3 * norm_y))
    share = (c.load + 1e-6) / load
    fx, fy = a.define("fx", fx * share), a.define("fy", fy * share)
    trail = length * _trail(a, p, load, c.lateral) * c.rolling
    resistance = by_load(
        load, p["nominal_load"], p["resistance_1"], p["resistance_2"], quadratic=False
    )
    lean = p["width"] * p["width"] * p["vertical_stiffness"] / 12
    return Forces(
        fx,
        fy,
        -lean * c.inclination,
        -resistance * c.load * p["radius"] * c.rolling,
        -trail * fy,
        x.slope * share,
        -y.slope * share,
        trail,
    )


def _force_over_slip(a: Arithmetic, curve: _Curve, slip: Any) -> Any:
    """Return the force over the slip: adhesion, two parabolas or a cubic, sliding."""
    slope = curve.slope + a.positive(2 * curve.maximum / curve.slip_of_maximum - curve.slope)
    part = a.define("adhering", at_most(a, slip, curve.slip_of_maximum) / curve.slip_of_maximum)
    bend = slope * curve.slip_of_maximum / curve.maximum - 2
    adhesion = slope * curve.slip_of_maximum * part / (1 + part * (part + bend))
    width = curve.slip_of_sliding - curve.slip_of_maximum
    beyond = a.positive(slip - curve.slip_of_maximum)
    fallen = _fallen(a, curve, slope, width, at_most(a, beyond, width))
    return (adhesion - fallen) / slip


def _fallen(a: Arithmetic, curve: _Curve, slope: Any, width: Any, beyond: Any) -> Any:
    """Return by how much the force is below its maximum, at a slip beyond that of the maximum.

    Two parabolas, the first with the curvature of adhesion at the maximum; where they do not meet
    before sliding, a cubic.
    """
    fall = curve.maximum - curve.sliding
    steep = curve.maximum / curve.slip_of_maximum
    curvature = steep * steep / (slope * curve.slip_of_maximum)
    meeting = fall / (curvature * width)
    meet = (1 + a.sign(width - meeting)) / 2  # one where they meet, zero where not
    before = at_most(a, beyond, meeting)
    rest = a.positive(width - meeting) + (1 - meet) * width
    left = a.positive(width - beyond) / rest
    behind = curvature * meeting * rest * left * left
    first = curvature * before * before
    passed = (1 + a.sign(beyond - meeting)) / 2
    parabolas = (1 - passed) * first + passed * (fall - behind)
    share = beyond / width
    return meet * parabolas + (1 - meet) * fall * share * share * (3 - 2 * share)


def _trail(a: Arithmetic, p: Mapping[str, Any], load: Any, lateral: Any) -> Any:
    """Return the trail over the length of the contact."""
    friction = p["friction"] / p["friction_measured"]
    values = [
        by_load(load, p["nominal_load"], p[f"{what}_1"], p[f"{what}_2"], quadratic=False)
        for what in TRAIL
    ]
    most, zero, none = values[0], values[1] * friction, values[2] * friction
    none = none + a.positive(zero - none)
    weight = zero / none
    slip = magnitude(a, lateral)
    part = at_most(a, slip, zero) / zero
    low = most * ((1 - weight) * (1 - part) + weight * (1 - (3 - 2 * part) * part * part))
    beyond = at_most(a, a.positive(slip - zero), none - zero)
    left = (none - zero - beyond) / (none - zero + 1e-12)
    return low - most * (1 - weight) * beyond / zero * left * left
