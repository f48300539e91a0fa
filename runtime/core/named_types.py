"""Types with a short name in the signatures of public functions."""

import numpy as np
import numpy.typing as npt
from typing_extensions import TypeAliasType

ArrayLike = TypeAliasType("ArrayLike", npt.ArrayLike)
"""Any argument of `numpy.asarray`: a number, a sequence of numbers, an array."""

Array = npt.NDArray[np.float64]
"""An array of floating-point numbers of double precision."""
