"""Files of load cards: one for each part."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from .....core.files import Paths, refuse, replacing
from .....core.validator import Validator
from .....datasets.recording import TIME
from ....assembly.by_wheel import flat
from ..dataset import AXES, AXIS, CASE, LOAD, PART
from . import abaqus, nastran
from .sheet import LENGTHS, CardSheet

_MOST_CASES = 1000
_NEEDED = "a result of kintrafo.loads.static or along is needed"
_FIELDS = ("force", "moment", "at", "force_in_part", "moment_in_part", "at_in_part")


class _Format(NamedTuple):
    lines: Callable[[CardSheet], Iterator[str]]
    program: str


_NASTRAN, _ABAQUS = _Format(nastran.lines_of, "Nastran"), _Format(abaqus.lines_of, "Abaqus")
ENDINGS = {".bdf": _NASTRAN, ".nas": _NASTRAN, ".inp": _ABAQUS}
"""Formats, by the endings of files."""


def write_cards(
    dataset: xr.Dataset,
    path: str | Path,
    parts: Sequence[str] | None = None,
    *,
    axes: str = "part",
    length: str = "mm",
    source: str = "a model",
    force: bool = False,
    inputs: Paths = (),
) -> list[Path]:
    """Write load cards for a strength program, and return the files, one for each part.

    Parameters
    ----------
    dataset : xarray.Dataset
        Result of `static` or `along`; each of at most 1000 outputs of a motion is a case.
    path : str or pathlib.Path
        ``loads.bdf`` or ``loads.nas`` (Nastran), ``loads.inp`` (Abaqus): the name of a part is
        inserted before the ending, ``loads_knuckle.bdf``.
    parts : sequence of str, optional
        By default all, with the chassis, which has the totals at its mounts.
    axes : {"part", "vehicle"}, optional
        Axes of points and components: those of the part at design, or those of the vehicle, with
        the part in its position in each case.
    length : {"mm", "m"}, optional
        Unit of length. Forces are in N, moments in N mm or N m.
    source : str, optional
        Name of the suspension or axle, for the first line.
    force : bool, optional
        Whether files that kintrafo did not write are replaced.
    inputs : iterable of str or pathlib.Path, optional
        Files that are never replaced.

    Returns
    -------
    list of pathlib.Path
        The files. Either all are written or none.

    Raises
    ------
    InputError
        If an argument cannot be used, or a file must not or cannot be written.

    Notes
    -----
    Loads at points with the same name are summed, and weights and inertia act at the centre of
    mass: the loads of a part in equilibrium have a sum of zero, to rounding. A point that moves on
    its part, such as the end of a telescope or the contact of a wheel, has a node in each case.
    """
    with Validator("load cards") as given:
        given.instance("dataset", dataset, xr.Dataset, _NEEDED)
        if not given.failed:
            dataset = _over_cases(given, flat(dataset))
        if not given.failed:
            known = [str(part) for part in dict.fromkeys(dataset[PART].values)]
            names = dict.fromkeys(known if parts is None else given.names("parts", parts, known))
            if not names:
                given.fail("parts: one or more are needed.")
        given.path("path", path)
        given.among("axes", axes, AXES)
        given.among("length", length, LENGTHS)
        given.text("source", source)
        given.flag("force", force)
    of_format = ENDINGS.get(Path(path).suffix.lower())
    refuse([path], endings=[*ENDINGS], force=True)
    assert of_format is not None
    begin, ending = Path(path).stem, Path(path).suffix
    files = {part: Path(path).with_name(f"{begin}_{part}{ending}") for part in names}
    refuse(files.values(), force=force, inputs=inputs)
    with ExitStack() as stack:
        for part, file in files.items():
            temporary = stack.enter_context(replacing(file, force=force, inputs=inputs))
            sheet = CardSheet.of(dataset, part, axes, length, source)
            # strength programs read ASCII
            text = "".join(f"{line}\n" for line in of_format.lines(sheet))
            temporary.write_bytes(text.encode("ascii", "replace"))
    return [*files.values()]


def _over_cases(given: Validator, dataset: xr.Dataset) -> xr.Dataset:
    """Return loads over cases; the cases of a motion are its outputs."""
    if TIME in dataset.dims and CASE not in dataset.dims:
        names = [f"output_{number}" for number in range(1, dataset.sizes[TIME] + 1)]
        dataset = dataset.rename({TIME: CASE}).assign_coords({CASE: np.array(names)})
    there = {*map(str, dataset.variables)}
    if not ({CASE, LOAD, AXIS} <= {*dataset.dims} and {*_FIELDS, PART} <= there):
        given.fail(f"dataset: {_NEEDED}.")
    elif not 0 < dataset.sizes[CASE] <= _MOST_CASES:
        given.fail(
            f"dataset: {dataset.sizes[CASE]} cases; 1 to {_MOST_CASES} can be written. Choose "
            "outputs of a motion, as by dataset.isel(time=[0, 50])."
        )
    return dataset
