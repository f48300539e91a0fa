"""An anti-roll bar, by what it does between two sides or to a rigid axle."""

from dataclasses import dataclass

from ..models.axle.bar import HalfBar


@dataclass(frozen=True)
class Bar:
    """An anti-roll bar between two sides.

    Attributes
    ----------
    halves : tuple of HalfBar
        By side.
    rate : float
        Torque by the twist, the first half less the second one [N m/rad].
    free_twist : float
        The twist without a torque [rad].
    """

    halves: tuple[HalfBar, HalfBar]
    rate: float
    free_twist: float


@dataclass(frozen=True)
class RollBar:
    """An anti-roll bar, by what it does to a rigid axle.

    Attributes
    ----------
    body : str
        The axle.
    rate : float
        Moment by the inclination of what points left at design [N m/rad].
    """

    body: str
    rate: float
