"""Print the sources of a model: straight-line functions, each step of which is there once.

No allocation, no global state, no ``pow``; every function returns a status word.
"""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

import sympy as sp

from ....equations import following
from ...equations.outputs import BOUNDED
from ...program.directions import TANGENT
from ...program.floors import ROUNDING
from ..schedule import schedule
from ..sharing import scheduled, together
from ..templates import template
from ..text import text_of, written, written_values
from ..words import ELEMENTARY, FORMULA, blocks_of, reads_given
from .common import ARGUMENTS, WIDTH, CText, unbroken
from .iteration import call_of, once
from .pieces import LONG, cut, is_long, length_of, steps_of
from .statements import declared, in_all_lanes, printed, wrapped

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping, Sequence

    from ...equations.outputs import Derivation
    from ...program.function import Function, IterationBlock, Stage
    from ...program.steps import Guard
    from ..schedule import Assignment
    from ..sharing import OwnSteps, Together
    from .pieces import Cut, Piece

COMPUTE = (
    "/* The steps of all functions of this file, each once, and the results of the selected one. */"
)

NOT_INLINED = """/*
 * Long functions are cut into pieces, since the time of a compiler grows with the square of their
 * length. Use -fno-tree-slp-vectorize with GCC: it would search for minutes for vectors in structs.
 */
#ifdef __GNUC__
#define NOT_INLINED __attribute__((noinline))
#else
#define NOT_INLINED
#endif"""


