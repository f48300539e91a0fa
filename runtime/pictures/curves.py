"""Curves for print: variables of a dataset, each in a panel of its own.

A variable over one dimension is a line; over two dimensions it is a family of lines. Names, units
and signs are those of the variables' attributes, see `kintrafo.core.quantities`.
"""

from collections.abc import Callable, Collection, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from textwrap import fill
from typing import Any

import numpy as np
import xarray as xr
from matplotlib import colormaps, rcParams
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, ScalarFormatter
from numpy.typing import NDArray

from ..core.named_types import Array
from ..core.quantities import bracketed, display_of, displayed, long_name
from ..core.validator import Validator
from .figures import BLUE, GREEN, ORANGE, typeset, wrapped, written_plainly
from .labels import label_lines
from .turned import turn

# Distinct in colour, and in black and white by the dashes.
_COLOURS = (BLUE, ORANGE, GREEN, "#cc79a7", "#56b4e9", "#e69f00", "#000000")
_DASHES = ("-", "--", "-.", ":")
_MOST_LINES = 7  # of a larger family some are drawn
COLUMNS = 3
# Width and height of a panel with its position on the horizontal or the vertical axis [in].
_LEVEL, _UPRIGHT = (3.7, 2.5), (3.0, 3.1)
# Numbers of narrow panels that are in rows of four, and of wide panels in rows of two.
_FOUR_IN_A_ROW, _TWO_IN_A_ROW = (4, 7, 8), 4
# Most letters in a line of the title of a narrow panel, and most ticks.
_NARROW_TITLE, _NARROW_TICKS = 34, 4
# Space of labels and ticks of a panel [in].
_AROUND = np.array([0.9, 0.7])
# Height of the first and of each further row of names below the panels [in].
_BELOW, _FURTHER = 0.4, 0.2
_NAME = 0.15  # height of a name above the curves of a panel [in]
_IN_A_ROW = 4  # names below the panels
_LETTERS_PER_INCH = 12  # of the title
# Round values.
_TICK_STEPS = [1, 2, 2.5, 5, 10]
# A smaller variation, relative to the values, is rounding: the curve is constant.
_CONSTANT = 1e-6
# A curve has a pole if its whole range exceeds that of nine tenths of its values by this factor, or
# a step of it the median step.
_POLE = 10.0
# Beside a simple pole a value is at least twice its neighbour farther away; less with an offset.
_GROWTH = 1.5

# Distance of marks from the ends of their axis, relative to its length.
_ROOM = 0.05

# Least span of the axis of values over a position, by unit: a small variation is drawn small.
LEAST_SPANS = {
    "deg": 0.1,
    "mm": 1.0,
    "deg/mm": 0.001,
    "N/mm": 0.5,
    "%": 1.0,
    "1": 0.01,
}
_FEW_NAMES = 3  # curves with their names in each panel; more have a legend below
_SHORT = 3  # rows of panels; a figure with more has the names of many lines in each row

# All lines are thin if one of them has more extremes than this, as over a rough road.
_MANY_TURNS, _THIN = 40, 0.7
# Values are rounded to this number of levels before extremes are counted.
_LEVELS = 200


Mark = Callable[[Axes, xr.DataArray, str, Mapping[str, str]], Array]
"""Draws marks in a panel, given its axes, curves, dimension along the axis, and colours by names.

It returns the marked values, which the vertical axis then includes.
"""


