"""Inputs that vary with time, as cubic splines: constants, samples, functions."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from .errors import InputError
from .input.suggestions import suggestion
from .system import System

Array = NDArray[np.float64]
Samples = tuple[Any, Any] | list[Any]
Signal = float | Samples | Callable[[float], Any]

# What follows by differentiation in time from an input that ends so, where a model takes it. A jump
# of the road passes the tyre's damper without a blow.
_RATES = {
    "_position": ("_velocity", "_acceleration"),
    "_height": ("_velocity",),
}
# An input that has stood still for this part of the time begins to move with a new integration.
_STILL = 0.01
_FIRST_GRID = 33
_LARGEST_GRID = 2**17 + 1
# A function becomes a spline that reproduces it between its samples to this part of its size; the
# second derivative, which the rack's acceleration needs, is then good to about the square root.
_SPLINE_TOLERANCE = 1e-10


@dataclass(frozen=True)
class Spline:
    """One varying input.

    Attributes
    ----------
    curve : CubicSpline
        With continuous second derivative, of time [s].
    targets : tuple of int
        Positions in the array of inputs of the value and its two derivatives; -1 for none.
    """

    curve: CubicSpline
    targets: tuple[int, int, int]


@dataclass(frozen=True)
class Segment:
    """A time over which no input jumps, or begins to move.

    Attributes
    ----------
    start, end : float
        [s]
    splines : tuple of Spline
    """

    start: float
    end: float
    splines: tuple[Spline, ...] = ()


@dataclass(frozen=True)
class TimeInputs:
    """The inputs of a model over time.

    Attributes
    ----------
    constant : ndarray
        Values of those that do not vary.
    segments : tuple of Segment
        In the order of time; at their borders an input may jump, or begin to move.
    variant : str
        What ends the names of the functions that leave out what stands still; empty if nothing
        does.
    """

    constant: Array
    segments: tuple[Segment, ...]
    variant: str

    def at(self, time: float, segment: Segment) -> Array:
        """Return the array of inputs at a time within a segment."""
        values = self.constant.copy()
        for spline in segment.splines:
            for order, target in enumerate(spline.targets):
                if target >= 0:
                    values[target] = spline.curve(time, order)
        return values

    def table(self, times: Array, segment: Segment) -> Array:
        """Return the inputs at many times of a segment, one row each."""
        values = np.repeat(self.constant[None], times.size, axis=0)
        for spline in segment.splines:
            for order, target in enumerate(spline.targets):
                if target >= 0:
                    values[:, target] = spline.curve(times, order)
        return values


@dataclass
class _Collected:
    """What `time_inputs` gathers."""

    constant: Array
    curves: dict[str, list[CubicSpline]] = field(default_factory=dict)
    borders: set[float] = field(default_factory=set)


def time_inputs(
    model: System, signals: Mapping[str, Signal] | None, t_span: tuple[float, float]
) -> TimeInputs:
    """Check the inputs of a simulation and bring them into one form.

    Parameters
    ----------
    model : System or Model
    signals : mapping, optional
        Input name to a number, to samples ``(times, values)``, or to a function of time; SI units.
        A cubic spline with continuous second derivative goes through the samples; a time that is
        given twice is a jump. Velocity and acceleration follow from a prescribed position.
    t_span : tuple of float
        First and last time of the simulation, which samples must cover [s].

    Returns
    -------
    TimeInputs
    """
    names = model.input_names
    derived = _derived(names)
    collected = _Collected(np.zeros(len(names)))
    for name, signal in (signals or {}).items():
        if name not in names or name in derived:
            raise InputError([_refusal(name, names, derived)], "inputs")
        _collect(collected, names, name, signal, t_span)
    return TimeInputs(
        collected.constant, _segments(collected, names, t_span), _variant(model, collected)
    )


@cache
def _rates(name: str, names: tuple[str, ...]) -> tuple[str, ...]:
    """Return the inputs of a model that are the derivatives of another one, in order."""
    for ending, rates in _RATES.items():
        if name.endswith(ending):
            return tuple(
                r for r in (name.removesuffix(ending) + rate for rate in rates) if r in names
            )
    return ()


def _derived(names: tuple[str, ...]) -> dict[str, str]:
    """Return the inputs that follow from another one, and from which."""
    return {rate: name for name in names for rate in _rates(name, names)}


def _variant(model: System, collected: _Collected) -> str:
    """Return the ending of the shortest functions that have all that moves."""
    names = model.input_names
    moving = {rate for name in collected.curves for rate in _rates(name, names)}
    for variant, still in model.equations.HELD_VARIANTS.items():
        if moving.isdisjoint(still):
            return f"_{variant}"
    return ""


def _refusal(name: str, names: tuple[str, ...], derived: dict[str, str]) -> str:
    if name in derived:
        source = derived[name]
        return (
            f"{name!r} follows from {source!r}: give that alone, as samples or as a function of "
            "time."
        )
    return f"{name!r} is not an input. {suggestion(name, [n for n in names if n not in derived])}"


def _collect(
    collected: _Collected,
    names: tuple[str, ...],
    name: str,
    signal: Signal,
    t_span: tuple[float, float],
) -> None:
    if isinstance(signal, CubicSpline):
        _check_samples(name, signal.x, signal(signal.x), t_span)
        collected.curves[name] = [signal]
    elif callable(signal):
        collected.curves[name] = [_fitted(name, signal, t_span)]
    elif isinstance(signal, tuple | list):
        pieces = _sampled(name, signal, t_span)
        if len(pieces) > 1 and name.endswith("_position"):
            problem = (
                f"{name!r} jumps at t = {pieces[1].x[0]:g} s: the {name.removesuffix('_position')} "
                "would need an infinite velocity. Give one value for each time."
            )
            raise InputError([problem], "inputs")
        collected.curves[name] = pieces
        collected.borders.update(float(piece.x[0]) for piece in pieces[1:])
    else:
        value = _number(name, signal)
        collected.constant[names.index(name)] = value
    for piece in collected.curves.get(name, ()):
        collected.borders.update(_awakenings(piece, abs(t_span[1] - t_span[0])))


def _awakenings(curve: CubicSpline, duration: float) -> list[float]:
    """Return the times at which a curve begins to move after it has stood still for long.

    The steps of an integration grow while nothing happens. One that does not begin anew could pass
    over a short bump without a trace of it.
    """
    still = np.concatenate(([False], np.diff(curve.c[-1]) == 0.0, [False]))
    begins, ends = np.flatnonzero(still[1:] & ~still[:-1]), np.flatnonzero(still[:-1] & ~still[1:])
    long = curve.x[ends] - curve.x[begins] >= _STILL * duration
    return [float(time) for time in curve.x[ends[long]]]


def _number(name: str, value: Any) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = np.nan
    if not np.isfinite(number):
        problem = (
            f"{name!r} = {value!r}: a finite number, samples (times, values) or a function of time "
            "is needed."
        )
        raise InputError([problem], "inputs")
    return number


def _segments(
    collected: _Collected, names: tuple[str, ...], t_span: tuple[float, float]
) -> tuple[Segment, ...]:
    """Cut the time where the integration begins anew, and give each part its splines."""
    first, last = (float(t) for t in t_span)
    inside = sorted(
        (t for t in collected.borders if min(t_span) < t < max(t_span)), reverse=last < first
    )
    borders = [first, *inside, last]
    segments = []
    for start, end in pairwise(borders):
        middle = (start + end) / 2
        splines = [
            Spline(_covering(curves, middle), _targets(name, names))
            for name, curves in collected.curves.items()
        ]
        segments.append(Segment(start, end, tuple(splines)))
    return tuple(segments)


def _covering(curves: list[CubicSpline], time: float) -> CubicSpline:
    return next(c for c in curves if c.x[0] <= time <= c.x[-1])


def _targets(name: str, names: tuple[str, ...]) -> tuple[int, int, int]:
    """Return where a value and its two derivatives go; -1 for what the model does not take."""
    first, second, *_ = (*(names.index(rate) for rate in _rates(name, names)), -1, -1)
    return names.index(name), first, second


# -- samples ------------------------------------------------------------------------------------


def _sampled(name: str, samples: Samples, t_span: tuple[float, float]) -> list[CubicSpline]:
    if len(samples) != 2:
        raise InputError([f"{name!r}: samples are a pair (times, values)."], "inputs")
    times, values = (np.asarray(s, dtype=np.float64) for s in samples)
    _check_samples(name, times, values, t_span)
    cuts = np.flatnonzero(np.diff(times) == 0.0) + 1
    parts = zip(np.split(times, cuts), np.split(values, cuts), strict=True)
    return [_through(t, v) for t, v in parts]


def _through(times: Array, values: Array) -> CubicSpline:
    """Return a spline, also through the two or three samples that may lie between jumps."""
    if times.size < 4:
        dense = np.linspace(times[0], times[-1], 4)
        times, values = dense, np.interp(dense, times, values)
    return CubicSpline(times, values)


def _check_samples(name: str, times: Array, values: Array, t_span: tuple[float, float]) -> None:
    if times.ndim != 1 or times.shape != values.shape or times.size < 2:
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
    """Return where times fall, or where one stands alone between jumps or is given three times."""
    steps = np.diff(times)
    still = np.concatenate(([False], steps == 0.0, [False]))
    bad = np.flatnonzero((steps < 0.0) | (still[:-2] & (steps == 0.0)))
    lonely = [0] if still[1] else [times.size - 1] if still[-2] else []
    found = [int(i) for i in bad] + lonely
    return found[0] if found else None


# -- functions ----------------------------------------------------------------------------------


def _fitted(
    name: str, function: Callable[[float], Any], t_span: tuple[float, float]
) -> CubicSpline:
    """Return a spline through so many values of a function that it follows it in between."""
    size = _FIRST_GRID
    times = np.linspace(min(t_span), max(t_span), size)
    values = _values(name, function, times)
    while True:
        spline = CubicSpline(times, values)
        between = (times[:-1] + times[1:]) / 2
        middle = _values(name, function, between)
        error = np.abs(spline(between) - middle)
        scale = max(np.ptp(values), np.ptp(middle))
        if error.max() <= _SPLINE_TOLERANCE * scale:
            return spline
        if times.size >= _LARGEST_GRID:
            worst = between[int(np.argmax(error))]
            problem = (
                f"{name!r}: a smooth curve does not follow this function near t = {worst:.6g} s "
                f"(error {error.max():.3g} with {times.size} values). If it jumps or has a kink "
                "there, give samples (times, values) with the time of the jump twice."
            )
            raise InputError([problem], "inputs")
        times, values = _merged(times, between), _merged(values, middle)


def _merged(first: Array, between: Array) -> Array:
    merged = np.empty(first.size + between.size)
    merged[::2], merged[1::2] = first, between
    return merged


def _values(name: str, function: Callable[[float], Any], times: Array) -> Array:
    return np.array([_number(f"{name} at t = {t:.6g} s", function(float(t))) for t in times])