class Source(CText):
    """The source files of one model.

    `in_pieces` is whether to cut long functions. Otherwise a file has its derivation once and
    whole, for readers, and the most frequent call is fastest; a compiler takes longer.
    """

    def __init__(self, derivation: Derivation, *, in_pieces: bool = False) -> None:
        super().__init__(derivation)
        self._in_pieces = in_pieces

    @property
    def parts(self) -> list[str]:
        """The source files of the model, by the ends of their names behind the model's."""
        return list(dict.fromkeys(["", *(f.part for f in self.derivation.emitted.values())]))

    def file_name(self, part: str) -> str:
        """Return the name of a source file."""
        return "_".join(filter(None, (self.prefix, part))) + ".c"

    def text(self, part: str = "") -> str:
        """Return the text of a source file."""
        functions = [f for f in self.derivation.emitted.values() if f.part == part]
        if not part and self.derivation.bounded:
            functions.append(self.derivation.bounded)
        text_functions = "\n#include <string.h>" if blocks_of(functions) else ""
        null = "\n#include <stddef.h>" if any(map(reads_given, functions)) else ""
        printed_functions = [
            *([] if part else self._functions_of_parameters()),
            *self._functions(functions),
        ]
        cut_up = any("NOT_INLINED" in text for text in printed_functions)
        blocks = [
            self.banner(),
            f'#include "{self.prefix}.h"\n\n#include "{ELEMENTARY}"',
            f"#include <math.h>{null}{text_functions}",
            template("c", "inlined.c").template.strip(),
            template("c", "scalars.c").template.strip(),
            *self._blocks(blocks_of(functions)),
            *([NOT_INLINED] if cut_up else []),
            *printed_functions,
        ]
        return "\n\n".join(blocks) + "\n"

    @property
    def _in_lanes(self) -> frozenset[str]:
        """The functions that a simulation evaluates, of many systems or along many directions."""
        variants = (f"rhs_{variant}" for variant in self.derivation.held_inputs)
        tangents = (f"{name}_{TANGENT}" for name in ("rhs", "signals"))
        return frozenset({"rhs", *variants, "signals", "margins", *tangents})

    def _functions_of_parameters(self) -> list[str]:
        more = map(self._body_of_parameters, self.derivation.by_parameters.of_parameters)
        design = self._body_of_parameters(self.derivation.design, "state")
        comment = "/* Limit of zero: of an angle in rad, of a distance relative to a length. */"
        limit = [f"{comment}\n#define ROUNDING {ROUNDING}"] if self.derivation.assumptions else []
        return [*limit, self._prepare_body(), design, *_only("ifndef", [*more])]

    def _blocks(self, blocks: Sequence[IterationBlock]) -> list[str]:
        """Print the code that follows loops, and the equations of each."""
        if not blocks:
            return []
        sizes = {
            "unknowns": max(len(block.unknowns) for block in blocks),
            "elements": max(len(block.elements) for block in blocks),
            "driven": max(1, *(len(block.driven) for block in blocks)),
        }
        text = template("c", "follow.c").substitute(vars(following), **sizes).strip()
        return [text, *(part for block in blocks for part in (once(block), call_of(block)))]

    def _prepare_body(self) -> str:
        prepare, count = self.derivation.prepare, f"{self.upper}_CONSTANT_COUNT"
        values = [e.name for e in self.derivation.parameters]
        kept = set(prepare.labels)
        read = {s.name for s in prepare.free_symbols}
        taken = read.union(step.name for step in scheduled(prepare).steps)
        c = _free("c", taken)
        names = {name: f"{c}->{name}" for name in prepare.labels}
        results = written(prepare, FORMULA, names)[1]
        steps = scheduled(prepare).steps
        equal = [  # assignments of constants that equal other ones
            f"    {names[name]} = {in_all_lanes(value)};" if value != names[name] else ""
            for name, value in zip(prepare.labels, results, strict=True)
        ]
        given = {name: f"parameters[{i}]" for i, name in enumerate(values) if name in read}
        pieces: list[str] = []
        calls: list[str] = []
        if self._in_pieces and is_long(steps):
            pieces, calls = self._prepare_in_pieces(steps, equal, names, given, c)
        lines = [
            *(f"{piece}\n" for piece in pieces),
            self.from_parameters("prepare", "constants", "status_word"),
            "{",
            f"    struct {self.prefix}_constants *const {c} = (void *)constants;",
            *([] if pieces else declared([f"{n} = {given[n]}" for n in given if n not in kept])),
            *(f"    {c}->{n} = {at};" for n, at in given.items() if n in kept),
            *(calls or [*printed(steps, names), *filter(None, equal)]),
            "",
            f"    status_word failed = first_not_finite(constants, {count});",
            *self._assumptions(c),
            "    return failed;",
            "}",
        ]
        return "\n".join(lines)

    def _prepare_in_pieces(
        self,
        steps: Sequence[Assignment],
        equal: Sequence[str],
        names: Mapping[str, str],
        given: Mapping[str, str],
        c: str,
    ) -> tuple[list[str], list[str]]:
        """Print the pieces of `prepare`, and their calls; one reads values that others stored.

        A compiler compares each read with every store of a long function.
        """
        found = cut(steps, scheduled(self.derivation.prepare).results, [], {})
        kept = _free("kept", {step.name for step in steps})
        handed = {name: place for name, place in found.kept.items() if name not in names}
        pieces = []
        for number, piece in enumerate(found.pieces, 1):
            start = f"NOT_INLINED static void prepare_{number}("
            indent = " " * len(start)
            read = piece.reads - names.keys()
            lines = [
                f"{start}const double *restrict parameters, double *restrict constants,",
                f"{indent}double *restrict {kept})",
                "{",
                f"    struct {self.prefix}_constants *const {c} = (void *)constants;",
                *(f"    (void){name};" for name in ("parameters", c, kept)),
                *declared([f"{name} = {at}" for name, at in given.items() if name in read]),
                *declared([f"{n} = {kept}[{handed[n]}]" for n in sorted(read & handed.keys())]),
                *printed(piece.steps, names),
                *(
                    f"    {kept}[{handed[s.name]}] = {s.name};"
                    for s in piece.steps
                    if s.name in handed
                ),
                *filter(None, (equal[i] for i in piece.results)),
                "}",
            ]
            pieces.append("\n".join(lines))
        array = f"    double {kept}[{max(1, found.size)}];"
        numbers = range(1, len(pieces) + 1)
        calls = [f"    prepare_{number}(parameters, constants, {kept});" for number in numbers]
        return pieces, [array, *calls]

    def _body_of_parameters(self, function: Function, out: str = "out") -> str:
        read = {s.name for s in function.free_symbols}
        places = self._places("parameters", [e.name for e in self.derivation.parameters])
        loads = [f"{n} = parameters[{i}]" for n, i in places.items() if n in read]
        finite = self.enumerator("status", "not_finite")
        results = written(function, FORMULA)[1]
        return "\n".join(
            [
                self.from_parameters(function.name, out, "status_word"),
                "{",
                *(declared(loads) or ["    (void)parameters;"]),
                *printed(scheduled(function).steps, {}),
                "",
                *(f"    {out}[{i}] = {in_all_lanes(value)};" for i, value in enumerate(results)),
                f"    return finite_bit({out}, {function.size}, {finite});",
                "}",
            ]
        )

    def _assumptions(self, c: str) -> list[str]:
        """Return the checks of constants that must be zero, or must not; the first one counts."""

        def constant(expression: sp.Expr) -> str:
            return text_of(schedule(expression), FORMULA, lambda symbol: f"{c}->{symbol.name}")

        tests = [
            *(
                f"fabs({constant(a.quantity)}) > ROUNDING"
                + ("" if a.scale == 1 else f" * {constant(a.scale)}")
                for a in self.derivation.assumptions
            ),
            *(
                f"fabs({constant(k.quantity)}) <= {constant(k.least)}"
                for k in self.derivation.conditions
            ),
        ]
        numbered = [
            f"    failed = either({test}, {self.upper}_CONSTANT_COUNT + {number}, failed);"
            for number, test in enumerate(tests, 1)
        ]
        return numbered[::-1]

    def _functions(self, functions: Sequence[Function | Stage]) -> list[str]:
        """Print functions: one with every step once, and each of them as a call of it."""
        own = {f"given_{e.name}" for e in self.derivation.relative}
        own.update(self.derivation.by_parameters.weights("inputs"))
        whole = together(functions, self.derivation.order, own)
        if self._in_pieces and length_of(whole) > LONG:
            parts = zip(functions, whole.parts, strict=True)
            return self._where_needed((f, self._cut(f, part, whole)) for f, part in parts)
        given = any(map(reads_given, functions))
        wanted = ", ".join(map(self._wanted, functions))
        return [
            "\n".join(wrapped(f"enum {self.prefix}_function {{ {wanted} }};", 0)),
            self._compute(functions, whole, given=given),
            *self._where_needed((f, [self._call(f, given=given)]) for f in functions),
        ]

    def _where_needed(
        self, printed_functions: Iterable[tuple[Function | Stage, Sequence[str]]]
    ) -> list[str]:
        """Guard functions: some are needed for many systems only, or for single ones only."""
        always: list[str] = []
        alone: list[str] = []
        in_lanes: list[str] = []
        for function, texts in printed_functions:
            if function.name == BOUNDED:
                in_lanes += texts
            else:
                (always if function.name in self._in_lanes else alone).extend(texts)
        return [*always, *_only("ifndef", alone), *_only("ifdef", in_lanes)]

    def _wanted(self, function: Function | Stage) -> str:
        return f"{self.upper}_{function.name.upper()}"

    def _call(self, function: Function | Stage, *, given: bool) -> str:
        arguments = [self._wanted(function), "constants", "state", "inputs"]
        if given:
            arguments.append("given" if reads_given(function) else "NULL")
        call = f"compute({', '.join(arguments)}, out)"
        return f"{self.signature(function, 'status_word')}\n{{\n    return {call};\n}}"

    def _cut(self, function: Function | Stage, part: OwnSteps, whole: Together) -> list[str]:
        """Print the pieces of a function, and their caller."""
        steps, guards = steps_of(function, part, whole), self._guards_of(function, part)
        sizes = {block.name: len(block.results) for block in blocks_of([function])}
        of_blocks = {s.name: s.value.of for s in steps if s.value.kind == "iterate"}
        wide = {name: sizes[block] for name, block in of_blocks.items()}
        read = [frozenset(s.name for s in (q, *f.free_symbols)) for _, q, f in guards]
        found = cut(steps, part.results, read, wide)
        printer = _Pieces(self, function, part, found, of_blocks, wide, _free("c", whole.names))
        where = {step.name: k for k, p in enumerate(found.pieces) for step in p.steps}
        bits: list[list[str]] = [[] for _ in found.pieces]
        for (name, quantity, floor), names in zip(guards, read, strict=True):
            at = max((where[n] for n in names if n in where), default=0)
            bits[at].append(printer.guard(name, quantity, floor))
        return [*(printer.piece(k, bits[k]) for k in range(len(bits))), printer.caller()]

    def _guards_of(
        self, function: Function | Stage, part: OwnSteps
    ) -> list[tuple[str, sp.Symbol, sp.Expr]]:
        """Return names, quantities and floors of the guards that act."""
        acting = {guard.name: guard for guard in function.guards}
        return [
            (g.name, sp.Symbol(part.names.get(q.name, q.name)), acting[g.name].floor)
            for g in self.derivation.guards
            if g.name in acting
            for q in (acting[g.name].quantity,)
        ]

    def _compute(
        self, functions: Sequence[Function | Stage], whole: Together, *, given: bool
    ) -> str:
        """Print the function that computes all of them, with each step once."""
        c = _free("c", whole.names)
        names = self.constants_in(c)
        start = "INLINED status_word compute("
        indent, more = " " * len(start), " const double *restrict given," * given
        lines = [
            COMPUTE,
            f"{start}const enum {self.prefix}_function wanted,",
            f"{indent}{ARGUMENTS}",
            f"{indent}const double *restrict inputs,{more} double *restrict out)",
            "{",
            *self.pointer(c, whole.reads),
            *self.loads(whole.reads),
            *printed(whole.steps, names),
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

    def constants_in(self, c: str) -> dict[str, str]:
        """Return the C expressions of constants, and of their directions behind them."""
        labels = self.derivation.prepare.labels
        names = {name: f"{c}->{name}" for name in labels}
        behind = self.derivation.by_parameters.places("constants")
        return names | {n: f"{c}[1].{labels[i - len(labels)]}" for n, i in behind.items()}

    def _places(self, array: str, names: Iterable[str]) -> dict[str, int]:
        """Return the indices of the elements of an array, with the names behind its values."""
        behind = self.derivation.by_parameters.places(array)
        return {name: i for i, name in enumerate(names)} | behind

    def pointer(self, c: str, read: Collection[str]) -> list[str]:
        """Return the declaration of the constants by a pointer name; mark unread arrays."""
        lines = [
            f"    (void){array};"
            for array, places in self._arrays().items()
            if array != "given" and not places.keys() & {*read}
        ]
        if not self.constants_in(c).keys() & {*read}:
            return ["    (void)constants;", *lines]
        pointer = f"    const struct {self.prefix}_constants *const {c} = (const void *)constants;"
        return [pointer, *lines]

    def _arrays(self) -> dict[str, dict[str, int]]:
        """Return the indices of all elements of arrays that are read by name, without constants."""
        arrays = {
            "state": [e.name for e in self.derivation.state],
            "inputs": [e.name for e in self.derivation.inputs],
            "given": [f"given_{e.name}" for e in self.derivation.relative],
        }
        return {array: self._places(array, names) for array, names in arrays.items()}

    def loads(self, read: Collection[str]) -> list[str]:
        """Return the declarations of the elements that are read, without constants."""
        return declared(
            [
                f"{name} = {array}[{i}]"
                for array, places in self._arrays().items()
                for name, i in places.items()
                if name in read
            ]
        )

    def _part(
        self, function: Function | Stage, part: OwnSteps, names: Mapping[str, str]
    ) -> list[str]:
        """Print the results of a function, and the steps that only it needs."""
        lines = [*self.loads(part.reads), *printed(part.steps, names)]
        texts, start = written_values(part.results, FORMULA, names), 0
        for member in function.members:
            lines += self._results(member, texts[start : start + member.size], start)
            start += member.size
        return [*lines, "", *self._status_of(function, part, names)]

    @staticmethod
    def _results(part: Function, texts: Sequence[str], start: int) -> list[str]:
        """Return the assignments of an array: row by row, and then the zeros."""
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
            text, label = f"out[{place}] = {in_all_lanes(value)};", f"/* {row} */"
            fits = len(text) + len(label) < WIDTH - 8
            if not (by and row == last):
                lines += [] if fits else [f"    {label}"]
                text += f" {label}" if fits else ""
            lines += wrapped(text, 4)
            last = row
        if zeros:
            lines += unbroken(
                f"{' = '.join(zeros)} = {in_all_lanes('0.0')};",
                initial_indent="    ",
                subsequent_indent="        ",
            )
        return lines

    def _status_of(
        self, function: Function | Stage, part: OwnSteps, names: Mapping[str, str]
    ) -> list[str]:
        """Return the statements of the status: comparisons only, no branch.

        A NaN or infinity in the input results in one, or is caught by a guard.
        """

        def bit(guard: Guard) -> str:
            floor = text_of(schedule(guard.floor), FORMULA, lambda s: names.get(s.name, s.name))
            quantity = part.names.get(guard.quantity.name, guard.quantity)
            return f"guard_bit({quantity}, {floor}, {self.enumerator('status', guard.name)})"

        acting = {guard.name: guard for guard in function.guards}
        bits = [bit(acting[g.name]) for g in self.derivation.guards if g.name in acting]
        finite = self.enumerator("status", "not_finite")
        bits.append(f"finite_bit(out, {function.size}, {finite})")
        return [f"    status |= {bit};" for bit in bits]


class _Pieces:
    """Prints the pieces of one function, and their caller."""

    def __init__(
        self,
        source: Source,
        function: Function | Stage,
        part: OwnSteps,
        found: Cut,
        of_blocks: Mapping[str, str],
        wide: Mapping[str, int],
        c: str,
    ) -> None:
        self._source, self._function, self._part, self._found = source, function, part, found
        self._of_blocks, self._wide, self._c = of_blocks, wide, c
        self._names = source.constants_in(c)
        taken = {s.name for p in found.pieces for s in p.steps}
        self._kept = next(n for n in ("kept", "kept_", "kept__") if n not in taken)

    def guard(self, name: str, quantity: sp.Symbol, floor: sp.Expr) -> str:
        """Print the comparison of a guard."""
        names = self._names
        text = text_of(schedule(floor), FORMULA, lambda s: names.get(s.name, s.name))
        value = names.get(quantity.name, quantity.name)
        return f"status |= guard_bit({value}, {text}, {self._source.enumerator('status', name)});"

    def piece(self, number: int, bits: Sequence[str]) -> str:
        """Print one piece: its inputs, its steps, values for others, its results."""
        piece, kept = self._found.pieces[number], self._kept
        start = f"NOT_INLINED static status_word {self._function.name}_{number + 1}("
        indent = " " * len(start)
        given = " const double *restrict given," * reads_given(self._function)
        lines = [
            f"{start}{ARGUMENTS}",
            f"{indent}const double *restrict inputs,{given}",
            f"{indent}double *restrict {kept}, double *restrict out)",
            "{",
            *self._source.pointer(self._c, piece.reads),
            *(["    (void)given;"] if given else []),
            f"    (void){kept};",
            "    (void)out;",
            *self._source.loads(piece.reads),
            *declared([f"{n} = {kept}[{self._found.kept[n]}]" for n in self._handed(piece)]),
            *(line for n in sorted(piece.reads & self._wide.keys()) for line in self._block(n)),
            *printed(piece.steps, self._names),
            "",
            *(f"    {line}" for step in piece.steps for line in self._hands_over(step.name)),
            *self._results(piece),
            "    status_word status = {0};",
            *(f"    {bit}" for bit in bits),
            "    return status;",
            "}",
        ]
        return "\n".join(lines)

    def _handed(self, piece: Piece) -> list[str]:
        """Return the values that a piece takes over, in the order of their indices."""
        names = (piece.reads & self._found.kept.keys()) - self._wide.keys()
        return sorted(names, key=self._found.kept.__getitem__)

    def _block(self, name: str) -> list[str]:
        place = self._found.kept[name]
        return [
            f"    struct {self._of_blocks[name]} {name};",
            f"    memcpy({name}.at, {self._kept} + {place}, sizeof {name}.at);",
        ]

    def _hands_over(self, name: str) -> list[str]:
        place = self._found.kept.get(name)
        if place is None:
            return []
        if name in self._wide:
            return [f"memcpy({self._kept} + {place}, {name}.at, sizeof {name}.at);"]
        return [f"{self._kept}[{place}] = {name};"]

    def _results(self, piece: Piece) -> list[str]:
        values = [self._part.results[i] for i in piece.results]
        texts = written_values(values, FORMULA, self._names)
        return [
            line
            for i, text in zip(piece.results, texts, strict=True)
            for line in wrapped(f"out[{i}] = {in_all_lanes(text)};", 4)
        ]

    def caller(self) -> str:
        """Print the function itself."""
        source, function, kept = self._source, self._function, self._kept
        given = " given," * reads_given(function)
        lines = [
            source.signature(function, "status_word"),
            "{",
            f"    double {kept}[{max(1, self._found.size)}];",
            "    status_word status = {0};",
        ]
        for number in range(1, len(self._found.pieces) + 1):
            call = f"{function.name}_{number}(constants, state, inputs,{given} {kept}, out)"
            lines.append(f"    status |= {call};")
        finite = source.enumerator("status", "not_finite")
        lines.append(f"    status |= finite_bit(out, {function.size}, {finite});")
        return "\n".join([*lines, "    return status;", "}"])


def _only(condition: str, texts: Sequence[str]) -> list[str]:
    """Guard texts so that they are compiled with vectors only, or without them only."""
    return [f"#{condition} KINTRAFO_LANES", *texts, "#endif"] if texts else []


def _free(name: str, taken: Collection[str]) -> str:
    """Return a name that is not taken in a function."""
    return next(n for n in (name, f"{name}_", f"{name}__") if n not in taken)
