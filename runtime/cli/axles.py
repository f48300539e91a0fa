"""What the commands do with the file of an axle."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from .axle_curves import tell
from .outputs import Outputs

if TYPE_CHECKING:
    from xarray import Dataset

    from ..assembly.rig import Extent
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
