"""The chapter about an axle."""

from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr

from ...core.arguments import Arguments
from ...core.tabulated import Tabulated
from ...study import axles
from ...study.axles.sheet import at_design
from ...study.characteristics.datasets import KNOWN
from ...study.variation.goals import Goal, check_goals
from ...study.variation.ways import dataset_of
from ...suspension.axle import Axle
from .chapter import Chapter, Picture
from .curves import pictures, positions_of, with_wanted

# The curves of each motion; those that an axle does not have are left out.
_DRAWN = {
    "roll": (
        "roll_moment",
        "roll_stiffness",
        "roll_center_height",
        "roll_center_lateral",
        "camber",
        "inclination",
        "steer",
        "jacking",
        "link_force",
    ),
    "bump": (
        "roll_center_height",
        "track_change",
        "roll_stiffness",
        "anti_dive",
        "anti_lift_driven",
        "anti_lift_braked",
        "anti_squat",
    ),
    "left": ("wheel_force", "bar_torque", "roll_center_height"),
    "steer": ("steer", "ackermann", "turning_circle", "steering_ratio", "camber", "rack_position"),
}


def axle_chapter(axle: Axle, goals: Sequence[Goal] = ()) -> Chapter:
    """Return what a rig finds of both wheels.

    Parameters
    ----------
    axle : Axle
    goals : sequence of Target and Limit, optional
        From `kintrafo.variation.goals`: those over its motions are drawn into the curves.

    Returns
    -------
    Chapter
    """
    with Arguments("axle_chapter") as given:
        given.kind("axle", axle, Axle, Axle.NEEDED)
        check_goals(given, "goals", goals)
    wanted = {goal.over for goal in goals}
    drawn = [m for m in _DRAWN if m != "steer" or axle.steered()] + ["right"] * ("right" in wanted)
    curves = {motion: _over(axle, motion, goals) for motion in drawn}
    on_rack = ", on one rack" if axle.steered() else ""
    words = [f"Both wheels of the {axle.heading()}{on_rack}."]
    words.append(
        "One side is the mirror image of the other." if axle.symmetric else "The sides differ."
    )
    if axle.bar is not None:
        rate = np.deg2rad(axle.bar.rate())
        part = axle.bar.link_on.replace("_", " ")
        soft = ", its bushes or drop links included" if axle.bar.gives_way() else ""
        words.append(f"Anti-roll bar: {rate:.4g} N m/deg{soft}, drop links on the {part}.")
    # what a wheel has by itself, the page has already, if the sides are alike
    whole = curves["bump"]
    if axle.symmetric:
        own = {f"{q.name}_{side}" for q in KNOWN["travel"].values() for side in axle.sides}
        whole = whole.drop_vars([n for n in own if n in whole and not n.startswith("anti_")])
    return Chapter(
        title="The axle",
        words=(" ".join(words),),
        tables=(*at_design(whole, "Over parallel travel: "), _data_of(axle)),
        pictures=tuple(_pictures(curves, goals)),
    )


def _data_of(axle: Axle) -> Tabulated:
    """Return what the axle's own file says."""
    sections = {
        "anti_roll_bar": axle.bar,
        "drive": axle.drive,
        "brakes": axle.brakes,
        "steering": axle.steering,
    }
    rows = [
        (f"[{name}] {key}", str(value))
        for name, section in sections.items()
        if section is not None
        for key, value in section.model_dump(exclude_none=True).items()
    ]
    title = "Input data of the axle"
    return Tabulated(title, ("key", "value"), tuple(rows), frozenset({0, 1}))


def _over(axle: Axle, motion: str, goals: Sequence[Goal]) -> xr.Dataset:
    """Return all that is told over a motion, at the positions of goals, too."""
    if motion == "steer":
        return axles.over(axle, motion)
    return dataset_of(axle, motion, positions_of(axle, motion, goals))


def _pictures(curves: dict[str, xr.Dataset], goals: Sequence[Goal]) -> Iterator[Picture]:
    for motion, dataset in curves.items():
        drawn = axles.by_side(dataset)
        own = [goal for goal in goals if goal.over == motion]
        # what the motion goes over, as the rack where no ratio is known, is no curve of it
        names = with_wanted(drawn, _DRAWN.get(motion, ()), own)
        words = axles.MOTIONS[motion]
        title = words[:1].upper() + words[1:]
        yield from pictures(drawn, names, title, f"Curves: {words}", goals=own)
