"""Derivatives of the functions of a model: along directions, and of weighted sums of results.

The compiled functions read directions and weights after the values in the same arrays; see
`kintrafo.generator.equations.parameter_derivatives`.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.named_types import Array
from .errors import ModelError, place_of

TANGENTS, ADJOINTS = "tangents", "adjoints"
"""Parts of the emitted code that have these functions."""

_GEOMETRY = ("m", "rad", "1")
# A step along a direction, relative to the greatest length. Quantities that are assumed to be zero
# are checked to 1e-9: a direction that breaks the assumption changes one by some 1e-6, and a
# direction that keeps it by the square of that.
_STEP = 1e-6


class WiderArrays:
    """The model of a derivative, whose arrays have more elements than the values.

    `more` are the numbers of elements that follow the constants, the state and the inputs.
    """

    def __init__(self, model: Any, more: tuple[int, ...]) -> None:
        self._model = model
        self.name: str = model.name
        self.widths = tuple(a + b for a, b in zip(model.widths, more, strict=True))

    def refuse(
        self,
        function: str,
        status: int,
        constants: Array,
        state: Array,
        inputs: Array,
        index: tuple[int, ...],
    ) -> None:
        """Raise the error of a status word with the values alone."""
        arrays = zip((constants, state, inputs), self._model.widths, strict=True)
        self._model.refuse(function, status, *(array[:width] for array, width in arrays), index)


class Directions:
    """Derivatives of a model with respect to everything that its functions read.

    `calls` are the compiled functions, none if the model was compiled without derivatives; `of` are
    the names of the functions that have derivatives.
    """

    def __init__(self, model: Any, calls: Mapping[str, Any]) -> None:
        self._model, self._calls = model, calls
        known = model.manifest["functions"]
        self.of = tuple(name for name in known if f"{name}_tangent" in known)
        self._zero = [a["meaning"] for a in model.manifest["assumptions"] if "least" not in a]

    def of_parameters(self, function: str, parameters: Array, behind: Array, size: int) -> Array:
        """Return the results of a function of parameters, shape (..., size).

        The function is ``prepare_tangent``, ``prepare_adjoint`` or ``design_state_tangent``;
        `behind` are directions or weights, (..., n). Raises `ModelError` if a result is not finite.
        """
        found = np.empty((*behind.shape[:-1], size))
        for index in np.ndindex(behind.shape[:-1]):
            given, one = np.concatenate([parameters, behind[index]]), np.empty(size)
            if self._model.call_of_parameters(function, given, one):
                where = f"{self._model.name}.{function}{place_of(index)}"
                raise ModelError(f"{where}: what constants change by is not finite")
            found[index] = one
        return found

    def tangent(
        self, function: str, values: tuple[Array, ...], directions: tuple[Array, ...]
    ) -> Array:
        """Return the derivative of a function along directions.

        `values` are constants, state and inputs, `directions` their changes; leading dimensions are
        broadcast.
        """
        constants, state, inputs = map(_joined, values, directions)
        return self._calls[f"{function}_tangent"](state, inputs, constants)

    def adjoint(self, function: str, values: tuple[Array, ...], weights: Array) -> list[Array]:
        """Return derivatives of a weighted sum of results by constants, state and inputs.

        `values` are these three; `weights` have the shape (..., results).
        """
        constants, state, inputs = values
        call = self._calls[f"{function}_adjoint"]
        found: Array = call(state, _joined(inputs, weights), constants)
        return np.split(found, np.cumsum(self._model.widths)[:-1], axis=-1)

    def bound(self, parameters: Array) -> NDArray[np.bool_]:
        """Return which parameters, shape (parameters,), can change only with others."""
        units = np.eye(parameters.size)
        if not self._zero:
            return np.zeros(parameters.size, dtype=bool)
        return np.array([bool(self.broken(parameters, unit)) for unit in units])

    def broken(self, parameters: Array, direction: Array) -> str:
        """Return the assumption of the equations that a direction breaks; empty if it keeps all.

        The direction, (parameters,), changes only `bound` parameters: beside others they could be
        too small.
        """
        if not self._zero or not direction.any():
            return ""
        units = [entry["unit"] for entry in self._model.manifest["parameters"].values()]
        size = max((abs(d) for d, u in zip(direction, units, strict=True) if u in _GEOMETRY))
        if size == 0.0:
            return ""
        length = max(abs(p) for p, u in zip(parameters, units, strict=True) if u == "m")
        moved = parameters + _STEP * length / size * direction
        constants = np.empty(len(self._model.constant_names))
        number = self._model.call_of_parameters("prepare", moved, constants) - constants.size
        if not 0 < number <= len(self._zero):
            return ""
        return str(self._zero[number - 1])


def _joined(values: Array, behind: Array) -> Array:
    """Return values followed by others along the last axis."""
    lead = np.broadcast_shapes(values.shape[:-1], behind.shape[:-1])
    parts = [np.broadcast_to(array, (*lead, array.shape[-1])) for array in (values, behind)]
    return np.concatenate(parts, axis=-1)
