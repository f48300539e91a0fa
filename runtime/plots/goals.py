"""Targets and limits of characteristics, drawn into their curves."""

from collections.abc import Iterable

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from ..core.quantities import display_of
from ..study.variation.goals import Goal, Limit, Target
from ..study.variation.ways import WAYS, way

_RED = "#aa0000"


def over_of(along: str) -> str | None:
    """Return what curves over a dimension are called as goals have it; None for any other."""
    return next((over for over, known in WAYS.items() if known.along.name == along), None)


def mark(axes: Axes, goals: Iterable[Goal], name: str, over: str) -> NDArray[np.float64]:
    """Mark what a characteristic is wanted to be, and what it must not pass.

    A target is a point with what matters of it to either side; of limits, arrows stand beyond.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    goals : iterable of Goal
        Those of other curves are left out.
    name, over : str
        The characteristic, and what it is over.

    Returns
    -------
    ndarray
        The values that were marked, as they are displayed.
    """
    own = [goal for goal in goals if (goal.name, goal.over) == (name, over)]
    if not own:
        return np.empty(0)
    factor = display_of(own[0].quantity.attributes()).factor
    step = way(over).factor
    marked: list[NDArray[np.float64]] = []
    for goal in own:
        if isinstance(goal, Target):
            axes.errorbar(
                step * goal.at, factor * goal.value, factor * goal.within,
                fmt="o", color="black", markersize=3, linewidth=1.0, capsize=2, label="target",
            )  # fmt: skip
            marked += [factor * (goal.value + side * goal.within) for side in (-1.0, 1.0)]
        if isinstance(goal, Limit):
            for bound, marker in ((goal.least, 6), (goal.most, 7)):  # carets up and down
                if np.isfinite(bound):
                    at = np.full(goal.at.size, factor * bound)
                    axes.plot(
                        step * goal.at, at, ":", marker=marker, color=_RED, linewidth=1.2,
                        label="limit",
                    )  # fmt: skip
                    marked.append(at)
    return np.concatenate(marked)
