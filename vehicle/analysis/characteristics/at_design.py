"""What a suspension or an axle is at design, as tables: of each wheel, and of the axle."""

from collections.abc import Sequence

import xarray as xr

from ....core.quantities import displayed, long_name, unit_or_stroke
from ....core.tabulated import Tabulated, significant
from ...assembly.by_wheel import AXLE, WHEEL


def at_design(dataset: xr.Dataset, title: str) -> list[Tabulated]:
    """Return the tables of all characteristics at zero of what varies.

    Parameters
    ----------
    dataset : xarray.Dataset
        From `kintrafo.characteristics.over`.
    title : str
        Begins the titles.

    Returns
    -------
    list of Tabulated
        Of a corner one; of an axle what each wheel has, and what the axle has; of a car what each
        wheel and each axle has. Those without rows are left out.
    """
    if WHEEL not in dataset.dims:
        return _tables(title, [("at design", ("value",), [*dataset.values()])])
    wheels = [str(name).replace("_", " ") for name in dataset[WHEEL].values]
    data = [*dataset.values()]
    of_wheels = [each for each in data if WHEEL in each.dims]
    of_axle = [each for each in data if WHEEL not in each.dims]
    axles = [*map(str, dataset[AXLE].values)] if AXLE in dataset.dims else ("value",)
    return _tables(
        title,
        [
            ("each wheel, at design", wheels, of_wheels),
            (
                "the axle, at design" if AXLE not in dataset.dims else "each axle, at design",
                axles,
                of_axle,
            ),
        ],
    )


def _tables(
    title: str, parts: Sequence[tuple[str, Sequence[str], Sequence[xr.DataArray]]]
) -> list[Tabulated]:
    return [
        Tabulated(
            f"{title}{words}",
            ("characteristic", *values, "unit", "sign"),
            tuple(_row(each) for each in data),
            frozenset({0, len(values) + 1, len(values) + 2}),
        )
        for words, values, data in parts
        if data
    ]


def _row(data: xr.DataArray) -> tuple[str, ...]:
    (along,) = (dim for dim in data.dims if dim not in (WHEEL, AXLE))
    index = int(abs(data[along].values).argmin())
    values = displayed(data)[..., index].ravel()
    cells = (significant(float(value)) for value in values)
    return long_name(data), *cells, unit_or_stroke(data.attrs), str(data.attrs.get("sign", ""))
