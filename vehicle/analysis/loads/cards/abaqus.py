"""Loads as keywords of Abaqus: nodes with sets of their names, and a step for each case."""

from collections.abc import Iterator

from .sheet import CardSheet

DIGITS = 13
"""Significant digits of all numbers."""


def lines_of(sheet: CardSheet) -> Iterator[str]:
    """Yield the lines of the file of a part, to be included after a model."""
    nodes = sheet.nodes()
    for remark in sheet.remarks(DIGITS):
        yield f"** {remark}"
    yield "** Nodes, in axes of the two points of *System; change them where the model has others."
    yield "*System"
    yield "0., 0., 0., 1., 0., 0."
    yield "0., 1., 0."
    for node in nodes:
        yield f"** {node.name}, by {', '.join(node.by)}"
        yield f"*Node, nset={_label(node.name)}"
        yield ", ".join((str(node.number), *map(_real, node.at)))
    yield "*System"
    yield "** Axes of the forces: x axis, and a point in the plane of x and y."
    for node in nodes:
        yield f"*Transform, nset={_label(node.name)}"
        yield "1., 0., 0., 0., 1., 0."
    for place, case in enumerate(sheet.cases):
        yield f"*Step, name={_label(case)}"
        yield "*Static"
        yield "*Cload, op=NEW"
        for node in nodes:
            force, moment = node.loads.get(place, ((), ()))
            for freedom, value in enumerate((*force, *moment), 1):
                if value:
                    yield f"{_label(node.name)}, {freedom}, {_real(value)}"
        yield "*End Step"


def _label(name: str) -> str:
    """Return a name for Abaqus, in quotes if it does not begin with a letter."""
    return name if name[0].isalpha() else f'"{name}"'


def _real(value: float) -> str:
    return f"{value:.{DIGITS - 1}E}"
