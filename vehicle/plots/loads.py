"""Free bodies: every part of a suspension with the forces on it."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.gridspec import GridSpec
from matplotlib.patheffects import withStroke
from matplotlib.text import Annotation

from ...core.files import Paths
from ...core.named_types import Array
from ...pictures.figures import BLUE, ORANGE, STYLE, save, written_plainly
from ..assembly.by_wheel import without_side
from .curves import check_formats

# Chassis axes across and upward in each view, and the sense of the first.
_VIEWS = {"from behind": (1, 2, -1.0), "from the right": (0, 2, 1.0)}
# The longest arrow, relative to the greatest extent of the part, and the least extent [m].
_LONGEST, _LEAST_EXTENT = 0.6, 0.15
# The shortest arrow, relative to the longest. A force with a smaller part than the second number in
# the plane of the view is drawn as a dot in a circle, out of the drawing, or a cross, into it.
_SHORTEST, _ACROSS = 0.12, 0.2
# Width of a part [points], and of its outline.
_THICK, _EDGE = 6.0, 1.2
# A part with more loads has a row for each view. Room for labels on both sides of a drawing, as a
# part of its width.
_MANY, _ASIDE, _ASIDE_NARROW = 4, 0.35, 0.9
# Least height of a row; its height without labels, and for each label in a column [in].
_ROW, _FRAME, _LABEL = 2.7, 0.8, 0.45
# Forces and couples below these are not drawn [N], [N m].
_SMALL_FORCE, _SMALL_MOMENT = 0.5, 1.0
_FROM_OUTSIDE = ("road", "drive", "gravity")
# Width of the figure, and room beside drawings for ticks, labels and titles [in]. They are given: a
# layout computed from all texts takes twice as long as the drawing itself.
_WIDTH, _LEFT, _RIGHT, _BELOW, _ABOVE, _TOP = 7.4, 0.65, 0.1, 0.45, 0.3, 0.35
# Distance of two labels, and of labels from the edge [points].
_ROOM = 3.0
_POINTS = 72.0


def write_free_bodies(
    dataset: xr.Dataset,
    path: Path,
    case: str,
    parts: Sequence[str] | None = None,
    *,
    title: str = "",
    force: bool = False,
    inputs: Paths = (),
) -> Path:
    """Write the moving parts of a suspension with the forces on them in a load case, in two views.

    Rods with forces only at their ends, and parts without loads, are drawn only if they are named.
    """
    check_formats([path])
    with rc_context(STYLE):
        figure = free_bodies(dataset, case, parts, title=f"{title}: forces on the parts in {case}")
        return save(figure, path, force=force, inputs=inputs)


def free_bodies(
    dataset: xr.Dataset, case: str, parts: Sequence[str] | None = None, *, title: str = ""
) -> Figure:
    """Return a figure of the moving parts with the forces on them; see `write_free_bodies`."""
    here = dataset.sel(case=case)
    rods = [str(rod) for rod in here["rod"].values] if "rod" in here.coords else []
    shown = parts or [str(part) for part in here["moving_part"].values if part not in rods]
    every = {part: here.isel(load=(here["part"] == part).values) for part in shown}
    # parts without loads are drawn only if they are named, or if there are no others
    loaded = {part: loads for part, loads in every.items() if len(_drawn(loads))}
    chosen = every if parts or not loaded else loaded
    # a view with many labels has a row of its own
    heights = [
        max(_ROW, _FRAME + _LABEL * -(-len(_drawn(loads)) // 2))
        for loads in chosen.values()
        for _ in (_VIEWS if _crowded(loads) else (0,))
    ]
    figure, grid = _grid(heights)
    row = 0
    labels = {}
    for part, loads in chosen.items():
        for column, view in enumerate(_VIEWS):
            place = grid[row + column, :] if _crowded(loads) else grid[row, column]
            axes = figure.add_subplot(place)
            labels[axes] = _draw(axes, loads, view)
            axes.set_title(f"{part.replace('_', ' ')}, {view}", fontsize=9.5)
        row += len(_VIEWS) if _crowded(loads) else 1
    figure.text(0.5, 1.0 - 0.6 * _TOP / figure.get_figheight(), title, fontsize=11, ha="center")
    for axes, of_view in labels.items():
        axes.apply_aspect()
        _in_columns(axes, of_view)
    return written_plainly(figure)


def _grid(heights: Sequence[float]) -> tuple[Figure, GridSpec]:
    """Return a figure and its grid of drawings, whose rows have these heights [in]."""
    height, width = _TOP + sum(heights), _WIDTH / len(_VIEWS)
    rows = [row - _BELOW - _ABOVE for row in heights]
    figure = Figure(figsize=(_WIDTH, height))
    FigureCanvasAgg(figure)  # keeps one renderer, in which all labels are measured
    grid = figure.add_gridspec(
        len(rows), len(_VIEWS), height_ratios=rows,
        left=_LEFT / _WIDTH, right=1.0 - _RIGHT / _WIDTH,
        bottom=_BELOW / height, top=1.0 - (_TOP + _ABOVE) / height,
        wspace=(_LEFT + _RIGHT) / (width - _LEFT - _RIGHT),
        hspace=(_BELOW + _ABOVE) / (sum(rows) / len(rows)),
    )  # fmt: skip
    return figure, grid


def _drawn(loads: xr.Dataset) -> np.ndarray:
    """Return the indices of the drawn loads: forces and couples above the least sizes."""
    sizes = np.linalg.norm(loads["force"].values, axis=1)
    couples = np.linalg.norm(loads["moment"].values, axis=1)
    return np.flatnonzero((sizes > _SMALL_FORCE) | (couples > _SMALL_MOMENT))


def _crowded(loads: xr.Dataset) -> bool:
    """Return whether labels of the loads on a part would overlap in one row."""
    return len(_drawn(loads)) > _MANY


def _draw(axes: Axes, loads: xr.Dataset, view: str) -> list[Annotation]:
    """Draw a part in one view, and return the labels of the forces."""
    across, upward, sense = _VIEWS[view]
    places = 1e3 * loads["at"].values[:, [across, upward]] * [sense, 1.0]
    forces = loads["force"].values[:, [across, upward]] * [sense, 1.0]
    sizes = np.linalg.norm(loads["force"].values, axis=1)
    _draw_part(axes, loads, places)
    extent = max(float(np.ptp(places, axis=0).max()), 1e3 * _LEAST_EXTENT)
    scale = _LONGEST * extent / max(float(sizes.max()), 1.0)
    labels = []
    for i in _drawn(loads):
        colour = ORANGE if without_side(loads["by"].values[i]) in _FROM_OUTSIDE else BLUE
        strength = float(np.linalg.norm(forces[i]))
        if strength < _ACROSS * sizes[i]:
            # positive is away from the viewer in both views
            away = float(loads["force"].values[i, 1 - across]) > 0.0
            axes.plot(
                *places[i], "o", markersize=9, markerfacecolor="white", color=colour, zorder=4
            )
            axes.plot(*places[i], "x" if away else ".", markersize=6, color=colour, zorder=5)
            tail = places[i]
        elif strength:
            length = max(scale * strength, _SHORTEST * _LONGEST * extent)
            tail = places[i] - length * forces[i] / strength
            style: dict[str, Any] = {"arrowstyle": "-|>", "color": colour, "linewidth": 1.4}
            axes.annotate("", xy=tuple(places[i]), xytext=tuple(tail), arrowprops=style)
        else:
            tail = places[i]
        labels.append(_labelled(axes, loads.isel(load=i), tail, colour))
        axes.plot(*tail, alpha=0.0)  # the limits of the axes include arrows
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(_ASIDE if _crowded(loads) else _ASIDE_NARROW, 0.15)
    axes.tick_params(labelsize=7)
    sides = {1: "y [mm], to the left" if sense > 0 else "-y [mm], to the right", 0: "x [mm]"}
    axes.set_xlabel(sides[across], fontsize=8)
    axes.set_ylabel("z [mm]", fontsize=8)
    return labels


def _labelled(axes: Axes, load: xr.Dataset, tail: np.ndarray, colour: str) -> Annotation:
    """Return the label of a load: its neighbour, its point and its size."""
    size, couple = (float(np.linalg.norm(load[name].values)) for name in ("force", "moment"))
    amounts = [f"{size:.0f} N"] if size > _SMALL_FORCE else []
    amounts += [f"{couple:.0f} N m"] if couple > _SMALL_MOMENT else []
    point = str(load["point"].values)
    where = "" if point == "mass" else f"\nat {point.replace('_', ' ')}"
    words = f"{str(load['by'].values).replace('_', ' ')}{where}\n" + ", ".join(amounts)
    return axes.annotate(
        words, (float(tail[0]), float(tail[1])), (0.0, 0.0), textcoords="offset points",
        fontsize=7.5, color=colour, ha="center", va="center",
        path_effects=[withStroke(linewidth=2.5, foreground="white")],
    )  # fmt: skip


def _draw_part(axes: Axes, loads: xr.Dataset, places: np.ndarray) -> None:
    """Draw the shortest connections between the points of a part."""
    held = np.flatnonzero(loads["point"].values != "mass")
    at = loads["at"].values[held]
    for first, second in _connected(at):
        line = places[held[[first, second]]]
        for width, colour, order in ((_THICK + _EDGE, "#888888", 1), (_THICK, "#eeeeee", 1.1)):
            axes.plot(*line.T, color=colour, linewidth=width, solid_capstyle="round", zorder=order)
    axes.plot(*places[held].T, "o", color="black", markersize=3)


def _connected(at: np.ndarray) -> list[tuple[int, int]]:
    """Return the pairs of points of the minimum spanning tree."""
    distances = np.linalg.norm(at[:, None] - at, axis=2)
    reached, pairs = [0], []
    while len(reached) < len(at):
        open_ = [i for i in range(len(at)) if i not in reached]
        first, second = min(
            ((i, k) for i in reached for k in open_), key=lambda pair: distances[pair]
        )
        reached.append(second)
        pairs.append((first, second))
    return pairs


def _in_columns(axes: Axes, labels: Sequence[Annotation]) -> None:
    """Move labels to the sides of a finished drawing, with lines to their points.

    Their offsets are in points.
    """
    if not labels:
        return
    figure = axes.get_figure(root=True)
    assert figure is not None
    pixels = figure.dpi / _POINTS
    frame = axes.get_window_extent()
    places = axes.transData.transform([label.xy for label in labels]) / pixels
    sizes = np.array([one.get_window_extent().size for one in labels]) / pixels + _ROOM
    order = np.argsort(places[:, 0], kind="stable")
    half = len(labels) // 2
    columns = (
        ("left", order[:half], frame.x0 / pixels + _ROOM, 1.0),
        ("right", order[half:], frame.x1 / pixels - _ROOM, -1.0),
    )
    for side, own, across, inward in columns:
        rows = own[np.argsort(places[own, 1], kind="stable")]
        upward = _stacked(places[rows, 1], sizes[rows, 1], frame.y0 / pixels, frame.y1 / pixels)
        for row, height in zip(rows, upward, strict=True):
            begin = np.array([across, height]) - places[row]
            labels[row].set(position=tuple(begin), ha=side, va="center")
            _join(axes, labels[row], begin + np.array([inward * sizes[row, 0], 0.0]))


def _stacked(wanted: Array, heights: Array, low: float, high: float) -> Array:
    """Return the middles of labels between two limits without overlap, near rising wanted ones."""
    middles = wanted.copy()
    edge = low
    for i, height in enumerate(heights):
        middles[i] = max(middles[i], edge + 0.5 * height)
        edge = middles[i] + 0.5 * height
    edge = high
    for i in reversed(range(heights.size)):
        middles[i] = min(middles[i], edge - 0.5 * heights[i])
        edge = middles[i] - 0.5 * heights[i]
    return middles


def _join(axes: Axes, label: Annotation, offset: Array) -> None:
    """Draw a line from the edge of a label to its point."""
    line = {
        "arrowstyle": "-", "color": label.get_color(), "linewidth": 0.5, "alpha": 0.6,
        "shrinkA": 0.0, "shrinkB": 0.0,
    }  # fmt: skip
    begin = float(offset[0]), float(offset[1])
    axes.annotate("", label.xy, begin, textcoords="offset points", arrowprops=line, zorder=1)
