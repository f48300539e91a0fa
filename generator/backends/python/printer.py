"""Print the Python face of a model: its module, and addresses in a shared library.

The module imports addresses from a file beside it, which is Cython where the C code is built with
this project, and Python where it lies in a shared library.
"""

from __future__ import annotations

import pprint
import textwrap
from typing import TYPE_CHECKING

from ...declare.ranges import described as parameters_of
from ...equations.design import design_coordinates
from ..counting import OPERATIONS, operations_of
from ..numpy.dialect import NUMPY
from ..templates import template
from ..text import formula
from ..words import count_line, iteration_note, mechanism_hash, reads_given

if TYPE_CHECKING:
    from ...declare.inputs import Input
    from ...equations.outputs import Entry, GeneratedModel
    from ...program.function import Function


class PythonPrinter:
    """Prints the Python face of one model."""

    def __init__(self, model: GeneratedModel) -> None:
        self.model = model
        self.name = model.model.name
        self._functions = list(model.functions.values())

    def _called(self) -> list[Function]:
        """Return the functions with the common signature."""
        return [f for f in self._functions if not reads_given(f)]

    # -- addresses ------------------------------------------------------------------------------

    @property
    def _names(self) -> list[str]:
        return ["prepare", *(f.name for f in self._functions)]

    def addresses_in(self, library: str) -> str:
        """Return the text of a ``.py`` file that finds the addresses in a library beside it."""
        return template("python", "addresses.py").substitute(
            name=self.name,
            library=library,
            functions="\n".join(f'        "{n}",' for n in self._names),
        )

    # -- Python ---------------------------------------------------------------------------------

    def module(self) -> str:
        """Return the text of the ``.py`` file."""
        model = self.model
        exports = [
            "ADDRESSES",
            "DEFAULT_CONSTANTS",
            "MECHANISM_HASH",
            "NAME",
            *self._tables(),
            "ClosureError",
            "ModelError",
            "ParameterError",
            "design_state",
            "prepare",
            *(f.name for f in self._functions),
        ]
        return template("python", "model.py").substitute(
            name=self.name,
            title=model.model.title,
            hash=mechanism_hash(model),
            iteration=self._iteration_note(),
            state_count=len(model.state),
            input_count=len(model.inputs),
            constant_count=len(model.prepare.results),
            state_names=_fill(", ".join(e.name for e in model.state), 4).lstrip(),
            input_names=_fill(", ".join(e.name for e in model.inputs), 4).lstrip(),
            summary="\n".join(
                f"``{f.name}``\n    {_fill(f'{f.doc} Result (..., {_shape(f)}).', 4).lstrip()}"
                for f in self._functions
            ),
            exports="\n".join(f'    "{name}",' for name in exports),
            tables="\n\n".join(
                f"{name}: Final[{kind}] = {pprint.pformat(table, width=98, sort_dicts=False)}"
                for name, (kind, table) in self._tables().items()
            ),
            design=self._design(),
            functions="\n".join(map(self._function, self._called())),
        )

    def _iteration_note(self) -> str:
        note = iteration_note(self.model)
        return f"\n\n{_fill(note, 0)}" if note else ""

    def _design(self) -> str:
        """Return the function that computes the state at the design position."""
        coordinates = design_coordinates(self.model.model)
        order = [e.name for e in self.model.state]
        steps = [step for found in coordinates.values() for step in found]
        read = set().union(*(e.free_symbols for _, e in steps)) - {s for s, _ in steps}
        lines = [
            "def design_state(parameters: Mapping[str, float]) -> Array:",
            '    """Return the state at the design position of some parameters, at rest."""',
            *(f'    {s} = parameters["{s}"]' for s in sorted(read, key=str)),
            *(f"    {symbol} = {formula(e, NUMPY)}" for symbol, e in steps),
            f"    state = np.zeros({len(order)})",
            *(f"    state[{order.index(name)}] = {name}" for name in coordinates),
            "    return state",
        ]
        return "\n".join(lines)

    def _tables(self) -> dict[str, tuple[str, object]]:
        model = self.model
        described = "dict[str, dict[str, str]]"
        names = "tuple[str, ...]"
        topology = model.plan.topology
        return {
            "PARAMETERS": ("dict[str, dict[str, Any]]", parameters_of(model.model.mechanism)),
            "STATE": (described, _described(model.state)),
            "INPUTS": ("dict[str, dict[str, str | None]]", _inputs(model.inputs)),
            "RELATIVE_COORDINATES": (described, _described(model.relative)),
            "SIGNALS": (described, _described(model.signals)),
            "BODIES": (names, model.moving_bodies),
            "MASSIVE_BODIES": (names, model.massive_bodies),
            "CONSTANTS": (names, model.prepare.labels),
            "GUARDS": (
                "tuple[tuple[str, str], ...]",
                tuple((g.name, g.meaning) for g in model.guards),
            ),
            "ASSUMPTIONS": (
                "tuple[tuple[str, str, str, str, str], ...]",
                tuple((str(a.quantity), a.unit, a.meaning, a.remedy, "") for a in model.assumptions)
                + tuple(
                    (str(c.quantity), c.unit, c.meaning, c.remedy, str(c.least))
                    for c in model.conditions
                ),
            ),
            "GUARD_UNITS": ("dict[str, str]", {g.name: g.unit for g in model.guards}),
            "ACTING_GUARDS": ("dict[str, tuple[int, ...]]", _acting(model)),
            "HELD_VARIANTS": ("dict[str, tuple[str, ...]]", model.held_inputs),
            "MOBILITY": ("int", topology.mobility),
            "LOOPS": (
                "tuple[tuple[str, ...], ...]",
                tuple(t.cycle.bodies for t in model.plan.transformers),
            ),
        }

    def _function(self, function: Function) -> str:
        counts = operations_of(function)
        operations = {"total": counts.total()} | {name: counts[name] for name in OPERATIONS}
        labels = pprint.pformat(function.labels, width=88, compact=True)
        doc = f"{function.doc}\n\nResult (..., {_shape(function)}); {count_line(function)}."
        return (
            f'{function.name} = _model.function(\n    "{function.name}",\n    {function.shape!r},\n'
            f"{textwrap.indent(labels, '    ')},\n    {operations!r},\n"
            f'    """{doc}""",\n)'
        )


def _shape(function: Function) -> str:
    return ", ".join(str(n) for n in function.shape)


def _fill(text: str, indent: int) -> str:
    pad = " " * indent
    return textwrap.fill(text, 96, initial_indent=pad, subsequent_indent=pad)


# Whose guards an integration has to know: what it evaluates, what it puts out, what places bodies.
_OF_A_SIMULATION = ("rhs", "signals", "positions", "orientations")


def _acting(model: GeneratedModel) -> dict[str, tuple[int, ...]]:
    """Return the places of the guards that act in some of the functions."""
    places = {guard.name: place for place, guard in enumerate(model.guards)}
    return {
        name: tuple(sorted(places[guard.name] for guard in model.functions[name].guards))
        for name in _OF_A_SIMULATION
        if name in model.functions
    }


def _inputs(entries: tuple[Input, ...]) -> dict[str, dict[str, str | None]]:
    return {
        e.name: {"unit": e.unit, "meaning": e.meaning, "derivative_of": e.derivative_of}
        for e in entries
    }


def _described(entries: tuple[Entry, ...]) -> dict[str, dict[str, str]]:
    return {e.name: {"unit": e.unit, "meaning": e.meaning} for e in entries}
