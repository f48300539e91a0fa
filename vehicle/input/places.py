"""Changes of values in the nested dictionaries of an input file."""

from typing import Any

from ...core.suggestions import suggestion

_COMPONENTS = {"x": 0, "y": 1, "z": 2}


def put(data: dict[str, Any], place: str, value: Any) -> str:
    """Change one value of nested dictionaries, in which points are lists.

    Returns the problem of a place that does not exist, or an empty text. An unknown key is left to
    the checks of the section.
    """
    *sections, key = place.split(".")
    table: Any = data
    for section in sections:
        known = table if isinstance(table, dict) else {}
        if section not in known:
            return f"{place}: there is no {section} in the data. {suggestion(section, known)}"
        table = known[section]
    if isinstance(table, dict):
        table[key] = value
        return ""
    if isinstance(table, list) and key in _COMPONENTS:
        table[_COMPONENTS[key]] = value
        return ""
    return f"{place}: {key} is not a part of {sections[-1]}. Points have x, y and z."


def reverse(values: Any, index: int | str) -> None:
    """Change the sign of one value in a list or a dictionary."""
    values[index] = 0.0 - values[index]  # unlike -x, this leaves no negative zero