def draw(
    dataset: xr.Dataset,
    names: Sequence[Hashable],
    *,
    title: str = "",
    alone: bool = True,
    columns: int = COLUMNS,
    headings: Mapping[Hashable, str] | None = None,
    positions: Collection[str] = (),
    upright: Collection[str] = (),
    mark: Mark = lambda *_: np.empty(0),
) -> Figure:
    """Return a figure of curves of some variables, over one dimension or two, each in its own axes.

    `alone` is whether this is the figure of one curve, with its definition where there is one;
    `columns` is the largest number of panels in a row; a variable with a heading begins a row below
    it. `positions` are dimensions whose zero is the design position, `upright` those on the
    vertical axis; `mark` draws marks in a panel.
    """
    with Validator("figures") as given:
        given.dataset(dataset)
        given.text("title", title)
        given.flag("alone", alone)
        columns = given.whole("columns", columns, least=1)
        if not given.failed:
            names = given.names("names", names, map(str, drawable(dataset)))
            if not names:
                given.fail("names is empty: at least one variable is needed.")
    vertical = {dimension_along(dataset[name]) in upright for name in names} == {True}
    begins = [i for i, name in enumerate(names) if i == 0 or name in (headings or {})]
    most = max(np.diff([*begins, len(names)]))
    columns = _columns(int(most), columns, vertical=vertical)
    cells = _cells(names, columns, headings or {})
    rows = 1 + cells[-1] // columns
    panel = np.array(_UPRIGHT if vertical else _LEVEL)
    size = (7.2, 4.6) if alone else (max(panel[0] * columns, 5.0), 1.0 + panel[1] * rows)
    result = Figure(figsize=size, layout="constrained")
    panels = np.array([result.add_subplot(rows, columns, 1 + cell) for cell in cells])
    curves = [dataset[name] for name in names]
    width = min(_width(values) for data in curves for _, values in _lines(data)[1])
    for cell, axes, name in zip(cells, panels, names, strict=True):
        along = _draw(axes, dataset[name], positions, mark, width)
        if alone:
            _describe_alone(axes, dataset[name])
        else:
            _describe_panel(axes, dataset[name], upright=along in upright)
        lowest = max(other for other in cells if (other - cell) % columns == 0)
        at_edge = cell % columns == 0 if along in upright else cell == lowest
        if at_edge:
            axes.set_xlabel(_with_sign(dataset[along]), fontsize=10 if alone else 9)
        if along in upright:
            turn(axes)
            if not alone:  # space for ticks
                axes.xaxis.set_major_locator(MaxNLocator(nbins=_NARROW_TICKS, steps=_TICK_STEPS))
        if headings and name in headings:
            above = "\n" * (1 + axes.get_title().count("\n"))
            axes.set_title(headings[name] + above, loc="left", fontweight="bold")
    shape = np.array(size) / (columns, rows) - _AROUND
    page = _Page(panels, curves, shape, alone, dense=width == _THIN)
    _name_lines(result, page, vertical=vertical)
    lines = [line for line in (*title.split("\n"), _held(dataset)) if line]
    most = int(_LETTERS_PER_INCH * result.get_figwidth())
    result.suptitle("\n".join(fill(line, most) for line in lines), fontsize=11)
    return written_plainly(result)


def _columns(count: int, columns: int, *, vertical: bool) -> int:
    """Return the number of panels in a row, for so many panels below a heading."""
    if vertical and columns == COLUMNS and count in _FOUR_IN_A_ROW:
        columns = 4
    if not vertical and columns == COLUMNS and count == _TWO_IN_A_ROW:
        columns = 2
    return min(columns, count)


