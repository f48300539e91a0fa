"""Splines through functions of time."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from ..core.errors import InputError
from ..core.named_types import Array
from ..core.validator import shown

# Longest time between two calls of a function [s], and least and most number of calls.
_RESOLUTION = 1e-3
_FEWEST_CALLS = 1000
_MOST_CALLS = 5_000_000
# Initial and largest number of knots.
_FIRST_KNOTS = 65
_MOST_KNOTS = 2**19
# Error of a spline relative to the range of its function, or a few roundings of its values. The
# second derivative has about the square root of it.
_TOLERANCE = 1e-10
_ROUNDINGS = 8.0 * float(np.finfo(np.float64).eps)
# Shortest time between two calls, relative to the whole time.
_SHORTEST = 1e-20
# Calls are at irregular times, so that no periodic function looks like a constant: multiples of
# the golden section leave no gaps.
_GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0
# A velocity jumps if it changes by the fraction _JUMP of its range between two knots whose distance
# is less than the fraction _CLOSE of that between two calls.
_JUMP, _CLOSE = 0.1, 0.01


def fitted(
    name: str,
    function: Callable[[float], Any],
    t_span: tuple[float, float],
    *,
    max_step: float,
    accelerates: bool,
) -> CubicSpline | float:
    """Return a spline through a function of time, or a number if it does not vary.

    The function is called at least every millisecond, every thousandth of the time and every
    `max_step`, the longest step of the integration [s], at irregular times. The spline has every
    value of these calls, with as few knots as that needs; where a cubic is not close enough, the
    function is called again. So it includes everything that lasts twice as long as the distance of
    two calls, and everything periodic. `accelerates` is whether the model reads the second
    derivative; the velocity must then not jump. Raises `InputError` if the function jumps, or has
    values that are not finite.
    """
    low, high = min(t_span), max(t_span)
    calls = math.ceil(max((high - low) / min(_RESOLUTION, max_step), _FEWEST_CALLS))
    if calls > _MOST_CALLS:
        _refuse(
            f"{name!r}: to miss nothing in {high - low:g} s, this function would be called "
            f"{calls:.3g} times; at most {_MOST_CALLS:,} are made. Give samples (times, values)."
        )
    times = _irregular(low, high, calls)
    values = _values(name, function, times)
    if np.ptp(values) == 0.0:
        return float(values[0])
    curve = _followed(name, function, times, values)
    if accelerates:
        _check_velocity(name, curve, _CLOSE * (high - low) / calls)
    return curve


def _irregular(low: float, high: float, count: int) -> Array:
    """Return times from end to end whose distances vary by half."""
    steps = np.arange(count + 1)
    shifts = 0.5 * ((steps * _GOLDEN) % 1.0 - 0.5)
    shifts[[0, -1]] = 0.0
    times: Array = low + (high - low) * (steps + shifts) / count
    times[-1] = high
    return times


def _followed(
    name: str, function: Callable[[float], Any], times: Array, values: Array
) -> CubicSpline:
    """Return a spline with knots added until it has every value."""
    knot = np.zeros(times.size, dtype=bool)
    knot[np.linspace(0, times.size - 1, _FIRST_KNOTS).astype(int)] = True
    tolerance = max(_TOLERANCE * np.ptp(values), _ROUNDINGS * np.abs(values).max())
    while True:
        at = np.flatnonzero(knot)
        curve = CubicSpline(times[at], values[at])
        error = np.abs(curve(times) - values)
        failed = np.maximum.reduceat(error, at[:-1]) > tolerance
        if not failed.any():
            return curve
        shortest = np.maximum(2.0 * np.spacing(np.abs(times[1:])), _SHORTEST * np.ptp(times))
        if at.size > _MOST_KNOTS or (np.diff(times) <= shortest).any():
            worst = int(np.argmax(error))
            _refuse(
                f"{name!r}: a smooth curve does not follow this function near "
                f"t = {times[worst]:.6g} s (error {error[worst]:.3g} with {at.size} values). If it "
                "jumps there, give samples (times, values) with the time of the jump twice."
            )
        knot[(at[:-1] + at[1:])[failed] // 2] = True
        # a value between any two knots tests the curve
        at = np.flatnonzero(knot)
        bare = at[:-1][np.diff(at) == 1]
        between = times[bare] + _GOLDEN * (times[bare + 1] - times[bare])
        times = np.insert(times, bare + 1, between)
        values = np.insert(values, bare + 1, _values(name, function, between))
        knot = np.insert(knot, bare + 1, False)


def _check_velocity(name: str, curve: CubicSpline, close: float) -> None:
    """Refuse a kink of a position: it would need an infinite acceleration."""
    velocity = curve(curve.x, 1)
    jumps = np.abs(np.diff(velocity)) > _JUMP * np.ptp(velocity)
    jumps &= np.diff(curve.x) < close
    if jumps.any():
        time = curve.x[int(np.argmax(jumps))]
        _refuse(
            f"{name!r}: the velocity of this function jumps near t = {time:.6g} s, which would "
            "take an infinite acceleration. Round its kink."
        )


def _values(name: str, function: Callable[[float], Any], times: Array) -> Array:
    return np.array([_value(name, function, time) for time in times.tolist()])


def _value(name: str, function: Callable[[float], Any], time: float) -> float:
    try:
        given = function(time)
    except Exception as error:
        error.add_note(f"This was raised by the function given for {name!r}, at t = {time:.6g} s.")
        raise
    try:
        value = float(given)
    except (TypeError, ValueError, OverflowError):
        value = math.nan
    if not math.isfinite(value):
        _refuse(f"{name!r} at t = {time:.6g} s is {shown(given)}: a finite number is needed.")
    return value


def _refuse(problem: str) -> None:
    raise InputError([problem], "inputs")
