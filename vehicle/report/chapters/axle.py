"""The chapter about an axle, of two corners or rigid: what a rig finds of both wheels."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import xarray as xr
from matplotlib import rc_context

from ....core.tabulated import Tabulated
from ....core.validator import Validator
from ....pictures.figures import STYLE
from ...analysis.characteristics.at_design import at_design
from ...analysis.characteristics.datasets import KNOWN, dataset
from ...analysis.checkup import checkup
from ...assembly.assembly import Assembly
from ...assembly.by_wheel import WHEEL
from ...assembly.of import given_assembly
from ...plots.whole_axle import views
from ...studies.goals import Goal, check_goals
from .chapter import Chapter, ChapterPicture
from .curves import pictures, positions_of, with_wanted

# The curves of each motion; those that an axle does not have are left out.
_DRAWN = {
    "roll": (
        "roll_moment",
        "roll_stiffness",
        "roll_center_height",
        "roll_center_lateral",
        "axle_steer",
        "axle_lateral",
        "camber",
        "inclination",
        "steer",
        "jacking",
        "wheel_force",
        "link_force",
    ),
    "bump": (
        "roll_center_height",
        "track_change",
        "axle_lateral",
        "axle_longitudinal",
        "axle_steer",
        "pinion_angle",
        "roll_steer",
        "roll_stiffness",
        "anti_dive",
        "anti_lift_driven",
        "anti_lift_braked",
        "anti_squat",
        "wheel_rate",
        "damper_motion_ratio",
    ),
    "left": (
        "wheel_force",
        "bar_torque",
        "roll_center_height",
        "camber",
        "axle_steer",
        "axle_lateral",
    ),
    "steer": ("steer", "ackermann", "turning_circle", "steering_ratio", "camber", "rack_position"),
}


def axle_chapter(axle: Any, goals: Sequence[Goal] = ()) -> Chapter:
    """Return the chapter of both wheels on a rig; a rigid axle is drawn, too.

    Parameters
    ----------
    axle : Axle, AxleModel, RigidAxle or RigidAxleModel
    goals : sequence of Target and Limit, optional
        From `kintrafo.variation.goals`: those over its motions are drawn into the curves.

    Returns
    -------
    Chapter

    Raises
    ------
    InputError
        If an argument cannot be used.
    """
    with Validator("axle_chapter") as given:
        assembly = given_assembly(given, axle, "axle")
        if not given.failed and len(assembly.wheels) < 2:
            given.fail("axle: one wheel has no such chapter. Give an Axle or a RigidAxle.")
        check_goals(given, "goals", goals)
    wanted = {goal.over for goal in goals}
    drawn = [*(m for m in _DRAWN if m in assembly.motions), *["right"] * ("right" in wanted)]
    curves = {m: dataset(assembly, m, positions_of(assembly, m, goals)) for m in drawn}
    words, looks, drawings = _of_a_beam(assembly) if assembly.on_a_beam else ((), (), ())
    return Chapter(
        title="The axle",
        words=(assembly.words, *words),
        tables=(
            *looks,
            *at_design(_not_on_the_page(assembly, curves["bump"]), "Over parallel travel: "),
            *_input_data(assembly),
        ),
        pictures=(*drawings, *_pictures(assembly, curves, goals)),
    )


def _of_a_beam(
    assembly: Assembly,
) -> tuple[tuple[str, ...], tuple[Tabulated, ...], tuple[ChapterPicture, ...]]:
    """Return a first look at an axle that nothing on the page moves: words, tables, drawings."""
    found = checkup(assembly)
    assert found.axle is not None
    words = [f"Problem: {text}" for text in found.problems]
    words += [f"Note: {text}" for text in found.notes]
    look = Tabulated("First look", ("", "value"), tuple(found.axle.rows.items()), frozenset({0, 1}))
    with rc_context(STYLE):
        drawing = ChapterPicture.of(
            views(assembly.subject), "The axle from above, from the left and from behind"
        )
    return tuple(words), (look,), (drawing,)


def _not_on_the_page(assembly: Assembly, whole: xr.Dataset) -> xr.Dataset:
    """Return what the page does not have: of like sides it has one wheel by itself."""
    if assembly.on_a_beam or not assembly.symmetric:
        return whole
    own = [n for n, data in whole.items() if WHEEL in data.dims and n in KNOWN["travel"]]
    return whole.drop_vars([name for name in own if not str(name).startswith("anti_")])


def _input_data(assembly: Assembly) -> Iterator[Tabulated]:
    """Yield a table of what the axle's own file says, if it says anything."""
    rows = [
        (f"[{name}] {key}", str(value))
        for name, section in assembly.own_sections.items()
        for key, value in section.model_dump(exclude_none=True).items()
    ]
    if assembly.own_sections:
        title = "Input data of the axle"
        yield Tabulated(title, ("key", "value"), tuple(rows), frozenset({0, 1}))


def _pictures(
    assembly: Assembly, curves: Mapping[str, xr.Dataset], goals: Sequence[Goal]
) -> Iterator[ChapterPicture]:
    for motion, found in curves.items():
        own = [goal for goal in goals if goal.over == motion]
        # what the motion goes over, as the rack where no ratio is known, is no curve of it
        names = with_wanted(found, _DRAWN.get(motion, ()), own)
        words = assembly.motions[motion].words
        title = words[:1].upper() + words[1:]
        yield from pictures(found, names, title, f"Curves: {words}", goals=own)
