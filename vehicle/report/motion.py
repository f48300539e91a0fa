"""The simulated second of the page: a spinning wheel, released above its design position."""

from dataclasses import dataclass

import numpy as np

from ...core.errors import KintrafoError
from ...core.named_types import Array
from ...core.quantities import attributes
from ...simulation.simulate import simulate
from ..analysis.paper import DURATION, REST_HEIGHT, SPIN_RATE, START_HEIGHT
from ..models.model import Model
from ..models.positions import design_height, state_at_height
from .curves import printed
from .grid import Grid, GridAxis

DROP = START_HEIGHT - REST_HEIGHT  # above the design position, as in the paper [m]
STEP = 1e-3  # between two samples [s]
# Computed steps in the step of samples, for the error of the interpolation.
_FINER = 4

# Signals plotted over time, if the model has them.
SIGNALS = (
    "wheel_center_z", "wheel_velocity", "wheel_acceleration", "tyre_force", "spring_force",
    "damper_force",
)  # fmt: skip


@dataclass(frozen=True)
class TimeCurve:
    """One signal over time."""

    # its name, and words for the reader
    name: str
    label: str
    sign: str
    unit: str  # display unit
    factor: float  # from the SI unit to the display unit
    values: Array  # in SI units, (n,)

    @property
    def key(self) -> str:
        """Unique name of the curve on the page."""
        return f"{self.name}_over_time"


@dataclass(frozen=True)
class ReportedMotion:
    """One second of motion."""

    time: GridAxis  # times of the samples [s]
    # (n,): wheel travel [m], rack displacement [m], spin angle of the wheel [rad]
    travel: Array
    rack: Array
    spin: Array
    signals: list[TimeCurve]
    travel_error: float  # largest error of the travel interpolated between two samples [m]
    solver: str  # the solver with its package


@dataclass(frozen=True)
class NoMotion:
    """The reason, in a sentence, why the page has no motion."""

    reason: str


def simulated_second(model: Model, grid: Grid) -> ReportedMotion | NoMotion:
    """Return a second of a wheel released above its design position, with the spin of the paper.

    A motion that leaves the grid cannot be shown.
    """
    try:
        return _shown(_simulate(model), grid)
    except KintrafoError as error:
        return NoMotion(f"The simulation could not be done: {error}")


def _simulate(model: Model) -> ReportedMotion:
    design = design_height(model)
    start = state_at_height(model, design + DROP, spin_rate=SPIN_RATE)
    times = np.linspace(0.0, DURATION, _FINER * round(DURATION / STEP) + 1)
    result = simulate(model, (0.0, DURATION), start, t_eval=times, rtol=1e-8, atol=1e-10)
    travel = result.signals["wheel_center_z"] - design
    rack = np.zeros_like(times)
    if model.free_rack:
        rack = result.y[model.state_names.index(model.names.rack)]
    elif model.suspension.steered():
        rack = result.inputs[:, model.input_names.index("rack_position")]
    time = GridAxis(0.0, STEP, round(DURATION / STEP) + 1)
    kept = slice(None, None, _FINER)
    return ReportedMotion(
        time=time,
        travel=travel[kept],
        rack=rack[kept],
        spin=result.y[model.state_names.index(model.names.spin)][kept],
        signals=[
            _time_curve(model, n, result.signals[n][kept]) for n in SIGNALS if n in result.signals
        ],
        travel_error=float(np.abs(time.interpolate(travel[kept], times) - travel).max()),
        solver=result.solver,
    )


def _time_curve(model: Model, name: str, values: Array) -> TimeCurve:
    signal = model.equations.SIGNALS[name]
    words = attributes(signal["meaning"], signal["unit"])
    unit, factor = printed(words["display_units"]), words["display_factor"]
    return TimeCurve(name, words["long_name"], words["sign"], unit, factor, values)


def _shown(motion: ReportedMotion, grid: Grid) -> ReportedMotion | NoMotion:
    pairs = ("wheel", motion.travel, grid.travel), ("rack", motion.rack, grid.rack)
    for what, values, axis in pairs:
        low, high = values.min(), values.max()
        if low < axis.first or high > axis.last:
            return NoMotion(
                f"The {what} moves from {low * 1e3:.1f} mm to {high * 1e3:.1f} mm, beyond the "
                f"{axis.first * 1e3:.1f} mm to {axis.last * 1e3:.1f} mm that this page covers."
            )
    return motion
