"""Events during a simulation: by physical name, by signal and level, or by a function."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ..core.arguments import Arguments, shown
from ..core.errors import InputError
from ..core.suggestions import suggestion
from ..systems.system import System


@dataclass(frozen=True)
class SignalEvent:
    """A signal of the model passes a level.

    Attributes
    ----------
    signal : str
        Name, see ``model.signal_names``.
    level : float
        SI units.
    direction : float
        Negative: falling only; positive: rising only; zero: both.
    terminal : bool or int
        Whether, or at which crossing, the simulation ends.
    """

    signal: str
    level: float
    direction: float = 0.0
    terminal: bool | int = False


EventFunction = Callable[..., float]
Event = str | SignalEvent | EventFunction

NAMED = {
    "wheel_leaves_ground": "the tyre force falls through zero",
    "wheel_touches_ground": "the tyre force rises through zero",
    "strut_fully_extended": "the strut reaches its greatest length",
    "strut_reaches_bump_stop": "the strut becomes as short as its bump stop allows freely",
    "strut_reaches_rebound_stop": "the strut becomes as long as its rebound stop allows freely",
}
_MOST_CROSSINGS = 2**31 - 1
_AT_THE_GROUND = {"wheel_leaves_ground": -1.0, "wheel_touches_ground": 1.0}
# Which stop, and the sense of the strut's length when it touches.
_AT_A_STOP = {
    "strut_reaches_bump_stop": ("bump", -1.0),
    "strut_reaches_rebound_stop": ("rebound", 1.0),
}
# Force at which a tyre that can lift off is taken to touch [N]: nanometres of its deflection.
_TOUCH = 1e-3


@dataclass(frozen=True)
class Events:
    """The events of a simulation: `signal` ones first, then the caller's functions.

    Attributes
    ----------
    signal : tuple of SignalEvent
    functions : tuple of callable
        Of time and state, with SciPy's attributes ``terminal`` and ``direction``.
    order : tuple of int
        Position of each of them in what the caller gave.
    """

    signal: tuple[SignalEvent, ...]
    functions: tuple[EventFunction, ...]
    order: tuple[int, ...]

    @property
    def directions(self) -> list[int]:
        """The sense of each event: -1, 0 or +1."""
        values = [e.direction for e in self.signal]
        values += [float(getattr(f, "direction", 0.0)) for f in self.functions]
        return [(v > 0) - (v < 0) for v in values]

    @property
    def terminal(self) -> list[int]:
        """At which crossing each event ends the simulation; 0 for never."""
        values: list[Any] = [e.terminal for e in self.signal]
        values += [getattr(f, "terminal", False) for f in self.functions]
        return [int(v) for v in values]

    def __len__(self) -> int:
        return len(self.order)


def events_of(model: System, given: Event | Sequence[Event] | None) -> Events:
    """Sort the events that a caller gave.

    Parameters
    ----------
    model : System or Model
    given : str, SignalEvent, callable, or sequence of these

    Returns
    -------
    Events
    """
    single = given is None or callable(given) or isinstance(given, str | SignalEvent)
    listed: list[Any] = list(given) if isinstance(given, Sequence) and not single else [given]
    listed = [event for event in listed if event is not None]
    signal: list[tuple[int, SignalEvent]] = []
    functions: list[tuple[int, EventFunction]] = []
    for index, event in enumerate(listed):
        if isinstance(event, str):
            signal.append((index, _checked(model, _named(model, event))))
        elif isinstance(event, SignalEvent):
            signal.append((index, _checked(model, event)))
        elif callable(event):
            functions.append((index, event))
        else:
            problem = f"event {shown(event)} is neither a name, nor a SignalEvent, nor a function."
            raise InputError([problem], "events")
    order = tuple(i for i, _ in (*signal, *functions))
    return Events(tuple(e for _, e in signal), tuple(f for _, f in functions), order)


def _named(model: System, name: str) -> SignalEvent:
    if name in _AT_THE_GROUND:
        # a tyre that lifts off has no force in the air: a zero would last as long as the flight
        level = _TOUCH if model.parameters.get("tyre_lifts_off") else 0.0
        return SignalEvent("tyre_force", level, direction=_AT_THE_GROUND[name])
    if name == "strut_fully_extended" and "strut_length_max" in model.parameters:
        length = model.parameters["strut_length_max"]
        return SignalEvent("strut_length", length, direction=+1.0, terminal=True)
    if name in _AT_A_STOP and "strut_length" in model.signal_names:
        return _touching(model, *_AT_A_STOP[name])
    if name in NAMED:
        problem = f"event {name!r} belongs to a strut, which {model.equations.NAME} has not."
        raise InputError([problem], "events")
    problem = f"event {name!r} is not known. {suggestion(name, NAMED)}"
    raise InputError([problem], "events")


def _touching(model: System, side: str, direction: float) -> SignalEvent:
    """Return the event of the strut touching one of its stops."""
    if not model.parameters.get(f"{side}_stop_rate"):
        problem = f"there is no {side} stop. Give the suspension's file a [{side}_stop]."
        raise InputError([problem], "events")
    return SignalEvent("strut_length", model.parameters[f"{side}_stop_length"], direction)


def _checked(model: System, event: SignalEvent) -> SignalEvent:
    with Arguments("events") as given:
        given.among("signal", event.signal, model.signal_names)
        given.number(f"level of {event.signal!r}", event.level)
        given.number(f"direction of {event.signal!r}", event.direction)
        if not isinstance(event.terminal, bool):
            given.whole(
                f"terminal of {event.signal!r}", event.terminal, least=0, most=_MOST_CROSSINGS
            )
    return event
