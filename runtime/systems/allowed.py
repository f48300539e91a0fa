"""Lengths that an end is put to beside what the equations say."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class LengthLimit(NamedTuple):
    """What a length may be.

    Attributes
    ----------
    signal : str
        The signal of the equations that is the length.
    limit : float
        The least length; the greatest, with a minus sign [m].
    part, end : str
        What is as long, and which end of its length that is, where it was given.
    """

    signal: str
    limit: float
    part: str
    end: str

    def left(self, signals: Mapping[str, Array]) -> Array:
        """Return what is left of the length, or the way beyond with a minus sign [m]."""
        found: Array = np.sign(self.limit) * signals[self.signal] - self.limit
        return found

    @property
    def meaning(self) -> str:
        """What it means that the length is there."""
        return f"the {self.part} is at its {self.end}"

    @property
    def beyond(self) -> str:
        """What it means that the length is beyond."""
        return f"the {self.part} is beyond its {self.end}"