def _cells(names: Sequence[Hashable], columns: int, headings: Mapping[Hashable, str]) -> list[int]:
    """Return the cell of each panel: those with headings begin a row."""
    cells: list[int] = []
    for name in names:
        cell = cells[-1] + 1 if cells else 0
        cells.append(-(-cell // columns) * columns if name in headings else cell)
    return cells


def varying(dataset: xr.Dataset) -> tuple[Hashable, ...]:
    """Return the names of the variables that vary; all that can be drawn if none varies."""
    names = drawable(dataset)
    return tuple(name for name in names if not is_constant(displayed(dataset[name]))) or names


def drawable(dataset: xr.Dataset) -> tuple[Hashable, ...]:
    """Return the names of the variables that can be drawn."""
    return tuple(n for n, data in dataset.items() if data.ndim in (1, 2) and data.dtype.kind == "f")


def _draw(
    axes: Axes, data: xr.DataArray, positions: Collection[str], mark: Mark, width: float
) -> str:
    """Draw one variable with its zero lines and design position; return its dimension."""
    along, lines = _lines(data)
    position = displayed(data[along])
    styles = _styles(data, len(lines))
    family = _family(data)
    measured = 0 if family is None else int(data[family].attrs.get("measured", 0))
    curves = [
        axes.plot(
            position, interrupted(values) if along in positions else values, dashes, color=colour,
            linewidth=width,
        )[0]
        for (_, values), (colour, dashes) in zip(lines, styles, strict=True)
    ]  # fmt: skip
    for curve in curves[:measured]:
        curve.set(marker="o", markersize=4, linewidth=_THIN)
    for (_, values), (colour, _) in zip(lines, styles, strict=True):
        alone = _alone(values)
        axes.plot(position[alone], values[alone], "o", color=colour, markersize=3.5)
    if along in positions:
        axes.axvline(0.0, color="#888888", linewidth=0.8, zorder=1)
        for (_, values), (colour, _) in zip(lines, styles, strict=True):
            at_design = values[position == 0.0]
            dot = "black" if len(lines) == 1 else colour
            axes.plot(np.zeros(at_design.size), at_design, "o", color=dot, markersize=4)
    colours = {label: colour for (label, _), (colour, _) in zip(lines, styles, strict=True)}
    marked = mark(axes, data, along, colours)
    axes.margins(x=0.02)
    drawn = np.concatenate([v for _, v in lines])
    _limit(axes, [values for _, values in lines], may_have_pole=along in positions)
    _include(axes, marked)
    if along in positions:
        whole = np.concatenate([drawn, marked])
        _widen(axes, whole, LEAST_SPANS.get(display_of(data.attrs).units, 0.0))
    low, high = axes.get_ylim()
    if low < 0.0 < high:
        axes.axhline(0.0, color="#888888", linewidth=0.8, zorder=1)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(nbins=7, steps=_TICK_STEPS))
        axis.set_major_formatter(ScalarFormatter(useOffset=False))
    return along


def _alone(values: Array) -> NDArray[np.bool_]:
    """Return which values have no neighbours, so that no line shows them."""
    known = np.isfinite(np.pad(values, 1, constant_values=np.nan))
    return known[1:-1] & ~known[:-2] & ~known[2:]


def _describe_alone(axes: Axes, data: xr.DataArray) -> None:
    axes.set_ylabel(_with_sign(data))
    definition = str(data.attrs.get("definition", ""))
    axes.set_title(fill(definition, 100), fontsize=8.5, color="#555555")


def _describe_panel(axes: Axes, data: xr.DataArray, *, upright: bool) -> None:
    """Write the name and the sign above a panel; the name below one with an upright position."""
    sign = str(data.attrs.get("sign", ""))
    name = bracketed(long_name(data), data.attrs)
    if upright:
        axes.set_ylabel(wrapped(name, 26), fontsize=9.5)
        axes.set_title(fill(sign, _NARROW_TITLE), fontsize=8, color="#555555")
    else:
        lines = filter(None, (wrapped(name, 42), fill(sign, 46)))
        axes.set_title("\n".join(lines), fontsize=8.5, color="#333333")


def _styles(data: xr.DataArray, count: int) -> list[tuple[Any, str]]:
    """Return colour and dashes of each line: a colour scale for numbers, contrast for names."""
    if count > 1 and _family(data) is None:
        scale = colormaps["viridis"]
        return [(scale(0.9 * index / (count - 1)), "-") for index in range(count)]
    return [
        (_COLOURS[index % len(_COLOURS)], _DASHES[index % len(_DASHES)]) for index in range(count)
    ]


def dimension_along(data: xr.DataArray) -> str:
    """Return the dimension along the axis."""
    dims = [str(d) for d in data.dims]
    return next(d for d in dims if not _has_names(data, d)) if data.ndim > 1 else dims[0]


def _has_names(data: xr.DataArray, dimension: str) -> bool:
    """Return whether a dimension is one of names, such as those of data sets or wheels."""
    return dimension in data.coords and data[dimension].dtype.kind in "UO"


def _family(data: xr.DataArray) -> str | None:
    """Return the dimension of lines that have names; None without one."""
    return next((str(d) for d in data.dims if _has_names(data, str(d))), None)


def _lines(data: xr.DataArray) -> tuple[str, list[tuple[str, Array]]]:
    """Return the dimension along the axis, and label and displayed values of each line."""
    along = dimension_along(data)
    values = displayed(data)
    if data.ndim == 1:
        return along, [("", values)]
    across = next(d for d in data.dims if d != along)
    if data.dims[0] == along:
        values = values.T
    return along, [(label, values[i]) for i, label in named_values(data[across]).items()]


def named_values(coordinate: xr.DataArray) -> dict[int, str]:
    """Return labels by index for the values of a coordinate for which lines are drawn."""
    count = coordinate.size
    chosen = np.unique(np.linspace(0, count - 1, min(count, _MOST_LINES)).round().astype(int))
    labels = _labels(coordinate)
    return {int(i): labels[i] for i in chosen}


def _labels(coordinate: xr.DataArray) -> list[str]:
    """Return names, or numbers with as few digits as distinguish them."""
    if coordinate.dtype.kind != "f":
        return [str(value) for value in coordinate.values]
    unit = display_of(coordinate.attrs).units
    values = displayed(coordinate)
    short = [f"{value:.4g} {unit}" for value in values]
    return short if len(set(short)) == len(short) else [f"{value:g} {unit}" for value in values]


def is_constant(values: Array) -> bool:
    """Return whether values vary by rounding errors at most."""
    finite = values[np.isfinite(values)]
    return finite.size > 0 and bool(np.ptp(finite) <= _CONSTANT * max(np.abs(finite).max(), 1e-6))


def _limit(axes: Axes, lines: Sequence[Array], *, may_have_pole: bool) -> None:
    """Choose limits that neither magnify rounding errors nor follow a curve into a pole."""
    values = np.concatenate(lines)
    finite = values[np.isfinite(values)]
    if finite.size == 0:
        axes.text(0.5, 0.5, "not defined", transform=axes.transAxes, ha="center")
    elif is_constant(finite):
        middle = float(finite.mean())
        half = max(0.05 * abs(middle), 0.1)
        axes.set_ylim(middle - half, middle + half)
    elif may_have_pole:
        low, high = np.quantile(finite, (0.05, 0.95))
        far = np.ptp(finite) > _POLE * (high - low) > 0.0
        if far or any(leaps(line).size for line in lines):
            axes.set_ylim(1.5 * low - 0.5 * high, 1.5 * high - 0.5 * low)


def _include(axes: Axes, marked: Array) -> None:
    """Extend an axis to the marked values."""
    if not marked.size:
        return
    low, high = axes.get_ylim()
    least, most = marked.min(), marked.max()
    room = _ROOM * (max(most, high) - min(least, low))
    axes.set_ylim(min(low, least - room), max(high, most + room))


def _widen(axes: Axes, values: Array, least: float) -> None:
    """Extend an axis to a least span, with the curve in its middle."""
    finite = values[np.isfinite(values)]
    low, high = axes.get_ylim()
    if finite.size and high - low < least:
        middle = 0.5 * float(finite.min() + finite.max())
        axes.set_ylim(middle - 0.5 * least, middle + 0.5 * least)


def interrupted(values: Array) -> Array:
    """Return a curve with gaps at its poles."""
    cut = values.copy()
    cut[leaps(values)] = np.nan
    return cut


def leaps(values: Array) -> NDArray[np.intp]:
    """Return the indices before poles, where a curve grows to one side and returns from the other.

    The step across a pole has opposite signs at its ends and is many times the median step, and
    towards it both sides grow.
    """
    known = np.pad(values, 1, constant_values=np.nan)
    before, first, last, after = (known[i : i + values.size - 1] for i in range(4))
    steps = np.abs(last - first)
    finite = steps[np.isfinite(steps)]
    found = (first * last < 0.0) & (steps > _POLE * np.median(finite) if finite.size else False)
    for near, far in ((first, before), (last, after)):  # also true beside missing values
        found &= ~(far * near < 0.0) & ~(np.abs(near) < _GROWTH * np.abs(far))
    return np.flatnonzero(found)


def _with_sign(data: xr.DataArray) -> str:
    sign = str(data.attrs.get("sign", ""))
    label = typeset(bracketed(long_name(data), data.attrs))
    return f"{label}\n{sign}" if sign else label


@dataclass(frozen=True)
class _Legend:
    """The lines of a legend, their names, and its title."""

    handles: Sequence[Any] = ()
    labels: Sequence[str] = ()
    title: str | None = None


@dataclass(frozen=True)
class _Page:
    """The panels of a figure, and the curves in them.

    A panel has about the width and height `shape` [in]; `alone` as in `draw`. Between `dense`
    curves there is no space for names.
    """

    panels: Array
    curves: Sequence[xr.DataArray]
    shape: Array
    alone: bool
    dense: bool


def _name_lines(result: Figure, page: _Page, *, vertical: bool) -> None:
    """Name the lines: few lines in each panel, beside them if it has space; else in one legend."""
    marks = _marks_of_goals(page.panels)
    once = _named_once(page.panels, page.curves) if vertical else None
    lines = _unnamed(page) if once is None else once
    if once is not None and len(page.panels) > 1:
        in_each = len(once.handles) <= _FEW_NAMES
        high = page.panels[0].get_gridspec().nrows > _SHORT
        room = _NAME * (1 + len(once.labels)) / float(page.shape[1])
        for axes, data in zip(page.panels, page.curves, strict=True):
            if in_each or (high and axes.get_subplotspec().is_first_col()):
                _name_above(axes, _named_lines(axes, data) if data.ndim > 1 else _Legend(), room)
        lines = _Legend() if in_each else once
    if len(page.panels) > 1 or page.alone or marks or once is not None:
        _legend_below(result, lines, marks, alone=page.alone and once is None)
    elif lines.handles:
        (axes,) = page.panels
        axes.legend(lines.handles, lines.labels, title=lines.title, loc="best", fontsize=8)


def _name_above(axes: Axes, lines: _Legend, room: float) -> None:
    """Name the lines above them in a part `room` of a panel, whose axis is extended for the names.

    Its vertical axis is that of the position, so that no curve is there.
    """
    low, high = axes.get_ylim()
    axes.set_ylim(low, low + (high - low) / (1.0 - room))
    if lines.handles:
        axes.legend(
            lines.handles, lines.labels, loc="upper left", borderaxespad=0.0, frameon=False,
            fontsize=7,
        )  # fmt: skip


def _unnamed(page: _Page) -> _Legend:
    """Name few lines beside them if a panel has space; return those that need a legend.

    Of several families without space in all of their panels, such as wheels and axles, the first
    one is returned, and the others get a legend in their first panel.
    """
    pairs = [(a, d) for a, d in zip(page.panels, page.curves, strict=True) if d.ndim > 1]
    first: dict[str | None, tuple[Axes, xr.DataArray]] = {}
    for axes, data in pairs:
        family = _family(data)
        names = [name for name, _ in _lines(data)[1]]
        few = not page.dense and family is not None and len(names) <= _FEW_NAMES
        if not few or not label_lines(axes, _drawn_lines(axes, len(names)), names, page.shape):
            first.setdefault(family, (axes, data))
    panels = list(first.values())
    for axes, data in panels[1:]:
        lines = _named_lines(axes, data)
        axes.legend(lines.handles, lines.labels, title=lines.title, loc="best", fontsize=8)
    return _named_lines(*panels[0]) if panels else _Legend()


def _named_once(panels: Array, curves: Sequence[xr.DataArray]) -> _Legend | None:
    """Return the names of the lines if they are the same in all panels, else None."""
    found = [(axes, data) for axes, data in zip(panels, curves, strict=True) if data.ndim > 1]
    if not found or any(_family(data) is None for _, data in found):
        return None
    named = [_named_lines(axes, data) for axes, data in found]
    return named[0] if all(one.labels == named[0].labels for one in named) else None


def _drawn_lines(axes: Axes, count: int) -> list[Line2D]:
    return [line for line in axes.get_lines() if line.get_linestyle() != "None"][:count]


def _named_lines(axes: Axes, data: xr.DataArray) -> _Legend:
    along, lines = _lines(data)
    across = next(d for d in data.dims if d != along)
    title = None if _has_names(data, str(across)) else long_name(data[across])
    return _Legend(_drawn_lines(axes, len(lines)), [label for label, _ in lines], title)


def _legend_below(result: Figure, lines: _Legend, marks: Mapping[str, Any], *, alone: bool) -> None:
    """Name lines, and marks of targets and limits, below panels that keep their size."""
    names = [*lines.labels, *marks]
    if not names:
        return
    if marks or not alone:
        further = (len(names) - 1) // _IN_A_ROW + (lines.title is not None)
        width, height = result.get_size_inches()
        result.set_size_inches(width, height + _BELOW + _FURTHER * further)
    result.legend(
        [*lines.handles, *marks.values()],
        names,
        title=lines.title,
        loc="outside lower center",
        ncols=_IN_A_ROW,
        frameon=False,
        fontsize=9,
    )


def _marks_of_goals(panels: Iterable[Axes]) -> dict[str, Any]:
    """Return the marks of targets and of limits, by their names; curves have no label."""
    return {
        label: mark
        for axes in panels
        for mark, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }


def _held(dataset: xr.Dataset) -> str:
    """Return a text with the values of scalar coordinates."""
    scalars = [data for name, data in dataset.coords.items() if data.ndim == 0]
    texts = [
        f"{long_name(data)} {float(displayed(data)):g} {display_of(data.attrs).units}"
        for data in scalars
        if data.dtype.kind == "f"
    ]
    return ", ".join(texts)


def _width(values: Array) -> float:
    """Return the line width of a curve: thin if a line with many extremes would fill its area."""
    finite = values[np.isfinite(values)]
    if finite.size == 0 or is_constant(finite):
        return float(rcParams["lines.linewidth"])
    steps = np.diff(np.round(_LEVELS * (finite - finite.min()) / np.ptp(finite)))
    steps = steps[steps != 0.0]
    turns = np.count_nonzero(steps[1:] * steps[:-1] < 0.0)
    return _THIN if turns > _MANY_TURNS else rcParams["lines.linewidth"]
