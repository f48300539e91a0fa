"""Loads of a rig on one wheel, or on both wheels of an axle."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ....core.named_types import Array
from ....core.quantities import Display
from ....core.vectors import cross
from ...assembly.part_poses import CENTER, CONTACT, touching, wheel_axes
from ...corner.corner import RoadWheel

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class RigLoad:
    """A load of a rig on a wheel."""

    name: str
    words: str
    at: str  # point of the force and of the displacement
    # unit load on a left wheel, tyre axes; the mirror image is on a right one
    force: Vector
    moment: Vector
    unit: str  # SI unit of the load
    shown: Display  # display unit, and its size in SI units
    sense: Vector  # positive direction of displacements of a left wheel
    where: str  # that direction in words; empty without displacements
    # attribute of `Vehicle` with the rate of the tyre in that direction; empty if there is none
    through: str = ""


_KILONEWTON = Display("kN", 1e3)
_INWARD, _REARWARD, _NOTHING = (0.0, -1.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 0.0, 0.0)
RIG_LOADS = (
    RigLoad("lateral", "a lateral force inward at the contact", CONTACT, _INWARD, _NOTHING, "N",
          _KILONEWTON, _INWARD, "inward", "tyre_lateral_rate"),
    RigLoad("braking", "a braking force at the contact", CONTACT, _REARWARD, _NOTHING, "N",
          _KILONEWTON, _REARWARD, "rearward", "tyre_longitudinal_rate"),
    RigLoad("recession", "a rearward force at the wheel centre", CENTER, _REARWARD, _NOTHING, "N",
          _KILONEWTON, _REARWARD, "rearward"),
    RigLoad("aligning", "a torque about the vertical towards toe-out", CONTACT, _NOTHING,
          (0.0, 0.0, 1.0), "N m", Display("100 N m", 1e2), _NOTHING, ""),
)  # fmt: skip
BY_NAME = {load.name: load for load in RIG_LOADS}


@dataclass(frozen=True)
class Loading:
    """A distribution of a load on the wheels."""

    name: str  # "parallel", in one direction, or "opposed"; empty for the wheel of a corner
    # factors of the load of `RIG_LOADS` on each wheel; that on a right wheel is the mirror image
    parts: tuple[float, ...]
    words: str

    def key(self, kind: str, load: RigLoad) -> str:
        """Return the name of a kind of compliance under a load."""
        return f"{kind}_by_{load.name}{self.name and f'_{self.name}'}"

    def title(self, load: RigLoad) -> str:
        """Return the load on all wheels in words."""
        return f"{_OF_BOTH[load.name]}, {self.words}" if self.name else load.words


_OF_BOTH = {
    "lateral": "lateral forces",
    "braking": "longitudinal forces",
    "recession": "forces at the wheel centres",
    "aligning": "torques about the vertical",
}
_IMAGES, _OPPOSED = (1.0, 1.0), (1.0, -1.0)
_FORE_AND_AFT = (
    Loading("parallel", _IMAGES, "both rearward"),
    Loading("opposed", _OPPOSED, "left rearward and right forward"),
)
_ONE_WHEEL = (Loading("", (1.0,), ""),)
_TWO_WHEELS = {
    "lateral": (
        Loading("parallel", (-1.0, 1.0), "both to the left"),
        Loading("opposed", _IMAGES, "both inward"),
    ),
    "braking": _FORE_AND_AFT,
    "recession": _FORE_AND_AFT,
    "aligning": (
        Loading("parallel", _OPPOSED, "both to the left"),
        Loading("opposed", _IMAGES, "both towards toe-out"),
    ),
}


def loadings(load: RigLoad, wheels: Sequence[object]) -> tuple[Loading, ...]:
    """Return the distributions of a load on one or two wheels."""
    return _ONE_WHEEL if len(wheels) == 1 else _TWO_WHEELS[load.name]


def load_at_contact(test: RigLoad, on_road: RoadWheel) -> Array:
    """Return a unit load on a wheel as force and moment at its contact, (n, 6), chassis axes."""
    axes, side = wheel_axes(on_road), on_road.vehicle.side
    force, moment = (
        np.einsum("nij,i->nj", axes, vector)
        for vector in (_mirror(side) * test.force, side * _mirror(side) * test.moment)
    )
    arm = where_of(test, on_road) - touching(on_road)
    return np.concatenate([force, moment + cross(arm, force)], axis=-1)


def where_of(test: RigLoad, on_road: RoadWheel) -> Array:
    """Return the point of a load, (n, 3) [m]."""
    return on_road.center if test.at == CENTER else touching(on_road)


def sense_of(test: RigLoad, on_road: RoadWheel) -> Array:
    """Return the positive direction of displacements under a load, (n, 3)."""
    sense = _mirror(on_road.vehicle.side) * test.sense
    return np.einsum("nij,i->nj", wheel_axes(on_road), sense)


def give_of_tyre(test: RigLoad, on_road: RoadWheel) -> float | None:
    """Return the deflection of the stationary tyre under a unit load [m/N]; None if unknown."""
    rate = getattr(on_road.vehicle, test.through) if test.through else None
    return None if rate is None else 1.0 / rate


def _mirror(side: float) -> Array:
    return np.array([1.0, side, 1.0])
