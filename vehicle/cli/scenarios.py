"""What a suspension is driven over, from the options of a command."""

import math
from dataclasses import dataclass
from pathlib import Path  # noqa: TC003 (Typer reads the types of options)
from typing import TYPE_CHECKING, Any

import typer

from ...terminal.console import note
from .options import metres
from .simulation_options import (
    Duration,
    Height,
    Measured,
    OutputStep,
    Rack,
    RackFrequency,
    RackSine,
    RoadFrequency,
    RoadSine,
    RoadStep,
    RoadStepAt,
    Speed,
    Spin,
)

if TYPE_CHECKING:
    from ..analysis.scenario import Scenario


@dataclass(frozen=True)
class ScenarioOptions:
    """The options of a road, the rack and the start, in the units of the command line."""

    height: Height = None
    spin: Spin = 0.0
    road_step: RoadStep = None
    road_step_at: RoadStepAt = 0.1
    road_sine: RoadSine = None
    road_frequency: RoadFrequency = 1.0
    measured: Measured = None
    speed: Speed = None
    rack: Rack = None
    rack_sine: RackSine = None
    rack_frequency: RackFrequency = 1.0
    duration: Duration = None
    output_step: OutputStep = 1.0

    @property
    def files(self) -> "list[Path]":
        """The files that are read."""
        return [] if self.measured is None else [self.measured]

    def scenario(self) -> "Scenario":
        """Return the scenario that the options describe."""
        from ..analysis.excitation import TimeProfile, excitation
        from ..analysis.measurement import measured
        from ..analysis.scenario import Scenario

        if self.speed is not None and self.measured is None:
            raise typer.BadParameter("only a road from --measured is driven on at a --speed")
        recording = None
        if self.measured is not None:
            recording = measured(self.measured, speed=_per_second(self.speed))
        if recording is not None and recording.left_out:
            names = ", ".join(recording.left_out)
            note(f"columns of {self.measured} that were not read: {names}.")
        end = self.duration
        if end is None:
            end = 1.0 if recording is None else recording.duration
        courses: dict[str, Any] = {
            "road_height": TimeProfile(
                step=metres(self.road_step),
                step_at=self.road_step_at,
                sine=metres(self.road_sine),
                frequency=self.road_frequency,
            ),
            "rack_position": TimeProfile(
                held=metres(self.rack),
                sine=metres(self.rack_sine),
                frequency=self.rack_frequency,
            ),
        }
        return Scenario(
            duration=end,
            output_step=self.output_step / 1e3,
            height=metres(self.height),
            spin_rate=self.spin * math.tau,
            inputs=excitation(courses, end, recording),
        )


USUAL_SCENARIO = ScenarioOptions()


def _per_second(speed: float | None) -> float | None:
    """Return a speed given in km/h in m/s."""
    return None if speed is None else speed / 3.6
