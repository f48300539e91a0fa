"""The names of one wheel's states, inputs and signals in the equations of motion."""

from dataclasses import dataclass


@dataclass(frozen=True)
class WheelNames:
    """Names of one wheel in the equations of motion."""

    prefix: str  # prefix of its inputs: empty for a corner, `left_` for an axle
    signals: str  # prefix of its signals and events: `left_front_` for an axle
    spin: str  # state: the angle of the wheel about its axis
    actuator: str  # input: the force of the actuator beside its spring
    tyre: str = "tyre_force"  # signal of the tyre's load, without this prefix

    @property
    def road(self) -> str:
        """Input: the height of the road under the wheel."""
        return f"{self.prefix}road_height"

    @property
    def load(self) -> str:
        """Signal: the load of the tyre."""
        return f"{self.signals}{self.tyre}"

    @property
    def hub_torque(self) -> str:
        """Input of a model with loads on the wheel: the torque of the brake at the hub."""
        return f"{self.prefix}hub_torque"

    @property
    def events(self) -> tuple[str, str]:
        """The events at which the wheel leaves and touches the ground."""
        leaves, touches = (f"{self.signals}wheel_{what}_ground" for what in ("leaves", "touches"))
        return leaves, touches
