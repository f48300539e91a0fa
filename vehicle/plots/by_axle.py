"""Curves of the wheels of a car by axle: two lines in a panel are easier to read than four."""

from collections.abc import Iterable

import xarray as xr

from ...core.validator import Validator
from ..assembly.by_wheel import WHEEL
from ..models.sides import SIDES

SIDE = "side"
"""The dimension of both wheels of an axle of a car."""


def by_axle(dataset: xr.Dataset) -> xr.Dataset:
    """Return a dataset in which every variable of four wheels is one for each axle.

    ``load_front`` and ``load_rear`` over ``side`` replace ``load``; all else is unchanged.
    """
    with Validator("by_axle") as given:
        given.dataset(dataset)
    ends = _ends(dataset)
    if not ends:
        return dataset
    found = dataset.drop_vars(WHEEL)
    for name, data in dataset.data_vars.items():
        if WHEEL not in data.dims:
            continue
        found = found.drop_vars(str(name))
        for end in ends:
            own = data.sel({WHEEL: [f"{end}_{side}" for side in SIDES]}).rename({WHEEL: SIDE})
            own = own.assign_coords({SIDE: list(SIDES)})
            own.attrs |= {"long_name": f"{end}: {data.attrs.get('long_name', name)}"}
            found[f"{name}_{end}"] = own
    return found


def names_by_axle(dataset: xr.Dataset, names: Iterable[str]) -> list[str]:
    """Return the names of some variables in the dataset of `by_axle`; missing ones are left out."""
    ends = _ends(dataset)
    return [
        own
        for name in names
        if name in dataset
        for own in (
            [f"{name}_{end}" for end in ends] if ends and WHEEL in dataset[name].dims else [name]
        )
    ]


def _ends(dataset: xr.Dataset) -> list[str]:
    """Return the ends of a car with two wheels each; none for one axle."""
    wheels = [str(name) for name in dataset[WHEEL].values.ravel()]
    ends = list(dict.fromkeys(name.rpartition("_")[0] for name in wheels))
    return ends if len(wheels) == len(ends) * len(SIDES) and len(ends) > 1 else []
