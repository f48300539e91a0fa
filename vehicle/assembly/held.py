"""The conditions of a search for rest: rack, road and applied forces."""

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class RestConditions:
    """Constraints and applied forces of an assembly that comes to rest.

    Attributes
    ----------
    rack : float
        Displacement of the rack [m].
    roads : mapping of str to float
        Height of the road by wheel [m].
    loads : mapping of str to float
        Instead of a road, by wheel: the vertical force of the tyre [N].
    actuators : mapping of str to float
        Force of the actuator, by wheel [N].
    inputs : mapping of str to float
        Further inputs by their names, SI units.
    """

    rack: float = 0.0
    roads: Mapping[str, float] = field(default_factory=dict)
    loads: Mapping[str, float] = field(default_factory=dict)
    actuators: Mapping[str, float] = field(default_factory=dict)
    inputs: Mapping[str, float] = field(default_factory=dict)
