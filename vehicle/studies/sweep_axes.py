"""What curves may be over: the motions of a rig, and what holds the wheels under loads."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ...core.quantities import display_of
from ..analysis.characteristics.datasets import ALONG, KNOWN, OF_AXLES
from ..analysis.compliance.flexibility import HELD
from ..analysis.compliance.linear import COMPLIANCES, COMPLIANCES_OF_AXLES
from ..assembly.of import assembly_of
from ..assembly.quantity import ROLL, TRAVEL, Quantity


@dataclass(frozen=True)
class SweepAxis:
    """What varies along some curves.

    Attributes
    ----------
    along : Quantity
    known : mapping of str to Quantity
        The curves over it, by the names of their columns.
    words : str
        'wheel travel'.
    """

    along: Quantity
    known: Mapping[str, Quantity]
    words: str

    @property
    def unit(self) -> str:
        """The display unit of what varies."""
        return display_of(self.along.attributes()).units

    @property
    def factor(self) -> float:
        """How many of them the SI unit has."""
        return display_of(self.along.attributes()).factor


_OF_AXLES = {
    "bump": (TRAVEL, "parallel wheel travel"),
    "roll": (ROLL, "roll"),
    "left": (TRAVEL, "travel of the left wheel"),
    "right": (TRAVEL, "travel of the right wheel"),
}
SWEEP_AXES: dict[str, SweepAxis] = {
    "travel": SweepAxis(TRAVEL, KNOWN["travel"], "wheel travel"),
    "rack": SweepAxis(ALONG["rack"], KNOWN["rack"], "the rack"),
    **{
        name: SweepAxis(along, OF_AXLES[along.name], words)
        for name, (along, words) in _OF_AXLES.items()
    },
}
"""What characteristics may be over, by the name of the motion."""

UNDER_LOADS = {
    held: SweepAxis(TRAVEL, COMPLIANCES | COMPLIANCES_OF_AXLES, "wheel travel") for held in HELD
}
"""Compliance over wheel travel, of an axle over parallel travel, by what holds the wheels."""

OF_CORNERS = ("travel", "rack")
_COMPLIANCES_OVER: dict[str, Mapping[str, Quantity]] = {
    "travel": COMPLIANCES,
    "bump": COMPLIANCES_OF_AXLES,
}


def sweep_axis(over: str) -> SweepAxis:
    """Return what some curves are over."""
    return (SWEEP_AXES | UNDER_LOADS)[over]


def sweep_axes_of(subject: Any) -> tuple[str, ...]:
    """Return what the characteristics of a suspension or an axle may be over, the usual first."""
    alone = len(assembly_of(subject).wheels) == 1
    return OF_CORNERS if alone else tuple(_OF_AXLES)


def compliances_over(over: str) -> Mapping[str, Quantity]:
    """Return the compliances over a motion, by the names of their columns; none over others."""
    return _COMPLIANCES_OVER.get(over, {})
