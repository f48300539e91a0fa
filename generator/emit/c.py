"""Print a model as C99: a header that documents every array, and the straight-line functions.

No allocation, no global state, no ``pow``; every function returns a status word.
"""

from __future__ import annotations

import hashlib
import textwrap
from typing import TYPE_CHECKING

import sympy as sp

from ..arithmetic import OPERATIONS, Iterated, write
from ..assumptions import ROUNDING
from ..iteration import ITERATIONS, LIMITS
from .text import template

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ..assumptions import Assumption
    from ..conditioning import Condition
    from ..iteration import Block
    from ..outputs import Entry, GeneratedModel
    from ..program import Function

GENERATOR_VERSION = "0.1.0"
WIDTH = 100
ARGUMENTS = "const double *restrict constants, const double *restrict state,"

# A status word has 30 bits for guards, under that for results that are not finite. The last one is
# for all guards that are left: which of those it is follows from the margins.
LAST_GUARD_BIT = 29


def count_line(function: Function) -> str:
    """Describe the operations of a function in one line."""
    counts = function.operations()
    parts = ", ".join(f"{counts[name]} {name}" for name in OPERATIONS if counts[name])
    line = f"{counts.total()} operations ({parts or 'none'})"
    iterating = "; iterates: " + ", ".join(block.name for block in function.blocks)
    return line + iterating if function.blocks else line


def iteration_note(model: GeneratedModel) -> str:
    """Say which loops of a model are solved by iteration; nothing where all have a closed form."""
    blocks = blocks_of(model.functions.values())
    if not blocks:
        return ""
    found = "; ".join(block.doc for block in blocks)
    return (
        f"This model is not free of iteration. Newton's method finds {found}: in stages from the "
        f"design position on, in at most {ITERATIONS} iterations, until a correction is below "
        f"{LIMITS['CONVERGED']}. A status bit says where that fails. Operations are counted for "
        "one iteration."
    )


def blocks_of(functions: Iterable[Function]) -> list[Block]:
    """Return the iterations of some functions, each once, and behind those that it calls."""
    found: dict[str, Block] = {}
    for block in (b for f in functions for b in f.blocks):
        found |= {inner.name: inner for inner in blocks_of([block.once])} | {block.name: block}
    return list(found.values())


def mechanism_hash(model: GeneratedModel) -> str:
    """Return a hash of everything that the emitted arithmetic depends on."""
    digest = hashlib.sha256()
    blocks = blocks_of(model.functions.values())
    once = (block.once for block in blocks)
    for function in (model.prepare, *once, *model.functions.values()):
        digest.update(function.name.encode())
        for step, written in zip(function.steps, function.written.steps, strict=True):
            digest.update(f"{step.symbol}={written.text};".encode())
        for written in function.written.results:
            digest.update(f"{written.text};".encode())
    return digest.hexdigest()[:16]


AT_LEAST = """\
/* The greater of two numbers; NaN for a NaN. One instruction, where fmax may be a call. */
static inline double at_least(double x, double least)
{
    return x < least ? least : x;
}"""

NOT_FINITE = """\
/* Whether any of some values is NaN or infinite. */
static unsigned not_finite(const double *values, int count)
{
    unsigned found = 0;
    for (int i = 0; i < count; ++i) {
        found |= !isfinite(values[i]);
    }
    return found;
}"""


