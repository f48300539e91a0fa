"""Derivatives with respect to parameters, state and inputs: functions emitted on request.

Constants are computed from parameters by one function, and everything else from constants by
others; so are their derivatives. Along a direction, `prepare_tangent` returns the change of the
constants, and ``rhs_tangent`` the resulting change of the right-hand side. Of a weighted sum of
results, ``rhs_adjoint`` returns the derivatives with respect to constants, state and inputs, and
`prepare_adjoint` converts those with respect to constants to those with respect to parameters.

They are called like all other functions. Their further arguments are in the same arrays, after the
values: `Behind`.
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
"""Functions to differentiate: all but derivatives, and parts of the equations."""


@dataclass(frozen=True)
class Behind:
    """Names behind the values in an array that a function reads."""

    # names of the derivatives of all values along a direction, in their order: for tangents
    directions: tuple[str, ...]
    weights: tuple[str, ...] = ()  # names of the weights of results, in their order: for adjoints


@dataclass(frozen=True)
class ParameterDerivatives:
    """The functions, and the names of their arguments."""

    of_parameters: tuple[Function, ...] = ()  # functions that read parameters
    functions: tuple[Function, ...] = ()  # those that read constants, state and inputs
    behind: Mapping[str, Behind] = field(default_factory=dict)  # names behind the values, by array

    def weights(self, array: str) -> tuple[str, ...]:
        """Return the names of the weights in an array; their number depends on the call."""
        return self.behind[array].weights if array in self.behind else ()

    def places(self, array: str) -> dict[str, int]:
        """Return the positions of the names behind the values in an array."""
        if array not in self.behind:
            return {}
        behind = self.behind[array]
        start = len(behind.directions)
        groups = behind.directions, behind.weights
        return {name: start + i for names in groups for i, name in enumerate(names)}

    def stages(self, stages: Iterable[Stage]) -> Iterator[Stage]:
        """Yield the tangents of functions that are computed together, also together."""
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
    """Derive the functions of a model, of which `prepare` and `design` are those of parameters.

    `arrays` are the names of the elements of ``parameters``, ``constants``, ``state`` and
    ``inputs``, in order.
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
    """Return the names behind the values of each array."""
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
        f"Derivatives of a weighted sum of {function.name} with respect to {what}; the weights "
        f"follow the {array}."
    )
    return adjoint(function, [sp.Symbol(name) for name in by], weights, doc)


def _needed_of(prepare: Function, functions: Iterable[Function]) -> Function:
    """Return the constants that functions read, and zero for the others.

    Those are only checked: distances that vanish have no derivative.
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
    """Yield the names of all symbols of a function."""
    yield from (symbol.name for symbol in function.free_symbols)
    yield from (step.symbol.name for step in function.steps)


def _unused(start: str, names: Collection[str]) -> str:
    """Return a beginning that no name has."""
    while any(name.startswith(start) for name in names):
        start = f"{start}_"
    return start
