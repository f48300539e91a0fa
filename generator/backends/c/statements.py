"""Print statements: declarations, assignments, and comments of sections."""

from __future__ import annotations

import string
from dataclasses import replace
from itertools import groupby
from typing import TYPE_CHECKING

from ..text import StepText, written_steps
from ..words import FORMULA
from .common import unbroken

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ..schedule import Assignment

_IN_ALL_LANES = "number({})"

STATEMENT = replace(FORMULA, argument=_IN_ALL_LANES)
"""Steps in C."""

_LETTERS = frozenset(string.ascii_letters) - {"e"}
"""Letters of a value that is not a mere number."""


def printed(steps: Sequence[Assignment], names: Mapping[str, str]) -> list[str]:
    """Return the assignments of steps, by section, with other names for some symbols."""
    lines: list[str] = []
    texts_of_steps = written_steps(steps, STATEMENT, names)
    for section, group in groupby(texts_of_steps, key=lambda step: step.section):
        lines += ["", f"    /* {section} */"]
        for kind, run in groupby(group, key=_kind):
            texts = [f"{step.name} = {in_all_lanes(step.text)}" for step in run]
            if kind == "const double":
                lines += declared(texts)
                continue
            start = f"{kind} " if kind else ""
            lines += [line for text in texts for line in wrapped(f"{start}{text};", 4)]
    return lines


def declared(assignments: Sequence[str]) -> list[str]:
    """Return the declaration of some numbers, one on a line."""
    if not assignments:
        return []
    texts = [f"{text}," for text in assignments[:-1]] + [f"{assignments[-1]};"]
    return ["    const double", *(line for text in texts for line in wrapped(text, 8))]


def in_all_lanes(text: str) -> str:
    """Return a value, with a number marked where it may be a vector."""
    return text if set(text) & _LETTERS else _IN_ALL_LANES.format(text)


def wrapped(text: str, indent: int) -> list[str]:
    """Break a statement into lines with an indent."""
    return unbroken(text, initial_indent=" " * indent, subsequent_indent=" " * (indent + 4))


def _kind(step: StepText) -> str:
    """Return the type that a step is declared with: double, the struct of an iteration, or none."""
    if step.kind == "iterate":
        return f"const struct {step.of}"
    return "" if "->" in step.name else "const double"
