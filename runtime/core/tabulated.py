"""Tables of texts, for the terminal and for a page."""

import math
from dataclasses import dataclass

# A smaller number is a rounding error in every unit of the tables.
_ROUNDING = 1e-9


@dataclass(frozen=True)
class Tabulated:
    """A table of texts.

    Attributes
    ----------
    title : str
    columns : tuple of str
        Headings.
    rows : tuple of tuple of str
        A cell for each column.
    words : frozenset of int
        Indices of the columns of words; the others have numbers.
    """

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    words: frozenset[int] = frozenset({0})


def number(value: float) -> str:
    """Return a number with three decimals, without a minus before zero."""
    return _special(value) or (f"{value:.3f}" if abs(value) >= 5e-4 else "0.000")


def significant(value: float, digits: int = 5) -> str:
    """Return a number with some significant digits; zero for a rounding error."""
    return _special(value) or (f"{value:.{digits}g}" if abs(value) > _ROUNDING else "0")


def whole(value: float) -> str:
    """Return a force in whole newtons."""
    return "-" if not math.isfinite(value) else f"{round(value)}"


def _special(value: float) -> str:
    if math.isnan(value):
        return "-"
    return "infinite" if math.isinf(value) else ""
