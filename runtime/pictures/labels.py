"""Names of curves beside them, where a panel has space for all of its names."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib import patheffects
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from ..core.named_types import Array

_SIZE = 8.0
# Mean width of a letter, and height of a line with its margins, relative to the size of the type.
_WIDE, _HIGH = 0.6, 1.5
_PLACES = 60
_POINTS = 72.0
_HALO = [patheffects.withStroke(linewidth=2.5, foreground="white")]


@dataclass(frozen=True)
class _Box:
    """A position for a name: centre and size in points from the lower left corner of the panel."""

    x: float
    y: float
    width: float
    height: float

    def meets(self, other: "_Box") -> bool:
        """Return whether two boxes overlap."""
        return (
            abs(self.x - other.x) < 0.5 * (self.width + other.width)
            and abs(self.y - other.y) < 0.5 * (self.height + other.height)
        )  # fmt: skip

    def crossed(self, curve: Array) -> bool:
        """Return whether a curve passes through the box."""
        within = np.abs(curve[:, 0] - self.x) < 0.5 * self.width
        return bool(np.any(np.abs(curve[within, 1] - self.y) < 0.5 * self.height))

    def gap(self, curve: Array) -> float:
        """Return the vertical distance of a curve."""
        within = np.abs(curve[:, 0] - self.x) < 0.5 * self.width
        return float(np.min(np.abs(curve[within, 1] - self.y), initial=np.inf))


def label_lines(axes: Axes, lines: Sequence[Line2D], names: Sequence[str], size: Array) -> bool:
    """Write the name of each line beside it, in its colour; return False without space for all.

    The nearest line to a name is its own by far, and no line crosses it. The axes have their
    limits; `size` is the approximate width and height of the panel [in].
    """
    panel = size * _POINTS
    curves = [_in_points(axes, line, panel) for line in lines]
    taken: list[_Box] = []
    for index, name in enumerate(names):
        width, height = _WIDE * _SIZE * len(name), _HIGH * _SIZE
        found = _best(curves, index, taken, (width, height), panel)
        if found is None:
            return False
        taken.append(found)
    for box, name, line in zip(taken, names, lines, strict=True):
        axes.text(
            box.x / panel[0],
            box.y / panel[1],
            name,
            transform=axes.transAxes,
            color=line.get_color(),
            fontsize=_SIZE,
            ha="center",
            va="center",
            path_effects=_HALO,
            zorder=5,
        )
    return True


def _in_points(axes: Axes, line: Line2D, panel: Array) -> Array:
    """Return points of a line, measured from the lower left corner of its panel [points]."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    x, y = (np.asarray(values, dtype=np.float64) for values in line.get_data())
    known = np.isfinite(x) & np.isfinite(y)
    places = np.column_stack([(x - left) / (right - left), (y - low) / (high - low)]) * panel
    places = places[known]
    if len(places) < 2:
        return places
    fine = np.linspace(places[0, 0], places[-1, 0], 4 * _PLACES)
    return np.column_stack([fine, np.interp(fine, places[:, 0], places[:, 1])])


def _best(
    curves: Sequence[Array],
    index: int,
    taken: Sequence[_Box],
    size: tuple[float, float],
    panel: Array,
) -> _Box | None:
    """Return the position for a name from which the other curves are farthest."""
    own, others = curves[index], [c for k, c in enumerate(curves) if k != index]
    width, height = size
    best, least = None, 1.6 * height
    for x in np.linspace(0.5 * width, panel[0] - 0.5 * width, _PLACES):
        within = own[np.abs(own[:, 0] - x) < 0.5 * width]
        if len(within) < 2:
            continue
        for y in (within[:, 1].max() + 0.6 * height, within[:, 1].min() - 0.6 * height):
            box = _Box(float(x), float(y), width, height)
            gap = min((box.gap(other) for other in others), default=np.inf)
            inside = 0.5 * height < y < panel[1] - 0.5 * height
            free = not (box.crossed(own) or any(box.meets(other) for other in taken))
            # of positions that are far enough the first, so that names are at the left
            if inside and free and gap > min(least, 4.0 * height):
                best, least = box, gap
    return best
