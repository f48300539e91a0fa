"""The conditions of a search for rest: rack, road and applied forces."""

from collections.abc import Mapping
from dataclasses import dataclass, field


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
