"""The dimension of the wheels in results, and flat tables without it.

A result of each wheel has the dimension ``wheel``; for a corner, which has one wheel, this is a
coordinate without a dimension. Tables of a spreadsheet have a column for each wheel, whose name
ends in that of the wheel.
"""

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from ...core.named_types import Array
from ...core.validator import Validator
from ...datasets.columns import AS_COLUMNS, with_columns
from ..models.car.car import WHEELS
from ..models.car.file import ENDS
from ..models.sides import SIDES
from .quantity import Quantity

WHEEL, AXLE, DATA_SET = "wheel", "axle", "data_set"
"""The dimensions of the wheels, of the axles of a car, and of several sets of curves."""

_ATTRIBUTES = {"long_name": "wheel"} | AS_COLUMNS


def wheel_coordinate(wheels: Sequence[str]) -> xr.Variable:
    """Return the names of wheels as a coordinate, without a dimension if there is one wheel."""
    if len(wheels) == 1:
        return xr.Variable((), wheels[0], _ATTRIBUTES)
    return xr.Variable(WHEEL, list(wheels), _ATTRIBUTES)


def axle_coordinate(axles: Sequence[str]) -> xr.Variable:
    """Return the names of the axles of a car as a coordinate."""
    return xr.Variable(AXLE, list(axles), {"long_name": "axle"} | AS_COLUMNS)


def of_wheels(
    quantity: Quantity, dims: str | Sequence[str], values: Sequence[Array]
) -> xr.Variable:
    """Return the values of all wheels, in the order of `Assembly.wheels`, as one variable.

    `dims` are its further dimensions.
    """
    return stacked(dims, values, quantity.attributes())


def stacked(
    dims: str | Sequence[str], values: Sequence[Array], attributes: Mapping[str, Any]
) -> xr.Variable:
    """Return the values of all wheels as one variable with some attributes, see `of_wheels`."""
    further = (dims,) if isinstance(dims, str) else tuple(dims)
    if len(values) == 1:
        return xr.Variable(further, values[0], attributes)
    return xr.Variable((WHEEL, *further), np.stack(values), attributes)


def flat(dataset: xr.Dataset) -> xr.Dataset:
    """Return the dataset of an analysis without the dimension of the wheels, for a table.

    It has ``camber_left`` and ``camber_right`` instead of ``camber`` over ``wheel``; other
    variables are unchanged. The wheel of a corner is not named.

    Examples
    --------
    >>> both = xr.Dataset({"camber": ("wheel", [0.1, 0.2])}, {"wheel": ["left", "right"]})
    >>> {name: float(value) for name, value in flat(both).items()}
    {'camber_left': 0.1, 'camber_right': 0.2}
    """
    with Validator("flat") as given:
        given.dataset(dataset)
    return with_columns(with_columns(dataset, WHEEL), AXLE)


def columns_of(names: Iterable[str], known: Collection[str]) -> list[str]:
    """Return the known columns of a flat table with some names, each once.

    A name without wheel or axle is that of the columns of all of them; others are unchanged.

    Examples
    --------
    >>> columns_of(["track", "toe", "tow"], ["toe_left", "toe_right", "track", "track_change"])
    ['track', 'toe_left', 'toe_right', 'tow']
    """
    ends = {f"_{place}" for place in (*SIDES, *ENDS, *WHEELS)}
    found: dict[str, None] = {}
    for name in names:
        of_all = [] if name in known else [k for k in known if k.removeprefix(str(name)) in ends]
        found |= dict.fromkeys(of_all or [name])
    return [*found]


def without_side(name: str) -> str:
    """Return a name of a flat table without the side and the axle at its end."""
    without = name.removesuffix("_left").removesuffix("_right")
    return without.removesuffix("_front").removesuffix("_rear")


def wheel_that_begins(name: str, wheels: Sequence[str]) -> str:
    """Return the wheel whose name begins another one; empty if there is none."""
    return next((wheel for wheel in wheels if name.startswith(f"{wheel}_")), "")


def together(dataset: xr.Dataset, wheels: Sequence[str]) -> xr.Dataset:
    """Return a dataset in which the variables of all wheels are one variable over the wheels.

    Names begin with that of a wheel, as in equations of motion: with ``left_road_height`` and so on
    for every wheel, the result has ``road_height`` over ``wheel``.
    """
    found: dict[str, xr.DataArray | xr.Variable] = {}
    for name, data in dataset.items():
        wheel = wheel_that_begins(str(name), wheels)
        stem = str(name).removeprefix(f"{wheel}_")
        names = [f"{each}_{stem}" for each in wheels]
        if not wheel or not all(each in dataset for each in names):
            found[str(name)] = data
        elif stem not in found:
            words = str(data.attrs["long_name"]).removesuffix(f", {wheel}")
            values = np.stack([dataset[each].values for each in names])
            attributes = data.attrs | {"long_name": words}
            found[stem] = xr.Variable((WHEEL, *data.dims), values, attributes)
    return xr.Dataset(found, {**dataset.coords, WHEEL: wheel_coordinate(wheels)}, dataset.attrs)


def by_ending(dataset: xr.Dataset, wheels: Sequence[str]) -> xr.Dataset:
    """Return a flat dataset with the dimension of the wheels: the inverse of `flat`.

    Names end in that of a wheel: with ``camber_left`` and so on for every wheel, the result has
    ``camber`` over ``wheel``.
    """
    begun = {
        str(name): f"{wheel}_{str(name).removesuffix(f'_{wheel}')}"
        for name in dataset
        for wheel in wheels
        if str(name).endswith(f"_{wheel}")
    }
    found = together(dataset.rename_vars(begun), wheels)
    back = {new: old for old, new in begun.items() if new in found}
    return found.rename_vars(back)
