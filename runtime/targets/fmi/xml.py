"""XML that both versions of FMI share."""

from collections.abc import Iterable, Mapping
from xml.etree import ElementTree as ET

from ...core.quantities import display_of
from .description import Variable
from .units import powers

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


def units_of(variable: Variable) -> dict[str, str]:
    """Return the attributes of a variable with its units."""
    if variable.unit == _NONE:
        return {}
    shown = display_of({"units": variable.unit}).units
    return {"unit": variable.unit, "displayUnit": shown if shown != variable.unit else ""}


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
