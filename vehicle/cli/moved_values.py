"""The table of values of a file that a search has moved."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from rich.markup import escape
from rich.table import Table

if TYPE_CHECKING:
    from ..studies.design_variables import DesignVariable


def moved_table(
    places: "Iterable[DesignVariable]", moved: Mapping[str, float], title: str
) -> Table:
    """Return a table of what values were, what they are, and by how much they have moved."""
    table = Table(title=escape(title))
    table.add_column("value")
    for column in ("was", "is", "moved by", "unit"):
        table.add_column(column, justify="left" if column == "unit" else "right")
    for place in places:
        by = moved[place.name]
        numbers = (f"{value:.3f}" for value in (place.value, place.value + by, by))
        table.add_row(escape(place.name), *numbers, place.unit or "-")
    return table
