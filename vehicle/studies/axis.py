"""The axis of the curves of a study."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import xarray as xr

from ...core.named_types import Array
from ...core.quantities import display_of
from ..assembly.assembly import Assembly
from ..assembly.quantity import Quantity


@dataclass(frozen=True)
class SweepAxis:
    """The quantity that varies along curves, and the curves over it."""

    along: Quantity
    known: Mapping[str, Quantity]  # the curves over it, by the names of their columns
    words: str  # name in titles and messages, such as 'wheel travel'
    # a function that returns the curves of an assembly at some positions, if they are not those of
    # a motion
    curves: Callable[[Assembly, Array], xr.Dataset] | None = None
    usual: tuple[float, ...] = ()  # the usual positions of such curves, SI units
    at: float = 0.0  # the default position, SI units

    @property
    def unit(self) -> str:
        """The display unit of the positions."""
        return display_of(self.along.attributes()).units

    @property
    def key(self) -> str:
        """The key of positions in a file of goals: ``at_mm``, ``at_m_per_s2``, ``at_percent``."""
        unit = self.unit.replace("%", "percent")
        return f"at_{unit.replace('/', '_per_').replace('^', '')}"

    @property
    def factor(self) -> float:
        """The number of display units in the SI unit."""
        return display_of(self.along.attributes()).factor


def number_of(value: Any) -> Any:
    """Return a text that is a number as a number, and other values unchanged."""
    if not isinstance(value, str):
        return value
    try:
        return float(value)
    except ValueError:
        return value
