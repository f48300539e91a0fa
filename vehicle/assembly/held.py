"""What holds and loads an assembly that comes to rest."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace


@dataclass(frozen=True)
class RestConditions:
    """What an assembly is held and loaded by while it comes to rest.

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

    def without_inputs(self) -> "RestConditions":
        """Return the same without further inputs, which have other names for another assembly."""
        return replace(self, inputs={})
