"""Print iterations: one iteration of a block, and the function that follows its loops."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

from ..sharing import scheduled
from ..text import written
from ..words import FORMULA
from .common import WIDTH, unbroken
from .statements import in_all_lanes, printed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...program.function import IterationBlock

_KEPT = "\N{NO-BREAK SPACE}"
"""Represents a space at which no line is broken."""


def once(block: IterationBlock) -> str:
    """Print one iteration: straight-line code."""
    read = {s.name for s in block.once.free_symbols}
    arrays = {
        "given": block.constants,
        "now": [d.now for d in block.driven],
        "way": [d.way for d in block.driven],
        "from": block.estimate.base,
        "step": block.estimate.step,
        "held": [s for line in block.estimate.held for s in line],
    }
    start = f"static void {block.name}_once("
    arguments = unbroken(
        ", ".join(
            [*(f"const{_KEPT}double{_KEPT}*{name}" for name in arrays), f"double{_KEPT}*out)"]
        ),
        width=WIDTH - len(start),
    )
    lines = [(start + f"\n{' ' * len(start)}".join(arguments)).replace(_KEPT, " "), "{"]
    for array, symbols in arrays.items():
        loads = [
            f"    const double {s} = {array}[{i}];" for i, s in enumerate(symbols) if s.name in read
        ]
        lines += loads or [f"    (void){array};"]
    results = written(block.once, FORMULA)[1]
    lines += [*printed(scheduled(block.once).steps, {}), ""]
    for i, (label, result) in enumerate(zip(block.once.labels, results, strict=True)):
        text = f"    out[{i}] = {in_all_lanes(result)};"
        lines.append(f"{text:<70} /* {label} */")
    return "\n".join([*lines, "}"])


def call_of(block: IterationBlock) -> str:
    """Print the function that follows the loops of a block."""
    along = [(f"{d.now}_start", f"{d.now}_end", f"{d.now}_unit") for d in block.driven]
    names = [*map(str, block.constants), *(name for values in along for name in values)]
    start = f"NO_EFFECT static struct {block.name} {block.name}("
    arguments = ", ".join(f"double{_KEPT}{name}" for name in names) + ")"
    signature = unbroken(start + arguments, subsequent_indent=" " * len(start))

    def array(kind: str, name: str, values: Sequence[str]) -> list[str]:
        text = f"{kind} {name}[] = {{{', '.join(values) or '0'}}};"
        return unbroken(text, initial_indent="    ", subsequent_indent="        ")

    count = f"{len(block.unknowns)}, {len(block.elements)}, {len(block.driven)}"
    starts, ends, units = ([values[k] for values in along] for k in range(3))
    call = "follow_turns(&loops, given, start, end, unit, found.at)"
    lines = [
        *textwrap.wrap(f"/* Finds {block.doc}. */", WIDTH, subsequent_indent="   "),
        f"struct {block.name} {{",
        f"    double at[{len(block.results)}];",
        "};",
        "",
        *(line.replace(_KEPT, " ") for line in signature),
        "{",
        *array("static const unsigned char", "turns", [str(int(d.turns)) for d in block.driven]),
        f"    static const struct loops loops = {{{count}, turns, {block.name}_once}};",
        *array("const double", "given", [str(s) for s in block.constants]),
        *array("const double", "start", starts),
        *array("const double", "unit", units),
        *array("double", "end", ends),
        f"    struct {block.name} found;",
        f"    found.at[{len(block.results) - 1}] = {call};",
        "    return found;",
        "}",
    ]
    return "\n".join(lines)
