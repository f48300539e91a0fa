"""The errors of compiled equations."""

from collections.abc import Mapping, Sequence
from typing import Any

from ..core.errors import KintrafoError

__all__ = ["HEAVIER", "WEIGHTLESS", "ClosureError", "ModelError", "ParameterError", "place_of"]

WEIGHTLESS = (
    "{!r} can change, alone or with other coordinates, without any mass or inertia being moved, so "
    "that forces would accelerate it without end"
)
HEAVIER = "give what moves then a mass above 0 kg or an inertia above 0 kg m^2"
"""What a mass matrix that is singular means of one of its coordinates, and what to do then."""


class ModelError(KintrafoError, ValueError):
    """A generated function cannot give a result."""


class ParameterError(ModelError):
    """A parameter set from which no model can be made."""


def _with_unit(value: float, unit: str) -> str:
    """Return a number with its unit; a pure number has none."""
    return f"{value:.3g}" if unit == "1" else f"{value:.3g} {unit}"


class ClosureError(ModelError):
    """A loop of the mechanism cannot close, or a formula has left its range.

    Attributes
    ----------
    reasons : tuple of str
        What is wrong, one text for each status bit.
    margins : dict
        The quantities concerned, which must be positive (SI units).
    coordinates : dict
        State and inputs at which it happened, by name (SI units).
    index : tuple of int
        Position in the leading dimensions of the arrays given; empty for a single state.
    """

    def __init__(
        self,
        function: str,
        reasons: Sequence[str],
        margins: Mapping[str, float],
        coordinates: Mapping[str, float],
        index: tuple[int, ...],
        units: Mapping[str, str],
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
        )
        shown = ", ".join(f"{name} = {value:.6g}" for name, value in self.coordinates.items())
        wrong = "; ".join(
            f"{reason} ({name} = {_with_unit(value, units.get(name, '1'))}, "
            f"must {'stay' if value > 0.0 else 'be'} positive)"  # it does at the end of a motion
            for reason, (name, value) in zip(self.reasons, self.margins.items(), strict=True)
        )
        super().__init__(f"{function}: {wrong}, at {shown}{place_of(index)}")

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), self._arguments


def place_of(index: tuple[int, ...]) -> str:
    """Say which element of the arrays given it is; nothing for a single state."""
    return f" (element {list(index)} of the arrays given)" if index else ""
