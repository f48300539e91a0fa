"""Motions of wheels and rack on a rig, and the positions along them."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from ...core.named_types import Array
from .quantity import Quantity

STEERING = ("steer", "rack")
"""Motions of the steering, with all wheels at one height."""


@dataclass(frozen=True)
class RigMotion:
    """A motion of a rig."""

    # varied quantity: wheel travel, roll angle, steering-wheel angle or rack displacement
    along: Quantity
    words: str  # description, 'both wheels rise and fall together'
    title: str  # abscissa of curves, 'parallel wheel travel'


@dataclass(frozen=True)
class RigPosition:
    """Positions of the wheels and the rack on a rig, (n,)."""

    # heights of the wheel centres above design by the names of the wheels, (n,) [m]
    travels: Mapping[str, Array]
    rack: Array  # displacement of the rack [m]; zero without a rack, () or (n,)
    # signed rack travel for one turn of the steering wheel there, if it turns [m]
    per_turn: Array | None = None


@dataclass(frozen=True)
class WheelReach:
    """The range of a wheel."""

    # coordinate at the lowest and at the highest position, see `HeldAssembly.at_wheel_coordinates`
    coordinate: tuple[float, float]
    height: tuple[float, float]  # heights of the wheel centre there [m]


@dataclass(frozen=True)
class SweepRange:
    """Ends of a motion of a rig; all positive. None for the default of `over`.

    Attributes
    ----------
    rebound, bump : float or None
        Wheel travel downward and upward from design [m].
    roll : float or None
        Roll angle to either side [rad].
    rack : float or None
        Displacement of the rack to either side [m].
    step : float
        Distance between two positions of the wheels or of the rack [m].
    """

    rebound: float | None = None
    bump: float | None = None
    roll: float | None = None
    rack: float | None = None
    step: float = 0.002


@dataclass(frozen=True)
class RestConditions:
    """Constraints and applied forces of an assembly that comes to rest."""

    rack: float = 0.0  # displacement of the rack [m]
    roads: Mapping[str, float] = field(default_factory=dict)  # height of the road by wheel [m]
    # instead of a road, by wheel: the vertical force of the tyre [N]
    loads: Mapping[str, float] = field(default_factory=dict)
    # force of the actuator, by wheel [N]
    actuators: Mapping[str, float] = field(default_factory=dict)
    # further inputs by their names, SI units
    inputs: Mapping[str, float] = field(default_factory=dict)
