"""Forces of strut and tyre as functions of lengths and velocities.

Every force of the strut is positive when it pushes knuckle and chassis apart, in N; `slide_rate` is
how fast they approach, in m/s, positive in bump.
"""

from functools import lru_cache

import numpy as np
from scipy.interpolate import PPoly

from oracle.reference import DAMPER_SEGMENTS


def damper_curve(parameters):
    """Return force over compression velocity, from the coefficients of a flat parameter dict.

    Parameters
    ----------
    parameters : dict of float
        Complete, see `oracle.reference.completed`.

    Returns
    -------
    callable
        From m/s to N: cubics between the knots, straight lines outside.
    """
    return _curve(parameters, "damper_table", 1.0)


def spring_force(parameters, length):
    """Return the force of the spring at a length (m), by its rate and its curve together."""
    return _spring(parameters)(length)


def _spring(parameters):
    rate, free = parameters["spring_rate"], parameters["spring_free_length"]
    curve = _curve(parameters, "spring_table", -1.0)
    return lambda length: rate * (free - length) + curve(-length)


def _curve(parameters, name, sense):
    """Return force over what presses; a table has its knots with a sign."""
    return _curve_of(tuple(parameters[f"{name}_{key}"] for key in _KEYS), sense)


_KEYS = (
    *("first_force", "first_slope", "last_slope"),
    *(f"knot_{i}" for i in range(DAMPER_SEGMENTS + 1)),
    *(f"{p}_{i}" for p in ("linear", "quadratic", "cubic") for i in range(DAMPER_SEGMENTS)),
)


@lru_cache(maxsize=64)  # an integration asks for one curve again and again
def _curve_of(values, sense):
    table = dict(zip(_KEYS, values, strict=True))
    knots = sense * np.array([table[f"knot_{i}"] for i in range(DAMPER_SEGMENTS + 1)])
    used = np.flatnonzero(np.diff(knots) > 0.0)
    first, force = table["first_slope"], table["first_force"]
    last, origin = table["last_slope"], knots[0]
    if len(used) == 0:
        return lambda v: force + (last if v > origin else first) * (v - origin)
    columns = []
    for i in used:
        width = knots[i + 1] - knots[i]
        linear, quadratic, cubic = (table[f"{p}_{i}"] for p in ("linear", "quadratic", "cubic"))
        columns.append([cubic / width**3, quadratic / width**2, linear / width, force])
        force += linear + quadratic + cubic
    end = knots[used[-1] + 1]
    inside = PPoly(np.array(columns).T, np.append(knots[used], end))

    def curve(v):
        if v < origin:
            return float(table["first_force"] + first * (v - origin))
        if v > end:
            return float(force + last * (v - end))
        return float(inside(v))

    return curve


def damper_force(parameters, slide_rate):
    """Return the force of the damper, its constant rate and its curve together."""
    curve = damper_curve(parameters)
    return parameters["damper_rate"] * slide_rate + curve(slide_rate)


def friction_force(parameters, slide_rate):
    """Return the friction of the strut: the sine of the angle whose tangent is v / speed."""
    angle = np.arctan2(slide_rate, parameters["strut_friction_speed"])
    return float(parameters["strut_friction"] * np.sin(angle))


def stop_force(parameters, side, length):
    """Return the force of the ``bump`` or ``rebound`` stop at a length of the strut, m."""
    depth, sense = _depth(parameters, side, length)
    if depth < 0.0:
        return 0.0
    rate, cubic = (parameters[f"{side}_stop_{name}"] for name in ("rate", "progression"))
    return float(sense * np.polyval([cubic, 0.0, rate, 0.0], depth))


def _depth(parameters, side, length):
    """Return how far a stop is pressed in, m, and the sign of its force."""
    sense = {"bump": 1.0, "rebound": -1.0}[side]
    return sense * (parameters[f"{side}_stop_length"] - length), sense


def tyre_load(parameters, deflection, deflection_rate):
    """Return the vertical force of the road on the tyre, N.

    Parameters
    ----------
    parameters : dict of float
        Complete. With ``tyre_lifts_off`` zero the tyre holds on to the road.
    deflection, deflection_rate : float
        Of the tyre, m and m/s, positive in compression.

    Returns
    -------
    float
        Positive upwards on the wheel.
    """
    load = parameters["tyre_rate"] * deflection + parameters["tyre_damper_rate"] * deflection_rate
    if parameters["tyre_lifts_off"] and (deflection < 0.0 or load < 0.0):
        return 0.0
    return float(load)
