"""Exact derivatives with respect to parameters, states and inputs: directions and gradients."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..core.errors import InputError
from ..core.named_types import Array, ArrayLike
from ..core.validator import Validator
from ..equations.directions import Directions
from .system import System, checked_point


def derivative(
    system: System,
    function: str,
    along: Mapping[str, ArrayLike],
    state: ArrayLike,
    inputs: ArrayLike | None = None,
) -> Array:
    """Return the exact derivative of a function of the equations along a direction.

    Parameters
    ----------
    system : System
        Equations that were compiled with ``parameter_derivatives=True``.
    function : str
        ``rhs``, ``signals``, ``relative_coordinates``, ``positions``, ``orientations`` or
        ``velocities``.
    along : mapping of str to array_like
        The direction: changes of parameters, elements of the state and inputs by name, SI units;
        zero for names that are left out. Arrays are broadcast with the leading dimensions of the
        state, for many directions in one call.
    state, inputs : array_like
        State and inputs at which the derivative is taken, as for `System.evaluate`.

    Returns
    -------
    ndarray
        Leading dimensions, then the shape of the function's result.

    Raises
    ------
    InputError
        If an argument cannot be used; or if a direction breaks an assumption of the equations, such
        as that of parallel hinges: without it they are meaningless.
    ClosureError, ModelError
        If the function has no result at this state.

    Notes
    -----
    The program of the function is differentiated step by step (forward mode), without finite
    differences. It takes three times the operations of the function.

    Examples
    --------
    >>> import kintrafo
    >>> from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
    >>> four_bar = kintrafo.System(kintrafo.compile(FOUR_BAR, parameter_derivatives=True))
    >>> at = four_bar.state(crank_angle=0.3)
    >>> kintrafo.derivative(four_bar, "relative_coordinates", {"crank_angle": 1.0}, at).round(4)
    array([ 1.    , -1.0119,  0.3715])
    """
    with Validator("derivative") as given:
        directions = checked_directions(given, system)
        if not given.failed:
            given.among("function", function, directions.of)
            named = given.mapping("along", along, "names and numbers")
            changes = _changes(given, system, named)
            values = checked_point(given, system, state, inputs)
            _broadcast(given, "along, state and inputs", [*changes, *values])
    direction, of_state, of_inputs = changes
    parameters = kept_together(system, directions, direction)
    of_constants = directions.of_parameters(
        "prepare_tangent", parameters, direction, system.constants.size
    )
    return directions.tangent(
        function, (system.constants, *values), (of_constants, of_state, of_inputs)
    )


def gradient(
    system: System,
    function: str,
    weights: ArrayLike,
    state: ArrayLike,
    inputs: ArrayLike | None = None,
) -> dict[str, Array]:
    """Return the exact gradient of a weighted sum of the elements of a function's result.

    It is the gradient with respect to all parameters, elements of the state and inputs.

    Parameters
    ----------
    system : System
        Equations that were compiled with ``parameter_derivatives=True``.
    function : str
        Name of the differentiated function, such as 'rhs'.
    weights : array_like
        Weights of the elements of the result, in its shape; more dimensions in front are broadcast
        with the leading ones of the state.
    state, inputs : array_like
        State and inputs at which the derivative is taken, as for `System.evaluate`.

    Returns
    -------
    dict of str to ndarray
        By the names of parameters, states and inputs: derivatives of the sum, SI units, over the
        leading dimensions. NaN for a parameter that cannot change alone, because that would break
        an assumption of the equations; `derivative` has directions of several parameters.

    Raises
    ------
    InputError
        If an argument cannot be used.
    ClosureError, ModelError
        If the function has no result at this state.

    Notes
    -----
    The program is differentiated backwards (reverse mode): it takes three times the operations of
    the function and of `prepare` for any number of parameters.

    Examples
    --------
    >>> import kintrafo
    >>> from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
    >>> four_bar = kintrafo.System(kintrafo.compile(FOUR_BAR, parameter_derivatives=True))
    >>> by = kintrafo.gradient(four_bar, "rhs", [0.0, 1.0], four_bar.state(crank_angle=0.3))
    >>> len(by), round(float(by["crank_mass"]), 4)
    (28, 23.239)
    """
    with Validator("gradient") as given:
        directions = checked_directions(given, system)
        if not given.failed:
            given.among("function", function, directions.of)
            values = checked_point(given, system, state, inputs)
        if not given.failed:
            shape = getattr(system.equations, function).shape
            rows = _flat(given, weights, shape)
            _broadcast(given, "weights, state and inputs", [rows, *values])
    by_constants, *rest = directions.adjoint(function, (system.constants, *values), rows)
    parameters = np.array([*system.parameters.values()])
    by_parameters = directions.of_parameters(
        "prepare_adjoint", parameters, by_constants, parameters.size
    )
    by_parameters[..., directions.bound(parameters)] = np.nan
    found = (by_parameters, *rest)
    return {
        name: array[..., i]
        for names, array in zip(_names(system), found, strict=True)
        for i, name in enumerate(names)
    }


def design_derivative(system: System, along: Mapping[str, ArrayLike]) -> dict[str, Array]:
    """Return derivatives of the state at the design position with respect to parameters.

    Parameters
    ----------
    system : System
        Equations that were compiled with ``parameter_derivatives=True``.
    along : mapping of str to array_like
        The direction: changes of parameters by name, SI units.

    Returns
    -------
    dict of str to ndarray
        Derivatives of the elements of the state, by name. ``along | design_derivative(system,
        along)`` is the direction for `derivative` in which the design position changes with the
        parameters.

    Raises
    ------
    InputError
        If an argument cannot be used, or the equations have no such derivatives.
    """
    with Validator("design_derivative") as given:
        directions = checked_directions(given, system)
        if not given.failed:
            named = given.mapping("along", along, "names and numbers")
            for name in named:
                given.among("parameter", name, system.parameters)
        if not given.failed:
            direction, *_ = _changes(given, system, named)
    parameters = kept_together(system, directions, direction)
    count = len(system.state_names)
    found = directions.of_parameters("design_state_tangent", parameters, direction, count)
    return {name: found[..., i] for i, name in enumerate(system.state_names)}


# -- arguments ------------------------------------------------------------------------------------


def checked_directions(given: Validator, system: Any) -> Any:
    """Return the derivatives of a system's equations; refuse a system without any."""
    given.instance("system", system, System, System.NEEDED)
    if not given.failed and not system.equations.DIRECTIONS.of:
        given.fail(
            f"{system.equations.NAME} has no derivatives with respect to parameters. Compile the "
            "mechanism with kintrafo.compile(..., parameter_derivatives=True)."
        )
    return None if given.failed else system.equations.DIRECTIONS


