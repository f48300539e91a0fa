"""Types that the signatures of public functions call by their names, rather than spell out."""

import numpy.typing as npt
from typing_extensions import TypeAliasType

ArrayLike = TypeAliasType("ArrayLike", npt.ArrayLike)
"""What `numpy.asarray` makes an array of: numbers, sequences of them, arrays."""
