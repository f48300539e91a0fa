"""Curves for print: one figure for each variable of a dataset, and one page for each group.

`kintrafo.pictures.curves` draws the curves; targets and limits are added here.
"""

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from io import BytesIO
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.backends.backend_pdf import PdfPages
from matplotlib.figure import Figure

from ...core.errors import InputError
from ...core.files import Paths, refuse, replacing
from ...core.named_types import Array
from ...core.quantities import displayed, names_in_words
from ...core.validator import Validator, shown
from ...pictures.curves import COLUMNS, dimension_along, draw, drawable, is_constant
from ...pictures.figures import METADATA, STYLE, lay_out, save
from ..analysis.characteristics.groups import ORDER, group_of
from ..assembly.by_wheel import AXLE, WHEEL
from ..studies.goals import Goal
from .goals import about, mark

FORMATS = ("png", "svg", "pdf")
# Main curves over travel and roll, and over the rack.
_FIRST = (
    "camber", "toe", "caster", "kingpin_inclination", "half_track_change", "track_change",
    "motion_ratio", "wheel_rate", "roll_center_height_kinematic", "roll_center_height",
)  # fmt: skip
_FIRST_STEERED = (
    "steer", "camber", "caster", "kingpin_inclination", "trail", "ackermann", "turning_circle",
    "steering_ratio",
)  # fmt: skip
_FEWEST_FIRST = 4
# Differences of equal curves by rounding, in SI units.
_ROUNDING = {"rtol": 1e-9, "atol": 1e-12}
# Positions with the design at zero, unlike time.
_WITH_DESIGN = (
    "wheel_travel", "rack_position", "roll_angle", "steering_wheel_angle", "body_heave",
    "body_pitch",
)  # fmt: skip
# Positions on the vertical axis, as suspension engineers draw them.
_UPRIGHT = ("wheel_travel",)


def write(
    dataset: xr.Dataset,
    folder: str | Path,
    *,
    formats: Sequence[str] = ("png",),
    title: str = "",
    suffix: str = "",
    goals: Sequence[Goal] = (),
    progress: Callable[[float], None] | None = None,
    force: bool = False,
    inputs: Paths = (),
) -> list[Path]:
    """Write a figure of each curve and an overview of each group, and return their paths.

    Parameters
    ----------
    dataset : xarray.Dataset
        Variables over one dimension or two.
    folder : str or pathlib.Path
        Created if it does not exist.
    formats : sequence of str, optional
        'png', 'svg' and 'pdf'.
    title : str, optional
        Title of each figure, usually the name of the data.
    suffix : str, optional
        Last part of the name of each file, before its ending.
    goals : sequence of Goal, optional
        Targets and limits, drawn into their curves; for an axle only those over its motion.
    progress : callable, optional
        Called with the completed fraction, up to 1.
    force : bool, optional
        Whether files that kintrafo did not write are replaced, see `kintrafo.core.files`.
    inputs : iterable of str or pathlib.Path, optional
        Files that are never replaced.

    Returns
    -------
    list of pathlib.Path
        ``overview_<group><suffix>.<format>`` and ``<variable><suffix>.<format>``.

    Raises
    ------
    InputError
        If a file must not be written, in which case none is written; or if one cannot be.
    """
    check_formats(formats=formats)
    with Validator("figures") as given:
        given.dataset(dataset)
        given.path("folder", folder)
        given.text("title", title)
        given.text("suffix", suffix)
        given.function("progress", progress)
        given.flag("force", force)
        given.paths("inputs", inputs)
    groups = grouped(dataset, goals).items()
    pages = {f"overview_{'_'.join(group.lower().split())}": names for group, names in groups}
    single = {str(name): (name,) for name in drawable(dataset)}
    drawn = {**pages, **single}
    files = {n: [Path(folder) / f"{n}{suffix}.{ending}" for ending in formats] for n in drawn}
    refuse([path for paths in files.values() for path in paths], force=force, inputs=inputs)
    for index, (name, variables) in enumerate(drawn.items()):
        with rc_context(STYLE):
            one = figure(dataset, variables, title=title, alone=name in single, goals=goals)
            for path in files[name]:
                save(one, path, force=force, inputs=inputs)
        if progress is not None:
            progress((index + 1) / len(drawn))
    return [path for paths in files.values() for path in paths]


def write_overview(
    dataset: xr.Dataset,
    path: str | Path,
    names: Sequence[Hashable] = (),
    title: str = "",
    *,
    goals: Sequence[Goal] = (),
    force: bool = False,
    inputs: Paths = (),
) -> Path:
    """Write the curves of some variables on one page, and return its path.

    A PDF has a page for each group of variables.

    Parameters
    ----------
    dataset : xarray.Dataset
    path : str or pathlib.Path
        The ending is the format: ``.png``, ``.svg`` or ``.pdf``.
    names : sequence of str, optional
        By default all that vary.
    title : str, optional
    goals : sequence of Goal, optional
        Targets and limits, drawn into their curves; for an axle only those over its motion.
    force : bool, optional
        Whether a file that kintrafo did not write is replaced, see `kintrafo.core.files`.
    inputs : iterable of str or pathlib.Path, optional
        Files that are never replaced.

    Returns
    -------
    pathlib.Path

    Raises
    ------
    InputError
        If the file must not or cannot be written.
    """
    check_formats([path])
    with Validator("figures") as given:
        given.dataset(dataset)
        given.text("title", title)
        given.flag("force", force)
        given.paths("inputs", inputs)
        if not given.failed:
            names = given.names("names", names, map(str, drawable(dataset)))
    pages = {"": tuple(names)} if names else grouped(dataset, goals)
    with rc_context(STYLE):
        if Path(path).suffix.lower() != ".pdf":
            chosen = tuple(name for page in pages.values() for name in page)
            headings = {page[0]: group for group, page in pages.items() if len(pages) > 1}
            one = figure(dataset, chosen, title=title, alone=False, headings=headings, goals=goals)
            return save(one, path, force=force, inputs=inputs)
        drawn = BytesIO()
        with PdfPages(drawn, metadata=METADATA["pdf"]) as document:
            for group, variables in pages.items():
                heading = ": ".join(text for text in (title, group) if text)
                page = figure(dataset, variables, title=heading, alone=False, goals=goals)
                document.savefig(lay_out(page))
    with replacing(path, force=force, inputs=inputs) as temporary:
        temporary.write_bytes(drawn.getvalue())
    return Path(path)


