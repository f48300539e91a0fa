"""Numbers of a whole batch for code that was written for one number.

A `BatchNumber` is used instead of a float: it has a number for each member of a batch, and
arithmetic acts on each. A comparison has one answer, since code branches on it: that of the first
member. The `BatchMask` excludes members with another answer, and these are computed one by one. So
code for one runs once for many, and no member has a result of a branch of others.

The functions below are those of `math` and NumPy for floats, with the same bits, and apply the same
functions of `math` to every element of a batch.
"""

import math
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .named_types import Array


class BatchMask:
    """The members of a batch that are computed together.

    `valid`, (count,), is False for members that took another branch than the first.
    """

    def __init__(self, count: int) -> None:
        self.valid = np.ones(count, dtype=bool)

    def decide(self, answers: NDArray[np.bool_]) -> bool:
        """Return the answer of the first member, and exclude those with another one."""
        self.valid &= answers == answers[0]
        return bool(answers[0])


def _arithmetic(operation: Callable[[Any, Any], Any]) -> Callable[[Any, Any], Any]:
    def method(self: "BatchNumber", other: Any) -> Any:
        # NumPy then makes an array of batch numbers
        if isinstance(other, np.ndarray):
            return NotImplemented
        with np.errstate(all="ignore"):  # members with NaN or infinity are excluded later
            return self.of(operation(self.values, other_values(other)))

    return method


def _comparison(question: Callable[[Any, Any], Any]) -> Callable[[Any, Any], Any]:
    def method(self: "BatchNumber", other: Any) -> bool:
        return self.mask.decide(question(self.values, other_values(other)))

    return method


class BatchNumber:
    """A number for each member of a batch, (count,); all numbers of a batch share its mask."""

    __slots__ = ("mask", "values")

    def __init__(self, values: Array, mask: BatchMask) -> None:
        self.values, self.mask = values, mask

    def of(self, values: Array) -> "BatchNumber":
        """Return another number of the same batch."""
        return BatchNumber(values, self.mask)

    def __repr__(self) -> str:
        return f"<BatchNumber from {self.values[0]}>"

    def __format__(self, how: str) -> str:
        return format(float(self.values[0]), how)

    __add__ = __radd__ = _arithmetic(np.add)
    __mul__ = __rmul__ = _arithmetic(np.multiply)
    __sub__ = _arithmetic(np.subtract)
    __rsub__ = _arithmetic(lambda a, b: b - a)
    __truediv__ = _arithmetic(np.divide)
    __rtruediv__ = _arithmetic(lambda a, b: b / a)
    __pow__ = _arithmetic(np.power)

    __lt__ = _comparison(np.less)
    __le__ = _comparison(np.less_equal)
    __gt__ = _comparison(np.greater)
    __ge__ = _comparison(np.greater_equal)
    __eq__ = _comparison(np.equal)
    __ne__ = _comparison(np.not_equal)
    __hash__: Any = None  # not hashable: some members may be equal, others not

    def __neg__(self) -> "BatchNumber":
        return self.of(-self.values)

    def __abs__(self) -> "BatchNumber":
        return self.of(np.abs(self.values))

    def __bool__(self) -> bool:
        return self.mask.decide(self.values != 0.0)


def other_values(other: Any) -> Any:
    """Return the values of a batch number, or any other operand unchanged."""
    return other.values if isinstance(other, BatchNumber) else other


def _of_a_batch(values: Iterable[Any]) -> BatchNumber | None:
    return next((value for value in values if isinstance(value, BatchNumber)), None)


def each(function: Callable[..., float], *values: Any) -> Any:
    """Return a function of floats, in a batch for each member."""
    column = _of_a_batch(values)
    if column is None:
        return function(*values)
    count = column.values.size
    rows = [np.broadcast_to(other_values(value), count).tolist() for value in values]
    try:
        return column.of(np.fromiter(map(function, *rows), np.float64, count))
    except (ValueError, OverflowError):  # of some member
        return column.of(np.array([_or_nan(function, *row) for row in zip(*rows, strict=True)]))


def _or_nan(function: Callable[..., float], *values: float) -> float:
    try:
        return function(*values)
    except (ValueError, OverflowError):
        return math.nan


def number(value: Any) -> Any:
    """Return a float, or a batch number unchanged."""
    return value if isinstance(value, BatchNumber) else float(value)


def hypot(*values: Any) -> Any:
    """Return the length of a vector of these components."""
    return each(math.hypot, *values)


def atan2(y: Any, x: Any) -> Any:
    """Return the angle of a direction in a plane [rad]."""
    return each(math.atan2, y, x)


def tan(angle: Any) -> Any:
    """Return the tangent of an angle [rad]."""
    return each(math.tan, angle)


def radians(angle: Any) -> Any:
    """Return an angle in radians."""
    return each(math.radians, angle)


def degrees(angle: Any) -> Any:
    """Return an angle in degrees."""
    return each(math.degrees, angle)


def length(vector: Any) -> Any:
    """Return the length of a vector; for floats by `numpy.linalg.norm`."""
    if _of_a_batch(vector) is None:
        return float(np.linalg.norm(vector))
    square: Any = sum(component * component for component in vector)
    return square.of(np.sqrt(square.values))


def greatest(values: Iterable[Any]) -> Any:
    """Return the greatest of some numbers, in a batch for each member."""
    found = list(values)
    column = _of_a_batch(found)
    if column is None:
        return max(found)
    return column.of(np.maximum.reduce(np.broadcast_arrays(*map(other_values, found))))


def sorted_moments(matrix: Any) -> tuple[Any, Any, Any]:
    """Return the eigenvalues of a symmetric 3 x 3 matrix in ascending order."""
    column = _of_a_batch(value for row in matrix for value in row)
    low: Any
    middle: Any
    high: Any
    moments = np.linalg.eigvalsh(stacked(matrix))
    if column is None:
        low, middle, high = (float(moment) for moment in moments)
        return low, middle, high
    low, middle, high = (column.of(np.array(row)) for row in np.moveaxis(moments, -1, 0))
    return low, middle, high


def least_singular_value(matrix: Any) -> Any:
    """Return the smallest singular value of a matrix."""
    column = _of_a_batch(value for row in matrix for value in row)
    least = np.linalg.svd(stacked(matrix), compute_uv=False)[..., -1]
    return float(least) if column is None else column.of(np.array(least))


def stacked(values: Any) -> Array:
    """Return values as an array of their shape, in a batch with (count,) in front of it."""
    array = np.asarray(values)
    if array.dtype != object:
        return array.astype(np.float64, copy=False)
    column = _of_a_batch(array.flat)
    if column is None:
        return array.astype(np.float64)
    rows = [np.broadcast_to(other_values(v), column.values.size) for v in array.flat]
    return np.stack(rows, axis=-1).reshape(column.values.size, *array.shape)


def spread(values: Any) -> Array:
    """Return values with shape (count, 1, ...) in a batch, to broadcast over positions."""
    array = stacked(values)
    return array if array.ndim == np.ndim(values) else array[:, None]
