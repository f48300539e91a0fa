"""The chapter about a rigid axle."""

from collections.abc import Sequence

import xarray as xr
from matplotlib import rc_context

from ...core.arguments import Arguments
from ...core.tabulated import Tabulated
from ...plots.figures import STYLE
from ...plots.rigid_axle import views
from ...study import rigid
from ...study.axles import by_side
from ...study.axles.sheet import at_design
from ...study.checkup import Checkup, checkup
from ...study.variation.goals import Goal, check_goals
from ...study.variation.ways import dataset_of
from ...suspension.rigid import RigidAxle
from ...suspension.rigid.model import RigidAxleModel
from .chapter import Chapter, Picture
from .curves import pictures, positions_of, with_wanted

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


def rigid_axle_chapters(axle: RigidAxle, goals: Sequence[Goal] = ()) -> tuple[Chapter, ...]:
    """Return what a first look and a rig find of a rigid axle.

    Parameters
    ----------
    axle : RigidAxle
    goals : sequence of Target and Limit, optional
        From `kintrafo.variation.goals`: those over its motions are drawn into the curves.

    Returns
    -------
    tuple of Chapter
    """
    with Arguments("rigid_axle_chapters") as given:
        given.kind("axle", axle, RigidAxle, RigidAxle.NEEDED)
        check_goals(given, "goals", goals)
    model, wanted = RigidAxleModel(axle), {goal.over for goal in goals}
    curves = {
        motion: dataset_of(model, motion, positions_of(model, motion, goals))
        for motion in [*_DRAWN, *["right"] * ("right" in wanted)]
    }
    found = checkup(axle)
    assert found.axle is not None
    words = f"A {found.axle.heading} on four rods, {', '.join(axle.rods)}.".replace("_", " ")
    told = tuple(f"{kind}: {text}" for kind, text in _told(found))
    look = Tabulated("First look", ("", "value"), tuple(found.axle.rows.items()), frozenset({0, 1}))
    with rc_context(STYLE):
        drawing = Picture.of(views(axle), "The axle from above, from the left and from behind")
    return (
        Chapter("The axle", (words, *told), (look,), (drawing,)),
        Chapter(
            "On a rig",
            ("Springs, stops and anti-roll bar; tyres are rigid where they are not named.",),
            tuple(at_design(curves["bump"], "Over parallel travel: ")),
            tuple(p for motion, found in curves.items() for p in _pictures(motion, found, goals)),
        ),
    )


def _told(found: Checkup) -> list[tuple[str, str]]:
    return [("Problem", text) for text in found.problems] + [("Note", text) for text in found.notes]


def _pictures(motion: str, dataset: xr.Dataset, goals: Sequence[Goal]) -> tuple[Picture, ...]:
    drawn = by_side(dataset)
    own = [goal for goal in goals if goal.over == motion]
    words = rigid.MOTIONS[motion]
    title = words[:1].upper() + words[1:]
    names = with_wanted(drawn, _DRAWN.get(motion, ()), own)
    return pictures(drawn, names, title, f"Curves: {words}", goals=own)