def _names(system: System) -> tuple[tuple[str, ...], ...]:
    return tuple(system.parameters), system.state_names, system.input_names


def _changes(given: Validator, system: System, along: Mapping[str, Any]) -> list[Array]:
    """Return the direction as arrays of parameters, state and inputs."""
    known = [name for names in _names(system) for name in names]
    checked = {
        given.among("name", name, known): given.array(f"along {name}", value, empty=True)
        for name, value in along.items()
    }
    if not given.failed:
        given.broadcast("along", [value.shape for value in checked.values()])
    if given.failed:
        return []
    found = []
    for names in _names(system):
        own = {name: value for name, value in checked.items() if name in names}
        lead = np.broadcast_shapes(*(value.shape for value in own.values()))
        direction = np.zeros((*lead, len(names)))
        for name, value in own.items():
            direction[..., names.index(name)] = value
        found.append(direction)
    return found


def direction_of(system: System, along: Mapping[str, float]) -> list[Array]:
    """Return a checked direction as arrays of parameters, state and inputs."""
    return [np.array([along.get(name, 0.0) for name in names]) for names in _names(system)]


def _flat(given: Validator, weights: Any, shape: tuple[int, ...]) -> Array:
    rows = given.array("weights", weights, empty=True)
    if rows.shape[-len(shape) :] != shape:
        given.fail(f"weights have the shape {rows.shape}: (..., {', '.join(map(str, shape))})")
        return np.zeros(1)
    return rows.reshape(*rows.shape[: -len(shape)], -1)


def _broadcast(given: Validator, what: str, arrays: list[Array]) -> None:
    if not given.failed:
        given.broadcast(what, [array.shape[:-1] for array in arrays])


def kept_together(system: System, directions: Directions, direction: Array) -> Array:
    """Return the parameters of a system; refuse directions that break its assumptions."""
    parameters = np.array([*system.parameters.values()])
    of_bound = np.where(directions.bound(parameters), direction, 0.0)
    for index in np.ndindex(direction.shape[:-1]):
        broken = directions.broken(parameters, of_bound[index])
        if broken:
            problem = (
                f"along: this direction leaves the mechanisms that the equations are of: {broken}. "
                "Move what keeps it together, too."
            )
            raise InputError([problem], "derivative")
    return parameters
