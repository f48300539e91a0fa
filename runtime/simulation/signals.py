"""Inputs that vary with time: constants, samples and functions in one form.

Every varying input becomes a piecewise cubic, which the integrators evaluate, with the derivatives
that the model reads (the velocity of a road, velocity and acceleration of a rack). Two rules ensure
that an integrator misses no change:

- a segment ends, and the integration starts again, where an input or such a derivative jumps;
- no step passes over the time of a kink of one, nor over the time of an extremum, unless the
  extremum is slow compared with the step.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy.interpolate import CubicHermiteSpline, CubicSpline, PPoly

from ..core.errors import InputError
from ..core.named_types import Array
from ..core.suggestions import suggestion
from ..core.validator import Validator
from ..systems.inputs import Inputs, derived_inputs, may_jump, rates_of
from ..systems.system import System
from .input_profiles import Signal, profile
from .interpolation import Eased
from .turning import merged, turning_points

# Relative difference of times that an integrator does not distinguish.
_RESOLVED = 1e-13
# Least jump of a derivative, relative to its greatest value.
_JUMP = 1e-6


@dataclass(frozen=True)
class Spline:
    """One varying input."""

    curve: PPoly  # piecewise cubic, of time [s]
    # indices in the array of inputs of the value and its two derivatives; -1 for none
    targets: tuple[int, int, int]


@dataclass(frozen=True)
class Segment:
    """A time span in which no input jumps, nor a derivative that the model reads."""

    start: float  # [s]
    end: float  # [s]
    splines: tuple[Spline, ...]
    kinks: Array  # times inside that no step passes over, from start to end [s]
    # extrema of each input, see `turning_points`, also from start to end, (2, n)
    turns: tuple[Array, ...] = ()

    @cached_property
    def milestones(self) -> Array:
        """Times at which any input has a kink or an extremum [s]."""
        return self.milestones_of(np.inf)

    def milestones_of(self, step: float) -> Array:
        """Return the times that no step of a length passes over [s]."""
        fast = [turns[0, turns[1] < step] for turns in self.turns]
        return _within(self, np.concatenate([self.kinks, *fast]))

    @cached_property
    def free(self) -> tuple[Array, Array]:
        """Times that no step passes over, and extrema over which a step passes up to their reach.

        The extrema of a single input are few, and steps that end there fail less often. Those of
        several inputs, such as the roads under four wheels, would end every step.
        """
        if sum(turns.size > 0 for turns in self.turns) < 2:
            return self.milestones, np.empty((2, 0))
        turns = merged(self.turns, _near(self))
        return self.kinks, np.ascontiguousarray(turns[:, ::-1] if self.end < self.start else turns)


@dataclass(frozen=True)
class TimeInputs:
    """The inputs of a model over time."""

    constant: Array  # values of the inputs that do not vary
    segments: tuple[Segment, ...]  # in the order of time; at their borders an input may jump
    # suffix of the names of functions that leave out coordinates at rest; empty if none is at rest
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

    def with_milestones(self, times: Array) -> "TimeInputs":
        """Return the same inputs with more times that no step passes over, in any order [s]."""
        segments = (
            replace(part, kinks=_within(part, np.concatenate([part.kinks, times])))
            for part in self.segments
        )
        return replace(self, segments=tuple(segments))


def _near(part: Segment) -> float:
    """Return the difference of times that an integrator does not distinguish [s]."""
    return _RESOLVED * max(abs(part.start), abs(part.end))


def _within(part: Segment, times: Array) -> Array:
    """Return the distinct times within a segment, from its start to its end."""
    first, last = min(part.start, part.end), max(part.start, part.end)
    near = _near(part)
    times = np.unique(times)
    within = times[(times > first + near) & (times < last - near)]
    within = within[np.diff(within, prepend=-np.inf) > near]
    return within[::-1].copy() if part.end < part.start else within


@dataclass
class _Collected:
    """Intermediate results of `time_inputs`."""

    constant: Array
    curves: dict[str, list[PPoly]] = field(default_factory=dict)
    borders: set[float] = field(default_factory=set)
    kinks: list[Array] = field(default_factory=list)
    turns: dict[str, list[Array]] = field(default_factory=dict)


def time_inputs(
    model: System,
    signals: Mapping[str, Signal] | None,
    t_span: tuple[float, float],
    *,
    held: Array | None = None,
    max_step: float = np.inf,
) -> TimeInputs:
    """Return the checked inputs of a simulation in one form.

    By name of an input, `signals` has a number, samples (`Samples`, or a pair of times and values),
    a piecewise cubic of SciPy, or a function of time (see `fitting`), in SI units; `held` are the
    values of others, zero by default. Velocity and acceleration of a prescribed position are
    derivatives of the curve. `t_span` are first and last time, which samples must cover [s];
    `max_step` is the longest step of the integration, and the longest time between two calls of a
    function [s].
    """
    names, inputs = model.input_names, model.equations.INPUTS
    with Validator("inputs") as given:
        profiles = given.mapping(
            "inputs", {} if signals is None else signals, "input names and their values"
        )
    derived = derived_inputs(inputs) if profiles else {}
    collected = _Collected(np.zeros(len(names)) if held is None else held.copy())
    for name, signal in profiles.items():
        if name not in names or name in derived:
            raise InputError([_refusal(name, names, derived)], "inputs")
        rates = len(rates_of(name, inputs))
        found = profile(name, signal, t_span, max_step=max_step, rates=rates)
        if isinstance(found, float):
            collected.constant[names.index(name)] = found
        else:
            _collect(collected, name, found, rates)
    return TimeInputs(
        collected.constant, _segments(collected, inputs, t_span), _variant(model, collected)
    )


def _variant(model: System, collected: _Collected) -> str:
    """Return the suffix of the shortest functions that include all moving coordinates."""
    inputs = model.equations.INPUTS
    moving = {rate for name in collected.curves for rate in rates_of(name, inputs)}
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
    known = [n for n in names if n not in derived]
    return f"{name!r} is not an input. {suggestion(str(name), known)}"


def _segments(
    collected: _Collected, inputs: Inputs, t_span: tuple[float, float]
) -> tuple[Segment, ...]:
    """Return the time spans between jumps, each with its splines."""
    first, last = (float(t) for t in t_span)
    if not collected.curves:
        return (Segment(first, last, (), np.empty(0)),)
    backward = last < first
    inside = (t for t in collected.borders if min(t_span) < t < max(t_span))
    borders = [first, *sorted(inside, reverse=backward), last]
    kinks = np.concatenate([*collected.kinks, np.empty(0)])
    turns = [merged(parts) for parts in collected.turns.values()]
    segments = []
    for start, end in pairwise(borders):
        middle = (start + end) / 2
        splines = [
            Spline(next(c for c in curves if c.x[0] <= middle <= c.x[-1]), _targets(name, inputs))
            for name, curves in collected.curves.items()
        ]
        part = Segment(start, end, tuple(splines), kinks)
        within = tuple(one[:, np.isin(one[0], _within(part, one[0]))] for one in turns)
        segments.append(replace(part, kinks=_within(part, kinks), turns=within))
    return tuple(segments)


def _targets(name: str, inputs: Inputs) -> tuple[int, int, int]:
    """Return the indices of a value and its derivatives; -1 for those the model does not read."""
    names = list(inputs)
    first, second, *_ = (*(names.index(rate) for rate in rates_of(name, inputs)), -1, -1)
    return names.index(name), first, second


# -- jumps and extrema ----------------------------------------------------------------------------


def _collect(collected: _Collected, name: str, found: Sequence[PPoly], rates: int) -> None:
    """Note the curves of an input, cut at jumps, with the times of their extrema."""
    for before, after in pairwise(found):
        stays = before(before.x[-1]) == after(after.x[0])
        _check_jump(name, float(after.x[0]), int(stays), rates)
    parts: list[PPoly] = []
    for curve in found:
        smooth = _continuity(curve)
        cuts = [_breaks(curve, order) for order in range(smooth + 1, rates + 1)]
        for order, times in enumerate(cuts, smooth + 1):
            if times.size:
                _check_jump(name, float(times[0]), order, rates)
        if not rates and smooth < 1:
            collected.kinks.append(_breaks(curve, 1))
        parts += _split(curve, np.unique(np.concatenate([*cuts, np.empty(0)])))
    collected.curves[name] = parts
    collected.borders.update(float(part.x[0]) for part in parts[1:])
    collected.turns[name] = [turning_points(part, range(rates + 1)) for part in parts]


def _check_jump(name: str, time: float, order: int, rates: int) -> None:
    """Refuse a jump of a position, or of its velocity, that would need an infinite rate."""
    if may_jump(rates) or order >= rates:
        return
    what, needs = (("", "velocity"), ("the velocity of ", "acceleration"))[order]
    problem = (
        f"{what}{name!r} jumps at t = {time:g} s: the driven body would need an infinite {needs} "
        "there. Give one value for each time, and a smooth curve between them."
    )
    raise InputError([problem], "inputs")


def _continuity(curve: PPoly) -> int:
    """Return the order to which a curve's construction makes it continuous; -1 for none."""
    if isinstance(curve, CubicSpline | Eased):
        return 2
    return 1 if isinstance(curve, CubicHermiteSpline) else -1


def _breaks(curve: PPoly, order: int) -> Array:
    """Return the times at which a derivative jumps."""
    derivative = curve.derivative(order)
    width = np.diff(curve.x)[:-1]
    ends = np.zeros(width.size)
    for row in derivative.c[:, :-1]:
        ends = ends * width + row
    begins = derivative.c[-1]
    largest = max(np.abs(begins).max(), np.abs(ends).max(initial=0.0))
    return curve.x[1:-1][np.abs(begins[1:] - ends) > _JUMP * largest]


def _split(curve: PPoly, times: Array) -> list[PPoly]:
    """Return the parts of a curve between times that are among its breaks."""
    ends = [0, *np.searchsorted(curve.x, times), curve.x.size - 1]
    if len(ends) == 2:
        return [curve]
    return [PPoly(curve.c[:, a:b], curve.x[a : b + 1]) for a, b in pairwise(ends)]
