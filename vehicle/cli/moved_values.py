"""The table of design variables that a search has changed."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from ...terminal.console import table

if TYPE_CHECKING:
    from rich.table import Table

    from ..studies.design_variables import DesignVariable


def moved_table(
    places: "Iterable[DesignVariable]", moved: Mapping[str, float], title: str
) -> "Table":
    """Return a table of design variables: old values, new ones, and changes."""
    rows = []
    for place in places:
        by = moved[place.name]
        numbers = (f"{value:.3f}" for value in (place.value, place.value + by, by))
        rows.append((place.name, *numbers, place.unit or "-"))
    return table(title, ("value", "was", "is", "moved by", "unit"), rows, words=(0, 4))
