"""XML that both versions of FMI share."""

import math
from collections import Counter
from collections.abc import Iterable, Mapping
from xml.etree import ElementTree as ET

from ...core.quantities import display_of
from ...core.si_units import powers_of
from .description import Variable

_NONE = "1"


def number(value: float) -> str:
    """Return a finite number with all its digits."""
    return repr(float(value))


def element(parent: ET.Element, tag: str, attributes: Mapping[str, object]) -> ET.Element:
    """Add an element with those of its attributes that have a value."""
    entries = {name: str(value) for name, value in attributes.items() if value not in (None, "")}
    return ET.SubElement(parent, tag, entries)


def unit_definitions(parent: ET.Element, variables: Iterable[Variable]) -> None:
    """Add the units of variables in SI base units, with their display units."""
    definitions = ET.SubElement(parent, "UnitDefinitions")
    for unit in sorted({v.unit for v in variables} - {_NONE}):
        defined = ET.SubElement(definitions, "Unit", {"name": unit})
        known = powers(unit)
        if known is not None:
            element(defined, "BaseUnit", known)
        shown = display_of({"units": unit})
        if shown.units != unit:
            factor = number(shown.factor)
            element(defined, "DisplayUnit", {"name": shown.units, "factor": factor})


def described(variable: Variable) -> dict[str, object]:
    """Return the attributes of a variable with its name, number, meaning and role."""
    return {
        "name": variable.name,
        "valueReference": variable.reference,
        "description": variable.meaning,
        "causality": variable.causality,
        "variability": variable.variability,
        "initial": variable.initial,
    }


def values_of(variable: Variable) -> dict[str, object]:
    """Return the attributes of a variable with its units, range and start."""
    shown = display_of({"units": variable.unit}).units
    units = {"unit": variable.unit, "displayUnit": shown if shown != variable.unit else ""}
    return {
        **({} if variable.unit == _NONE else units),
        "min": number(variable.least) if math.isfinite(variable.least) else None,
        "max": number(variable.most) if math.isfinite(variable.most) else None,
        "start": None if variable.start is None else number(variable.start),
    }


def log_categories(parent: ET.Element) -> None:
    """Add the kinds of messages."""
    categories = ET.SubElement(parent, "LogCategories")
    for name, meaning in (
        ("logEvents", "events, such as a wheel that leaves the ground"),
        ("logStatusWarning", "what ends the motion"),
        ("logStatusDiscard", "states that the model refuses"),
        ("logStatusError", "values and calls that cannot be used"),
    ):
        element(categories, "Category", {"name": name, "description": meaning})


def text_of(root: ET.Element) -> str:
    """Return a document."""
    ET.indent(root)
    body = ET.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{body}\n'


_DERIVED = {"N": {"kg": 1, "m": 1, "s": -2}, "J": {"kg": 1, "m": 2, "s": -2}}
_DERIVED |= {"W": {"kg": 1, "m": 2, "s": -3}, "Pa": {"kg": 1, "m": -1, "s": -2}, "Hz": {"s": -1}}
_BASE = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")


def powers(unit: str) -> dict[str, int] | None:
    """Return the powers of base units in a unit; None for a unit that is not known.

    Examples
    --------
    >>> powers("N s/m")
    {'kg': 1, 's': -1}
    >>> powers("furlong") is None
    True
    """
    factors = powers_of(unit)
    if factors is None or not factors.keys() <= {*_BASE, *_DERIVED}:
        return None
    found: Counter[str] = Counter()
    for name, power in factors.items():
        for base, exponent in _DERIVED.get(name, {name: 1}).items():
            found[base] += power * exponent
    return {base: found[base] for base in _BASE if found[base]}
