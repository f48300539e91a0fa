"""Print a model as C99: a header that documents every array, and the straight-line functions.

No allocation, no global state, no ``pow``; every function returns a status word.
"""

from __future__ import annotations

import string
import textwrap
from itertools import groupby
from typing import TYPE_CHECKING

from ....equations import following
from ....equations.status import NOT_FINITE_BIT, bit_of
from ...program.floors import ROUNDING
from ..schedule import schedule
from ..sharing import scheduled, together
from ..templates import template
from ..text import Written, text_of, written, written_steps, written_values
from ..words import (
    FORMULA,
    GENERATOR_VERSION,
    blocks_of,
    count_line,
    iteration_note,
    mechanism_hash,
    reads_given,
)

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping, Sequence

    import sympy as sp

    from ...declare.inputs import Input
    from ...declare.shown import Shown
    from ...equations.outputs import Derivation, Entry
    from ...program.conditions import Assumption, Condition
    from ...program.function import Block, Function, Stage
    from ...program.steps import Guard
    from ..schedule import Assignment
    from ..sharing import Part

WIDTH = 100
ARGUMENTS = "const double *restrict constants, const double *restrict state,"

PLAIN = """\
#ifndef KINTRAFO_LANES /* else all numbers are vectors, and what includes this file has these */
typedef int status_word;

/* The greater of two numbers; NaN for a NaN. One instruction, where fmax may be a call. */
static inline double at_least(double x, double least)
{
    return x < least ? least : x;
}

/* One for what is positive, else zero. */
static inline double is_positive(double x)
{
    return x > 0.0;
}

/* A number that depends on nothing. */
static inline double number(double x)
{
    return x;
}

/* A bit, where a guarded quantity is not over its floor. */
static inline status_word guard_bit(double quantity, double least, int bit)
{
    return !(quantity > least) * bit;
}

/* A bit, where any of some values is NaN or infinite. */
static inline status_word finite_bit(const double *values, int count, int bit)
{
    status_word found = 0;
    for (int i = 0; i < count; ++i) {
        found |= !isfinite(values[i]);
    }
    return found * bit;
}

/* One number or the other. */
static inline status_word either(int applies, int code, status_word otherwise)
{
    return applies ? code : otherwise;
}

/* One plus the index of the first value that is NaN or infinite; 0: all are finite. */
static inline status_word first_not_finite(const double *values, int count)
{
    for (int i = 0; i < count; ++i) {
        if (!isfinite(values[i])) {
            return i + 1;
        }
    }
    return 0;
}
#endif"""


INLINED = """\
/*
 * What becomes part of every function that calls it, and what is left out where nothing reads its
 * result: with optimisation, each function keeps of `compute` the steps that its results need.
 */
#ifdef __GNUC__
#define INLINED static inline __attribute__((always_inline))
#define NO_EFFECT __attribute__((const))
#else
#define INLINED static inline
#define NO_EFFECT
#endif"""

COMPUTE = (
    "/* All functions of this file: the steps, each once, and the results of the one wanted. */"
)


