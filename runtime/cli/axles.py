"""What the commands do with the file of an axle."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import typer
from rich.markup import escape
from rich.table import Table

from .axle_curves import tell
from .console import console, problems
from .outputs import Outputs

if TYPE_CHECKING:
    from xarray import Dataset

    from ..assembly.rig import Extent
    from ..simulation.result import Simulation
    from ..study.axles.checkup import AxleCheckup
    from ..suspension.axle import Axle

# Beside the tables at design: what changes over roll, over steering, and over one wheel's travel.
_TOLD = {
    "roll": (
        "roll_moment",
        "roll_moment_gradient",
        "roll_stiffness",
        "roll_center_height",
        "roll_center_lateral",
        "inclination_left",
        "inclination_right",
    ),
    "steer": ("steer_left", "steer_right", "ackermann", "turning_circle", "steering_ratio"),
}
_OF_ONE_WHEEL = (
    "wheel_force_left",
    "wheel_force_right",
    "bar_torque",
    "track",
    "roll_center_height",
)
# On the page of curves of a simulation, for both sides.
_DRAWN = ("wheel_center_z", "wheel_acceleration", "tyre_force", "camber", "toe")


def is_axle(file: str) -> bool:
    """Tell whether a file is that of an axle."""
    from ..suspension.axle.axle import is_axle as found

    return found(file)


def all_axles(files: list[str]) -> bool:
    """Tell whether files are those of axles; refuse axles beside suspensions."""
    from ..suspension.kinds import Suspension

    axles = [file for file in files if is_axle(file)]
    if axles and len(axles) < len(files):
        other = next(file for file in files if file not in axles)
        Suspension.load(other)  # says what is wrong with one that is neither
        message = f"{axles[0]} is an axle and {other} is not: compare files of one sort"
        raise typer.BadParameter(message)
    return bool(axles)


def refuse_options(sort: str, given: Mapping[str, Any]) -> None:
    """Refuse options that the files of one sort do not have."""
    for option, value in given.items():
        if value is not None:
            raise typer.BadParameter(f"{option} is only for {sort}")


def characteristics(
    file: str,
    motions: list[str],
    extent: "Extent",
    held: Mapping[str, float],
    outputs: Outputs,
    *,
    of: list[str] | None,
    goals: Path | None,
    json: bool,
) -> None:
    """All characteristics of an axle over the motions of a rig."""
    from ..study import axles
    from ..suspension.axle import Axle

    axle = Axle.load(file)
    curves = {motion: axles.over(axle, motion, extent, **held) for motion in motions}
    shown = {motion: _TOLD.get(motion, _OF_ONE_WHEEL) for motion in motions}
    tell(file, axle, curves, axles.MOTIONS, shown, outputs, of=of, goals=goals, json=json)


def compared(files: list[str], motion: str) -> "tuple[Dataset, str, dict[str, Axle]]":
    """Return the characteristics of several axles, their motion and the axles."""
    from ..core.quantities import distinct
    from ..study import axles
    from ..suspension.axle import Axle

    if motion not in axles.MOTIONS:
        raise typer.BadParameter(f"--over {motion}: of axles it is {', '.join(axles.MOTIONS)}")
    found = dict(zip(distinct(files), map(Axle.load, files), strict=True))
    return axles.compare(found, over=motion), motion, found


def looked_at(file: str) -> "AxleCheckup":
    """Return a first look at an axle."""
    from ..study.axles.checkup import checkup
    from ..suspension.axle import Axle

    return checkup(Axle.load(file))


def print_look(found: "AxleCheckup", file: str) -> None:
    """Print what an axle has besides its sides."""
    table = Table(title=f"{escape(file)}: {escape(found.heading)}", show_header=False)
    for name, text in found.rows.items():
        table.add_row(name, escape(text))
    console.print(table)


class Ride(NamedTuple):
    """What ``kintrafo simulate`` simulates.

    Attributes
    ----------
    model : Model or AxleModel
    run : callable
        Takes the model, a scenario and options of `kintrafo.simulate`.
    curves : sequence of str
        What stands in the table and on the page, in this order.
    loads : callable
        Takes the model and the result, and returns the loads on every part.
    drawn : callable
        Takes the motion, and returns it as it is drawn.
    wheels : sequence of str
        What begins the names of their events, in the order of the result.
    """

    model: Any
    run: Callable[..., tuple["Simulation", "Dataset"]]
    curves: Sequence[str]
    loads: Callable[[Any, "Simulation"], "Dataset"]
    drawn: Callable[["Dataset"], "Dataset"] = lambda motion: motion
    wheels: Sequence[str] = ("",)


def ride(file: str, wheels: str, *, wheel_loads: bool) -> Ride:
    """Return an axle to be simulated over a road under one wheel or both."""
    from ..study import axles
    from ..study.axles import ride as study
    from ..suspension.axle import Axle
    from ..suspension.axle.equations import AxleModel

    axle = Axle.load(file)
    with problems.status("preparing the equations of the axle") as status:
        model = AxleModel(
            axle,
            progress=lambda text: status.update(f"the axle: {text}"),
            wheel_loads=wheel_loads,
        )
    stems = ("road_height", *(f"{axle.end}_{part}" for part in _DRAWN))
    of_wheels = [f"{side}_{stem}" for stem in stems for side in ("left", "right")]
    curves = ("rack_position", *of_wheels, "bar_angle", "bar_spring_moment")
    played = partial(study.run, wheels=wheels)
    return Ride(model, played, curves, axles.loads_along, study.by_side, wheels=("left_", "right_"))
