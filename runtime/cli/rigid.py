"""What the commands do with the file of a rigid axle."""

from pathlib import Path
from typing import TYPE_CHECKING

import typer

from .axle_curves import tell
from .options import among
from .outputs import Outputs

if TYPE_CHECKING:
    from collections.abc import Sequence

    from xarray import Dataset

    from ..assembly.rig import Extent
    from ..report import Chapter
    from ..study.variation.goals import Goal
    from ..suspension.rigid import RigidAxle

# Beside the tables at design: what changes over roll, and over one wheel's travel.
_TOLD = {
    "roll": (
        "roll_moment",
        "roll_moment_gradient",
        "roll_stiffness",
        "roll_center_height",
        "axle_steer",
        "axle_lateral",
    ),
}
_OF_ONE_WHEEL = ("wheel_force_left", "wheel_force_right", "axle_steer", "axle_lateral")


def is_rigid_axle(file: str) -> bool:
    """Tell whether a file is that of a rigid axle."""
    from ..suspension.rigid.axle import is_rigid_axle as found

    return found(file)


def all_rigid(files: list[str]) -> bool:
    """Tell whether files are those of rigid axles; refuse these beside others."""
    rigid = [file for file in files if is_rigid_axle(file)]
    if rigid and len(rigid) < len(files):
        other = next(file for file in files if file not in rigid)
        message = f"{rigid[0]} is a rigid axle and {other} is not: compare files of one sort"
        raise typer.BadParameter(message)
    return bool(rigid)


def motions(wanted: list[str] | None) -> list[str]:
    """Return the motions of the rig that are asked for, or the usual ones."""
    from ..study.rigid import MOTIONS

    return among(wanted or ["bump", "roll", "left"], MOTIONS, "--motion")


def characteristics(
    file: str,
    chosen: list[str],
    extent: "Extent",
    outputs: Outputs,
    *,
    of: list[str] | None,
    goals: Path | None,
    json: bool,
) -> None:
    """All characteristics of a rigid axle over the motions of a rig."""
    from ..study import rigid as study
    from ..suspension.rigid import RigidAxle

    axle = RigidAxle.load(file)
    curves = {motion: study.over(axle, motion, extent) for motion in chosen}
    shown = {motion: _TOLD.get(motion, _OF_ONE_WHEEL) for motion in chosen}
    tell(file, axle, curves, study.MOTIONS, shown, outputs, of=of, goals=goals, json=json)


def compared(files: list[str], motion: str) -> "tuple[Dataset, str, dict[str, RigidAxle]]":
    """Return the characteristics of several rigid axles, their motion and the axles."""
    from ..core.quantities import distinct
    from ..study import rigid as study
    from ..suspension.rigid import RigidAxle

    if motion not in study.MOTIONS:
        raise typer.BadParameter(
            f"--over {motion}: of rigid axles it is {', '.join(study.MOTIONS)}"
        )
    found = dict(zip(distinct(files), map(RigidAxle.load, files), strict=True))
    return study.compare(found, over=motion), motion, found


def report(
    file: str,
    target: Path,
    title: str | None,
    further: "Sequence[Chapter]",
    goals: "Sequence[Goal]",
    *,
    force: bool,
    inputs: list[str | Path],
) -> Path:
    """Write the report of a rigid axle: drawings, tables, curves with goals, further chapters.

    There is nothing to be moved.
    """
    from ..report import rigid_axle_chapters, write_chapters
    from ..suspension.rigid import RigidAxle

    axle = RigidAxle.load(file)
    heading = axle.heading()
    heading = title or f"{heading[:1].upper()}{heading[1:]}"
    chapters = [*rigid_axle_chapters(axle, goals), *further]
    return write_chapters(
        target, title=heading, chapters=chapters, data=axle, force=force, inputs=inputs
    )