class CPrinter:
    """Prints the header and the source of one model."""

    def __init__(self, model: Derivation) -> None:
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
                f"Parameters, SI units, at the design position, {self.model.model.mechanism.axes}.",
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
            self._constants(),
            self._status(),
            "#ifndef KINTRAFO_LANES",
            *self._prototypes(),
            "#endif",
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

    def _enum(self, kind: str, title: str, entries: Sequence[Entry | Input | Shown]) -> str:
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

    def _constants(self) -> str:
        names = textwrap.fill(
            ", ".join(self.model.prepare.labels),
            WIDTH,
            initial_indent=" " * 8,
            subsequent_indent=" " * 8,
        )
        count = len(self.model.prepare.labels)
        return (
            "/* Constants of one parameter set, computed by prepare: an array of that many. */"
            f"\nenum {{ {self.upper}_CONSTANT_COUNT = {count} }};\n#ifndef __cplusplus\n"
            f"struct {self.prefix}_constants {{\n    double\n{names};\n}};\n#endif"
        )

    def enumerator(self, kind: str, name: str) -> str:
        """Return the C name of an index."""
        return f"{self.upper}_{kind.upper()}_{name.upper()}"

    def _status(self) -> str:
        lines = ["/* Status bits. */", f"enum {self.prefix}_status {{"]
        for bit, guard in enumerate(self.model.guards):
            name = self.enumerator("status", guard.name)
            place = bit_of(bit)
            lines.append(f"    {name} = 1 << {place}, /* {guard.meaning} */")
        lines.append(
            f"    {self.enumerator('status', 'not_finite')} = 1 << {NOT_FINITE_BIT} "
            "/* a result is NaN or infinite */"
        )
        return "\n".join([*lines, "};"])

    def _prototypes(self) -> list[str]:
        prepare = (
            "/*\n * Compute the constants of one parameter set. Ranges of parameters are not\n"
            f" * checked here: they are `least`, `above` and `most` in {self.prefix}.json.\n"
            f"{self._prepare_returns()} */\n{self._from_parameters('prepare', 'constants')};"
        )
        design = (
            f"{self._comment(self.model.design, self.model.design.doc)}\n"
            f"{self._from_parameters('design_state', 'state')};"
        )
        return [prepare, design, *(self._prototype(f) for f in self.model.emitted.values())]

    def _from_parameters(self, name: str, out: str, returns: str = "int") -> str:
        arguments = f"const double *restrict parameters, double *restrict {out}"
        return f"{returns} {self.prefix}_{name}({arguments})"

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

    def _prototype(self, function: Function | Stage) -> str:
        shapes = [(m.name, " x ".join(map(str, m.shape))) for m in function.members]
        out = ", ".join(f"{name} {shape}" for name, shape in shapes)
        out = out if len(shapes) > 1 else shapes[0][1]
        comment = self._comment(function, f"{function.doc} out: {out}.")
        return f"{comment}\n{self._signature(function)};"

    @staticmethod
    def _comment(function: Function | Stage, text: str) -> str:
        comment = f"/* {text} {count_line(function)}. */"
        return "\n".join(textwrap.wrap(comment, WIDTH, subsequent_indent="   "))

    def _signature(self, function: Function | Stage, returns: str = "int") -> str:
        name = f"{returns} {self.prefix}_{function.name}("
        given = "const double *restrict given, " if reads_given(function) else ""
        indent = " " * len(name)
        return (
            f"{name}{ARGUMENTS}\n{indent}const double *restrict inputs, {given}"
            "double *restrict out)"
        )

    # -- source ---------------------------------------------------------------------------------

    @property
    def parts(self) -> list[str]:
        """The source files of the model, by what their names add to the model's."""
        return list(dict.fromkeys(["", *(f.part for f in self.model.emitted.values())]))

    def file_name(self, part: str) -> str:
        """Return the name of a source file."""
        return "_".join(filter(None, (self.prefix, part))) + ".c"

    def source(self, part: str = "") -> str:
        """Return the text of a source file."""
        functions = [f for f in self.model.emitted.values() if f.part == part]
        text_functions = "\n#include <string.h>" if blocks_of(functions) else ""
        null = "\n#include <stddef.h>" if any(map(reads_given, functions)) else ""
        blocks = [
            self._banner(),
            f'#include "{self.prefix}.h"\n\n#include <math.h>{null}{text_functions}',
            INLINED,
            PLAIN,
            *self._blocks(blocks_of(functions)),
            *([] if part else [*self._rounding(), self._prepare_body(), self._design_body()]),
            *self._functions(functions),
        ]
        return "\n\n".join(blocks) + "\n"

    @property
    def _in_lanes(self) -> frozenset[str]:
        """The functions that a simulation evaluates, of many systems at once."""
        variants = (f"rhs_{variant}" for variant in self.model.held_inputs)
        return frozenset({"rhs", *variants, "signals", "margins"})

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
        text = template("c", "follow.c").substitute(vars(following), **sizes).strip()
        return [text, *(part for block in blocks for part in (_once(block), _call(block)))]

    def _prepare_body(self) -> str:
        prepare, count = self.model.prepare, f"{self.upper}_CONSTANT_COUNT"
        values = [e.name for e in self.model.parameters]
        kept = set(prepare.labels)
        read = {s.name for s in prepare.free_symbols}
        taken = read.union(step.name for step in scheduled(prepare).steps)
        c = _free("c", taken)
        names = {name: f"{c}->{name}" for name in prepare.labels}
        results = written(prepare, FORMULA, names)[1]
        lines = [
            self._from_parameters("prepare", "constants", "status_word"),
            "{",
            f"    struct {self.prefix}_constants *const {c} = (void *)constants;",
            *declared([f"{n} = parameters[{i}]" for i, n in enumerate(values) if n in read - kept]),
            *(f"    {c}->{n} = parameters[{i}];" for i, n in enumerate(values) if n in kept),
            *_printed(scheduled(prepare).steps, names),
            *(
                f"    {names[name]} = {_in_all_lanes(value)};"
                for name, value in zip(prepare.labels, results, strict=True)
                if value != names[name]  # one whose value another one has
            ),
            "",
            f"    status_word failed = first_not_finite(constants, {count});",
            *self._assumptions(c),
            "    return failed;",
            "}",
        ]
        return "\n".join(lines)

    def _design_body(self) -> str:
        design = self.model.design
        read = {s.name for s in design.free_symbols}
        values = [e.name for e in self.model.parameters]
        loads = [f"{n} = parameters[{i}]" for i, n in enumerate(values) if n in read]
        finite = self.enumerator("status", "not_finite")
        results = written(design, FORMULA)[1]
        return "\n".join(
            [
                self._from_parameters("design_state", "state", "status_word"),
                "{",
                *(declared(loads) or ["    (void)parameters;"]),
                *_printed(scheduled(design).steps, {}),
                "",
                *(f"    state[{i}] = {_in_all_lanes(value)};" for i, value in enumerate(results)),
                f"    return finite_bit(state, {len(self.model.state)}, {finite});",
                "}",
            ]
        )

    def _assumptions(self, c: str) -> list[str]:
        """Return the checks of what must be zero, and of what must not; the first one counts."""

        def constant(expression: sp.Expr) -> str:
            return text_of(schedule(expression), FORMULA, lambda symbol: f"{c}->{symbol.name}")

        tests = [
            *(
                f"fabs({constant(a.quantity)}) > ROUNDING"
                + ("" if a.scale == 1 else f" * {constant(a.scale)}")
                for a in self.model.assumptions
            ),
            *(
                f"fabs({constant(k.quantity)}) <= {constant(k.least)}"
                for k in self.model.conditions
            ),
        ]
        numbered = [
            f"    failed = either({test}, {self.upper}_CONSTANT_COUNT + {number}, failed);"
            for number, test in enumerate(tests, 1)
        ]
        return numbered[::-1]

    def _functions(self, functions: Sequence[Function | Stage]) -> list[str]:
        """Print functions: what they compute, each step once, and each of them as a call of it."""
        given = any(map(reads_given, functions))
        wanted = ", ".join(map(self._wanted, functions))
        return [
            "\n".join(_wrapped(f"enum {self.prefix}_function {{ {wanted} }};", 0)),
            self._compute(functions, given=given),
            *(self._call(f, given=given) for f in functions if f.name in self._in_lanes),
            *_plain(
                [self._call(f, given=given) for f in functions if f.name not in self._in_lanes]
            ),
        ]

    def _wanted(self, function: Function | Stage) -> str:
        return f"{self.upper}_{function.name.upper()}"

    def _call(self, function: Function | Stage, *, given: bool) -> str:
        arguments = [self._wanted(function), "constants", "state", "inputs"]
        if given:
            arguments.append("given" if reads_given(function) else "NULL")
        call = f"compute({', '.join(arguments)}, out)"
        return f"{self._signature(function, 'status_word')}\n{{\n    return {call};\n}}"

    def _compute(self, functions: Sequence[Function | Stage], *, given: bool) -> str:
        """Print what all functions compute, each step once."""
        relative = {f"given_{e.name}" for e in self.model.relative}
        whole = together(functions, self.model.order, relative)
        c = _free("c", whole.names)
        names = {name: f"{c}->{name}" for name in self.model.prepare.labels}
        start = "INLINED status_word compute("
        indent, more = " " * len(start), " const double *restrict given," * given
        lines = [
            COMPUTE,
            f"{start}const enum {self.prefix}_function wanted,",
            f"{indent}{ARGUMENTS}",
            f"{indent}const double *restrict inputs,{more} double *restrict out)",
            "{",
            *self._pointer(c, whole.reads),
            *self._loads(whole.reads),
            *_printed(whole.steps, names),
            "",
            "    status_word status = {0};",
        ]
        for function, part in zip(functions, whole.parts, strict=True):
            body = self._part(function, part, names)
            lines += [
                "",
                f"    if (wanted == {self._wanted(function)}) {{",
                *(f"    {line}" if line else "" for line in body[body[0] == "" :]),
                "    }",
            ]
        return "\n".join([*lines, "    return status;", "}"])

    def _pointer(self, c: str, read: Collection[str]) -> list[str]:
        """Return the declaration of the constants; mark what is not read."""
        labels, states = self.model.prepare.labels, [e.name for e in self.model.state]
        unread = {"state": states, "inputs": [e.name for e in self.model.inputs]}
        lines = [f"    (void){n};" for n, names in unread.items() if not {*names} & {*read}]
        if not {*labels} & {*read}:
            return ["    (void)constants;", *lines]
        pointer = f"    const struct {self.prefix}_constants *const {c} = (const void *)constants;"
        return [pointer, *lines]

    def _loads(self, read: Collection[str]) -> list[str]:
        """Return the declarations of what is read of state, inputs and given coordinates."""
        arrays = {
            "state": [e.name for e in self.model.state],
            "inputs": [e.name for e in self.model.inputs],
            "given": [f"given_{e.name}" for e in self.model.relative],
        }
        return declared(
            [
                f"{name} = {array}[{i}]"
                for array, names in arrays.items()
                for i, name in enumerate(names)
                if name in read
            ]
        )

    def _part(self, function: Function | Stage, part: Part, names: Mapping[str, str]) -> list[str]:
        """Print the results of a function, and the steps that it alone has."""
        lines = [*self._loads(part.reads), *_printed(part.steps, names)]
        texts, start = written_values(part.results, FORMULA, names), 0
        for member in function.members:
            lines += self._results(member, texts[start : start + member.size], start)
            start += member.size
        return [*lines, "", *self._status_of(function, part, names)]

    @staticmethod
    def _results(part: Function, texts: Sequence[str], start: int) -> list[str]:
        """Return the assignments of an array: row by row, and then what is zero."""
        rows = [label.partition(" by ") for label in part.labels]
        columns = dict.fromkeys(column for _, _, column in rows if column)
        title = f"/* {part.name}{' by ' if columns else ''}{', '.join(columns)} */"
        lines = [
            "",
            *textwrap.wrap(title, WIDTH, initial_indent="    ", subsequent_indent="       "),
        ]
        zeros, last = [], ""
        for place, ((row, by, _), value) in enumerate(zip(rows, texts, strict=True), start):
            if value == "0.0":
                zeros.append(f"out[{place}]")
                continue
            text, label = f"out[{place}] = {_in_all_lanes(value)};", f"/* {row} */"
            fits = len(text) + len(label) < WIDTH - 8
            if not (by and row == last):
                lines += [] if fits else [f"    {label}"]
                text += f" {label}" if fits else ""
            lines += _wrapped(text, 4)
            last = row
        if zeros:
            lines += textwrap.wrap(
                f"{' = '.join(zeros)} = {_in_all_lanes('0.0')};",
                WIDTH,
                initial_indent="    ",
                subsequent_indent="        ",
            )
        return lines

    def _status_of(
        self, function: Function | Stage, part: Part, names: Mapping[str, str]
    ) -> list[str]:
        """Collect the status: comparisons only, no branch.

        A NaN or infinity that goes in comes out as one, or is caught by a guard.
        """

        def bit(guard: Guard) -> str:
            floor = text_of(schedule(guard.floor), FORMULA, lambda s: names.get(s.name, s.name))
            quantity = part.names.get(guard.quantity.name, guard.quantity)
            return f"guard_bit({quantity}, {floor}, {self.enumerator('status', guard.name)})"

        acting = {guard.name: guard for guard in function.guards}
        bits = [bit(acting[g.name]) for g in self.model.guards if g.name in acting]
        finite = self.enumerator("status", "not_finite")
        bits.append(f"finite_bit(out, {function.size}, {finite})")
        return [f"    status |= {bit};" for bit in bits]


