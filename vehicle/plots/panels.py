"""Figures of several panels with one legend below them."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TypedDict

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...core.files import Paths
from ...pictures.figures import STYLE, save, written_plainly
from .curves import check_formats

_COLUMNS = 2


class FigureOptions(TypedDict, total=False):
    """Options of all functions that write a figure of panels."""

    title: str  # title of the figure; none by default
    force: bool  # whether a file that kintrafo did not write is replaced, see `kintrafo.core.files`
    inputs: Paths  # files that are never replaced


def write_panels(
    draw: Callable[[Axes, str], None],
    names: Sequence[str],
    path: str | Path,
    *,
    height: float,
    title: str = "",
    force: bool = False,
    inputs: Paths = (),
) -> Path:
    """Write one figure of several panels, two in a row with a height [in].

    `draw` is a function of the axes of a panel and its name. The legend below them is that of
    panels without a legend.
    """
    check_formats([path])
    columns = min(_COLUMNS, len(names))
    rows = -(-len(names) // columns)
    with rc_context(STYLE):
        figure = Figure(figsize=(4.8 * columns, 0.7 + height * rows), layout="constrained")
        panels = figure.subplots(rows, columns, squeeze=False).ravel()
        for axes, name in zip(panels, names, strict=False):
            draw(axes, name)
        for axes in panels[len(names) :]:
            axes.remove()
        named = {
            label: line
            for panel in panels[: len(names)]
            if panel.get_legend() is None
            for line, label in zip(*panel.get_legend_handles_labels(), strict=True)
        }
        if named:
            figure.legend(
                named.values(), named.keys(), loc="outside lower center", ncols=2 * columns,
                frameon=False,
            )  # fmt: skip
        figure.suptitle(title, fontsize=11)
        return save(written_plainly(figure), path, force=force, inputs=inputs)
