"""The options of a simulated motion and of the solver, in display units."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...core.units import KM_PER_H
from ...terminal.console import note
from .options import metres, option, refuse_options

if TYPE_CHECKING:
    from ..analysis.scenario import Scenario

_Number = float | None

_STEP_AT = 0.1  # [s]
_FREQUENCY = 1.0  # [Hz]


@dataclass(frozen=True)
class ScenarioOptions:
    """The options of a road, the rack and the start."""

    height: Annotated[
        _Number, option("Height of the wheel centre. Default: at rest.", "MM", panel="Start")
    ] = None
    spin: Annotated[
        float, option("Wheel spin, positive rolling forward.", "REV/S", panel="Start")
    ] = 0.0
    road_step: Annotated[_Number, option("Height of a step of the road.", "MM", panel="Road")] = (
        None
    )
    road_step_at: Annotated[
        _Number, option("Time of the step. Default: 0.1 s.", "S", panel="Road")
    ] = None
    road_sine: Annotated[_Number, option("Amplitude of a sinusoidal road.", "MM", panel="Road")] = (
        None
    )
    road_frequency: Annotated[
        _Number, option("Frequency of that road. Default: 1 Hz.", "HZ", panel="Road")
    ] = None
    measured: Annotated[
        Path | None,
        option(
            "Measured road, rack and loads on the wheel, with the columns time_s or distance_m, "
            "road_height_mm, rack_position_mm, contact_force_x_N, ...",
            "CSV",
            panel="Road",
        ),
    ] = None
    speed: Annotated[
        _Number, option("Speed on a measured road over distance_m.", "KM/H", panel="Road")
    ] = None
    rack: Annotated[_Number, option("Constant rack displacement.", "MM", panel="Rack")] = None
    rack_sine: Annotated[
        _Number, option("Amplitude of a sinusoidal rack motion.", "MM", panel="Rack")
    ] = None
    rack_frequency: Annotated[
        _Number, option("Frequency of that motion. Default: 1 Hz.", "HZ", panel="Rack")
    ] = None
    duration: Annotated[
        _Number, option("Duration. Default: 1, or that of the measurement.", "S", panel="Time")
    ] = None
    output_step: Annotated[float, option("Time between outputs.", "MS", panel="Time")] = 1.0

    def scenario(self) -> "Scenario":
        """Return the scenario of the options."""
        from ..analysis.excitation import TimeProfile, excitation
        from ..analysis.measurement import measured
        from ..analysis.scenario import Scenario

        if self.speed is not None and self.measured is None:
            raise typer.BadParameter("--speed is only for a road from --measured")
        self._refuse_details()
        recording = None
        if self.measured is not None:
            speed = None if self.speed is None else self.speed / KM_PER_H
            recording = measured(self.measured, speed=speed)
        if recording is not None and recording.left_out:
            names = ", ".join(recording.left_out)
            note(f"columns of {self.measured} that were not read: {names}.")
        end = self.duration
        if end is None:
            end = 1.0 if recording is None else recording.duration
        profiles: dict[str, Any] = {
            "road_height": TimeProfile(
                step=metres(self.road_step),
                step_at=_STEP_AT if self.road_step_at is None else self.road_step_at,
                sine=metres(self.road_sine),
                frequency=_FREQUENCY if self.road_frequency is None else self.road_frequency,
            ),
            "rack_position": TimeProfile(
                held=metres(self.rack),
                sine=metres(self.rack_sine),
                frequency=_FREQUENCY if self.rack_frequency is None else self.rack_frequency,
            ),
        }
        return Scenario(
            duration=end,
            output_step=self.output_step / 1e3,
            height=metres(self.height),
            spin_rate=self.spin * math.tau,
            inputs=excitation(profiles, end, recording),
        )

    def _refuse_details(self) -> None:
        """Refuse details of a step or sine that is not given."""
        details = {
            "--road-step": (self.road_step, {"--road-step-at": self.road_step_at}),
            "--road-sine": (self.road_sine, {"--road-frequency": self.road_frequency}),
            "--rack-sine": (self.rack_sine, {"--rack-frequency": self.rack_frequency}),
        }
        for name, (amplitude, given) in details.items():
            if amplitude is None:
                refuse_options(name, given)


@dataclass(frozen=True)
class SolverOptions:
    """The options of the integrator."""

    method: Annotated[
        str,
        option(
            "BDF, Adams, Verner, DormandPrince, RK4, RODASP, Tsitouras, Radau, LSODA, RK45, "
            "DOP853.",
            panel="Solver",
        ),
    ] = "BDF"
    step: Annotated[
        _Number, option("Fixed step of RK4 or RODASP.", "MS", "--fixed-step", panel="Solver")
    ] = None
    rtol: Annotated[
        _Number,
        option("Relative tolerance. Default: 1e-8 for BDF, else 1e-6.", panel="Solver"),
    ] = None
    atol: Annotated[
        _Number,
        option("Absolute tolerance, SI units. Default: 1e-10 for BDF, else 1e-9.", panel="Solver"),
    ] = None
    max_step: Annotated[
        _Number, option("Longest step. Default: no limit.", "MS", panel="Solver")
    ] = None
    max_steps: Annotated[int, option("Largest number of steps.", panel="Solver")] = 10_000_000

    def of_simulate(self) -> dict[str, Any]:
        """Return the options as keywords of `kintrafo.simulate`."""
        longest = math.inf if self.max_step is None else self.max_step / 1e3
        step = None if self.step is None else self.step / 1e3
        return {**vars(self), "step": step, "max_step": longest}
