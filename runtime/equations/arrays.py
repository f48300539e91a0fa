"""Calls of the functions of a model that has no C code: the same programs, over NumPy arrays.

The functions of such a model take constants, state and inputs with any leading dimensions. They
return their results, and by the number of each guard whether its quantity is positive.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.named_types import Array
from .status import NOT_FINITE, bit_of

Code = Callable[..., tuple[tuple[Any, ...], dict[int, Any]]]


class ModelFunction:
    """A function of a model, with the interface of a compiled one but without an address."""

    def __init__(
        self,
        model: Any,
        name: str,
        code: Code,
        shape: tuple[int, ...],
        labels: tuple[str, ...],
        operations: dict[str, int],
        doc: str,
        stage: str,
        start: int,
        whole: int,
        mask: int,
    ) -> None:
        self._model, self._code, self._mask, self.stage = model, code, mask, stage
        self._whole, self._part = whole, slice(start, start + len(labels))
        self.name, self.shape, self.labels, self.operations = name, shape, labels, operations
        self.__doc__ = doc

    def __repr__(self) -> str:
        return f"<NumPy function {self._model.name}.{self.name}, result (..., {self.shape})>"

    def __call__(
        self,
        state: ArrayLike,
        inputs: ArrayLike | None = None,
        constants: ArrayLike | None = None,
    ) -> Array:
        """Evaluate the function; see the documentation of the model's module."""
        model = self._model
        arrays = [
            np.asarray(model.default_constants if constants is None else constants, dtype=float),
            np.asarray(state, dtype=float),
            np.asarray(model.no_inputs if inputs is None else inputs, dtype=float),
        ]
        for array, what, width in zip(
            arrays, ("constants", "state", "inputs"), model.widths, strict=True
        ):
            if array.shape[-1:] != (width,):
                raise ValueError(
                    f"{model.name}.{self.name}: the last dimension of {what} must be {width}, "
                    f"its shape is {array.shape}"
                )
        lead = np.broadcast_shapes(*(array.shape[:-1] for array in arrays))
        everything, status = _run(self._code, lead, self._whole, arrays)
        values = everything[..., self._part]
        finite = np.isfinite(values).all(axis=-1)  # another part may not be finite
        status &= np.where(finite, self._mask & ~NOT_FINITE, self._mask)
        for found in np.argwhere(status):
            index = tuple(map(int, found))
            one = [np.broadcast_to(a, lead + a.shape[-1:])[index] for a in arrays]
            model.refuse(self.name, int(status[index]), *one, index)
        return values.reshape(lead + self.shape)


def _run(
    code: Code, lead: tuple[int, ...], count: int, arrays: list[Array]
) -> tuple[Array, NDArray[np.int64]]:
    """Return results and status words, both with the leading dimensions in front."""
    values = np.empty((*lead, count))
    status = np.zeros(lead, dtype=np.int64)
    with np.errstate(all="ignore"):  # the status has the errors
        results, holds = code(*arrays)
        for k, result in enumerate(results):
            values[..., k] = result
        for place, positive in holds.items():
            status |= np.where(positive, 0, 1 << bit_of(place))
    status |= np.where(np.isfinite(values).all(axis=-1), 0, NOT_FINITE)
    return values, status


def _fill(code: Code, arrays: list[Array], out: Array) -> int:
    values, status = _run(code, (), out.size, arrays)
    out[:] = values
    return int(status)


def call_prepare(code: Code, parameters: Array, constants: Array) -> int:
    """Fill the constants; return 0 or the number of an error, as the C code does."""
    with np.errstate(all="ignore"):
        constants[:], holds = code(parameters)
    broken = [place for place, good in holds.items() if not good]
    if broken:
        return constants.size + broken[0] + 1
    bad = np.flatnonzero(~np.isfinite(constants))
    return int(bad[0]) + 1 if bad.size else 0


def call_margins(code: Code, constants: Array, state: Array, inputs: Array, out: Array) -> int:
    """Fill the margins and return the status word."""
    return _fill(code, [constants, state, inputs], out)


def call_residuals(
    code: Code, constants: Array, state: Array, inputs: Array, given: Array, out: Array
) -> int:
    """Fill the closure residuals and return the status word."""
    return _fill(code, [constants, state, inputs, given], out)
