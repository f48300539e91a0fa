"""Closure residuals of given relative coordinates."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.named_types import Array
from .errors import ModelError, place_of


class Residuals:
    """Closure residuals g(beta, q) of given relative coordinates (Eqs. 4 to 13).

    Called as ``residuals(given, state, inputs=None, constants=None)``; ``given`` and the result are
    in the order and units of ``RELATIVE_COORDINATES``, after the leading dimensions. For an angle
    that the paper gives by its sine, the residual is that of the sine.
    """

    def __init__(self, model: Any) -> None:
        self._model = model

    def __call__(
        self,
        given: ArrayLike,
        state: ArrayLike,
        inputs: ArrayLike | None = None,
        constants: ArrayLike | None = None,
    ) -> Array:
        """Return the residuals, shape (..., number of relative coordinates)."""
        model = self._model
        arrays = {
            "given": (given, len(model.relative_names)),
            "constants": (
                model.default_constants if constants is None else constants,
                model.widths[0],
            ),
            "state": (state, model.widths[1]),
            "inputs": (model.no_inputs if inputs is None else inputs, model.widths[2]),
        }
        rows = {what: _rows(values, width, what) for what, (values, width) in arrays.items()}
        lead = np.broadcast_shapes(*(array.shape[:-1] for array in rows.values()))
        rows = {what: np.broadcast_to(a, (*lead, a.shape[-1])) for what, a in rows.items()}
        result = np.empty((*lead, len(model.relative_names)))
        for index in np.ndindex(lead):
            one = {what: np.ascontiguousarray(array[index]) for what, array in rows.items()}
            result[index] = self._one(one, tuple(map(int, index)))
        return result

    def _one(self, row: Mapping[str, Array], index: tuple[int, ...]) -> Array:
        model, beta = self._model, row["given"]
        bad = [n for n, v in zip(model.relative_names, beta, strict=True) if not np.isfinite(v)]
        if bad:
            message = f"{model.name}.residuals: NaN or infinite: {', '.join(bad)}{place_of(index)}"
            raise ModelError(message)
        c, y, u = row["constants"], row["state"], row["inputs"]
        out = np.empty(len(model.relative_names))
        status = model.call_residuals(c, y, u, beta, out)
        if status:
            model.refuse("residuals", status, c, y, u, index)
        return out


def _rows(values: ArrayLike, width: int, what: str) -> Array:
    array = np.asarray(values, dtype=np.float64)
    if array.shape[-1:] != (width,):
        message = f"{what}: the last dimension must be {width}, the shape is {array.shape}"
        raise ValueError(message)
    return array
