"""Free bodies: every part of a suspension with the forces on it."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.text import Annotation

from ...core.files import Paths
from ...pictures.figures import BLUE, ORANGE, STYLE, save, written_plainly
from ..analysis.loads.sheets import without_side
from .columns import in_columns
from .curves import check_formats

# Seen from behind and from the right: which axes of the chassis lie across and upward.
_VIEWS = {"from behind": (1, 2, -1.0), "from the right": (0, 2, 1.0)}
# The longest arrow of a part, as a part of the part's greatest extent, and the least extent [m].
_LONGEST, _LEAST_EXTENT = 0.6, 0.15
# Forces below this part of the greatest on a part are not drawn.
_SMALL = 0.03
# A part with more loads than this has a row for each view. Labels are at both sides of a drawing,
# in room that is this part of its width.
_MANY, _ASIDE, _ASIDE_NARROW = 4, 0.35, 0.7
# Couples below this have no label [N m].
_SMALL_MOMENT = 1.0


def write_free_bodies(
    dataset: xr.Dataset,
    paths: Sequence[Path],
    case: str,
    parts: Sequence[str] | None = None,
    *,
    title: str = "",
    force: bool = False,
    inputs: Paths = (),
) -> list[Path]:
    """Write the moving parts of a suspension with the forces on them, in two views.

    Rods that only forces at their ends act on are drawn if they are named.

    Parameters
    ----------
    dataset : xarray.Dataset
        From `kintrafo.loads.static`.
    paths : sequence of pathlib.Path
        The case's name goes behind each file's name; the ending is the format.
    case : str
        Load case.
    parts : sequence of str, optional
        By default all that move.
    title : str, optional
    force : bool, optional
        Whether a file that somebody else wrote is replaced, see `kintrafo.core.files`.
    inputs : iterable of str or pathlib.Path, optional
        Files that are never replaced.

    Returns
    -------
    list of pathlib.Path
    """
    check_formats(paths)
    written = []
    with rc_context(STYLE):
        words = f"{title}: forces on the parts in {case}"
        figure = free_bodies(dataset, case, parts, title=words)
        for path in paths:
            named = path.with_name(f"{path.stem}_{case}{path.suffix}")
            written.append(save(figure, named, force=force, inputs=inputs))
    return written


def free_bodies(
    dataset: xr.Dataset, case: str, parts: Sequence[str] | None = None, *, title: str = ""
) -> Figure:
    """Draw the moving parts of a suspension with the forces on them; see `write_free_bodies`."""
    here = dataset.sel(case=case)
    rods = [str(rod) for rod in here["rod"].values] if "rod" in here.coords else []
    shown = parts or [str(part) for part in here["moving_part"].values if part not in rods]
    chosen = {part: here.isel(load=(here["part"] == part).values) for part in shown}
    # a view stands alone in its row where many labels are beside it
    rows = sum(len(_VIEWS) if _crowded(loads) else 1 for loads in chosen.values())
    figure = Figure(figsize=(7.4, 0.6 + 2.7 * rows), layout="constrained")
    grid, row = figure.add_gridspec(rows, len(_VIEWS)), 0
    labels = {}
    for part, loads in chosen.items():
        for column, view in enumerate(_VIEWS):
            place = grid[row + column, :] if _crowded(loads) else grid[row, column]
            axes = figure.add_subplot(place)
            labels[axes] = _draw(axes, loads, view)
            axes.set_title(f"{part.replace('_', ' ')}, {view}", fontsize=9.5)
        row += len(_VIEWS) if _crowded(loads) else 1
    figure.suptitle(title, fontsize=11)
    figure.draw_without_rendering()  # labels are placed by what is drawn
    for axes, of_view in labels.items():
        in_columns(axes, of_view)
    return written_plainly(figure)


def _crowded(loads: xr.Dataset) -> bool:
    """Return whether so many loads are on a part that their labels would lie on each other."""
    return loads.sizes["load"] > _MANY


def _draw(axes: Axes, loads: xr.Dataset, view: str) -> list[Annotation]:
    """Draw a part in one view, and return the labels of the forces."""
    across, upward, sense = _VIEWS[view]
    places = 1e3 * loads["at"].values[:, [across, upward]] * [sense, 1.0]
    forces = loads["force"].values[:, [across, upward]] * [sense, 1.0]
    sizes = np.linalg.norm(loads["force"].values, axis=1)
    couples = np.linalg.norm(loads["moment"].values, axis=1)
    held = places[loads["point"].values != "mass"]
    outline = held[_around(held)]
    axes.fill(*outline.T, facecolor="#eeeeee", edgecolor="#888888", joinstyle="round")
    axes.plot(*held.T, "o", color="black", markersize=3)
    extent = max(float(np.ptp(places, axis=0).max()), 1e3 * _LEAST_EXTENT)
    scale = _LONGEST * extent / max(float(sizes.max()), 1.0)
    halo = [withStroke(linewidth=2.5, foreground="white")]
    strong = sizes > _SMALL * sizes.max()
    labels = []
    for i in np.flatnonzero(strong | (couples > _SMALL_MOMENT)):
        place, push, by = places[i], forces[i], loads["by"].values[i]
        colour = ORANGE if without_side(by) in ("road", "drive", "gravity") else BLUE
        tail = place - scale * push
        style: dict[str, Any] = {"arrowstyle": "-|>", "color": colour, "linewidth": 1.4}
        axes.annotate("", xy=(place[0], place[1]), xytext=(tail[0], tail[1]), arrowprops=style)
        amounts = [f"{sizes[i]:.0f} N"] if strong[i] else []
        amounts += [f"{couples[i]:.0f} N m"] if couples[i] > _SMALL_MOMENT else []
        point = str(loads["point"].values[i])
        where = "" if point == "mass" else f"\nat {point.replace('_', ' ')}"
        words = f"{by.replace('_', ' ')}{where}\n" + ", ".join(amounts)
        label = axes.annotate(
            words, (tail[0], tail[1]), (0.0, 0.0), textcoords="offset points", fontsize=7.5,
            color=colour, ha="center", path_effects=halo,
            va="bottom" if push[1] <= 0.0 else "top",
        )  # fmt: skip
        labels.append(label)
        axes.plot(*tail, alpha=0.0)  # so that arrows are within the axes
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(_ASIDE if _crowded(loads) else _ASIDE_NARROW, 0.15)
    axes.tick_params(labelsize=7)
    sides = {1: "y [mm], to the left" if sense > 0 else "-y [mm], to the right", 0: "x [mm]"}
    axes.set_xlabel(sides[across], fontsize=8)
    axes.set_ylabel("z [mm]", fontsize=8)
    return labels


def _around(places: np.ndarray) -> list[int]:
    """Return the points in the order of their directions from the middle."""
    distinct = {tuple(place): i for i, place in enumerate(places.round(3).tolist())}
    rows = [*distinct.values()]
    arms = places[rows] - places[rows].mean(axis=0)
    return [rows[i] for i in np.argsort(np.arctan2(arms[:, 1], arms[:, 0]), kind="stable")]
