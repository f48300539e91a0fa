"""The elements of a report, in any output format.

Texts within a line have the marks of forges: ``code`` between backticks, formulas between $` and
`$, and strong text between two stars. `pieces` separates them.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

FIGURES = ("bodies", "graph", "elementary", "transformers")
"""The figures of a mechanism by which a report is illustrated, in its order."""

_MARKED = re.compile(r"\$`(?P<formula>.+?)`\$|`(?P<code>.+?)`|\*\*(?P<strong>.+?)\*\*")


@dataclass(frozen=True)
class Heading:
    """The title of the report (level 1), of a section (2) or of a part of one (3)."""

    level: int
    text: str


@dataclass(frozen=True)
class Paragraph:
    """A paragraph."""

    text: str


@dataclass(frozen=True)
class TextTable:
    """Rows of texts below a header."""

    header: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]


@dataclass(frozen=True)
class Equation:
    """A displayed formula under its number, and the paper's number of it."""

    formula: str
    number: int
    paper: str = ""


@dataclass(frozen=True)
class Picture:
    """One of the figures of a mechanism, see `figures`; or a diagram, where text draws it."""

    name: str  # name of the figure
    caption: str
    mermaid: str = ""  # diagram as text, if there is one


@dataclass(frozen=True)
class Transformation:
    """A kinematic transformer: inputs, contents, and outputs."""

    number: int
    inputs: Sequence[str]
    inside: dict[str, str]
    outputs: Sequence[str]


Block = Heading | Paragraph | TextTable | Equation | Picture | Transformation


def pieces(text: str) -> Iterator[tuple[str, str]]:
    """Yield the pieces of a text with their kinds: 'words', 'code', 'formula' or 'strong'."""
    end = 0
    for found in _MARKED.finditer(text):
        if found.start() > end:
            yield "words", text[end : found.start()]
        kind = str(found.lastgroup)
        yield kind, found[kind]
        end = found.end()
    if end < len(text):
        yield "words", text[end:]