def _plain(texts: Sequence[str]) -> list[str]:
    """Leave out, where numbers are vectors, what no simulation evaluates."""
    return ["#ifndef KINTRAFO_LANES", *texts, "#endif"] if texts else []


def _free(name: str, taken: Collection[str]) -> str:
    """Return a name that nothing else in a function has."""
    return next(n for n in (name, f"{name}_", f"{name}__") if n not in taken)


def _printed(steps: Sequence[Assignment], names: Mapping[str, str]) -> list[str]:
    """Return assignments, with the parts of the derivation in between."""
    lines: list[str] = []
    for section, group in groupby(written_steps(steps, FORMULA, names), key=lambda s: s.section):
        lines += ["", f"    /* {section} */"]
        for kind, run in groupby(group, key=_kind):
            texts = [f"{step.name} = {_in_all_lanes(step.text)}" for step in run]
            lines += declared(texts) if kind == "const double" else _each(kind, texts)
    return lines


def _once(block: Block) -> str:
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
    results = written(block.once, FORMULA)[1]
    lines += [*_printed(scheduled(block.once).steps, {}), ""]
    for i, (label, result) in enumerate(zip(block.once.labels, results, strict=True)):
        text = f"    out[{i}] = {result};"
        lines.append(f"{text:<70} /* {label} */")
    return "\n".join([*lines, "}"])


