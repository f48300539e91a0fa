"""The chapter of compliance."""

from collections.abc import Sequence

import xarray as xr

from ....core.validator import Validator
from ...analysis.compliance.flexibility import HELD
from ...analysis.compliance.tables import compliances, compliances_of_beam
from ...plots.curves import grouped
from ...studies.goals import Goal, check_goals
from .chapter import Chapter
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
