"""What the generator found out about a compiled mechanism: bodies, joints, loops, transformers.

It is read from the report that was packaged with the model, so that nothing is derived again and
SymPy is not needed.
"""

import re
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from types import ModuleType

from .. import generated

_RULE = re.compile(r"\|[-|]+\|")


@dataclass(frozen=True)
class Topology:
    """The structure of a mechanism.

    Attributes
    ----------
    title : str
        What the mechanism is, and what the model makes of it.
    bodies : tuple of str
        The moving bodies.
    joints : tuple of dict
        Name, type, the two bodies, number of freedoms, what the bodies have in common.
    mobility : int
        Number of independent coordinates (Grübler).
    loops : tuple of tuple of str
        The bodies of each independent loop, in the order in which the loops are solved.
    pairs : tuple of tuple of dict
        For each loop, the pairs of joints that were tried, and which one was chosen.
    sections : dict
        The whole report: heading to Markdown text.
    """

    title: str
    bodies: tuple[str, ...]
    joints: tuple[dict[str, str], ...]
    mobility: int
    loops: tuple[tuple[str, ...], ...]
    pairs: tuple[tuple[dict[str, str], ...], ...]
    sections: dict[str, str]


def topology(model: str | ModuleType = "macpherson") -> Topology:
    """Return the structure of a compiled mechanism.

    Parameters
    ----------
    model : str or module, optional
        Name of a module of `kintrafo.generated`, or what `kintrafo.compile` returns.

    Returns
    -------
    Topology

    Examples
    --------
    >>> found = topology()
    >>> found.mobility, [len(loop) for loop in found.loops]
    (3, [4, 5])
    >>> [pair[0]["pair with a common distance"] for pair in found.pairs]
    ['B, C', 'D, E']
    """
    equations = model
    if not isinstance(equations, ModuleType):
        equations = import_module(f".{model}", generated.__name__)
    report = Path(str(equations.__file__)).with_suffix(".md").read_text(encoding="utf-8")
    title = report.partition("\n")[0].removeprefix("# ")
    sections = _sections(report, "## ")
    transformers = _sections(sections["Kinematic transformers"], "### ")
    return Topology(
        title=title,
        bodies=tuple(equations.BODIES),
        joints=_table(sections["Bodies and joints"]),
        mobility=equations.MOBILITY,
        loops=tuple(tuple(loop) for loop in equations.LOOPS),
        pairs=tuple(_table(text) for text in transformers.values()),
        sections=sections,
    )


def _sections(text: str, mark: str) -> dict[str, str]:
    """Return the text below each heading of one level."""
    parts = re.split(rf"^{mark}(.+)\n", text, flags=re.MULTILINE)
    return {heading: body.strip() for heading, body in zip(parts[1::2], parts[2::2], strict=True)}


def _table(text: str) -> tuple[dict[str, str], ...]:
    """Return the rows of the first Markdown table in a text, by column name."""
    lines = text.splitlines()
    rule = next(i for i, line in enumerate(lines) if _RULE.fullmatch(line))
    names = _cells(lines[rule - 1])
    rows = []
    for line in lines[rule + 1 :]:
        if not line.startswith("|"):
            break
        rows.append(dict(zip(names, _cells(line), strict=True)))
    return tuple(rows)


def _cells(line: str) -> list[str]:
    return [cell.strip() for cell in line.strip("|").split("|")]
