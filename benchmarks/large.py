"""One large mechanism, from its declaration to functions that can be called: a Stewart platform.

Part of ``python -m benchmarks.growth``. The Jacobian is held against differences of the compiled
right-hand side, with an error that follows from their steps.
"""

from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from kintrafo import System
from kintrafo.generator import Formulation
from kintrafo.generator.backends.counting import operations_of
from kintrafo.generator.equations.outputs import generate
from kintrafo.systems.compile.build import build
from kintrafo.systems.compile.compiler import Compiler
from kintrafo.systems.compile.loader import load
from sympy.core.cache import clear_cache

from .report import children_seconds, count, markdown_table, power, seconds_of, timing_of

Array = np.ndarray[Any, np.dtype[np.float64]]

BATCH = 200  # states in one call, so that Python's share of a call is small
STEP = 2e-3  # of the differences; their error is of the order of its eighth power
WEIGHTS = (672.0, -168.0, 32.0, -3.0)


@dataclass(frozen=True)
class Large:
    """What a large mechanism costs."""

    title: str
    # of one call of `rhs` (of a block that iterates, of one iteration) and of `rhs_jacobian`
    operations: int
    jacobian_operations: int
    # processor time of the derivation, of writing the C, and of the C compiler [s]
    derive: float
    write: float
    compile: float
    # processor time of one call of `rhs` and of `rhs_jacobian` [s]
    call: float
    jacobian_call: float
    error: float  # of the Jacobian, as a part of its greatest element


def measure(model: Formulation, compiler: Compiler, rounds: int, reach: float) -> Large:
    """Derive, compile and call a mechanism.

    Parameters
    ----------
    reach : float
        How far from the design position its coordinates are taken.
    """
    clear_cache()
    found: list[Any] = []
    children = children_seconds()
    derive = seconds_of(lambda: found.append(generate(model)))
    (derived,) = found
    with TemporaryDirectory() as folder:
        package = Path(folder) / f"{model.name}-large"
        package.mkdir()
        write = seconds_of(lambda: build(derived, package, compiler))
        module = load(package)
        compiling = children_seconds() - children
    system, random = System(module), np.random.default_rng(0)
    states = system.design_state + random.uniform(-reach, reach, (BATCH, len(module.STATE)))
    calls = {
        name: timing_of(
            [
                seconds_of(lambda name=name: getattr(module, name)(states, None, system.constants))
                for _ in range(rounds)
            ]
        )
        for name in ("rhs", "rhs_jacobian")
    }
    return Large(
        title=model.title,
        operations=operations_of(derived.functions["rhs"]).total(),
        jacobian_operations=operations_of(derived.functions["rhs_jacobian"]).total(),
        derive=derive,
        write=write,
        compile=compiling,
        call=calls["rhs"].least / BATCH,
        jacobian_call=calls["rhs_jacobian"].least / BATCH,
        error=max(_error(module, system, state) for state in states[:10]),
    )


def _error(module: Any, system: System, state: Array) -> float:
    """Return how far a Jacobian is from differences of the right-hand side over eight places."""
    shifts = STEP * np.eye(len(state))

    def rates(states: Array) -> Array:
        return np.asarray(module.rhs(states, None, system.constants))

    columns = sum(
        w * (rates(state + k * shifts) - rates(state - k * shifts))
        for k, w in enumerate(WEIGHTS, 1)
    ) / (840.0 * STEP)
    jacobian = np.asarray(module.rhs_jacobian(state, None, system.constants))
    return float(np.abs(jacobian - columns.T).max() / np.abs(jacobian).max())


def table(large: Large) -> str:
    """Return the results as Markdown."""
    operations = f"{count(large.operations)}, {count(large.jacobian_operations)}"
    calls = f"{1e6 * large.call:.2g}, {1e6 * large.jacobian_call:.2g}"
    whole = large.derive + large.write + large.compile
    rows = [
        ("operations of rhs, of its Jacobian", operations),
        ("derive [s]", f"{large.derive:.2g}"),
        ("write the C [s]", f"{large.write:.2g}"),
        ("compile [s]", f"{large.compile:.2g}"),
        ("from declaration to functions [s]", f"{whole:.2g}"),
        ("one rhs, one Jacobian [µs]", calls),
        ("error of the Jacobian", power(large.error)),
    ]
    return markdown_table((large.title, ""), rows)
