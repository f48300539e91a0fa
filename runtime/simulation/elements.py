"""Struts, tyres and dampers: the events and the bounds that their signals have.

The equations do not say which of their signals is the length of a strut or the force of a tyre, so
that it is read from the names: here, and nowhere else below what knows suspensions.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.errors import InputError
from ..core.suggestions import suggestion
from ..systems.system import System
from .events import SignalEvent
from .validity import Bound

Values = float | NDArray[np.float64]

NAMED = {
    "wheel_leaves_ground": "the tyre force falls through zero",
    "wheel_touches_ground": "the tyre force rises through zero",
    "strut_fully_extended": "the strut reaches its greatest length",
    "strut_reaches_bump_stop": "strut or damper becomes as short as its bump stop allows freely",
    "strut_reaches_rebound_stop": "strut or damper becomes as long as its rebound stop allows",
}
_AT_THE_GROUND = {"wheel_leaves_ground": -1.0, "wheel_touches_ground": 1.0}
# Which stop, and the sense of the strut's length when it touches.
_AT_A_STOP = {
    "strut_reaches_bump_stop": ("bump", -1.0),
    "strut_reaches_rebound_stop": ("rebound", 1.0),
}
# Force at which a tyre that can lift off is taken to touch, and below which the pull of another is
# rounding [N]: nanometres of its deflection.
_TOUCH = 1e-3


def named_event(model: System, name: str) -> SignalEvent:
    """Return an event by its name.

    Parameters
    ----------
    model : System or Model
    name : str
        One of `NAMED`.

    Raises
    ------
    InputError
        If there is no such event, or the model has not what it is of.
    """
    if name in _AT_THE_GROUND:
        # a tyre that lifts off has no force in the air: a zero would last as long as the flight
        level = _TOUCH if model.parameters.get("tyre_lifts_off") else 0.0
        return SignalEvent("tyre_force", level, direction=_AT_THE_GROUND[name])
    if name == "strut_fully_extended" and "strut_length_max" in model.parameters:
        length = model.parameters["strut_length_max"]
        return SignalEvent("strut_length", length, direction=+1.0, terminal=True)
    if name in _AT_A_STOP and (stopped := _stopped(model)):
        return _touching(model, stopped, *_AT_A_STOP[name])
    if name in NAMED:
        problem = f"event {name!r} belongs to a strut, which {model.equations.NAME} has not."
        raise InputError([problem], "events")
    problem = f"event {name!r} is not known. {suggestion(name, NAMED)}"
    raise InputError([problem], "events")


def _stopped(model: System) -> str:
    """Return the length that stops limit: of a strut, or of a damper on its spring's axis."""
    lengths = ("strut_length", "spring_length")
    return next((name for name in lengths if name in model.signal_names), "")


def _touching(model: System, length: str, side: str, direction: float) -> SignalEvent:
    """Return the event of a length at which one of the stops is touched."""
    if not model.parameters.get(f"{side}_stop_rate"):
        problem = f"there is no {side} stop. Give the suspension's file a [{side}_stop]."
        raise InputError([problem], "events")
    return SignalEvent(length, model.parameters[f"{side}_stop_length"], direction)


def bounds_of(model: System) -> Iterator[Bound]:
    """Yield what the signals of a model must not pass."""
    for found in limits_of(model.signal_names, model.parameters):
        if np.isfinite(found.limit):
            limit = float(found.limit)
            yield Bound(found.signal, limit, found.above, found.words, found.possible)


@dataclass(frozen=True)
class Limit:
    """What a signal must not pass, in one system or in each of many.

    Attributes
    ----------
    signal : str
    limit : float or ndarray
        SI units; infinite where there is none.
    above, words, possible
        As of `Bound`.
    """

    signal: str
    limit: Values
    above: bool
    words: str
    possible: bool = False


def limits_of(signals: tuple[str, ...], parameters: Mapping[str, Values]) -> Iterator[Limit]:
    """Yield what signals must not pass.

    Whoever has a new bound writes a function like those in `_LIMITS`.

    Parameters
    ----------
    signals : tuple of str
    parameters : mapping
        By name: one value, or those of many systems; SI units.
    """
    seen = _Seen(signals, parameters)
    for signal in signals:
        for ending, kind in _LIMITS.items():
            if signal == ending or signal.endswith(f"_{ending}"):
                yield from kind(seen, signal, signal.removesuffix(ending))


@dataclass(frozen=True)
class _Seen:
    """What the bounds follow from."""

    signals: tuple[str, ...]
    parameters: Mapping[str, Values]

    def parameter(self, prefix: str, name: str) -> Values:
        """Return a parameter of this side, or the common one; zero where there is neither."""
        return self.parameters.get(f"{prefix}{name}", self.parameters.get(name, 0.0))


def _strut_length(seen: _Seen, signal: str, prefix: str) -> Iterator[Limit]:
    greatest = seen.parameter(prefix, "strut_length_max")
    limit = np.where(greatest, greatest, np.inf)
    yield Limit(signal, limit, above=True, words="the strut is longer than it can be")
    least = seen.parameter(prefix, "strut_length_min")
    yield Limit(signal, least, above=False, words="the strut is shorter than it can be")


def _tyre_force(seen: _Seen, signal: str, prefix: str) -> Iterator[Limit]:
    limit = np.where(seen.parameter(prefix, "tyre_lifts_off"), -np.inf, -_TOUCH)
    yield Limit(signal, limit, above=False, words="the tyre pulls at the road")


def _compression(seen: _Seen, signal: str, prefix: str) -> Iterator[Limit]:
    """Yield the ends of a damper's table, which is one of velocities in bump."""
    if signal.endswith("spring_velocity") and f"{prefix}strut_velocity" in seen.signals:
        return
    table = {
        name.removeprefix(prefix): value
        for name, value in seen.parameters.items()
        if name.removeprefix(prefix).startswith("damper_table_")
    }
    knots = np.broadcast_arrays(*(value for name, value in table.items() if "_knot_" in name))
    if not knots:
        return
    first, last = np.min(knots, axis=0), np.max(knots, axis=0)
    words = "the damper is faster in {} than its table goes, and is taken to go on straight"
    for limit, above, where in ((-last, False, "bump"), (-first, True, "rebound")):
        none = np.inf if above else -np.inf
        there = np.where(last > first, limit, none)
        yield Limit(signal, there, above, words=words.format(where), possible=True)


_LIMITS: dict[str, Callable[[_Seen, str, str], Iterator[Limit]]] = {
    "strut_length": _strut_length,
    "tyre_force": _tyre_force,
    "strut_velocity": _compression,
    "spring_velocity": _compression,
}
