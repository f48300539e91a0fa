"""A rigid or twist-beam axle at design from above, from the left and from behind."""

from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse, Rectangle

from ...core.named_types import Array
from ...core.validator import Validator
from ..models.sides import SIDES
from ..models.whole_axle import WholeAxle

_SPRING, _DAMPER, _WHEEL = "#e69f00", "#56b4e9", "#cfd6dc"
# Components of points to the right and upward in each view, with their senses.
_VIEWS = {
    "from above": ((1, -1.0), (0, 1.0)),
    "from the left": ((0, -1.0), (2, 1.0)),
    "from behind": ((1, -1.0), (2, 1.0)),
}
_NAMES = "xyz"
_LEFTWARD = np.array([0.0, 1.0, 0.0])
# Width of a tyre relative to its radius.
_WIDTH = 0.6
_RADIUS = 0.33  # of wheels without a given radius [m]


def views(axle: WholeAxle) -> Figure:
    """Return a figure of an axle at its design position in three views."""
    with Validator("views") as given:
        given.instance("axle", axle, WholeAxle, "an axle such as a RigidAxle is needed")
    result = Figure(figsize=(6.4, 5.6), layout="constrained")
    grid = result.add_gridspec(2, 2)
    places = (grid[0, 0], grid[0, 1], grid[1, 0])
    lines = list(_lines(axle))
    for (title, ways), place in zip(_VIEWS.items(), places, strict=True):
        axes = result.add_subplot(place)
        _draw(axes, axle, lines, ways)
        axes.set_title(title[:1].upper() + title[1:])
    legend = result.add_subplot(grid[1, 1])
    legend.set_axis_off()
    handles = {label: axes.plot([], [], color=c, lw=w)[0] for label, c, w, *_ in lines}
    legend.legend(handles.values(), handles.keys(), loc="center", frameon=False, fontsize=10)
    return result


def _lines(axle: WholeAxle) -> Iterator[tuple[str, str, float, Array]]:
    """Yield the drawn lines: label, colour, width and points, (n, 3) [m]."""
    yield from axle.drawn_lines()
    for part, color in (("spring", _SPRING), ("damper", _DAMPER)):
        for side in SIDES:
            points = axle.points(side)
            yield f"{part}s", color, 2.0, np.array((points[f"{part}_top"], points[f"{part}_seat"]))


def _draw(
    axes: Axes,
    axle: WholeAxle,
    lines: list[tuple[str, str, float, Array]],
    ways: tuple[tuple[int, float], tuple[int, float]],
) -> None:
    (right, mirror), (up, _) = ways
    sense = np.array([mirror, 1.0])
    radius = axle.tyre_radius() or _RADIUS
    sizes = {0: 2.0 * radius, 1: _WIDTH * radius, 2: 2.0 * radius}
    for sign in (-1.0, 1.0):
        center = (axle.center + sign * axle.half_track * _LEFTWARD)[[right, up]] * sense
        size = sizes[right], sizes[up]
        if {right, up} == {0, 2}:
            axes.add_patch(Ellipse(center, *size, color=_WHEEL, zorder=0))
        else:
            axes.add_patch(Rectangle(center - 0.5 * np.array(size), *size, color=_WHEEL, zorder=0))
    for _, color, width, points in lines:
        seen = points[:, [right, up]] * sense
        axes.plot(*seen.T, color=color, lw=width, solid_capstyle="round")
        if width < 5.0:
            axes.plot(*seen.T, "o", color=color, ms=3.5)
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.06)
    ticks = [f"{_NAMES[right]} [m]", f"{_NAMES[up]} [m]"]
    axes.set_xlabel(ticks[0])
    axes.set_ylabel(ticks[1])
    if mirror < 0.0:
        axes.xaxis.set_major_formatter(lambda value, _: f"{-value + 0.0:.4g}".replace("-", "−"))
