"""Print statements: declarations, assignments, and the words between them."""

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
"""As C writes a step."""

_LETTERS = frozenset(string.ascii_letters) - {"e"}
"""What a value has that is no number alone."""


def printed(steps: Sequence[Assignment], names: Mapping[str, str]) -> list[str]:
    """Return assignments, with the parts of the derivation in between.

    Parameters
    ----------
    steps
        In their order.
    names
        Other names for some symbols.
    """
    lines: list[str] = []
    for section, group in groupby(written_steps(steps, STATEMENT, names), key=_section):
        lines += ["", f"    /* {section} */"]
        for kind, run in groupby(group, key=_kind):
            texts = [f"{step.name} = {in_all_lanes(step.text)}" for step in run]
            lines += declared(texts) if kind == "const double" else _each(kind, texts)
    return lines


def declared(assignments: Sequence[str]) -> list[str]:
    """Return the declaration of some numbers, one on a line."""
    if not assignments:
        return []
    texts = [f"{text}," for text in assignments[:-1]] + [f"{assignments[-1]};"]
    return ["    const double", *(line for text in texts for line in wrapped(text, 8))]


def in_all_lanes(text: str) -> str:
    """Write a value; one that is a number is marked where it may be a vector."""
    return text if set(text) & _LETTERS else _IN_ALL_LANES.format(text)


def _each(kind: str, assignments: Sequence[str]) -> list[str]:
    """Return assignments that are statements of their own."""
    start = f"{kind} " if kind else ""
    return [line for text in assignments for line in wrapped(f"{start}{text};", 4)]


def wrapped(text: str, indent: int) -> list[str]:
    """Break a statement into lines.

    Parameters
    ----------
    text, indent
        The statement, and what each line begins with.
    """
    return unbroken(text, initial_indent=" " * indent, subsequent_indent=" " * (indent + 4))


def _section(step: StepText) -> str:
    return step.section


def _kind(step: StepText) -> str:
    """Return how a step is declared: a number, what an iteration returns, or an element."""
    if step.kind == "iterate":
        return f"const struct {step.of}"
    return "" if "->" in step.name else "const double"
