"""The chapters of compliance and of elastokinematics."""

from collections.abc import Sequence

import xarray as xr

from ....core.quantities import long_name
from ....core.validator import Validator
from ...analysis.characteristics.datasets import DATA_SET
from ...analysis.compliance.flexibility import HELD
from ...analysis.compliance.tables import compliances, compliances_of_beam, deflections
from ...assembly.by_wheel import WHEEL, flat
from ...assembly.quantity import RACK
from ...plots.curves import grouped
from ...studies.goals import Goal, check_goals
from .chapter import Chapter, ChapterPicture
from .curves import pictures, with_wanted


def compliance_chapter(found: xr.Dataset, goals: Sequence[Goal] = ()) -> Chapter:
    """Return the chapter of deflections on bushes, of a wheel or both wheels of an axle.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `kintrafo.compliance.linear`.
    goals : sequence of TargetValue and Limit, optional
        Result of `kintrafo.variation.goals`: those with the same support of the wheels are drawn
        into the curves. They are for the middle position of the rack.

    Returns
    -------
    Chapter
    """
    with Validator("compliance_chapter") as given:
        given.dataset(found, over="wheel_travel")
        check_goals(given, "goals", goals)
    curves = found.drop_dims([name for name in ("moved", "by") if name in found.dims])
    own = [goal for goal in goals if HELD.get(goal.over) == found.attrs["held"]]
    usual = [str(name) for group in grouped(curves, own).values() for name in group]
    names = with_wanted(curves, usual, own)
    title = "Compliance over wheel travel"
    drawn = pictures(curves, names, title, "Compliances over wheel travel", goals=own)
    words = f"Linear compliance by the unit-load theorem, relaxed bushes: {found.attrs['held']}."
    sheets = compliances(found, "At design"), *compliances_of_beam(found, "At design, the axle")
    return Chapter("Compliance", (words,), sheets, drawn)


def elastokinematics_chapter(*found: xr.Dataset, goals: Sequence[Goal] = ()) -> Chapter:
    """Return the chapter of wheels on bushes and with rigid joints.

    Parameters
    ----------
    *found : xarray.Dataset
        Result of `kintrafo.compliance.elastokinematics`, each over another motion.
    goals : sequence of TargetValue and Limit, optional
        Result of `kintrafo.variation.goals`: those of these curves are drawn into them. They are
        for rigid joints and the middle position of the rack.

    Returns
    -------
    Chapter

    Raises
    ------
    InputError
        If an argument cannot be used, or the rack of curves with goals is not in the middle.
    """
    with Validator("elastokinematics_chapter") as given:
        if not found:
            given.fail("dataset: one or more are needed.")
        for dataset in found:
            given.dataset(dataset, over=DATA_SET)
        check_goals(given, "goals", goals)
        if not given.failed:
            wanted = [_about(given, flat(dataset), goals) for dataset in found]
    sheets = []
    drawn: list[ChapterPicture] = []
    for dataset, own in zip(found, wanted, strict=True):
        (along,) = (name for name in dataset.sizes if name not in (DATA_SET, WHEEL))
        columns, over = flat(dataset), dataset[along].attrs["long_name"]
        title = f"Kinematic and elastokinematic, over {over}"
        words = f"Curves over {over} with rigid joints and on the bushes"
        drawn += pictures(columns, list(map(str, columns)), title, words, goals=own)
        sheets += deflections(dataset, f"Over {over}")
    hardpoints = found[0].attrs["hardpoints"]
    words = f"The curves are equilibria of all parts with deflections of any size: {hardpoints}."
    of_goals = ["Targets and limits apply to the curves with rigid joints."] if any(wanted) else []
    return Chapter("Elastokinematics", (words, *of_goals), tuple(sheets), tuple(drawn))


def _about(given: Validator, dataset: xr.Dataset, goals: Sequence[Goal]) -> list[Goal]:
    """Return the goals of curves in a dataset, which have the same name and long name."""
    if goals and "over" not in dataset.attrs:
        given.fail(
            'goals: the dataset has no attrs["over"], the name of its motion. Compute it again, or '
            "leave the goals out."
        )
    own = [
        goal
        for goal in goals
        if goal.over == dataset.attrs.get("over")
        and goal.name in dataset
        and long_name(dataset[goal.name]) == goal.quantity.long_name
    ]
    rack = dataset.coords.get(RACK.name)
    if own and rack is not None and rack.ndim == 0 and float(rack) != 0.0:
        given.fail(
            f"goals: they are about the rack in its middle, and here it is at {1e3 * float(rack):g}"
            " mm. Give curves with rack_position = 0, or leave the goals out."
        )
    return own
