"""The errors of compiled equations."""

import re
from collections.abc import Mapping, Sequence
from typing import Any

from ..core.errors import KintrafoError

__all__ = [
    "HEAVIER",
    "WEIGHTLESS",
    "ClosureError",
    "ModelError",
    "ParameterError",
    "located",
    "named",
    "place_of",
]

WEIGHTLESS = (
    "{!r} can change, alone or with other coordinates, without any mass or inertia being moved, so "
    "that forces would accelerate it without end"
)
HEAVIER = "give what moves then a mass above 0 kg or an inertia above 0 kg m^2"
"""Explanation of a singular mass matrix, with the name of a coordinate, and advice."""


class ModelError(KintrafoError, ValueError):
    """A compiled function has no result: the base of `ClosureError` and `ParameterError`."""


class ParameterError(ModelError):
    """Values of parameters for which the equations have no meaning, such as a mass below zero."""


class ClosureError(ModelError):
    """A loop of the mechanism cannot close, or a formula has left its range.

    Attributes
    ----------
    reasons : tuple of str
        A text for each condition that is not met.
    margins : dict
        The quantities concerned, which must be positive (SI units).
    coordinates : dict
        State and inputs at which the error occurred, by name (SI units).
    index : tuple of int
        Index of the state in the leading dimensions of the arguments; empty for a single state.
    """

    def __init__(
        self,
        function: str,
        reasons: Sequence[str],
        margins: Mapping[str, float],
        coordinates: Mapping[str, float],
        index: tuple[int, ...],
        units: Mapping[str, str],
        described: Mapping[str, Mapping[str, Any]] | None = None,
    ) -> None:
        self.reasons = tuple(reasons)
        self.margins = dict(margins)
        self.coordinates = dict(coordinates)
        self.index = index
        self._arguments = (
            function,
            self.reasons,
            self.margins,
            self.coordinates,
            index,
            dict(units),
            described,
        )
        wrong = "; ".join(
            f"{reason} ({name} = {value:.3g}{_unit(units.get(name, '1'))}, "
            f"must {'stay' if value > 0.0 else 'be'} positive)"  # a motion ends before zero
            for reason, (name, value) in zip(self.reasons, self.margins.items(), strict=True)
        )
        shown = located(self.coordinates, described or {})
        super().__init__(f"{function}: {wrong}, at {shown}{place_of(index)}")

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), self._arguments


def located(values: Mapping[str, float], described: Mapping[str, Mapping[str, Any]]) -> str:
    """Return names with values and known units; a symbol has its meaning, too.

    Examples
    --------
    >>> located({"beta1": 1.5}, {"beta1": {"unit": "rad", "meaning": "arm angle (Eq. 6)"}})
    'beta1 = 1.5 rad (arm angle)'
    """
    return ", ".join(
        f"{n} = {v:.6g}{_unit(described.get(n, {}).get('unit', '1'))}"
        + named(n, described).removeprefix(n)
        for n, v in values.items()
    )


def named(name: str, described: Mapping[str, Mapping[str, Any]]) -> str:
    """Return a name; a symbol with its meaning: ``beta1 (arm angle)``."""
    meaning = re.split(r"[;,(]| from | of | relative ", described.get(name, {}).get("meaning", ""))[
        0
    ]
    symbol = re.fullmatch(r"(?:\w+_)?[a-z]+\d+", name)
    return f"{name} ({meaning.strip()})" if symbol and meaning.strip() else name


def _unit(unit: str) -> str:
    """Return a unit after a space; empty for that of a pure number."""
    return "" if unit == "1" else f" {unit}"


def place_of(index: tuple[int, ...]) -> str:
    """Return a text with the index in the given arrays; empty for a single state."""
    return f" (element {list(index)} of the arrays given)" if index else ""
