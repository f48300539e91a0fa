"""Inputs that vary with time: constants, samples, splines, functions."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from .errors import InputError
from .input.suggestions import suggestion
from .model import Model

Array = NDArray[np.float64]
Samples = tuple[NDArray[np.float64], NDArray[np.float64]]
TimeFunction = Callable[[float], Any]
Signal = float | Samples | TimeFunction

RACK = "rack_position"
_DERIVED = {"rack_velocity": 1, "rack_acceleration": 2}


@dataclass(frozen=True)
class TimeInputs:
    """The inputs of a model as a function of time.

    Attributes
    ----------
    constant : ndarray
        Values of those that do not vary.
    varying : dict
        Position in the array of inputs to function of time [s].
    rack_held : bool
        Whether the rack stands still.
    """

    constant: Array
    varying: dict[int, TimeFunction]
    rack_held: bool

    def __call__(self, time: float) -> Array:
        """Return the array of inputs at a time."""
        values = self.constant.copy()
        for index, function in self.varying.items():
            values[index] = function(time)
        return values

    def at(self, times: Array) -> Array:
        """Return the inputs at many times, shape (number of times, number of inputs)."""
        return np.array([self(float(t)) for t in times])


def time_inputs(
    model: Model, signals: Mapping[str, Signal] | None, t_span: tuple[float, float]
) -> TimeInputs:
    """Check the inputs of a simulation and bring them into one form.

    Parameters
    ----------
    model : Model
    signals : mapping, optional
        Input name to a number, to samples ``(times, values)``, which a cubic spline with continuous
        second derivative interpolates, or to a function of time; SI units. Velocity and
        acceleration of the rack follow from its position, so that a function given for it needs a
        method ``derivative(order)``, as SciPy's splines have.
    t_span : tuple of float
        First and last time of the simulation, which samples must cover [s].

    Returns
    -------
    TimeInputs
    """
    names = model.input_names
    constant = np.zeros(len(names))
    varying: dict[int, TimeFunction] = {}
    for name, signal in (signals or {}).items():
        if name not in names or name in _DERIVED:
            raise InputError([_refusal(name, names)], "inputs")
        if isinstance(signal, int | float):
            _check_finite(name, signal)
            constant[names.index(name)] = signal
            continue
        function: TimeFunction
        function = _sampled(name, signal, t_span) if isinstance(signal, tuple) else signal
        varying[names.index(name)] = function
        if name == RACK:
            for derived, order in _DERIVED.items():
                varying[names.index(derived)] = _derivative(function, order)
    rack_held = not model.free_rack and names.index(RACK) not in varying
    return TimeInputs(constant, varying, rack_held)


def _refusal(name: str, names: tuple[str, ...]) -> str:
    if name in _DERIVED:
        return f"{name!r} follows from {RACK!r}: give the position alone, as samples or a spline."
    known = [n for n in names if n not in _DERIVED]
    return f"{name!r} is not an input. {suggestion(name, known)}"


def _check_finite(name: str, value: float) -> None:
    if not np.isfinite(value):
        raise InputError([f"{name!r} = {value}: a finite number is needed."], "inputs")


def _sampled(name: str, samples: Samples, t_span: tuple[float, float]) -> TimeFunction:
    times, values = (np.asarray(s, dtype=np.float64) for s in samples)
    problems = []
    if times.ndim != 1 or times.shape != values.shape or times.size < 4:
        problems.append(
            f"{name!r}: times and values must be two rows of the same length, four or more; "
            f"their shapes are {times.shape} and {values.shape}."
        )
    elif not (np.all(np.isfinite(times)) and np.all(np.isfinite(values))):
        problems.append(f"{name!r}: times and values must be finite.")
    elif np.any(np.diff(times) <= 0.0):
        first = int(np.argmax(np.diff(times) <= 0.0))
        problems.append(
            f"{name!r}: times must increase; they do not after element {first} "
            f"(t = {times[first]:g} s)."
        )
    elif times[0] > min(t_span) or times[-1] < max(t_span):
        problems.append(
            f"{name!r}: the samples cover {times[0]:g} s to {times[-1]:g} s, the simulation runs "
            f"from {min(t_span):g} s to {max(t_span):g} s. Give samples for the whole time."
        )
    if problems:
        raise InputError(problems, "inputs")
    spline: TimeFunction = CubicSpline(times, values, extrapolate=False)
    return spline


def _derivative(function: TimeFunction, order: int) -> TimeFunction:
    derivative = getattr(function, "derivative", None)
    if derivative is None:
        problem = (
            f"{RACK!r}: velocity and acceleration are needed too. Give samples (times, values), "
            "or a spline with a method derivative(order), as scipy.interpolate.CubicSpline has."
        )
        raise InputError([problem], "inputs")
    result: TimeFunction = derivative(order)
    return result