def check_formats(paths: Sequence[str | Path] = (), formats: Sequence[str] = ()) -> None:
    """Raise an `InputError` for files or formats other than png, svg and pdf.

    Parameters
    ----------
    paths : sequence of str or pathlib.Path, optional
        Pages of curves.
    formats : sequence of str, optional
        Formats of figures.
    """
    with Validator("figures") as given:
        for name, listed in (("paths", paths), ("formats", formats)):
            if not isinstance(listed, list | tuple):
                given.fail(f"{name} = {shown(listed)}: a list is needed.")
            for path in () if given.failed or name == "formats" else listed:
                given.path("path", path)
    endings = {str(path): Path(path).suffix.lower().removeprefix(".") for path in paths}
    wrong = [given for given, ending in endings.items() if ending not in FORMATS]
    problems = [f"{given}: a figure ends in .{', .'.join(FORMATS)}." for given in wrong]
    problems += [
        f"{name!r} is not a format of figures; there are {', '.join(FORMATS)}."
        for name in formats
        if name not in FORMATS
    ]
    if problems:
        raise InputError(problems, "figures")


def grouped(dataset: xr.Dataset, goals: Sequence[Goal] = ()) -> dict[str, tuple[Hashable, ...]]:
    """Return the variables of each page by the name of their group, in the order of the report.

    Constant variables are left out, unless all are constant, or have a goal.

    Parameters
    ----------
    dataset : xarray.Dataset
    goals : sequence of Goal, optional
        Targets and limits.

    Returns
    -------
    dict of str to tuple of str
    """
    with Validator("figures") as given:
        given.dataset(dataset)
    groups: dict[str, tuple[Hashable, ...]] = {}
    names = drawable(dataset)
    varying = tuple(
        name
        for name in names
        if not is_constant(displayed(dataset[name]))
        or any(about(goals, dataset[name], dimension_along(dataset[name])).values())
    )
    for name in without_copies(dataset, varying or names):
        group = group_of(name)
        groups[group] = (*groups.get(group, ()), name)
    return {group: groups[group] for group in ORDER if group in groups}


def first_curves(dataset: xr.Dataset) -> tuple[str, ...]:
    """Return the names of the main curves in the order of a page; none if too few exist.

    Parameters
    ----------
    dataset : xarray.Dataset
        Characteristics over a motion.

    Returns
    -------
    tuple of str
    """
    with Validator("first_curves") as given:
        given.dataset(dataset)
    over_rack = any(name in dataset.dims for name in ("rack_position", "steering_wheel_angle"))
    there = [name for name in (_FIRST_STEERED if over_rack else _FIRST) if name in dataset]
    shown = [name for name in there if not is_constant(displayed(dataset[name]))]
    if "track_change" in shown:  # the sum of both halves
        shown = [name for name in shown if name != "half_track_change"]
    return tuple(shown) if len(shown) >= _FEWEST_FIRST else ()


def without_copies(dataset: xr.Dataset, names: Iterable[Hashable]) -> Iterator[Hashable]:
    """Yield the names of curves without those that equal an earlier one or its negative."""
    seen: list[xr.DataArray] = []
    for name in names:
        data = dataset[name]
        alike = (
            one.dims == data.dims
            and any(np.allclose(data, sign * one, equal_nan=True, **_ROUNDING) for sign in (1, -1))
            for one in seen
        )
        if not any(alike):
            seen.append(data)
            yield name


def figure(
    dataset: xr.Dataset,
    names: Sequence[Hashable],
    *,
    title: str = "",
    alone: bool = True,
    columns: int = COLUMNS,
    headings: Mapping[Hashable, str] | None = None,
    goals: Sequence[Goal] = (),
) -> Figure:
    """Return a figure with curves of some variables, each in its own axes.

    Parameters
    ----------
    dataset : xarray.Dataset
    names : sequence of str
        Variables over one dimension or two.
    title : str, optional
    alone : bool, optional
        Whether this is the figure of one curve, with its definition if it has one.
    columns : int, optional
        Largest number of curves in a row.
    headings : mapping of str to str, optional
        Headings by the variable that begins a row below them.
    goals : sequence of Goal, optional
        Targets and limits, drawn into their curves; for an axle only those over its motion.

    Returns
    -------
    matplotlib.figure.Figure
    """

    def marked(axes: Axes, data: xr.DataArray, along: str, colours: Mapping[str, str]) -> Array:
        # goals of one side in the colour of its curve
        of_sides = about(goals, data, along).items()
        return np.concatenate(
            [mark(axes, own, side, colours.get(side, "")) for side, own in of_sides]
        )

    with Validator("figures") as given:
        given.dataset(dataset)
    words = {dim: names_in_words(dataset[dim]) for dim in (WHEEL, AXLE) if dim in dataset.dims}
    return draw(
        dataset.assign_coords(words), names, title=title, alone=alone, columns=columns,
        headings=headings, positions=_WITH_DESIGN, upright=_UPRIGHT, mark=marked,
    )  # fmt: skip
