"""What a rig does to wheels and rack: its motions, and the positions along them."""

from collections.abc import Mapping
from dataclasses import dataclass

from ..corner.corner import Array
from .quantity import Quantity


@dataclass(frozen=True)
class RigMotion:
    """A motion of a rig.

    Attributes
    ----------
    along : Quantity
        What varies: wheel travel, roll angle, steering-wheel angle or rack displacement.
    words : str
        What it is, 'both wheels rise and fall together'.
    title : str
        What curves are over, 'parallel wheel travel'.
    """

    along: Quantity
    words: str
    title: str


@dataclass(frozen=True)
class RigPosition:
    """Where a rig holds the wheels and the rack, in n positions.

    Attributes
    ----------
    travels : mapping of str to ndarray, each of shape (n,)
        Heights of the wheel centres above design by the names of the wheels [m].
    rack : ndarray, shape () or (n,)
        Displacement of the rack [m]; zero where there is none.
    per_turn : ndarray or None
        Where a steering wheel turns, the rack travel for one turn of it there, with its sign [m].
    """

    travels: Mapping[str, Array]
    rack: Array
    per_turn: Array | None = None


@dataclass(frozen=True)
class WheelReach:
    """How far a wheel goes.

    Attributes
    ----------
    coordinate : tuple of float
        Its coordinate at the lowest and at the highest position, as of
        `HeldAssembly.at_wheel_coordinates`.
    height : tuple of float
        Heights of the wheel centre there [m].
    """

    coordinate: tuple[float, float]
    height: tuple[float, float]


@dataclass(frozen=True)
class SweepRange:
    """Ends of a motion that differ from the default; all positive.

    Attributes
    ----------
    rebound, bump : float or None
        Wheel travel [m].
    roll : float or None
        To either side [rad].
    rack : float or None
        To either side [m].
    step : float
        Distance of the positions, of wheel travel and rack [m].
    """

    rebound: float | None = None
    bump: float | None = None
    roll: float | None = None
    rack: float | None = None
    step: float = 0.002
