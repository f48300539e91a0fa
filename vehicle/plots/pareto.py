"""Pictures of a Pareto front: each pair of its objectives."""

from itertools import combinations
from pathlib import Path
from typing import Unpack

from matplotlib.axes import Axes

from ...core.quantities import bracketed, display_of
from ...pictures.figures import BLUE, GREEN, ORANGE, wrapped
from ..studies.objectives import Objective
from ..studies.pareto import Front
from .panels import FigureOptions, write_panels

# Letters in a line of the label of an axis.
_LETTERS = 34


def write_front(
    found: Front, path: str | Path, *, chosen: int = 0, **how: Unpack[FigureOptions]
) -> Path:
    """Write a picture of a front, with marks at the given suspension and at members."""
    panels = {f"{a.name} {b.name}": (a, b) for a, b in combinations(found.objectives, 2)}

    def draw(axes: Axes, key: str) -> None:
        _pair(axes, found, panels[key], chosen)

    return write_panels(draw, [*panels], path, height=3.4, **how)


def _pair(axes: Axes, found: Front, pair: tuple[Objective, Objective], chosen: int) -> None:
    factors = [display_of(objective.attributes()).factor for objective in pair]
    across, up = (
        found.dataset[objective.name].values * factor
        for objective, factor in zip(pair, factors, strict=True)
    )
    start = [found.before[o.name] * factor for o, factor in zip(pair, factors, strict=True)]
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


def _label(objective: Objective) -> str:
    """Return the label of an axis, with its direction of optimisation."""
    attrs = objective.attributes()
    name = bracketed(str(attrs["long_name"]), attrs)
    return f"{wrapped(name, _LETTERS)}\n{attrs['wanted']}"
