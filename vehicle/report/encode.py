"""Arrays as text: base64 of little-endian 32-bit floats, differences from the design position."""

import base64
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.named_types import Array


def rounded(values: ArrayLike, design: ArrayLike) -> Array:
    """Return values as the page will have them.

    Parameters
    ----------
    values : array_like
    design : array_like
        What is subtracted before the rounding to 32 bits; NaN counts as zero.

    Returns
    -------
    ndarray
        The values with the error of the encoding.
    """
    offset = _offset(design)
    return _difference(values, offset).astype(np.float64) + offset


def packed(values: ArrayLike, design: ArrayLike = 0.0) -> dict[str, Any]:
    """Encode an array for the page.

    Parameters
    ----------
    values : array_like
        In C order in the text.
    design : array_like, optional
        Value at design, or one for each of the last dimension; it is kept in full. NaN counts as
        zero.

    Returns
    -------
    dict
        ``design`` and ``differences``, the latter in base64.
    """
    offset = _offset(design)
    text = base64.b64encode(_difference(values, offset).tobytes()).decode("ascii")
    return {"design": offset.tolist(), "differences": text}


def _offset(design: ArrayLike) -> Array:
    return np.nan_to_num(np.asarray(design, dtype=np.float64), nan=0.0)


def _difference(values: ArrayLike, offset: Array) -> NDArray[np.float32]:
    return (np.asarray(values, dtype=np.float64) - offset).astype("<f4")
