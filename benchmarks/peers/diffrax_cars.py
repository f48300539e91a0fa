"""diffrax: cars under JAX's `vmap`, compiled by XLA for the processor.

The right-hand side is the program that is printed for NumPy, called with jax.numpy instead. A
thousand cars are asked for at a time, from several threads: of all at once XLA's loop takes twice
as long for each, and on one core.
"""

import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from types import FunctionType
from typing import Any

import diffrax
import jax
import jax.numpy as jnp
import kintrafo
import numpy as np
from kintrafo.generator.mechanisms import MODELS

jax.config.update("jax_enable_x64", True)

Array = np.ndarray[Any, np.dtype[np.float64]]

_RHS = "rhs_rack_held"
_TOGETHER = 1000


def mapped(
    model: kintrafo.Model,
    start: Array,
    span: tuple[float, float],
    samples: Array,
    cars: Callable[[int], dict[str, Array]],
    threads: int,
) -> Callable[[int, float], Array]:
    """Return what simulates many cars.

    Parameters
    ----------
    model : Model
        What they are otherwise.
    start : ndarray
        Of all cars.
    span : tuple of float
        First and last time [s].
    samples : ndarray
        Times of the outputs [s].
    cars : callable
        From a number of cars to their parameters by name.
    threads : int
    """
    declared = next(m for m in MODELS if m.name == model.equations.NAME)
    equations = kintrafo.compile(declared, backend="numpy")
    printed: Any = sys.modules[f"{equations.__name__.rpartition('.')[0]}._{declared.name}"]
    rhs = FunctionType(getattr(printed, _RHS).__code__, {"np": jnp})
    inputs = jnp.zeros(len(model.input_names))

    def rates(_: Any, state: Any, constants: Any) -> Any:
        results, _guards = rhs(constants, state, inputs)
        return jnp.stack(results)

    def angles(constants: Any, tolerance: Any) -> Any:
        found = diffrax.diffeqsolve(
            diffrax.ODETerm(rates),
            diffrax.Tsit5(),
            *span,
            dt0=None,
            y0=jnp.asarray(start),
            args=constants,
            saveat=diffrax.SaveAt(ts=samples, fn=lambda _t, state, _constants: state[0]),
            stepsize_controller=diffrax.PIDController(rtol=tolerance, atol=tolerance),
        )
        return found.ys

    compiled = jax.jit(jax.vmap(angles, in_axes=(0, None)))

    @cache  # not what is measured
    def prepared(number: int) -> Array:
        own = cars(number)
        rows = [dict(zip(own, values, strict=True)) for values in zip(*own.values(), strict=True)]
        return np.array([model.equations.prepare(model.parameters | row) for row in rows])

    def solve(number: int, tolerance: float) -> Array:
        constants = prepared(number)
        parts = [constants[i : i + _TOGETHER] for i in range(0, number, _TOGETHER)]
        with ThreadPoolExecutor(threads) as pool:
            found = pool.map(lambda part: np.asarray(compiled(part, tolerance)), parts)
        return np.concatenate(list(found))

    return solve
