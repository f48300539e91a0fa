"""A Pareto front: each two of its objectives against each other."""

from itertools import combinations
from pathlib import Path
from textwrap import fill
from typing import Unpack

from matplotlib.axes import Axes

from ...core.named_types import Array
from ...core.quantities import bracketed, display_of
from ...pictures.figures import BLUE, GREEN, ORANGE
from ..studies.objectives import Objective
from ..studies.pareto import Front
from .panels import FigureOptions, write_panels

# So many letters of a name stand beside an axis of these pictures.
_LETTERS = 34


def write_front(
    found: Front,
    path: str | Path,
    *,
    chosen: int = 0,
    **how: Unpack[FigureOptions],
) -> Path:
    """Write a front, the suspension as it was, and members that are marked.

    Parameters
    ----------
    found : Front
        From `kintrafo.variation.pareto`.
    path, **how
        As of `panels.write_panels`.
    chosen : int, optional
        A member that is marked besides the compromise.

    Returns
    -------
    pathlib.Path
    """
    panels = {f"{a.name} {b.name}": (a, b) for a, b in combinations(found.objectives, 2)}
    return write_panels(
        lambda axes, key: _pair(axes, found, panels[key], chosen),
        [*panels],
        path,
        height=3.4,
        **how,
    )


def _pair(axes: Axes, found: Front, pair: tuple[Objective, Objective], chosen: int) -> None:
    across, up = (_shown(found, objective) for objective in pair)
    start = [found.before[objective.name] * _factor(objective) for objective in pair]
    axes.plot(across, up, "o", color=BLUE, markersize=4, alpha=0.8, label="front")
    label = "as it is" if found.keeps_limits else "as it is, beyond limits"
    axes.plot(*start, "X", color="black", markersize=8, label=label)
    marks = [(found.compromise, ORANGE, "compromise")]
    if chosen not in (0, found.compromise):
        marks.append((chosen, GREEN, f"member {chosen}"))
    for member, colour, words in marks:
        axes.plot(
            across[member - 1], up[member - 1], "o", markersize=10, markerfacecolor="none",
            markeredgecolor=colour, markeredgewidth=1.8, label=words,
        )  # fmt: skip
    axes.margins(0.06)
    axes.set_xlabel(_label(pair[0]), fontsize=9.5)
    axes.set_ylabel(_label(pair[1]), fontsize=9.5)


def _factor(objective: Objective) -> float:
    return display_of(objective.attributes()).factor


def _shown(found: Front, objective: Objective) -> Array:
    values: Array = found.dataset[objective.name].values * _factor(objective)
    return values


def _label(objective: Objective) -> str:
    """Return what an axis is, and to which side it is better."""
    attrs = objective.attributes()
    name = bracketed(str(attrs["long_name"]), attrs)
    return f"{fill(name, _LETTERS)}\n{attrs['wanted']}"
