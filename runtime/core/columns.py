"""Numbers of many at once where code was written for one.

A `Column` replaces a float: it has a number for each of many, and arithmetic with it is
that of each. A comparison has one answer, since code branches on it: that of the first. Those to
whom it does not apply are struck from the `Ledger`, and somebody has to do them one by one. So code
for one runs once for many, and nobody gets a result of a branch that is not theirs.

The functions below are those of `math` and NumPy for floats, to the last bit, and go through every
element of columns with the same functions of `math`.
"""

import math
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Ledger:
    """Who is still there.

    Parameters
    ----------
    count : int
        How many there are.

    Attributes
    ----------
    there : ndarray of bool, shape (count,)
        False for those who took another branch than the first.
    """

    def __init__(self, count: int) -> None:
        self.there = np.ones(count, dtype=bool)

    def decide(self, answers: NDArray[np.bool_]) -> bool:
        """Return the answer of the first, and strike those who have another."""
        self.there &= answers == answers[0]
        return bool(answers[0])


class Truth:
    """The answers of many to a question; as a condition, that of the first."""

    def __init__(self, answers: NDArray[np.bool_], ledger: Ledger) -> None:
        self._answers, self._ledger = answers, ledger

    def __bool__(self) -> bool:
        return self._ledger.decide(self._answers)


class Column:
    """A number for each of many.

    Parameters
    ----------
    values : ndarray, shape (count,)
    ledger : Ledger
        Shared by all columns of the same many.
    """

    # of an array and a column NumPy makes an array of columns
    __slots__ = ("ledger", "values")

    def __init__(self, values: Array, ledger: Ledger) -> None:
        self.values, self.ledger = values, ledger

    def of(self, values: Array) -> "Column":
        """Return another column of the same many."""
        return Column(values, self.ledger)

    def __repr__(self) -> str:
        return f"<Column from {self.values[0]}>"

    def __format__(self, how: str) -> str:
        return format(float(self.values[0]), how)

    def _with(self, other: Any, operation: Callable[[Any, Any], Any]) -> Any:
        if isinstance(other, np.ndarray):
            return NotImplemented
        with np.errstate(all="ignore"):  # as floats, but that what is wrong is struck later on
            return self.of(operation(self.values, other_values(other)))

    def _asked(self, other: Any, question: Callable[[Any, Any], Any]) -> Any:
        return Truth(question(self.values, other_values(other)), self.ledger)

    def __add__(self, other: Any) -> Any:
        return self._with(other, np.add)

    __radd__ = __add__

    def __mul__(self, other: Any) -> Any:
        return self._with(other, np.multiply)

    __rmul__ = __mul__

    def __sub__(self, other: Any) -> Any:
        return self._with(other, np.subtract)

    def __rsub__(self, other: Any) -> Any:
        return self._with(other, lambda a, b: b - a)

    def __truediv__(self, other: Any) -> Any:
        return self._with(other, np.divide)

    def __rtruediv__(self, other: Any) -> Any:
        return self._with(other, lambda a, b: b / a)

    def __pow__(self, other: Any) -> Any:
        return self._with(other, np.power)

    def __neg__(self) -> "Column":
        return self.of(-self.values)

    def __abs__(self) -> "Column":
        return self.of(np.abs(self.values))

    def __lt__(self, other: Any) -> Any:
        return self._asked(other, np.less)

    def __le__(self, other: Any) -> Any:
        return self._asked(other, np.less_equal)

    def __gt__(self, other: Any) -> Any:
        return self._asked(other, np.greater)

    def __ge__(self, other: Any) -> Any:
        return self._asked(other, np.greater_equal)

    def __eq__(self, other: object) -> Any:
        return self._asked(other, np.equal)

    def __ne__(self, other: object) -> Any:
        return self._asked(other, np.not_equal)

    __hash__ = None  # type: ignore[assignment] # equal for some, and not for others

    def __bool__(self) -> bool:
        return self.ledger.decide(self.values != 0.0)


def other_values(other: Any) -> Any:
    """Return the numbers of a column, or what else it is."""
    return other.values if isinstance(other, Column) else other


def _first_column(values: Iterable[Any]) -> Column | None:
    return next((value for value in values if isinstance(value, Column)), None)


def each(function: Callable[..., float], *values: Any) -> Any:
    """Return a function of floats, of every one of many where one of its arguments is a column."""
    column = _first_column(values)
    if column is None:
        return function(*values)
    count = column.values.size
    rows = [np.broadcast_to(other_values(value), count).tolist() for value in values]
    try:
        return column.of(np.fromiter(map(function, *rows), np.float64, count))
    except (ValueError, OverflowError):  # as math does; who it is has to be found one by one
        return column.of(np.array([_or_nan(function, *row) for row in zip(*rows, strict=True)]))


def _or_nan(function: Callable[..., float], *values: float) -> float:
    try:
        return function(*values)
    except (ValueError, OverflowError):
        return math.nan


def number(value: Any) -> Any:
    """Return a float, or a column as it is."""
    return value if isinstance(value, Column) else float(value)


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
    """Return the length of a vector: that of NumPy for floats."""
    if _first_column(vector) is None:
        return float(np.linalg.norm(vector))
    square: Any = sum(component * component for component in vector)
    return square.of(np.sqrt(square.values))


def greatest(values: Iterable[Any]) -> Any:
    """Return the greatest of some numbers; of columns the greatest of each."""
    found = list(values)
    column = _first_column(found)
    if column is None:
        return max(found)
    return column.of(np.maximum.reduce(np.broadcast_arrays(*map(other_values, found))))


def sorted_moments(matrix: Any) -> tuple[Any, Any, Any]:
    """Return the eigenvalues of a symmetric matrix of three rows, the smallest first."""
    column = _first_column(value for row in matrix for value in row)
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
    """Return the least singular value of a matrix."""
    column = _first_column(value for row in matrix for value in row)
    least = np.linalg.svd(stacked(matrix), compute_uv=False)[..., -1]
    return float(least) if column is None else column.of(np.array(least))


def stacked(values: Any) -> Array:
    """Return an array of floats; one of columns has many of them in front.

    Parameters
    ----------
    values : array_like
        Floats, columns or both; nested as NumPy takes them.

    Returns
    -------
    ndarray
        Of the shape of `values`, with (count,) in front of it if there is a column.
    """
    array = np.asarray(values)
    if array.dtype != object:
        return array.astype(np.float64, copy=False)
    column = _first_column(array.flat)
    if column is None:
        return array.astype(np.float64)
    rows = [np.broadcast_to(other_values(v), column.values.size) for v in array.flat]
    return np.stack(rows, axis=-1).reshape(column.values.size, *array.shape)


def spread(values: Any) -> Array:
    """Return what is broadcast over the positions of each: (count, 1, ...) for columns."""
    array = stacked(values)
    return array if array.ndim == np.ndim(values) else array[:, None]
