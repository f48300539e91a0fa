"""Inputs as piecewise cubics, from a number, samples or a function."""

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.interpolate import PPoly
from typing_extensions import TypeAliasType

from ..core.errors import InputError
from ..core.named_types import Array
from .fitting import fitted
from .interpolation import WAYS, Samples, curves

Signal = TypeAliasType(
    "Signal", float | Samples | tuple[Any, Any] | list[Any] | PPoly | Callable[[float], Any]
)


def profile(
    name: str, signal: Signal, t_span: tuple[float, float], *, max_step: float, rates: int
) -> list[PPoly] | float:
    """Return an input as piecewise cubics, or as a number if it does not vary.

    There is one cubic for each time span between given jumps. The signal has SI units; `t_span` are
    first and last time, which samples must cover [s]; `max_step` is the longest time between two
    calls of a function [s], `rates` the number of derivatives that the model reads. Raises
    `InputError` if the input cannot be used.
    """
    if isinstance(signal, tuple | list):
        if len(signal) != 2:
            raise InputError([f"{name!r}: samples are a pair (times, values)."], "inputs")
        signal = Samples(*signal)
    if isinstance(signal, Samples):
        return _sampled(name, signal, t_span, rates)
    if isinstance(signal, PPoly):
        return [_padded(name, signal, t_span)]
    if not callable(signal):
        return _number(name, signal)
    found = fitted(name, signal, t_span, max_step=max_step, accelerates=rates == 2)
    return found if isinstance(found, float) else [found]


def _number(name: str, value: Any) -> float:
    number = np.nan
    if not isinstance(value, bool | str | bytes):
        try:
            number = float(value)
        except (TypeError, ValueError, OverflowError):
            number = np.nan
    if not np.isfinite(number):
        problem = (
            f"{name!r} = {value!r}: a finite number, samples (times, values) or a function of time "
            "is needed."
        )
        raise InputError([problem], "inputs")
    return number


def _padded(name: str, curve: PPoly, t_span: tuple[float, float]) -> PPoly:
    """Return a piecewise polynomial of SciPy as a cubic."""
    degree = curve.c.shape[0] - 1
    if curve.c.ndim != 2 or degree > 3 or not np.isrealobj(curve.c):
        problem = (
            f"{name!r}: a piecewise polynomial of degree 3 or less with real numbers as values is "
            f"needed; its coefficients have shape {curve.c.shape} and are {curve.c.dtype}. Give "
            "samples (times, values) of it."
        )
        raise InputError([problem], "inputs")
    _check_samples(name, curve.x, curve.c[-1], t_span, pieces=True)
    if not np.isfinite(curve.c).all():
        raise InputError([f"{name!r}: the coefficients must be finite."], "inputs")
    if degree == 3:
        # of the same class; margins may be evaluated beyond its end
        return curve.construct_fast(curve.c, curve.x, extrapolate=True)
    return PPoly(np.concatenate((np.zeros((3 - degree, curve.c.shape[1])), curve.c)), curve.x)


def _sampled(name: str, samples: Samples, t_span: tuple[float, float], rates: int) -> list[PPoly]:
    if not (isinstance(samples.between, str) and samples.between in WAYS):
        problem = f"{name!r}: between = {samples.between!r}; there are {', '.join(WAYS)}."
        raise InputError([problem], "inputs")
    try:
        times, values = (np.asarray(s, dtype=np.float64) for s in (samples.times, samples.values))
    except (TypeError, ValueError, OverflowError):
        problem = f"{name!r}: samples are two rows of numbers, times and values."
        raise InputError([problem], "inputs") from None
    _check_samples(name, times, values, t_span)
    found = curves(times, values, samples.between, accelerates=rates == 2)
    broken = next((c for c in found if not np.isfinite(c.c).all()), None)
    if broken is not None:
        time = broken.x[int(np.argmin(np.isfinite(broken.c).all(axis=0)))]
        problem = (
            f"{name!r}: values near t = {time:.6g} s change faster than double precision can "
            "represent. "
            "Check times and values there."
        )
        raise InputError([problem], "inputs")
    return found


def _check_samples(
    name: str, times: Array, values: Array, t_span: tuple[float, float], *, pieces: bool = False
) -> None:
    if not pieces and (times.ndim != 1 or times.shape != values.shape or times.size < 2):
        problem = (
            f"{name!r}: times and values must be two rows of the same length, two or more; their "
            f"shapes are {times.shape} and {values.shape}."
        )
    elif not (np.all(np.isfinite(times)) and np.all(np.isfinite(values))):
        problem = f"{name!r}: times and values must be finite."
    elif _first_disorder(times) is not None:
        index = _first_disorder(times) or 0
        problem = (
            f"{name!r}: times must increase, and a jump is one time given twice; this fails at "
            f"element {index} (t = {times[index]:g} s)."
        )
    elif times[0] > min(t_span) or times[-1] < max(t_span):
        problem = (
            f"{name!r}: the samples cover {times[0]:g} s to {times[-1]:g} s, the simulation runs "
            f"from {min(t_span):g} s to {max(t_span):g} s. Give samples for the whole time."
        )
    else:
        return
    raise InputError([problem], "inputs")


def _first_disorder(times: Array) -> int | None:
    """Return where times decrease, or one is alone between jumps or given three times."""
    steps = np.diff(times)
    still = np.concatenate(([False], steps == 0.0, [False]))
    bad = np.flatnonzero((steps < 0.0) | (still[:-2] & (steps == 0.0)))
    lonely = [0] if still[1] else [times.size - 1] if still[-2] else []
    found = [int(i) for i in bad] + lonely
    return found[0] if found else None
