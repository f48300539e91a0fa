"""What a kind of suspension says of its equations: names, and what a wheel hangs on."""

from typing import NamedTuple


class Names(NamedTuple):
    """What the equations call that which every suspension has.

    Attributes
    ----------
    arm, spin : str
        States: angle of the lower arm, which falls as the wheel rises, and of the wheel [rad].
    rack : str
        Relative coordinate, and with a free rack a state: displacement of the rack [m]. Empty
        where nothing steers the wheel.
    actuator : str
        Input: force of an actuator in the strut, or beside the spring [N].
    """

    arm: str
    spin: str
    rack: str
    actuator: str


class Extended(NamedTuple):
    """What the wheel hangs on when it is drawn out as far as it goes.

    Attributes
    ----------
    signal : str
        The signal of the equations that is its length.
    length : float
        The greatest one [m].
    name, key : str
        What it is called, and where the file says its greatest length.
    """

    signal: str
    length: float
    name: str
    key: str
