"""What curves may be over: motions of a rig, supports of wheels under loads, steady turns."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ...core.quantities import display_of
from ..analysis.characteristics.datasets import ALONG, KNOWN, OF_AXLES, OF_CARS
from ..analysis.compliance.flexibility import HELD
from ..analysis.compliance.linear import COMPLIANCES, COMPLIANCES_OF_AXLES
from ..analysis.handling.circle import columns_of_turns, turns_at
from ..analysis.handling.subject import driving_car
from ..assembly.assembly import Assembly
from ..assembly.of import assembly_of
from ..assembly.quantity import HEAVE, LATERAL_ACCELERATION, PITCH, ROLL, TRAVEL, Quantity
from ..models.car.car import WHEELS

Array = NDArray[np.float64]

TURNING_SPEED = 100.0 / 3.6
"""Constant speed of the steady turns of studies [m/s]."""


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
    curves : callable, optional
        Returns the curves of an assembly at some positions, where no motion of a rig has them.
    usual : tuple of float, optional
        The usual positions of such curves, SI units.
    """

    along: Quantity
    known: Mapping[str, Quantity]
    words: str
    curves: Callable[[Assembly, Array], xr.Dataset] | None = None
    usual: tuple[float, ...] = ()

    @property
    def unit(self) -> str:
        """The display unit of what varies."""
        return display_of(self.along.attributes()).units

    @property
    def key(self) -> str:
        """The key of positions in a file of goals: ``at_mm``, ``at_m_per_s2``."""
        return f"at_{self.unit.replace('/', '_per_').replace('^', '')}"

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
TURNS = "lateral_acceleration"
"""Steady turns of cars that drive."""


def _steady_turns(assembly: Assembly, accelerations: Array) -> xr.Dataset:
    return turns_at(driving_car("steady turns", assembly), TURNING_SPEED, accelerations)


SWEEP_AXES: dict[str, SweepAxis] = {
    "travel": SweepAxis(TRAVEL, KNOWN["travel"], "wheel travel"),
    "rack": SweepAxis(ALONG["rack"], KNOWN["rack"], "the rack"),
    **{
        name: SweepAxis(along, OF_AXLES[along.name], words)
        for name, (along, words) in _OF_AXLES.items()
    },
    # over roll cars have columns of their own beside those of axles
    "roll": SweepAxis(ROLL, OF_AXLES[ROLL.name] | OF_CARS, "roll"),
    "heave": SweepAxis(HEAVE, OF_CARS, "heave of the body"),
    "pitch": SweepAxis(PITCH, OF_CARS, "pitch of the body"),
    TURNS: SweepAxis(
        LATERAL_ACCELERATION,
        columns_of_turns(WHEELS),
        f"lateral acceleration at {3.6 * TURNING_SPEED:g} km/h",
        _steady_turns,
        (0.0, 1.0, 2.0, 3.0, 4.0),
    ),
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
    """Return what the characteristics of an assembly may be over, the usual first."""
    assembly = assembly_of(subject)
    if assembly.body_moves:
        return (*assembly.motions, *([TURNS] if assembly.drives else ()))
    alone = len(assembly.wheels) == 1
    return OF_CORNERS if alone else tuple(_OF_AXLES)


def compliances_over(over: str) -> Mapping[str, Quantity]:
    """Return the compliances over a motion, by the names of their columns; none over others."""
    return _COMPLIANCES_OVER.get(over, {})
