"""Loads as bulk data of Nastran: GRID, FORCE and MOMENT in fields of 16 columns.

Each case has a load set. One card, CORD2R, has the coordinate system of all points and forces, so
that they can be moved into the axes of a model.
"""

from collections.abc import Iterator

import numpy as np

from .sheet import FIRST_NODE, CardSheet

DIGITS = 10
"""Significant digits of numbers in 16 columns."""

_SYSTEM = FIRST_NODE
# Points of CORD2R on the z axis and in the plane of x and z.
_ON_Z, _IN_XZ = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])


def lines_of(sheet: CardSheet) -> Iterator[str]:
    """Yield the lines of the file of a part."""
    cases, numbers = sheet.cases, sheet.numbers
    nodes = sheet.nodes()
    for remark in sheet.remarks(DIGITS):
        yield f"$ {remark}"
    yield "$ Load sets, for the case control:"
    for place, (case, number) in enumerate(zip(cases, numbers, strict=True)):
        if not any(place in node.loads for node in nodes):
            yield f"$ {case}: nothing acts on this part"
            continue
        yield f"$ SUBCASE {number}"
        yield f"$   LABEL = {case}"
        yield f"$   LOAD = {number}"
    yield "$ The coordinate system of what follows; change it where the model has other axes."
    yield from _card("CORD2R", _SYSTEM, 0, *np.zeros(3), *_ON_Z, *_IN_XZ)
    for node in nodes:
        yield f"$ {node.name}, by {', '.join(node.by)}"
        yield from _card("GRID", node.number, _SYSTEM, *node.at, _SYSTEM)
    for place, (case, number) in enumerate(zip(cases, numbers, strict=True)):
        yield f"$ {case}"
        for node in nodes:
            for name, vector in zip(("FORCE", "MOMENT"), node.loads.get(place, ()), strict=False):
                if vector.any():  # a factor of 1, and its components
                    yield from _card(name, number, node.number, _SYSTEM, 1.0, *vector)


def _card(name: str, *values: float) -> Iterator[str]:
    """Yield a card with four wide fields in a line."""
    fields = [
        f"{value:16d}" if isinstance(value, int) else f"{value:16.{DIGITS - 1}E}"
        for value in values
    ]
    for first in range(0, len(fields), 4):
        head = f"{name}*" if first == 0 else "*"
        yield f"{head:<8}{''.join(fields[first : first + 4])}"
