"""The functions that a formula may use, and those of NumPy."""

from typing import Any, Protocol

import numpy as np


class Arithmetic(Protocol):
    """Functions of numbers, of arrays or of symbols.

    Sums, products and quotients are those of Python. Functions with a corner are written with
    `positive`, so that derivatives at it are known.
    """

    def define(self, name: str, value: Any) -> Any:
        """Return a value; for symbols, the step of this name with that value."""

    def sqrt(self, x: Any) -> Any:
        """Return the square root."""

    def sin(self, x: Any) -> Any:
        """Return the sine."""

    def cos(self, x: Any) -> Any:
        """Return the cosine."""

    def atan(self, x: Any) -> Any:
        """Return the arc tangent."""

    def exp(self, x: Any) -> Any:
        """Return the exponential function."""

    def log(self, x: Any) -> Any:
        """Return the natural logarithm of a positive number."""

    def positive(self, x: Any) -> Any:
        """Return the number where it is positive, and zero elsewhere."""

    def sign(self, x: Any) -> Any:
        """Return minus one, zero or one."""


class _Arrays:
    """Functions of NumPy for numbers and arrays."""

    sqrt, sin, cos, atan = np.sqrt, np.sin, np.cos, np.arctan
    exp, log, sign = np.exp, np.log, np.sign

    @staticmethod
    def define(name: str, value: Any) -> Any:
        """Return the value."""
        del name
        return value

    @staticmethod
    def positive(x: Any) -> Any:
        """Return the number where it is positive, and zero elsewhere."""
        return np.maximum(x, 0.0)


ARRAYS: Arithmetic = _Arrays()
"""Functions of numbers and NumPy arrays, which broadcast."""


def magnitude(a: Arithmetic, x: Any) -> Any:
    """Return the absolute value, with a corner at zero."""
    return a.positive(x) + a.positive(-x)


def at_most(a: Arithmetic, x: Any, limit: Any) -> Any:
    """Return the number, or the limit where it is greater."""
    return x - a.positive(x - limit)
