"""Arrays as text: base64 of differences from design position, as little-endian 32-bit floats."""

import base64
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.named_types import Array


def rounded(values: ArrayLike, design: ArrayLike) -> Array:
    """Return values with the error of the encoding.

    The value at design is subtracted before the rounding to 32 bits; NaN counts as zero.
    """
    offset = _offset(design)
    return _difference(values, offset).astype(np.float64) + offset


def packed(values: ArrayLike, design: ArrayLike = 0.0) -> dict[str, Any]:
    """Return an array for the page: ``design``, and ``differences`` in base64 and C order.

    The value at design, or one for each of the last dimension, has full precision. NaN counts as
    zero.
    """
    offset = _offset(design)
    text = base64.b64encode(_difference(values, offset).tobytes()).decode("ascii")
    return {"design": offset.tolist(), "differences": text}


def _offset(design: ArrayLike) -> Array:
    return np.nan_to_num(np.asarray(design, dtype=np.float64), nan=0.0)


def _difference(values: ArrayLike, offset: Array) -> NDArray[np.float32]:
    return (np.asarray(values, dtype=np.float64) - offset).astype("<f4")
