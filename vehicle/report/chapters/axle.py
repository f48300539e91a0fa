"""The chapter of an axle or a car: characteristics of all wheels over the motions of a rig."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import xarray as xr
from markupsafe import Markup
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
from ...plots.by_axle import by_axle, names_by_axle
from ...plots.motion.rig import rig_player
from ...plots.whole_axle import views
from ...studies.goals import Goal, check_goals
from .chapter import Chapter, ChapterPicture
from .curves import pictures, positions_of, small_pictures, with_wanted

# The curves of each motion; those that an axle does not have are left out.
_DRAWN = {
    "heave": (
        "camber", "steer", "track_change", "wheelbase_change", "roll_center_height", "wheel_rate",
        "damper_motion_ratio",
    ),
    "pitch": ("camber", "steer", "anti_dive", "anti_lift_driven", "anti_lift_braked", "anti_squat"),
    "roll": (
        "roll_moment", "roll_stiffness", "roll_center_height", "roll_center_lateral", "axle_steer",
        "axle_lateral", "camber", "inclination", "steer", "jacking", "wheel_force", "link_force",
    ),
    "bump": (
        "roll_center_height", "track_change", "axle_lateral", "axle_longitudinal", "axle_steer",
        "pinion_angle", "roll_steer", "roll_stiffness", "anti_dive", "anti_lift_driven",
        "anti_lift_braked", "anti_squat", "wheel_rate", "damper_motion_ratio",
    ),
    "left": (
        "wheel_force", "bar_torque", "roll_center_height", "camber", "axle_steer", "axle_lateral",
    ),
    "steer": ("steer", "ackermann", "turning_circle", "steering_ratio", "camber", "rack_position"),
}  # fmt: skip


def axle_chapter(axle: Any, goals: Sequence[Goal] = ()) -> Chapter:
    """Return the chapter of all wheels on a rig, with a drawing of a rigid axle.

    Parameters
    ----------
    axle : Axle, AxleModel, RigidAxle, RigidAxleModel, Car or CarModel
    goals : sequence of TargetValue and Limit, optional
        Result of `kintrafo.variation.goals`: those over the motions are drawn into the curves.

    Returns
    -------
    Chapter

    Raises
    ------
    InputError
        If an argument cannot be used.
    """
    with Validator("axle_chapter") as given:
        assembly = given_assembly(given, axle, "axle", cars=True)
        if not given.failed and len(assembly.wheels) < 2:
            given.fail("axle: one wheel has no such chapter. Give an Axle, a RigidAxle or a Car.")
        check_goals(given, "goals", goals)
    wanted = {goal.over for goal in goals}
    drawn = [*(m for m in _DRAWN if m in assembly.motions), *["right"] * ("right" in wanted)]
    curves = {m: dataset(assembly, m, positions_of(assembly, m, goals)) for m in drawn}
    words, looks, drawings = _of_a_whole_axle(assembly) if _is_whole(assembly) else ((), (), ())
    players = _players(assembly)
    words += (_PLAYED,) * len(players)
    usual = assembly.usual_motion
    over = assembly.motions[usual].title if assembly.axles else "parallel travel"
    shown = tuple(_pictures(assembly, curves, goals))
    return Chapter(
        title="Over motions of the body" if assembly.axles else "The axle",
        words=() if assembly.axles else (assembly.words, *words),
        tables=(
            *looks,
            *at_design(_not_on_the_page(assembly, curves[usual]), f"Over {over}: "),
            *_input_data(assembly),
        ),
        panels=shown if assembly.axles else (),
        pictures=drawings if assembly.axles else (*drawings, *shown),
        players=players,
    )


def _is_whole(assembly: Assembly) -> bool:
    """Return whether an axle has no two suspensions: the page has no interactive view of it."""
    return not (assembly.corners or assembly.axles)


def _of_a_whole_axle(
    assembly: Assembly,
) -> tuple[tuple[str, ...], tuple[Tabulated, ...], tuple[ChapterPicture, ...]]:
    """Return words, tables and drawings of an axle without an interactive view."""
    found = checkup(assembly)
    assert found.axle is not None
    words = [f"Problem: {text}" for text in found.problems]
    words += [f"Note: {text}" for text in found.notes]
    look = Tabulated("Summary", ("", "value"), tuple(found.axle.rows.items()), frozenset({0, 1}))
    with rc_context(STYLE):
        drawing = ChapterPicture.of(
            views(assembly.subject), "The axle from above, from the left and from behind"
        )
    return tuple(words), (look,), (drawing,)


_PLAYED = (
    "The motions of the rig follow one another, each over its usual range: the picture and the "
    "curves over time show them."
)


def _players(assembly: Assembly) -> tuple[Markup, ...]:
    """Return the player of a rigid axle or a twist beam; other axles have the interactive view."""
    plays = _is_whole(assembly) and assembly.moves_rigidly
    return (rig_player(assembly),) if plays else ()


def _not_on_the_page(assembly: Assembly, whole: xr.Dataset) -> xr.Dataset:
    """Return characteristics without those of a wheel if its page has them: of equal sides."""
    if _is_whole(assembly) or assembly.axles or not assembly.symmetric:
        return whole
    own = [n for n, data in whole.items() if WHEEL in data.dims and n in KNOWN["travel"]]
    return whole.drop_vars([name for name in own if not str(name).startswith("anti_")])


def _input_data(assembly: Assembly) -> Iterator[Tabulated]:
    """Yield a table of the axle's own sections, if it has some."""
    rows = [
        (f"[{name}] {key}", str(value))
        for name, section in assembly.own_sections.items()
        for key, value in section.model_dump(exclude_none=True).items()
    ]
    if assembly.own_sections:
        yield Tabulated("Input data of the axle", ("key", "value"), tuple(rows), frozenset({0, 1}))


def _pictures(
    assembly: Assembly, curves: Mapping[str, xr.Dataset], goals: Sequence[Goal]
) -> Iterator[ChapterPicture]:
    for motion, found in curves.items():
        own = [goal for goal in goals if goal.over == motion]
        # the axis of the motion, such as the rack without a steering ratio, is not a curve
        shown, usual = _by_axle(assembly, found, _DRAWN.get(motion, ()))
        names = with_wanted(shown, usual, own)
        words = assembly.motions[motion].words
        if assembly.axles:  # both axles have twice as many curves
            yield from small_pictures(shown.reset_coords(drop=True), names, words, goals=own)
            continue
        title = words[:1].upper() + words[1:]
        yield from pictures(shown, names, title, f"Curves: {words}", goals=own)


def _by_axle(
    assembly: Assembly, found: xr.Dataset, names: Sequence[str]
) -> tuple[xr.Dataset, Sequence[str]]:
    """Return curves of a car by axle, front before rear; those of an axle unchanged."""
    if not assembly.axles:
        return found, names
    of_axles = [n for n in names if n in found and WHEEL not in found[n].dims]
    paired = [*(n for n in names if n not in of_axles), *of_axles]
    return by_axle(found), names_by_axle(found, paired)
