"""Descriptions of quantities: SI units inside, degrees and millimetres in display.

A variable of a dataset has its description as attributes: ``units`` (SI), ``long_name``, ``sign``,
``display_units`` and ``display_factor``: a value in SI units times the factor is in display units.
"""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .named_types import Array
from .units import in_si

if TYPE_CHECKING:
    import xarray as xr


_SHOWN = ("mm", "deg", "deg/s", "N/mm")  # in place of their SI units


class Display(NamedTuple):
    """A unit for display, such as mm for a length."""

    units: str  # as it is printed
    factor: float  # value in this unit divided by the value in SI units

    @classmethod
    def of(cls, units: str) -> "Display":
        """Return a unit that `kintrafo.core.units` knows.

        Examples
        --------
        >>> Display.of("%")
        Display(units='%', factor=100.0)
        """
        return cls(units, 1.0 / in_si(units)[1])


_DISPLAYS = {in_si(unit)[0]: Display.of(unit) for unit in _SHOWN}


def attributes(meaning: str, units: str) -> dict[str, Any]:
    """Return the attributes of a variable.

    `meaning` is its name in words, in which its sign follows ", positive"; `units` its SI unit, "1"
    for a pure number. The attributes are ``long_name``, ``sign``, ``units``, ``display_units`` and
    ``display_factor``.

    Examples
    --------
    >>> attributes("toe angle, positive toe-in", "rad")["sign"]
    'positive toe-in'
    """
    name, mark, sign = meaning.partition(", positive")
    shown = _DISPLAYS.get(units, Display(units, 1.0))
    return {
        "long_name": name,
        "sign": f"positive{sign}" if mark else "",
        "units": units,
        "display_units": shown.units,
        "display_factor": shown.factor,
    }


def variable(
    dimensions: str | tuple[str, ...], values: Any, meaning: str, units: str
) -> "xr.Variable":
    """Return a variable over some dimensions, with its description as `attributes` makes it."""
    from xarray import Variable  # noqa: PLC0415 (slow to import)

    return Variable(dimensions, values, attributes(meaning, units))


def display_of(attrs: Mapping[str, Any]) -> Display:
    """Return the display unit of a variable with these attributes."""
    units = str(attrs.get("units", ""))
    known = _DISPLAYS.get(units, Display(units, 1.0))
    given = attrs.get("display_units", known.units), attrs.get("display_factor", known.factor)
    return Display(str(given[0]), float(given[1]))


def unit_or_stroke(attrs: Mapping[str, Any]) -> str:
    """Return the display unit of a variable for a table; "-" for a pure number.

    Examples
    --------
    >>> unit_or_stroke({"units": "1"}), unit_or_stroke({"units": "1/s"})
    ('-', '1/s')
    """
    units = display_of(attrs).units
    return "-" if units in ("", "1") else units


def displayed(data: "xr.DataArray") -> Array:
    """Return the values of a variable in the display unit."""
    return np.asarray(data.values, dtype=np.float64) * display_of(data.attrs).factor


def bracketed(name: str, attrs: Mapping[str, Any]) -> str:
    """Return a name with its display unit, ``camber [deg]``; pure numbers have none."""
    units = display_of(attrs).units
    return name if units in ("", "1") else f"{name} [{units}]"


def long_name(data: "xr.DataArray") -> str:
    """Return the name of a variable in words."""
    return str(data.attrs.get("long_name") or str(data.name).replace("_", " "))


def names_in_words(coordinate: "xr.DataArray") -> list[str]:
    """Return the names of a coordinate, one or more, in words: ``front left``."""
    return [str(name).replace("_", " ") for name in coordinate.values.ravel()]


def heading_of(data: "xr.DataArray") -> str:
    """Return the name of a variable in words, with its display unit."""
    return bracketed(long_name(data), data.attrs)


def distinct(labels: Sequence[str]) -> list[str]:
    """Return labels with a number added to each that has occurred before.

    Examples
    --------
    >>> distinct(["car", "car", "van"])
    ['car', 'car (2)', 'van']
    """
    return [
        label if label not in labels[:index] else f"{label} ({1 + labels[:index].count(label)})"
        for index, label in enumerate(labels)
    ]
