"""Labels of a crowded drawing, in columns at its sides."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.text import Annotation

from ...core.named_types import Array

# Distance of two labels, and of labels from the edge [points].
_ROOM = 3.0
_POINTS = 72.0


def in_columns(axes: Axes, labels: Sequence[Annotation]) -> None:
    """Move labels to the sides of a finished drawing, with lines to their points.

    Parameters
    ----------
    axes : Axes
    labels : sequence of Annotation
        With offsets in points.
    """
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
