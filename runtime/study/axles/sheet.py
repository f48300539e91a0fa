"""What an axle is at design, as tables: of each wheel, and of the whole."""

from collections.abc import Iterable

import xarray as xr

from ...core.quantities import displayed, long_name, unit_or_stroke
from ...core.tabulated import Tabulated, significant
from ...suspension.axle.axle import LEFT, RIGHT

_ENDINGS = (f"_{LEFT}", f"_{RIGHT}")


def at_design(dataset: xr.Dataset, title: str) -> list[Tabulated]:
    """Return the tables of all characteristics at zero of what varies.

    Parameters
    ----------
    dataset : xarray.Dataset
        From `bump`, `roll`, `single` or `steer`.
    title : str
        Begins the titles.

    Returns
    -------
    list of Tabulated
        Of each wheel, and of the axle.
    """
    stems = [n.removesuffix(_ENDINGS[0]) for n in map(str, dataset) if n.endswith(_ENDINGS[0])]
    sides = {f"{stem}{ending}" for stem in stems for ending in _ENDINGS}
    of_wheels = [[dataset[f"{stem}{ending}"] for ending in _ENDINGS] for stem in stems]
    of_axle = [[data] for name, data in dataset.items() if name not in sides]
    ends = ("unit", "sign")
    return [
        Tabulated(
            f"{title}each wheel, at design",
            ("characteristic", LEFT, RIGHT, *ends),
            _rows(of_wheels),
            frozenset({0, 3, 4}),
        ),
        Tabulated(
            f"{title}the axle, at design",
            ("characteristic", "value", *ends),
            _rows(of_axle),
            frozenset({0, 2, 3}),
        ),
    ]


def _rows(lines: Iterable[list[xr.DataArray]]) -> tuple[tuple[str, ...], ...]:
    return tuple(
        (
            long_name(first).removesuffix(f", {LEFT}"),
            *(_value(data) for data in (first, *others)),
            unit_or_stroke(first.attrs),
            str(first.attrs.get("sign", "")),
        )
        for first, *others in lines
    )


def _value(data: xr.DataArray) -> str:
    (along,) = data.dims
    index = int(abs(data[along].values).argmin())
    return significant(float(displayed(data)[index]))
