"""Signals of a mechanism, with ranges and events of their values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import sympy as sp

if TYPE_CHECKING:
    from .parameters import Parameter

Level: TypeAlias = float | sp.Expr
"""A number in SI units, or a parameter's symbol with its sign."""


def words_of(name: str) -> str:
    """Return the name of an element for a sentence."""
    return f"the {name.replace('_', ' ')}"


@dataclass(frozen=True)
class Range:
    """Valid range of the values of a signal; with ``least >= most`` there is no limit."""

    # ends, None for none
    least: Level | None = None
    most: Level | None = None
    # situation beyond either end, as a clause
    below: str = ""
    above: str = ""
    possible: bool = False  # whether values beyond are possible, and only the data end
    unless: Parameter | None = None  # where this parameter is not zero, there is no range


@dataclass(frozen=True)
class Event:
    """A signal passes a level."""

    name: str  # by which a simulation watches for it
    level: Level  # value of the signal
    rising: bool  # whether upwards; else downwards
    meaning: str  # event, as a clause
    terminal: bool = False  # whether a simulation ends there
    needs: Parameter | None = None  # where this parameter is zero, there is no such event


@dataclass(frozen=True)
class Shown:
    """A signal of a force: an element of the result of the function ``signals``.

    Attributes
    ----------
    name
        Name of the signal.
    value
        Its value, an expression in SI units.
    unit
        Unit of SI without a prefix.
    meaning
        Description in the documentation of the generated code.
    ranges
        Ranges of its valid values; a motion beyond one is reported.
    events
        Levels of the signal at which a simulation may end.
    """

    name: str
    value: sp.Expr
    unit: str
    meaning: str
    ranges: tuple[Range, ...] = ()
    events: tuple[Event, ...] = ()
