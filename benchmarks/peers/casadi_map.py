"""CasADi: CVODES with compiled functions, mapped over cars on several threads."""

from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np

from .casadi_tree import build, expert_numbers
from .compiled import FLAGS

Array = np.ndarray[Any, np.dtype[np.float64]]

# The formulation and the settings that are the fastest of `make benchmark-peers`.
_FORMULATION = "implicit"
_OPTIONS = {
    "linear_multistep_method": "adams",
    "nonlinear_solver_iteration": "functional",
    "max_num_steps": 100000,
    "jit": True,
    "compiler": "shell",
    "jit_options": {"flags": list(FLAGS["native"])},
}


def mapped(
    start: Array,
    span: tuple[float, float],
    samples: Array,
    cars: Callable[[int], dict[str, Array]],
    threads: int,
) -> Callable[[int, float], Array]:
    """Return what simulates many cars.

    Parameters
    ----------
    start : ndarray
        Of all cars.
    span : tuple of float
        First and last time [s].
    samples : ndarray
        Times of the outputs, of which the first is the start [s].
    cars : callable
        From a number of cars to their parameters by name.
    threads : int
    """
    model = build(_FORMULATION, literal=False)
    state, given = ca.SX.sym("x", 4), ca.SX.sym("p", model.constants.size)
    equations = {"x": state, "p": given, "ode": model.function(state, given)}
    solvers: dict[tuple[int, float], Any] = {}

    def solve(number: int, tolerance: float) -> Array:
        if (number, tolerance) not in solvers:  # compiled when it is first used
            options = {**_OPTIONS, "reltol": tolerance, "abstol": tolerance}
            one = ca.integrator("car", "cvodes", equations, span[0], samples[1:].tolist(), options)
            solvers[number, tolerance] = one.map(number, "thread", threads)
        constants = _constants(model.constants, cars(number))
        found = solvers[number, tolerance](x0=ca.repmat(ca.DM(start), 1, number), p=constants)
        angles = np.asarray(found["xf"])[0].reshape(number, samples.size - 1)
        return np.concatenate((np.full((number, 1), start[0]), angles), axis=1)

    return solve


def _constants(reference: Array, cars: dict[str, Array]) -> Array:
    """Return the constants of every car in a column."""
    places, first = {}, 0
    for name, value in expert_numbers().items():
        places[name] = first
        first += np.size(value)
    columns = np.repeat(reference[:, None], len(next(iter(cars.values()))), axis=1)
    for name, values in cars.items():
        columns[places[name]] = values
    return columns
