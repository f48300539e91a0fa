"""Types that the signatures of public functions call by their names, rather than spell out."""

import numpy as np
import numpy.typing as npt
from typing_extensions import TypeAliasType

ArrayLike = TypeAliasType("ArrayLike", npt.ArrayLike)
"""What `numpy.asarray` makes an array of: numbers, sequences of them, arrays."""

Array = npt.NDArray[np.float64]
"""An array of floating-point numbers of double precision."""
