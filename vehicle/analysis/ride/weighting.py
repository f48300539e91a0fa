"""The frequency weighting of vertical acceleration, W_k of ISO 2631-1:1997, Annex A."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ....core.named_types import Array
from ....core.validator import Validator

Complex = NDArray[np.complex128]

# Corner frequencies [Hz] and quality factors of W_k.
_HIGH_PASS, _LOW_PASS = 0.4, 100.0
_TRANSITION, _TRANSITION_QUALITY = 12.5, 0.63
_STEP_FROM, _STEP_TO, _STEP_QUALITY = 2.37, 3.35, 0.91


def _polynomials() -> tuple[Array, Array]:
    """Return numerator and denominator of W_k over s, highest power first."""
    corners = (_HIGH_PASS, _LOW_PASS, _TRANSITION, _STEP_FROM, _STEP_TO)
    w1, w2, w3, w5, w6 = (2.0 * np.pi * corner for corner in corners)
    root, q4, q = np.sqrt(2.0), _TRANSITION_QUALITY, _STEP_QUALITY
    parts: list[tuple[list[float], list[float]]] = [
        ([1.0, 0.0, 0.0], [1.0, root * w1, w1 * w1]),
        ([1.0], [1.0 / w2**2, root / w2, 1.0]),
        ([1.0 / w3, 1.0], [1.0 / w3**2, 1.0 / (q4 * w3), 1.0]),
        ([1.0, w5 / q, w5 * w5], [1.0, w6 / q, w6 * w6]),
    ]
    return _product([above for above, _ in parts]), _product([below for _, below in parts])


def _product(polynomials: list[list[float]]) -> Array:
    found = np.ones(1)
    for each in polynomials:
        found = np.convolve(found, each)
    return found


def weighting(frequency: ArrayLike) -> Complex:
    """Return the frequency weighting W_k of vertical acceleration (ISO 2631-1).

    Parameters
    ----------
    frequency : array_like
        Frequencies [Hz].

    Returns
    -------
    ndarray of complex
        The transfer function with its band limits, of the shape of `frequency` [1]: its absolute
        values are the weighting factors. Its poles are those of ISO 2631-1, Annex A.

    Examples
    --------
    >>> from kintrafo import ride
    >>> abs(ride.weighting([1.0, 8.0])).round(3).tolist()
    [0.482, 1.036]
    """
    with Validator("weighting") as given:
        frequencies = given.array("frequency", frequency, "Hz", empty=True)
    numerator, denominator = _polynomials()
    s = 2j * np.pi * frequencies
    return np.polyval(numerator, s) / np.polyval(denominator, s)


def weighted(acceleration: ArrayLike, step: float) -> Array:
    """Return a vertical acceleration over time, filtered by the weighting W_k.

    Parameters
    ----------
    acceleration : array_like, shape (n,)
        At equally spaced times, linear in between [m/s^2]. The filter begins at rest.
    step : float
        Time between two values, above zero [s].

    Returns
    -------
    ndarray, shape (n,)
        The weighted acceleration at the same times [m/s^2].

    Raises
    ------
    InputError
        If an argument cannot be used.
    """
    with Validator("weighted") as given:
        values = given.array("acceleration", acceleration, "m/s^2", dimensions=[1])
        step = given.number("step", step, "s", above=0.0)
    from scipy.signal import lsim  # noqa: PLC0415 (slow to import)

    _, filtered, _ = lsim(_polynomials(), values, step * np.arange(values.size, dtype=float))
    return np.asarray(filtered, dtype=float)
