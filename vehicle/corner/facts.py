"""Facts of a kind of suspension: names in its equations, and the limit in rebound."""

from typing import NamedTuple


class Names(NamedTuple):
    """The names in the equations of coordinates and inputs that every suspension has.

    Attributes
    ----------
    arm, spin : str
        States: angle of the lower arm, which falls as the wheel rises, and of the wheel [rad].
    rack : str
        Relative coordinate, and with a free rack a state: displacement of the rack [m]. Empty if
        the wheel is not steered.
    actuator : str
        Input: force of an actuator in the strut, or beside the spring [N].
    """

    arm: str
    spin: str
    rack: str
    actuator: str


class Extended(NamedTuple):
    """The strut or damper that limits rebound at its greatest length.

    Attributes
    ----------
    signal : str
        The signal of its length.
    length : float
        The greatest length [m].
    name, key : str
        Its name, and the key of its greatest length in the file.
    """

    signal: str
    length: float
    name: str
    key: str