class CPrinter:
    """Prints the header and the source of one model."""

    def __init__(self, model: GeneratedModel) -> None:
        self.model = model
        self.prefix = model.model.name
        self.upper = self.prefix.upper()

    # -- header ---------------------------------------------------------------------------------

    def header(self) -> str:
        """Return the text of the header file."""
        guard = f"KINTRAFO_{self.upper}_H"
        blocks = [
            self._banner(self._conventions()),
            (
                f"#ifndef {guard}\n#define {guard}\n\n#ifdef __cplusplus\n"
                'extern "C" {\n#define restrict\n#endif'
            ),
            self._enum(
                "parameter",
                "Parameters, SI units, at the design position, chassis axes.",
                self.model.parameters,
            ),
            self._enum(
                "state", "State: independent coordinates, then their rates.", self.model.state
            ),
            self._enum("input", "Time-varying inputs.", self.model.inputs),
            self._enum("relative", "Relative joint coordinates.", self.model.relative),
            self._enum("signal", "Elements of the signals function.", self.model.signals),
            self._plain_enum(
                "body",
                "Order of the bodies in the arrays of poses and velocities.",
                self.model.moving_bodies,
            ),
            self._plain_enum(
                "massive", "Order of the bodies in the Jacobians.", self.model.massive_bodies
            ),
            self._plain_enum(
                "constant",
                "Constants of one parameter set, computed by prepare.",
                self.model.prepare.labels,
            ),
            self._status(),
            *self._prototypes(),
            f"#ifdef __cplusplus\n#undef restrict\n}}\n#endif\n\n#endif /* {guard} */",
        ]
        return "\n\n".join(blocks) + "\n"

    def _banner(self, extra: str = "") -> str:
        total = count_line(self.model.functions["rhs"])
        text = (
            f"{self.model.model.title}.\n\n"
            f"Generated by kintrafo {GENERATOR_VERSION}; do not edit: `make generate` writes it "
            f"anew.\nMechanism {mechanism_hash(self.model)}. rhs: {total}.{extra}"
        )
        return "/*\n" + "\n".join(f" * {line}".rstrip() for line in text.split("\n")) + "\n */"

    def _conventions(self) -> str:
        return (
            "\n\nAxes are ISO 8855 (x forward, y left, z up), units SI. Arrays of several "
            "dimensions are row-major.\nAll functions are pure: no allocation, no global state, "
            "safe to call from any thread. They return 0,\nor status bits that say what is wrong; "
            "the results then are finite but meaningless."
            f"{self._iteration_note()}"
        )

    def _iteration_note(self) -> str:
        note = iteration_note(self.model)
        return f"\n\n{textwrap.fill(note, WIDTH - 4)}" if note else ""

    def _enum(self, kind: str, title: str, entries: Sequence[Entry]) -> str:
        described = [(e.name, f"[{e.unit}] {e.meaning}") for e in entries]
        return self._print_enum(kind, title, described)

    def _plain_enum(self, kind: str, title: str, names: Iterable[str]) -> str:
        return self._print_enum(kind, title, [(name, "") for name in names])

    def _print_enum(self, kind: str, title: str, entries: Sequence[tuple[str, str]]) -> str:
        lines = [f"/* {title} */", f"enum {self.prefix}_{kind} {{"]
        for index, (name, comment) in enumerate(entries):
            item = f"    {self.enumerator(kind, name)} = {index},"
            lines.append(f"{item:<58} /* {comment} */" if comment else item)
        lines += [f"    {self.upper}_{kind.upper()}_COUNT = {len(entries)}", "};"]
        return "\n".join(lines)

    def enumerator(self, kind: str, name: str) -> str:
        """Return the C name of an index."""
        return f"{self.upper}_{kind.upper()}_{name.upper()}"

    def _status(self) -> str:
        lines = ["/* Status bits. */", f"enum {self.prefix}_status {{"]
        for bit, guard in enumerate(self.model.guards):
            name = self.enumerator("status", guard.name)
            place = min(bit, LAST_GUARD_BIT)
            lines.append(f"    {name} = 1 << {place}, /* {guard.meaning} */")
        lines.append(
            f"    {self.enumerator('status', 'not_finite')} = 1 << 30 /* a result is NaN or "
            "infinite */"
        )
        return "\n".join([*lines, "};"])

    def _prototypes(self) -> list[str]:
        prepare = (
            "/*\n * Compute the constants of one parameter set.\n"
            f"{self._prepare_returns()} */\n"
            f"int {self.prefix}_prepare(const double *restrict parameters, "
            "double *restrict constants);"
        )
        return [prepare, *(self._prototype(f) for f in self.model.functions.values())]

    def _prepare_returns(self) -> str:
        first = " * Returns 0, or one plus the index of the first constant that is not finite"
        checked: list[Assumption | Condition] = [*self.model.assumptions, *self.model.conditions]
        if not checked:
            return f"{first}.\n"
        count = f"{self.upper}_CONSTANT_COUNT"
        names = [f" *   {a.quantity}: {a.meaning}" for a in checked]
        return "\n".join(
            [
                f"{first},",
                f" * or {count} plus the number of the first of these that applies:",
                *(
                    line
                    for name in names
                    for line in textwrap.wrap(name, WIDTH, subsequent_indent=" *       ")
                ),
                "",
            ]
        )

    def _prototype(self, function: Function) -> str:
        shape = " x ".join(str(n) for n in function.shape)
        comment = f"/* {function.doc} out: {shape}. {count_line(function)}. */"
        comment = "\n".join(textwrap.wrap(comment, WIDTH, subsequent_indent="   "))
        return f"{comment}\n{self._signature(function)};"

    def _signature(self, function: Function) -> str:
        name = f"int {self.prefix}_{function.name}("
        given = "const double *restrict given, " if self.reads_given(function) else ""
        indent = " " * len(name)
        return (
            f"{name}{ARGUMENTS}\n{indent}const double *restrict inputs, {given}"
            "double *restrict out)"
        )

    @staticmethod
    def reads_given(function: Function) -> bool:
        """Tell whether a function takes relative coordinates as an argument of their own."""
        return any(s.name.startswith("given_") for s in function.free_symbols)

    # -- source ---------------------------------------------------------------------------------

    @property
    def parts(self) -> list[str]:
        """The source files of the model, by what their names add to the model's."""
        return list(dict.fromkeys(["", *(f.part for f in self.model.functions.values())]))

    def file_name(self, part: str) -> str:
        """Return the name of a source file."""
        return "_".join(filter(None, (self.prefix, part))) + ".c"

    def source(self, part: str = "") -> str:
        """Return the text of a source file."""
        functions = [f for f in self.model.functions.values() if f.part == part]
        text_functions = "\n#include <string.h>" if blocks_of(functions) else ""
        blocks = [
            self._banner(),
            f'#include "{self.prefix}.h"\n\n#include <math.h>{text_functions}',
            AT_LEAST,
            NOT_FINITE,
            *self._blocks(blocks_of(functions)),
            *([] if part else [*self._rounding(), self._prepare_body()]),
            *(self._body(f) for f in functions),
        ]
        return "\n\n".join(blocks) + "\n"

    def _rounding(self) -> list[str]:
        if not self.model.assumptions:
            return []
        comment = (
            "/* What is still zero: of an angle in rad, of a distance as a part of a length. */"
        )
        return [f"{comment}\n#define ROUNDING {ROUNDING}"]

    def _blocks(self, blocks: Sequence[Block]) -> list[str]:
        """Print what follows loops, and the equations of each."""
        if not blocks:
            return []
        sizes = {
            "unknowns": max(len(block.unknowns) for block in blocks),
            "elements": max(len(block.elements) for block in blocks),
            "driven": max(1, *(len(block.driven) for block in blocks)),
        }
        text = template("follow.c").substitute(LIMITS, **sizes).strip()
        return [text, *(part for block in blocks for part in (_once(self, block), _call(block)))]

    def _prepare_body(self) -> str:
        prepare = self.model.prepare
        read = [e.name for e in self.model.parameters if sp.Symbol(e.name) in prepare.free_symbols]
        lines = [
            (
                f"int {self.prefix}_prepare(const double *restrict parameters, "
                "double *restrict constants)"
            ),
            "{",
            *self._loads("parameter", "parameters", read),
            *self.steps(prepare),
            "",
        ]
        for label, result in zip(prepare.labels, prepare.results, strict=True):
            lines.append(f"    constants[{self.enumerator('constant', label)}] = {result};")
        count = f"{self.upper}_CONSTANT_COUNT"
        lines += [
            "",
            *self._assumptions(),
            f"    for (int i = 0; i < {count}; ++i) {{",
            "        if (!isfinite(constants[i])) {",
            "            return i + 1;",
            "        }",
            "    }",
            "    return 0;",
            "}",
        ]
        return "\n".join(lines)

    def _assumptions(self) -> list[str]:
        """Return the checks of what must be zero, and of what must not; a NaN is found later."""
        lines = []
        tests = [
            *(
                f"fabs({a.quantity}) > ROUNDING{'' if a.scale == 1 else f' * {a.scale}'}"
                for a in self.model.assumptions
            ),
            *(f"fabs({c.quantity}) <= {write(c.least).text}" for c in self.model.conditions),
        ]
        for number, test in enumerate(tests, 1):
            lines += [
                f"    if ({test}) {{",
                f"        return {self.upper}_CONSTANT_COUNT + {number};",
                "    }",
            ]
        return lines

    def _body(self, function: Function) -> str:
        read = {s.name for s in function.free_symbols}
        constants = [n for n in self.model.prepare.labels if n in read]
        state = [e.name for e in self.model.state if e.name in read]
        inputs = [e.name for e in self.model.inputs if e.name in read]
        given = [e.name for e in self.model.relative if f"given_{e.name}" in read]
        lines = [self._signature(function), "{"]
        for kind, array, names in (
            ("constant", "constants", constants),
            ("state", "state", state),
            ("input", "inputs", inputs),
        ):
            lines += self._loads(kind, array, names) or [f"    (void){array};"]
        lines += [
            f"    const double given_{n} = given[{self.enumerator('relative', n)}];" for n in given
        ]
        lines += self.steps(function)
        lines.append("")
        for index, (label, result) in enumerate(
            zip(function.labels, function.written.results, strict=True)
        ):
            text = f"    out[{index}] = {result.text};"
            lines.append(f"{text:<70} /* {label} */")
        lines += ["", *self._return(function)]
        return "\n".join([*lines, "}"])

    def _loads(self, kind: str, array: str, names: Iterable[str]) -> list[str]:
        return [f"    const double {n} = {array}[{self.enumerator(kind, n)}];" for n in names]

    @staticmethod
    def steps(function: Function) -> list[str]:
        """Return the assignments of a function, with the parts of the derivation in between."""
        lines, section = [], None
        for step, written in zip(function.steps, function.written.steps, strict=True):
            if step.section != section:
                section = step.section
                lines += ["", f"    /* {section} */"]
            text = f"{_type(step.expression)} {step.symbol} = {written.text};"
            lines += textwrap.wrap(
                text,
                WIDTH,
                initial_indent="    ",
                subsequent_indent="        ",
                break_long_words=False,
                break_on_hyphens=False,
            )
        return lines

    def _return(self, function: Function) -> list[str]:
        """Collect the status: comparisons only, no branch.

        A NaN or infinity that goes in comes out as one, or is caught by a guard.
        """
        bits = [
            (f"!({g.quantity} > {write(g.floor).text})", self.enumerator("status", g.name))
            for g in self.model.guards
            if g in function.guards
        ]
        finite = self.enumerator("status", "not_finite")
        bits.append((f"not_finite(out, {len(function.results)})", finite))
        lines = [f"    unsigned status = {bits[0][0]} * {bits[0][1]};"]
        lines += [f"    status |= {test} * {bit};" for test, bit in bits[1:]]
        return [*lines, "    return (int)status;"]