def _call(block: Block) -> str:
    """Print the function that follows the loops of a block."""
    along = [(f"{d.now}_start", f"{d.now}_end", f"{d.now}_unit") for d in block.driven]
    names = [*map(str, block.constants), *(name for values in along for name in values)]
    start = f"NO_EFFECT static struct {block.name} {block.name}("
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


_LETTERS = frozenset(string.ascii_letters) - {"e"}
"""What a value has that is no number alone."""

_KEPT = "\N{NO-BREAK SPACE}"
"""Stands for a space at which no line is broken."""


def declared(assignments: Sequence[str]) -> list[str]:
    """Return the declaration of some numbers, one on a line."""
    if not assignments:
        return []
    texts = [f"{text}," for text in assignments[:-1]] + [f"{assignments[-1]};"]
    return ["    const double", *(line for text in texts for line in _wrapped(text, 8))]


def _in_all_lanes(text: str) -> str:
    """Write a value; one that is a number has to be told that it may stand for a vector."""
    return text if set(text) & _LETTERS else f"number({text})"


def _each(kind: str, assignments: Sequence[str]) -> list[str]:
    """Return assignments that are statements of their own."""
    start = f"{kind} " if kind else ""
    return [line for text in assignments for line in _wrapped(f"{start}{text};", 4)]


def _wrapped(text: str, indent: int) -> list[str]:
    return textwrap.wrap(
        text,
        WIDTH,
        initial_indent=" " * indent,
        subsequent_indent=" " * (indent + 4),
        break_long_words=False,
        break_on_hyphens=False,
    )


def _kind(step: Written) -> str:
    """Return how a step is declared: a number, what an iteration returns, or an element."""
    if step.kind == "iterate":
        return f"const struct {step.of}"
    return "" if "->" in step.name else "const double"
