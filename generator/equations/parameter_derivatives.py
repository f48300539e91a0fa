"""Derivatives by parameters, state and inputs: functions that are emitted when asked for.

Constants are computed from parameters by one function, and everything else from constants by
others; so it is with their derivatives. Along a direction, `prepare_tangent` gives what constants
change by, and ``rhs_tangent`` what that does to the right-hand side. Of a weighted sum of results,
``rhs_adjoint`` gives the derivatives by constants, state and inputs, and `prepare_adjoint` makes
derivatives by parameters of those by constants.

They are called like all other functions. Their further arguments are in the same arrays, after
the values: `Behind`.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import chain
from typing import TYPE_CHECKING

import sympy as sp

from ...equations.directions import ADJOINTS, TANGENTS
from ..program.directions import TANGENT, adjoint, tangent
from ..program.function import Stage

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from ..program.function import Function

OF = ("rhs", "signals", "relative_coordinates", "positions", "orientations", "velocities")
"""What is differentiated: all but what is a derivative itself, or a part of the equations."""


@dataclass(frozen=True)
class Behind:
    """What follows the values in an array that a function reads.

    Attributes
    ----------
    directions
        Names of the derivatives of all values along a direction, in their order: for tangents.
    weights
        Names of the weights of results, in their order: for adjoints.
    """

    directions: tuple[str, ...]
    weights: tuple[str, ...] = ()


@dataclass(frozen=True)
class ParameterDerivatives:
    """The functions, and how what they read is called.

    Attributes
    ----------
    of_parameters
        Functions that read parameters.
    functions
        Those that read constants, state and inputs.
    behind
        What follows the values, by array.
    """

    of_parameters: tuple[Function, ...] = ()
    functions: tuple[Function, ...] = ()
    behind: Mapping[str, Behind] = field(default_factory=dict)

    def weights(self, array: str) -> tuple[str, ...]:
        """Return the names of the weights in an array; how many there are depends on the call."""
        return self.behind[array].weights if array in self.behind else ()

    def places(self, array: str) -> dict[str, int]:
        """Return the places of what follows the values in an array, by name."""
        if array not in self.behind:
            return {}
        behind = self.behind[array]
        start = len(behind.directions)
        groups = behind.directions, behind.weights
        return {name: start + i for names in groups for i, name in enumerate(names)}

    def stages(self, stages: Iterable[Stage]) -> Iterator[Stage]:
        """Yield tangents of what is computed together: they are computed together, too."""
        own = {function.name: function for function in self.functions}
        for stage in stages:
            names = (f"{member.name}_{TANGENT}" for member in stage.members)
            members = tuple(own[name] for name in names if name in own)
            if len(members) > 1:
                doc = f"Derivatives along a direction. {stage.doc}"
                yield Stage(f"{stage.name}_{TANGENT}", doc, members)


def derivatives_by_parameters(
    functions: Mapping[str, Function],
    prepare: Function,
    design: Function,
    arrays: Mapping[str, Sequence[str]],
) -> ParameterDerivatives:
    """Derive the functions.

    Parameters
    ----------
    functions
        Those of the model.
    prepare, design
        Its functions of parameters.
    arrays
        Names of what is in ``parameters``, ``constants``, ``state`` and ``inputs``, in order.
    """
    of = [functions[name] for name in OF if name in functions]
    behind = _behind(arrays, of, {*chain(*map(_names, (prepare, design, *of)))})
    prepare = _needed_of(prepare, of)
    direction = {
        sp.Symbol(name): sp.Symbol(along)
        for array, names in arrays.items()
        for name, along in zip(names, behind[array].directions, strict=True)
    }
    read = [n for array in ("constants", "state", "inputs") for n in arrays[array]]
    by_prepare = _adjoint(prepare, arrays["parameters"], behind["parameters"], "parameters")
    return ParameterDerivatives(
        (*(tangent(f, direction, _along(f.name)) for f in (prepare, design)), by_prepare),
        (
            *(replace(tangent(f, direction, _along(f.name)), part=TANGENTS) for f in of),
            *(replace(_adjoint(f, read, behind["inputs"], "inputs"), part=ADJOINTS) for f in of),
        ),
        behind,
    )


def _behind(
    arrays: Mapping[str, Sequence[str]], of: Iterable[Function], taken: Iterable[str]
) -> dict[str, Behind]:
    """Give names to what follows the values in each array."""
    known = {*taken, *chain(*arrays.values())}
    along, weight = (_unused(start, known) for start in ("along_", "weight_"))
    weights = {
        "parameters": len(arrays["constants"]),
        "inputs": max(function.size for function in of),
    }
    return {
        array: Behind(
            tuple(f"{along}{name}" for name in names),
            tuple(f"{weight}{i}" for i in range(weights.get(array, 0))),
        )
        for array, names in arrays.items()
    }


def _adjoint(function: Function, by: Sequence[str], behind: Behind, array: str) -> Function:
    weights = [sp.Symbol(name) for name in behind.weights[: function.size]]
    what = "parameters" if array == "parameters" else "constants, state and inputs"
    doc = (
        f"Derivatives of a weighted sum of {function.name} by {what}; the weights follow the "
        f"{array}."
    )
    return adjoint(function, [sp.Symbol(name) for name in by], weights, doc)


def _needed_of(prepare: Function, functions: Iterable[Function]) -> Function:
    """Return the constants that functions read; others, zero.

    Those are checked, and no more: distances that vanish have no derivative.
    """
    read = {symbol for function in functions for symbol in function.free_symbols}
    results = (
        result if sp.Symbol(label) in read else sp.Integer(0)
        for label, result in zip(prepare.labels, prepare.results, strict=True)
    )
    return replace(prepare, results=tuple(results))


def _along(name: str) -> str:
    return f"Derivative of {name} along a direction, which follows the values of each array."


def _names(function: Function) -> Iterator[str]:
    """Yield the names of all that is in a function."""
    yield from (symbol.name for symbol in function.free_symbols)
    yield from (step.symbol.name for step in function.steps)


def _unused(start: str, names: Collection[str]) -> str:
    """Return how no name begins."""
    while any(name.startswith(start) for name in names):
        start = f"{start}_"
    return start
