"""Curves of a chapter as pictures, with targets and limits."""

from collections.abc import Iterable, Sequence
from math import ceil

import numpy as np
import xarray as xr
from matplotlib import rc_context
from numpy.typing import NDArray

from ....core.errors import InputError
from ....core.quantities import heading_of
from ....pictures.figures import STYLE, small
from ...assembly.assembly import Assembly
from ...models.sides import SIDES
from ...plots.curves import figure
from ...studies.evaluation import usual_positions
from ...studies.goals import Goal
from .chapter import ChapterPicture

# Panels in a row, for the width of a phone, and on a sheet.
_COLUMNS, _MOST = 2, 8
# Most positions beyond the usual ones to either side, more than any wheel reaches.
_MOST_BEYOND = 1000


def pictures(
    dataset: xr.Dataset, names: Sequence[str], title: str, words: str, *, goals: Sequence[Goal] = ()
) -> tuple[ChapterPicture, ...]:
    """Return pictures of some curves, eight in each, with a title and a description.

    Curves of both wheels of an axle are over ``wheel``. Goals of other curves are left out.
    """
    count = -(-len(names) // _MOST)
    found = []
    for index, part in enumerate(np.array_split(np.arange(len(names)), max(count, 1))):
        first, line, others = title.partition("\n")
        which = f", {index + 1} of {count}" if count > 1 else ""
        with rc_context(STYLE):
            drawn = figure(
                dataset, [names[i] for i in part], title=f"{first}{which}{line}{others}",
                alone=False, columns=_COLUMNS, goals=goals,
            )  # fmt: skip
            found.append(ChapterPicture.of(drawn, f"{words}{which}"))
    return tuple(found)


def small_pictures(
    dataset: xr.Dataset, names: Sequence[str], words: str = "", *, goals: Sequence[Goal] = ()
) -> tuple[ChapterPicture, ...]:
    """Return a small picture of each curve, for the panels of a chapter.

    The motion of the curves is described in a chapter with several motions. Goals of other curves
    are left out.
    """
    found = []
    with rc_context(STYLE):
        for name in names:
            drawn = small(figure(dataset, [name], alone=False, goals=goals))
            heading = heading_of(dataset[name])
            found.append(ChapterPicture.of(drawn, f"{heading}: {words}" if words else heading))
    return tuple(found)


def with_wanted(dataset: xr.Dataset, usual: Iterable[str], goals: Iterable[Goal]) -> list[str]:
    """Return the names of the usual curves with data, and of curves with goals.

    A goal of another curve is an `InputError`.
    """
    there = [name for name in usual if name in dataset.data_vars]
    names = dict.fromkeys(n for n in there if bool(np.isfinite(dataset[n]).any()))
    return [*(names | dict.fromkeys(_curve(dataset, goal.name) for goal in goals))]


def _curve(dataset: xr.Dataset, name: str) -> str:
    """Return the curve of a characteristic, of one wheel or of both."""
    of_both = (name.removesuffix(f"_{side}") for side in SIDES if name.endswith(f"_{side}"))
    for known in (name, *of_both):
        if known in dataset.data_vars:
            return known
    problem = (
        f"there is no curve of {name} here. Leave it out, or give the data that it needs, see "
        "[vehicle], [rack], [tyre] and [bushings]."
    )
    raise InputError([problem], "goals")


def positions_of(assembly: Assembly, over: str, goals: Iterable[Goal]) -> NDArray[np.float64]:
    """Return the usual positions over an axis and those of goals, with the same steps to these."""
    usual = usual_positions(assembly, over)
    wanted = [goal.at for goal in goals if goal.over == over]
    if not wanted or usual.size == 1:  # a load case has one usual position
        return np.unique(np.concatenate([usual, *wanted]))
    own = np.concatenate([usual[:1], *wanted])
    step = float(np.diff(usual).max())
    ends = (usual[0], min(usual[0], own.min())), (usual[-1], max(usual[-1], own.max()))
    # positions out of reach are errors anyway, so that few are enough
    beyond = (np.linspace(*way, 1 + min(ceil(np.ptp(way) / step), _MOST_BEYOND)) for way in ends)
    return np.unique(np.concatenate([usual, own, *beyond]))
