"""Targets and limits of characteristics, drawn into their curves."""

from collections.abc import Iterable

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from numpy.typing import NDArray

from ...core.errors import InputError
from ...core.quantities import display_of
from ..assembly.by_wheel import WHEEL
from ..models.sides import SIDES
from ..studies.goals import Goal, Limit, TargetValue
from ..studies.sweep_axes import sweep_axis
from .by_axle import SIDE

_RED = "#aa0000"


def of_curve(goals: Iterable[Goal], name: str, over: str) -> list[Goal]:
    """Return the goals of a characteristic over an axis."""
    return [goal for goal in goals if (goal.name, goal.over) == (name, over)]


def about(goals: Iterable[Goal], data: xr.DataArray, along: str) -> dict[str, list[Goal]]:
    """Return the goals of the curves of a panel, by side; under '' those of all curves.

    Curves of both wheels of an axle are over ``wheel``, or of a car over ``side``; equal goals of
    both are one goal of all curves. Goals over parallel travel and over that of one wheel have the
    same axis, and are an `InputError` together.
    """
    own = [goal for goal in goals if sweep_axis(goal.over).along.name == along]
    name = str(data.name)
    found = {"": [goal for goal in own if goal.name == name]}
    if WHEEL in data.dims or SIDE in data.dims:
        both = [[goal for goal in own if goal.name == f"{name}_{side}"] for side in SIDES]
        found[""] += [goal for goal in both[0] if _has_like(both[1], goal)]
        for side, some, others in zip(SIDES, both, reversed(both), strict=True):
            found[side] = [goal for goal in some if not _has_like(others, goal)]
    over = dict.fromkeys(goal.over for some in found.values() for goal in some)
    if len(over) > 1:
        words = " and ".join(over)
        problem = f"goals of {name} over {words} have one axis. Give those of these curves alone."
        raise InputError([problem], "figures")
    return found


def _has_like(goals: Iterable[Goal], goal: Goal) -> bool:
    """Return whether one of some goals equals another but for its name."""
    return any(but_name(other) == but_name(goal) for other in goals)


def but_name(goal: Goal) -> tuple[type, dict[str, list[float] | str]]:
    """Return all attributes of a goal but its name, for comparisons."""
    values = {key: np.asarray(value).tolist() for key, value in vars(goal).items() if key != "name"}
    return type(goal), values


def mark(
    axes: Axes, goals: Iterable[Goal], side: str = "", colour: str = ""
) -> NDArray[np.float64]:
    """Draw targets as points with an error bar of `within`, and limits as lines with arrows beyond.

    The side is that of their curve, if it is one of several. The drawn values are returned, in
    display units.
    """
    marked: list[NDArray[np.float64]] = [np.empty(0)]
    whose = f", {side}" if side else ""
    for goal in goals:
        factor, step = display_of(goal.quantity.attributes()).factor, sweep_axis(goal.over).factor
        if isinstance(goal, TargetValue):
            axes.errorbar(
                step * goal.at, factor * goal.value, factor * goal.within,
                fmt="o", color=colour or "black", markersize=3, linewidth=1.0, capsize=2,
                label=f"target{whose}",
            )  # fmt: skip
            marked += [factor * (goal.value + sign * goal.within) for sign in (-1.0, 1.0)]
        if isinstance(goal, Limit):
            for bound, marker in ((goal.least, 6), (goal.most, 7)):  # carets up and down
                if np.isfinite(bound):
                    at = np.full(goal.at.size, factor * bound)
                    axes.plot(
                        step * goal.at, at, ":", marker=marker, color=colour or _RED,
                        linewidth=1.2, label=f"limit{whose}",
                    )  # fmt: skip
                    marked.append(at)
    return np.concatenate(marked)
