"""Limits of lengths that are given beside the equations."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..core.named_types import Array


class LengthLimit(NamedTuple):
    """A limit of a length."""

    signal: str  # signal of the equations that is the length
    limit: float  # least length; or minus the greatest length [m]
    # part with this length, and the name of the limit
    part: str
    end: str

    def left(self, signals: Mapping[str, Array]) -> Array:
        """Return the distance of the length from its limit, negative beyond it [m]."""
        return np.sign(self.limit) * signals[self.signal] - self.limit

    @property
    def meaning(self) -> str:
        """Description of a length at the limit."""
        return f"the {self.part} is at its {self.end}"

    @property
    def beyond(self) -> str:
        """Description of a length beyond the limit."""
        return f"the {self.part} is beyond its {self.end}"
