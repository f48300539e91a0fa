"""Tables of the characteristics at design, of each wheel and of the axle."""

from collections.abc import Sequence

import xarray as xr

from ....core.quantities import displayed, long_name, names_in_words, unit_or_stroke
from ....core.tabulated import Tabulated, significant
from ...assembly.by_wheel import AXLE, WHEEL


def at_design(dataset: xr.Dataset, title: str) -> list[Tabulated]:
    """Return tables of all characteristics at the zero of the motion, with titles that begin alike.

    A corner has one table; an axle or a car one of the wheels, and one of the axle or axles.
    """
    if WHEEL not in dataset.dims:
        return _tables(title, [("at design", ("value",), [*dataset.values()])])
    wheels = names_in_words(dataset[WHEEL])
    data = [*dataset.values()]
    of_wheels = [each for each in data if WHEEL in each.dims]
    of_axle = [each for each in data if WHEEL not in each.dims]
    last: tuple[str, Sequence[str], Sequence[xr.DataArray]]
    last = "the axle, at design", ("value",), of_axle
    if AXLE in dataset.dims:
        last = "each axle, at design", [*map(str, dataset[AXLE].values)], of_axle
    return _tables(title, [("each wheel, at design", wheels, of_wheels), last])


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
    cells = (significant(float(value)) for value in displayed(data)[..., index].ravel())
    return long_name(data), *cells, unit_or_stroke(data.attrs), str(data.attrs.get("sign", ""))
