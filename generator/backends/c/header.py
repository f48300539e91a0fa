"""Print the header of a model: enumerations that document every array, and prototypes."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

from ....equations.status import NOT_FINITE_BIT, bit_of
from ..words import count_line, iteration_note
from .common import WIDTH, CText, unbroken

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ...declare.inputs import Input
    from ...declare.shown import Shown
    from ...declare.states import Entry
    from ...program.conditions import Assumption, Condition
    from ...program.function import Function, Stage


class Header(CText):
    """The header file of one model."""

    def text(self) -> str:
        """Return the text of the header file."""
        guard = f"KINTRAFO_{self.upper}_H"
        state = "State: independent coordinates, then their rates."
        if self.derivation.states.free:
            state = (
                "State: positions, then speeds; of free bodies the latter are in their own axes."
            )
        blocks = [
            self.banner(self._conventions()),
            (
                f"#ifndef {guard}\n#define {guard}\n\n#ifdef __cplusplus\n"
                'extern "C" {\n#define restrict\n#endif'
            ),
            self._enum(
                "parameter",
                f"Parameters, SI units, at the design position, {self.formulation.mechanism.axes}.",
                self.derivation.parameters,
            ),
            self._enum("state", state, self.derivation.state),
            self._enum("input", "Time-varying inputs.", self.derivation.inputs),
            self._enum("relative", "Relative joint coordinates.", self.derivation.relative),
            self._enum("signal", "Elements of the signals function.", self.derivation.signals),
            self._plain_enum(
                "body",
                "Order of the bodies in the arrays of poses and velocities.",
                self.derivation.moving_bodies,
            ),
            self._plain_enum(
                "massive", "Order of the bodies in the Jacobians.", self.derivation.massive_bodies
            ),
            self._constants(),
            self._status(),
            "#ifndef KINTRAFO_LANES",
            *self._prototypes(),
            "#endif",
            f"#ifdef __cplusplus\n#undef restrict\n}}\n#endif\n\n#endif /* {guard} */",
        ]
        return "\n\n".join(blocks) + "\n"

    def _conventions(self) -> str:
        gravity, note = "", iteration_note(self.derivation)
        if any(entry.name == "gravity" for entry in self.derivation.parameters):
            gravity = ", with gravity along -z; in a vehicle x is forward and y left (ISO 8855)"
        return (
            f"\n\nUnits are SI. Axes are right-handed{gravity}.\n"
            "Arrays of several dimensions are row-major.\n"
            "All functions are pure: no allocation, no global state, safe to call from any thread."
            "\nThey return 0, or status bits, which name the error; results are then meaningless."
        ) + (f"\n\n{textwrap.fill(note, WIDTH - 4)}" if note else "")

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
        labels, indent = ", ".join(self.derivation.prepare.labels), " " * 8
        names = "\n".join(unbroken(labels, initial_indent=indent, subsequent_indent=indent))
        count = len(self.derivation.prepare.labels)
        return (
            "/* Number of constants of one parameter set, and their order in the array that "
            "prepare writes. */"
            f"\nenum {{ {self.upper}_CONSTANT_COUNT = {count} }};\n#ifndef __cplusplus\n"
            f"struct {self.prefix}_constants {{\n    double\n{names};\n}};\n#endif"
        )

    def _status(self) -> str:
        lines = ["/* Status bits. */", f"enum {self.prefix}_status {{"]
        for bit, guard in enumerate(self.derivation.guards):
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
            f"{self._prepare_returns()} */\n{self.from_parameters('prepare', 'constants')};"
        )
        design = (
            f"{self._comment(self.derivation.design, self.derivation.design.doc)}\n"
            f"{self.from_parameters('design_state', 'state')};"
        )
        more = (
            f"{self._comment(f, f.doc)}\n{self.from_parameters(f.name, 'out')};"
            for f in self.derivation.by_parameters.of_parameters
        )
        emitted = (self._prototype(f) for f in self.derivation.emitted.values())
        return [prepare, design, *more, *emitted]

    def _prepare_returns(self) -> str:
        first = " * Returns 0, or one plus the index of the first constant that is not finite"
        checked: list[Assumption | Condition] = [
            *self.derivation.assumptions,
            *self.derivation.conditions,
        ]
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
        return f"{comment}\n{self.signature(function)};"

    @staticmethod
    def _comment(function: Function | Stage, text: str) -> str:
        comment = f"/* {text} {count_line(function)}. */"
        return "\n".join(textwrap.wrap(comment, WIDTH, subsequent_indent="   "))
