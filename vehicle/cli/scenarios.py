"""What a suspension is driven over, from the options of a command."""

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from ...terminal.console import note
from .options import metres

if TYPE_CHECKING:
    from ..analysis.scenario import Scenario


def scenario_of(
    *,
    height: float | None,
    spin: float,
    road_step: float | None,
    road_step_at: float,
    road_sine: float | None,
    road_frequency: float,
    measured: Path | None,
    speed: float | None,
    rack: float | None,
    rack_sine: float | None,
    rack_frequency: float,
    duration: float | None,
    output_step: float,
) -> "Scenario":
    """Return the scenario that some options describe, in the units of the command line."""
    from ..analysis.excitation import Course, excitation
    from ..analysis.measurement import measured as read
    from ..analysis.scenario import Scenario

    if speed is not None and measured is None:
        raise typer.BadParameter("only a road from --measured is driven on at a --speed")
    recording = None if measured is None else read(measured, speed=_per_second(speed))
    if recording is not None and recording.left_out:
        note(f"columns of {measured} that were not read: {', '.join(recording.left_out)}.")
    end = duration
    if end is None:
        end = 1.0 if recording is None else recording.duration
    courses: dict[str, Any] = {
        "road_height": Course(
            step=metres(road_step),
            step_at=road_step_at,
            sine=metres(road_sine),
            frequency=road_frequency,
        ),
        "rack_position": Course(
            held=metres(rack), sine=metres(rack_sine), frequency=rack_frequency
        ),
    }
    return Scenario(
        duration=end,
        output_step=output_step / 1e3,
        height=metres(height),
        spin_rate=spin * math.tau,
        inputs=excitation(courses, end, recording),
    )


def _per_second(speed: float | None) -> float | None:
    """Return a speed given in km/h in m/s."""
    return None if speed is None else speed / 3.6
