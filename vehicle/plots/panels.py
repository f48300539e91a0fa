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
    """Options of all functions that write a figure of panels.

    Attributes
    ----------
    title : str
        Title of the figure; none by default.
    force : bool
        Whether a file that kintrafo did not write is replaced, see `kintrafo.core.files`.
    inputs : iterable of str or pathlib.Path
        Files that are never replaced.
    """

    title: str
    force: bool
    inputs: Paths


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
    """Write one figure of several panels, two in a row.

    The legend below them is that of panels without a legend.

    Parameters
    ----------
    draw : callable
        A function of the axes of a panel and its name.
    names : sequence of str
        The panels.
    path : str or pathlib.Path
        The ending is the format: ``.png``, ``.svg`` or ``.pdf``.
    height : float
        Height of a row [in].
    title, force, inputs
        As in `FigureOptions`.

    Returns
    -------
    pathlib.Path
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
