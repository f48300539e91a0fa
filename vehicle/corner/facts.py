"""Facts of a kind of suspension: names in its equations, and the limit in rebound."""

from typing import NamedTuple


class Names(NamedTuple):
    """The names in the equations of coordinates and inputs that every suspension has."""

    # states: angle of the lower arm, which falls as the wheel rises, and of the wheel [rad]
    arm: str
    spin: str
    # relative coordinate, and with a free rack a state: displacement of the rack [m]. Empty if the
    # wheel is not steered.
    rack: str
    actuator: str  # input: force of an actuator in the strut, or beside the spring [N]


class Extended(NamedTuple):
    """The strut or damper that limits rebound at its greatest length."""

    signal: str  # signal of its length
    length: float  # greatest length [m]
    # name, and the key of its greatest length in the file
    name: str
    key: str
