"""The curves of a chapter as pictures, with what is wanted of them."""

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

# So few beside each other are read on the width of a phone, too; and so many fill a sheet.
_COLUMNS, _MOST = 2, 8
# So many positions beyond the usual ones, to either side, are more than any wheel reaches.
_MOST_BEYOND = 1000


def pictures(
    dataset: xr.Dataset,
    names: Sequence[str],
    title: str,
    words: str,
    *,
    goals: Sequence[Goal] = (),
) -> tuple[ChapterPicture, ...]:
    """Return curves in as many pictures as they need, all of which are read on any width.

    Parameters
    ----------
    dataset : xarray.Dataset
        Those of both wheels of an axle over ``wheel``.
    names : sequence of str
    title : str
        Above each picture.
    words : str
        What they show.
    goals : sequence of Goal, optional
        About these curves; those of others are left out.
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

    Parameters
    ----------
    dataset : xarray.Dataset
    names : sequence of str
    words : str, optional
        The motion of the curves, in a chapter with several motions.
    goals : sequence of Goal, optional
        About these curves; those of others are left out.
    """
    found = []
    with rc_context(STYLE):
        for name in names:
            drawn = small(figure(dataset, [name], alone=False, goals=goals))
            heading = heading_of(dataset[name])
            found.append(ChapterPicture.of(drawn, f"{heading}: {words}" if words else heading))
    return tuple(found)


def with_wanted(dataset: xr.Dataset, usual: Iterable[str], goals: Iterable[Goal]) -> list[str]:
    """Return which curves are drawn: the usual ones that there are, and what goals are about.

    Parameters
    ----------
    dataset : xarray.Dataset
        As of `pictures`.
    usual : iterable of str
        Names, of which the file may not have the data.
    goals : iterable of Goal
        About curves of this dataset.

    Raises
    ------
    InputError
        If a goal is about something else.
    """
    there = [name for name in usual if name in dataset.data_vars]
    names = dict.fromkeys(n for n in there if bool(np.isfinite(dataset[n]).any()))
    return [*(names | dict.fromkeys(_curve(dataset, goal.name) for goal in goals))]


def _curve(dataset: xr.Dataset, name: str) -> str:
    """Return the curve in which a characteristic is, alone or with that of the other wheel."""
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
    """Return the usual positions over something, as far as goals about it, and theirs [m] or [rad].

    Beyond the usual ones they are as near to each other: curves are no straight lines there.
    """
    usual = usual_positions(assembly, over)
    wanted = [goal.at for goal in goals if goal.over == over]
    if not wanted:
        return usual
    own = np.concatenate([usual[:1], *wanted])
    step = float(np.diff(usual).max())
    ends = (usual[0], min(usual[0], own.min())), (usual[-1], max(usual[-1], own.max()))
    # of what is so far that nothing reaches it, it is enough that it is refused
    beyond = (np.linspace(*way, 1 + min(ceil(np.ptp(way) / step), _MOST_BEYOND)) for way in ends)
    return np.unique(np.concatenate([usual, own, *beyond]))
