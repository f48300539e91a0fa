"""Events during a simulation: named events, signals that pass levels, or functions."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, TypeVar, cast

import numpy as np
from numpy.typing import NDArray
from typing_extensions import TypeAliasType

from ..core.errors import InputError
from ..core.suggestions import suggestion
from ..core.validator import Validator, shown
from ..systems.system import System
from .levels import value_of


@dataclass(frozen=True)
class SignalEvent:
    """An event: a signal of the model crosses a level.

    Attributes
    ----------
    signal : str
        Name, see ``model.signal_names``.
    level : float
        The level, in the SI unit of the signal.
    direction : float
        Crossings that count. Negative: of a falling signal; positive: of a rising one; zero: both.
    terminal : bool or int
        Whether the simulation ends at the first crossing, or the number of the crossing at which it
        ends.
    """

    signal: str
    level: float
    direction: float = 0.0
    terminal: bool | int = False


EventFunction = Callable[..., float]
Event = TypeAliasType("Event", str | SignalEvent | EventFunction)
_Kind = TypeVar("_Kind", SignalEvent, "_CheckedFunction")

_MOST_CROSSINGS = 2**31 - 1


@dataclass(frozen=True)
class Events:
    """The events of a simulation: `signal` ones first, then the caller's functions."""

    signal: tuple[SignalEvent, ...]
    # of time and state, with SciPy's attributes `terminal` and `direction`. They return finite
    # numbers or raise an `InputError`: for a solver NaN means "no crossing".
    functions: tuple["_CheckedFunction", ...]
    order: tuple[int, ...]  # index of each of them in the caller's list

    @cached_property
    def directions(self) -> NDArray[np.int32]:
        """Direction of each event: -1, 0 or +1."""
        signs = [(e.direction > 0) - (e.direction < 0) for e in self._all]
        return np.array(signs, dtype=np.int32)

    @cached_property
    def terminal(self) -> NDArray[np.int32]:
        """Number of the crossing at which each event ends the simulation; 0 for never."""
        return np.array([int(e.terminal) for e in self._all], dtype=np.int32)

    @property
    def _all(self) -> "tuple[SignalEvent | _CheckedFunction, ...]":
        return *self.signal, *self.functions

    def __len__(self) -> int:
        return len(self.order)

    def after(self, passed: Sequence[int]) -> "Events":
        """Return the remaining events after each has occurred a number of times."""
        if not any(passed):
            return self
        count = len(self.signal)
        signal, functions = (
            _after(self.signal, passed[:count]),
            _after(self.functions, passed[count:]),
        )
        return Events(signal, functions, self.order)


NO_EVENTS = Events((), (), ())


def named_event(model: System, name: str) -> SignalEvent:
    """Return an event of the forces of a model, by its name.

    Raises `InputError` if there is no such event, or a parameter that it needs is zero.
    """
    known = {
        event: (signal, entry)
        for signal, described in model.equations.SIGNALS.items()
        for event, entry in described.get("events", {}).items()
    }
    if name not in known:
        problem = (
            f"event {name!r} is not one of {model.equations.NAME}: events come with its forces. "
            f"{suggestion(name, known)}"
        )
        raise InputError([problem], "events")
    signal, entry = known[name]
    needed = entry.get("needs")
    if needed is not None and not value_of(needed, model.parameters):
        problem = (
            f"event {name!r} cannot happen: {needed} is zero. Give it, or leave the event out."
        )
        raise InputError([problem], "events")
    level = float(value_of(entry["level"], model.parameters))
    return SignalEvent(
        signal, level, 1.0 if "rising" in entry else -1.0, terminal="terminal" in entry
    )


def events_of(model: System, given: Event | Sequence[Event] | None) -> Events:
    """Return the checked events: one or several names, `SignalEvent` or functions, or None."""
    if given is None:
        return NO_EVENTS
    single = callable(given) or isinstance(given, str | SignalEvent)
    several = isinstance(given, Sequence) and not isinstance(given, bytes)
    listed: list[Any] = list(cast("Sequence[Any]", given)) if several and not single else [given]
    listed = [event for event in listed if event is not None]
    signal: list[tuple[int, SignalEvent]] = []
    functions: list[tuple[int, _CheckedFunction]] = []
    for index, event in enumerate(listed):
        if isinstance(event, str):
            signal.append((index, _checked(model, named_event(model, event))))
        elif isinstance(event, SignalEvent):
            signal.append((index, _checked(model, event)))
        elif callable(event):
            functions.append((index, _CheckedFunction.of(event)))
        else:
            problem = (
                f"event {shown(event)} is neither a name, nor a SignalEvent, nor a function, nor a "
                "list of these."
            )
            raise InputError([problem], "events")
    order = tuple(i for i, _ in (*signal, *functions))
    return Events(tuple(e for _, e in signal), tuple(f for _, f in functions), order)


def _after(events: tuple[_Kind, ...], passed: Sequence[int]) -> tuple[_Kind, ...]:
    """Return events of one kind after each has occurred a number of times."""
    return tuple(
        replace(event, terminal=int(event.terminal) - times if event.terminal else 0)
        for event, times in zip(events, passed, strict=True)
    )


def _checked(model: System, event: SignalEvent) -> SignalEvent:
    with Validator("events") as given:
        given.among("signal", event.signal, model.signal_names)
        given.number(f"level of {event.signal!r}", event.level)
        _check_sense(given, repr(event.signal), event.direction, event.terminal)
    return event


def _check_sense(given: Validator, name: str, direction: Any, terminal: Any) -> None:
    given.number(f"direction of {name}", direction)
    if not isinstance(terminal, bool):
        given.whole(f"terminal of {name}", terminal, least=0, most=_MOST_CROSSINGS)


@dataclass(frozen=True)
class _CheckedFunction:
    """A caller's function that returns a finite number or raises an error."""

    function: EventFunction
    name: str
    direction: float
    terminal: bool | int

    @classmethod
    def of(cls, function: EventFunction) -> "_CheckedFunction":
        name = getattr(function, "__name__", None) or shown(function)
        direction = getattr(function, "direction", 0.0)
        terminal = getattr(function, "terminal", False)
        with Validator("events") as given:
            _check_sense(given, name, direction, terminal)
        return cls(function, name, float(direction), terminal)

    def __call__(self, time: float, state: Any) -> float:
        try:
            value = self.function(time, state)
        except Exception as error:
            error.add_note(f"This was raised by the event {self.name}, at t = {time:.6g} s.")
            raise
        with Validator("events") as given:
            return given.number(f"{self.name} at {time:.6g} s", value)
