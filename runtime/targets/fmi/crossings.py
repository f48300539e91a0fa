"""Zero crossings that an FMU reports as events."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Crossing:
    """A zero crossing that is reported as an event.

    The crossing quantity is a signal minus `level`, minus `sign` times a parameter; or the margin
    of a guard.
    """

    name: str
    meaning: str
    # index of the signal, or -1 and that of the guard
    signal: int
    guard: int
    level: float = 0.0  # in the SI unit of the signal
    parameter: int = -1  # index of the parameter; -1 for none
    sign: float = 1.0  # 1 or -1
    needs: int = -1  # index of a parameter without which it cannot occur; -1 for none


def crossings(manifest: Mapping[str, Any]) -> tuple[Crossing, ...]:
    """Return the events of the signals, and the guards beyond which there is no motion."""
    return (*_of_signals(manifest), *_of_guards(manifest))


def _of_signals(manifest: Mapping[str, Any]) -> Iterator[Crossing]:
    parameters = list(manifest["parameters"])
    for place, signal in enumerate(manifest["signals"].values()):
        seen = set()
        for name, entry in signal.get("events", {}).items():
            level = entry["level"]
            if level in seen:  # the same crossing in the other direction
                continue
            seen.add(level)
            needs = entry.get("needs")
            named = isinstance(level, str)
            yield Crossing(
                f"events.{name}",
                entry["meaning"],
                place,
                -1,
                0.0 if named else float(level),
                parameters.index(level.removeprefix("-")) if named else -1,
                -1.0 if named and level.startswith("-") else 1.0,
                -1 if needs is None else parameters.index(needs.removeprefix("-")),
            )


def _of_guards(manifest: Mapping[str, Any]) -> Iterator[Crossing]:
    functions = manifest["functions"]
    acting = {g for n in ("rhs", "signals") if n in functions for g in functions[n]["guards"]}
    for place in sorted(acting):
        guard = manifest["guards"][place]
        yield Crossing(f"margins.{guard['name']}", guard["meaning"], -1, place)
