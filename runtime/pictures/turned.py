"""Panels whose position is on the vertical axis, as suspension engineers draw wheel travel."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import Collection, LineCollection, PolyCollection
from matplotlib.lines import Line2D

# Markers that point up, down or across, and the same with the axes exchanged.
_MARKERS: dict[Any, Any] = {6: 5, 7: 4, "_": "|"}


def turn(axes: Axes) -> None:
    """Exchange the axes of a panel with all lines, bands, error bars, limits and labels in it."""
    limits = axes.get_xlim(), axes.get_ylim()
    across, upward = axes.xaxis, axes.yaxis
    locators = across.get_major_locator(), upward.get_major_locator()
    formatters = across.get_major_formatter(), upward.get_major_formatter()
    for line in axes.get_lines():
        _turn_line(axes, line)
    for collection in axes.collections:
        _turn_collection(collection)
    labels = [(axis.label.get_text(), axis.label.get_fontsize()) for axis in (upward, across)]
    axes.set_xlabel(labels[0][0], fontsize=labels[0][1])
    axes.set_ylabel(labels[1][0], fontsize=labels[1][1])
    axes.set_xlim(limits[1])
    axes.set_ylim(limits[0])
    for axis, locator, formatter in (
        (upward, locators[0], formatters[0]),
        (across, locators[1], formatters[1]),
    ):
        axis.set_major_locator(locator)
        axis.set_major_formatter(formatter)


def _turn_line(axes: Axes, line: Line2D) -> None:
    """Exchange the coordinates of a line; for one across the panel the transform, too."""
    x, y = line.get_data(orig=False)
    line.set_data(y, x)
    over_height = axes.get_xaxis_transform(which="grid")
    over_width = axes.get_yaxis_transform(which="grid")
    transform = line.get_transform()
    if transform == over_height:
        line.set_transform(over_width)
    elif transform == over_width:
        line.set_transform(over_height)
    marker = line.get_marker()
    if marker in _MARKERS:
        line.set_marker(_MARKERS[marker])


def _turn_collection(collection: Collection) -> None:
    """Exchange the coordinates of bands and error bars."""
    if isinstance(collection, LineCollection):
        collection.set_segments([np.asarray(part)[:, ::-1] for part in collection.get_segments()])
    elif isinstance(collection, PolyCollection):
        collection.set_verts(
            [np.asarray(path.vertices)[:, ::-1] for path in collection.get_paths()]
        )