def _once(printer: CPrinter, block: Block) -> str:
    """Print one iteration: straight-line code."""
    read = {s.name for s in block.once.free_symbols}
    arrays = {
        "given": block.constants,
        "now": [d.now for d in block.driven],
        "from": block.estimate.base,
        "step": block.estimate.step,
        "held": [s for line in block.estimate.held for s in line],
    }
    start = f"static void {block.name}_once("
    arguments = textwrap.wrap(
        ", ".join(
            [*(f"const{_KEPT}double{_KEPT}*{name}" for name in arrays), f"double{_KEPT}*out)"]
        ),
        WIDTH - len(start),
    )
    lines = [(start + f"\n{' ' * len(start)}".join(arguments)).replace(_KEPT, " "), "{"]
    for array, symbols in arrays.items():
        loads = [
            f"    const double {s} = {array}[{i}];" for i, s in enumerate(symbols) if s.name in read
        ]
        lines += loads or [f"    (void){array};"]
    lines += [*printer.steps(block.once), ""]
    for i, (label, result) in enumerate(
        zip(block.once.labels, block.once.written.results, strict=True)
    ):
        text = f"    out[{i}] = {result.text};"
        lines.append(f"{text:<70} /* {label} */")
    return "\n".join([*lines, "}"])


def _call(block: Block) -> str:
    """Print the function that follows the loops of a block."""
    along = [(f"{d.now}_start", f"{d.now}_end", f"{d.now}_unit") for d in block.driven]
    names = [*map(str, block.constants), *(name for values in along for name in values)]
    start = f"static struct {block.name} {block.name}("
    arguments = ", ".join(f"double{_KEPT}{name}" for name in names) + ")"
    signature = textwrap.wrap(start + arguments, WIDTH, subsequent_indent=" " * len(start))

    def array(kind: str, name: str, values: Sequence[str]) -> list[str]:
        text = f"{kind} {name}[] = {{{', '.join(values) or '0'}}};"
        return textwrap.wrap(text, WIDTH, initial_indent="    ", subsequent_indent="        ")

    count = f"{len(block.unknowns)}, {len(block.elements)}, {len(block.driven)}"
    starts, ends, units = ([values[k] for values in along] for k in range(3))
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
        "    const int arrived = follow_turns(&loops, given, start, end, unit, found.at);",
        f"    found.at[{len(block.results) - 1}] = arrived ? 0.0 : 1.0;",
        "    return found;",
        "}",
    ]
    return "\n".join(lines)


_KEPT = "\N{NO-BREAK SPACE}"
"""Stands for a space at which no line is broken."""


def _type(expression: sp.Expr) -> str:
    """Return the type of a step: a number, or what an iteration returns."""
    if isinstance(expression, Iterated):
        return f"const struct {expression.args[0].name}"
    return "const double"
