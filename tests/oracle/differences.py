"""Derivatives of oracles by travel: central differences over nine places."""

from collections.abc import Callable
from typing import Any

import numpy as np

WEIGHTS = np.array([3.0, -32.0, 168.0, -672.0, 0.0, 672.0, -168.0, 32.0, -3.0]) / 840.0


def difference(function: Callable[[float], Any], step: float = 2e-3) -> Any:
    """Differentiate at zero; the error is of the order of the eighth power of 2 mm."""
    return sum(w * function(k * step) for k, w in enumerate(WEIGHTS, -4) if w) / step


def second_difference(function: Callable[[float], Any], step: float) -> Any:
    """Differentiate twice, the differences of differences: of 17 places, each used once."""
    twice = enumerate(np.convolve(WEIGHTS, WEIGHTS), -8)
    return sum(w * function(k * step) for k, w in twice) / step**2
