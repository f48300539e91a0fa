"""Characteristics of many cars that differ in values of the input file."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from ...core.named_types import Array, ArrayLike
from ...core.quantities import variable
from ...core.suggestions import suggestion
from ...core.validator import Validator, shown
from ..analysis.compliance.flexibility import WheelSupport
from .batch import curves_of_many
from .curves import Curves, curves_of, refuse_bushes
from .design_variables import DesignVariable, places_of
from .evaluation import Subject, check_subject

CAR = "car"
"""Dimension of values that are rows of numbers."""

# They take 0.8 GB.
_MOST_NUMBERS = 100_000_000

_REDUCTIONS: dict[str, tuple[str, Callable[[Array], Array]]] = {
    "min": ("least", lambda rows: rows.min(axis=-1)),
    "max": ("greatest", lambda rows: rows.max(axis=-1)),
    "mean": ("mean of", lambda rows: rows.mean(axis=-1)),
    "range": ("range of", lambda rows: np.ptp(rows, axis=-1)),
}
"""Reductions of the curves of a car over its positions, with equal weights."""


def cars(
    suspension: Subject,
    values: Mapping[str, ArrayLike] | xr.Dataset,
    *,
    over: str | None = None,
    positions: ArrayLike | None = None,
    names: Sequence[str] | None = None,
    held: WheelSupport | None = None,
    reductions: Sequence[str] | None = None,
    threads: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> xr.Dataset:
    """Return the characteristics of many cars that differ in values of the input file.

    Parameters
    ----------
    suspension : Suspension, Axle, RigidAxle or Car
        The nominal subject, from which the cars differ.
    values : mapping or xarray.Dataset
        Values of each car, by place as in `sensitivity` but without ``*``:
        ``hardpoints.ball_joint.z``, in the display unit (mm, deg, N/m). Rows of numbers are over
        the dimension ``car``; of a dataset, all combinations along its dimensions are cars.
    over, positions, names, held, progress
        Motion, positions along it, characteristics, support of the wheels for compliance, and a
        function of the completed fraction; see `sensitivity`. Travel is measured from the design
        position of each car.
    reductions : sequence of str, optional
        'min', 'max', 'mean' or 'range' of the curves over the positions, instead of the curves.
    threads : int, optional
        By default the number of cores.

    Returns
    -------
    xarray.Dataset
        Over the dimensions of the cars and the positions: the characteristics, or instead of each
        ``..._min`` and so on; and ``reason``, empty for a car with curves. Curves of cars that
        cannot be built, or do not reach all positions, are NaN.

    Raises
    ------
    InputError
        If an argument cannot be used.

    Notes
    -----
    Some hundred cars are evaluated together. The results agree with those of single cars to
    rounding, some 1e-12 of a curve. Cars at the end of their reach, or beyond, are evaluated one by
    one.

    Examples
    --------
    >>> import numpy as np
    >>> from kintrafo import Suspension, variation
    >>> car = Suspension.load("reference_car")
    >>> heights = {"hardpoints.tie_rod_inner.z": [278.0, 280.0, 282.0]}
    >>> found = variation.cars(car, heights, positions=[0.0])
    >>> np.rad2deg(found["bump_steer"].values[:, 0] * 1e-3).round(4).tolist()  # deg/mm
    [0.0039, 0.0062, 0.0084]
    """
    with Validator("cars") as given:
        check_subject(given, suspension)
        given.function("progress", progress)
        if threads is not None:
            threads = given.whole("threads", threads, most=1024)
        kept = () if reductions is None else given.names("reductions", reductions, _REDUCTIONS)
        if not given.failed:
            curves = curves_of(given, suspension, over, positions, names, held)
            columns, frame = _columns(given, suspension, values, curves.over)
        if not given.failed:
            numbers = frame.size * len(curves.names) * (len(kept) or curves.positions.size)
            if numbers > _MOST_NUMBERS:
                given.fail(
                    f"values: {frame.size} cars make {numbers:.3g} numbers, and at most "
                    f"{_MOST_NUMBERS:.3g} are allowed. Name fewer, or reductions."
                )

    def reduced(rows: Array) -> Array:
        if not kept:
            return rows
        with np.errstate(invalid="ignore"):  # a turning circle may be infinite
            return np.stack([_REDUCTIONS[name][1](rows) for name in kept], axis=-1)

    [found], reasons = curves_of_many(
        suspension, columns, [curves], reduced=reduced, threads=threads, progress=progress
    )
    return _dataset(curves, kept, found, reasons.astype(str).reshape(frame.shape), frame)


def _columns(
    given: Validator, suspension: Subject, values: Any, over: str
) -> tuple[dict[str, Array], xr.DataArray]:
    """Return the values of each car by place, in the unit of the file, and a frame of zeros."""
    if not isinstance(values, xr.Dataset):
        rows = {}
        for name, row in given.mapping("values", values, "places and rows of numbers").items():
            array = given.array(f"values of {shown(name)}", row, dimensions=[0, 1])
            rows[str(name)] = xr.DataArray(array, dims=(CAR,) * array.ndim)
    else:
        known = places_of(suspension)
        rows = {str(n): values[n] for n in (*values.data_vars, *values.coords) if n in known}
        rows |= {str(n): values[n] for n in values.data_vars}
    places = _places(given, suspension, rows)
    if given.failed:
        return {}, xr.DataArray(0.0)
    refuse_bushes(given, places.values(), [over])
    try:
        whole = xr.broadcast(*(row.drop_vars(row.coords) for row in rows.values()))
    except ValueError:
        given.fail("values: rows have different lengths; as many numbers of each are needed.")
        return {}, xr.DataArray(0.0)
    whole = tuple(row if row.dims else row.expand_dims(CAR) for row in whole)
    columns = {}
    for (name, place), row in zip(places.items(), whole, strict=True):
        flat = given.array(f"values of {name}", row.values.ravel(), place.unit)
        columns[name] = flat * place.in_file
    frame = whole[0]
    labels = {}
    if isinstance(values, xr.Dataset):
        labels = {n: c for n, c in values.coords.items() if set(c.dims) <= set(frame.dims)}
    return columns, xr.zeros_like(frame, dtype=float).assign_coords(labels)


def _places(given: Validator, suspension: Subject, names: Any) -> dict[str, DesignVariable]:
    known = places_of(suspension)
    if not names:
        given.fail("values: one place or more is needed.")
    for name in names:
        if name not in known:
            given.fail(f"values: {name} is not a number of the file. {suggestion(name, [*known])}")
    return {name: known[name] for name in names if name in known}


def _dataset(
    curves: Curves, kept: Sequence[str], found: Array, reasons: Array, frame: xr.DataArray
) -> xr.Dataset:
    along = curves.along
    shape, dims = frame.shape, tuple(map(str, frame.dims))
    data: dict[str, Any] = {}
    for row, name in enumerate(curves.names):
        attributes = curves.quantity(name).attributes()
        values = found[:, row]
        if not kept:
            data[name] = ((*dims, along.name), values.reshape(*shape, -1), attributes)
        for which, reduction in enumerate(kept):
            meaning = f"{_REDUCTIONS[reduction][0]} {attributes['long_name']}"
            reduced = attributes | {"long_name": meaning}
            data[f"{name}_{reduction}"] = (dims, values[:, which].reshape(shape), reduced)
    data["reason"] = variable(dims, reasons, "why a car has no curves", "1")
    coordinates: dict[Any, Any] = dict(frame.coords)
    if not kept:
        coordinates[along.name] = (along.name, curves.positions, along.attributes())
    seen = int((reasons == "").sum())
    attributes = {
        "title": f"characteristics of {frame.size} cars over {along.long_name}",
        "message": f"{seen} of {frame.size} cars have curves",
    }
    return xr.Dataset(data, coordinates, attributes)
