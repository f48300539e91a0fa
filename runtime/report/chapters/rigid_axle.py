"""The chapter about a rigid axle."""

import numpy as np
import xarray as xr
from matplotlib import rc_context

from ...core.arguments import Arguments
from ...core.tabulated import Tabulated
from ...plots.curves import figure
from ...plots.figures import STYLE
from ...plots.rigid_axle import views
from ...study import rigid
from ...study.axles import by_side
from ...study.axles.sheet import at_design
from ...study.rigid.checkup import RigidAxleCheckup, checkup
from ...suspension.rigid import RigidAxle
from .chapter import Chapter, Picture

# The curves of each motion; those that an axle does not have are left out.
_DRAWN = {
    "roll": (
        "axle_steer",
        "axle_lateral",
        "roll_center_height",
        "roll_moment",
        "roll_stiffness",
        "wheel_force",
    ),
    "bump": (
        "axle_lateral",
        "axle_longitudinal",
        "axle_steer",
        "pinion_angle",
        "roll_center_height",
        "roll_steer",
        "anti_dive",
        "anti_lift_driven",
        "anti_lift_braked",
        "anti_squat",
        "wheel_rate",
        "damper_motion_ratio",
    ),
    "left": ("wheel_force", "camber", "axle_steer", "axle_lateral"),
}


def rigid_axle_chapters(axle: RigidAxle) -> tuple[Chapter, ...]:
    """Return what a first look and a rig find of a rigid axle.

    Parameters
    ----------
    axle : RigidAxle

    Returns
    -------
    tuple of Chapter
    """
    with Arguments("rigid_axle_chapters") as given:
        given.kind("axle", axle, RigidAxle, RigidAxle.NEEDED)
    curves = {motion: rigid.over(axle, motion) for motion in _DRAWN}
    found = checkup(axle)
    words = f"A {found.heading} on four rods, {', '.join(axle.rods)}.".replace("_", " ")
    told = tuple(f"{kind}: {text}" for kind, text in _told(found))
    look = Tabulated("First look", ("", "value"), tuple(found.rows.items()), frozenset({0, 1}))
    with rc_context(STYLE):
        drawing = Picture.of(views(axle), "The axle from above, from the left and from behind")
    return (
        Chapter("The axle", (words, *told), (look,), (drawing,)),
        Chapter(
            "On a rig",
            ("Springs, stops and anti-roll bar; tyres are rigid where they are not named.",),
            tuple(at_design(curves["bump"], "Over parallel travel: ")),
            tuple(_picture(motion, dataset) for motion, dataset in curves.items()),
        ),
    )


def _told(found: RigidAxleCheckup) -> list[tuple[str, str]]:
    return [("Problem", text) for text in found.problems] + [("Note", text) for text in found.notes]


def _picture(motion: str, dataset: xr.Dataset) -> Picture:
    drawn = by_side(dataset)
    there = [name for name in _DRAWN[motion] if name in drawn.data_vars]
    names = [name for name in there if bool(np.isfinite(drawn[name]).any())]
    words = rigid.MOTIONS[motion]
    with rc_context(STYLE):
        page = figure(drawn, names, title=words[:1].upper() + words[1:], alone=False)
        return Picture.of(page, f"Curves: {words}")
