"""Descriptions of a model for several back ends: its hash, its counts, its iterations."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import sympy as sp

from ...equations.following import CONVERGED, ITERATIONS
from ..program.functions import Guarded, IsPositive, Positive, SignOf
from .counting import OPERATIONS, operations_of
from .text import Dialect, written

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ..equations.outputs import Derivation
    from ..program.function import Function, IterationBlock, Stage

GENERATOR_VERSION = "0.1.0"

ELEMENTARY = "elementary.h"
"""The header of elementary functions, which all emitted C includes."""

_hashes: WeakKeyDictionary[Derivation, str] = WeakKeyDictionary()

FORMULA = Dialect(
    {
        sp.sin: "sin({})",
        sp.cos: "cos({})",
        sp.asin: "asin({})",
        sp.atan2: "atan2({}, {})",
        sp.exp: "exp({})",
        sp.log: "log({})",
        Guarded: "at_least({}, {})",
        SignOf: "copysign(1.0, {})",
        Positive: "at_least({}, 0.0)",
        IsPositive: "is_positive({})",
    },
    root="sqrt({})",
    component="{}.at[{}]",
)
"""Syntax of C, also for formulas in reports, and for hashes."""


def count_line(function: Function | Stage) -> str:
    """Describe the operations of a function in one line."""
    counts = operations_of(function)
    parts = ", ".join(f"{counts[name]} {name}" for name in OPERATIONS if counts[name])
    line = f"{counts.total()} operations ({parts or 'none'})"
    iterating = "; iterates: " + ", ".join(block.name for block in function.blocks)
    return line + iterating if function.blocks else line


def iteration_note(derivation: Derivation) -> str:
    """Return a note on the loops that are solved by iteration; empty without any."""
    blocks = blocks_of(derivation.functions.values())
    if not blocks:
        return ""
    found = "; ".join(block.doc for block in blocks)
    return (
        f"Some loops of this model are solved by iteration. Newton's method finds {found}: in "
        f"stages from the design position, in at most {ITERATIONS} iterations in total, until a "
        f"correction is below {CONVERGED}. A status bit reports a failure. Operation counts are "
        "those of one iteration."
    )


def blocks_of(functions: Iterable[Function | Stage]) -> list[IterationBlock]:
    """Return the iterations of functions, each once, behind those that it calls."""
    found: dict[str, IterationBlock] = {}
    for block in (b for f in functions for b in f.blocks):
        found |= {inner.name: inner for inner in blocks_of([block.once])} | {block.name: block}
    return list(found.values())


def emitted_names(derivation: Derivation) -> list[str]:
    """Return the names of all functions, those of parameters first."""
    of_parameters = (derivation.design, *derivation.by_parameters.of_parameters)
    return ["prepare", *(function.name for function in of_parameters), *derivation.emitted]


def mechanism_hash(derivation: Derivation) -> str:
    """Return a hash of all inputs of the emitted arithmetic; computed once."""
    if derivation not in _hashes:
        _hashes[derivation] = _hash(derivation)
    return _hashes[derivation]


def _hash(derivation: Derivation) -> str:
    digest = hashlib.sha256()
    for entries in (derivation.parameters, derivation.state, derivation.inputs):
        digest.update(f"{','.join(entry.name for entry in entries)};".encode())
    blocks = blocks_of(derivation.functions.values())
    once = (block.once for block in blocks)
    for function in (derivation.prepare, derivation.design, *once, *derivation.emitted.values()):
        digest.update(function.name.encode())
        steps, results = written(function, FORMULA)
        for step in steps:
            digest.update(f"{step.name}={step.text};".encode())
        for text in results:
            digest.update(f"{text};".encode())
    return digest.hexdigest()[:16]


def reads_given(function: Function | Stage) -> bool:
    """Return whether a function has relative coordinates as a separate argument."""
    return any(s.name.startswith("given_") for s in function.free_symbols)
