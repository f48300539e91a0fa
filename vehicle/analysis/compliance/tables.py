"""Compliance as tables for the terminal and the report."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from ....core.quantities import bracketed, display_of, displayed, long_name
from ....core.tabulated import Tabulated, significant
from ...assembly.by_wheel import WHEEL, flat, without_side

# Variables in tables of deflections, and names of the other curve.
_IN_TABLES = (
    "toe", "toe_change", "camber", "camber_change", "displacement", "patch_displacement",
    "contact_rate", "roll_stiffness_at_contacts", "bar_torque", "axle_steer", "axle_lateral",
    "axle_steer_change", "axle_lateral_change", "axle_longitudinal_change",
)  # fmt: skip
_WORDS = {"patch_displacement": "contact patch"}
_COMPLIANCES = {
    "toe": "toe-in [deg]",
    "camber": "camber [deg]",
    "displacement": "inward, rearward [mm]",
    "patch_displacement": "contact patch [mm]",
}
_OF_AXLES = {
    "axle_steer": "steer [deg]",
    "axle_lateral": "to the left [mm]",
    "axle_longitudinal": "forward [mm]",
}
_MOST = 11  # positions in a table
_BESIDE = {"elastokinematic": "on bushes", "linear": "linear"}


def compliances(found: xr.Dataset, title: str, at: float = 0.0) -> Tabulated:
    """Return a table of compliances at a wheel travel [m], with a row for each load."""
    heads, every = _by_load(found, _COMPLIANCES, at)
    on_axle = any(without_side(str(name)) != name for name in flat(found).data_vars)
    first = ("by", "wheel", "per") if on_axle else ("by", "per")
    rows = []
    for by, *others in every:
        words = by.removeprefix("a ")
        rows.append((*(words.rsplit(", ", 1) if on_axle else [words]), *others))
    return Tabulated(title, (*first, *heads), tuple(rows), frozenset(range(len(first))))


def compliances_of_beam(found: xr.Dataset, title: str, at: float = 0.0) -> list[Tabulated]:
    """Return a table of the compliances of the beam of a rigid axle; none for other assemblies."""
    heads, rows = _by_load(found, _OF_AXLES, at)
    columns = ("by", "per, each wheel", *heads)
    return [Tabulated(title, columns, tuple(rows), frozenset({0, 1}))] if rows else []


def _by_load(
    found: xr.Dataset, words: Mapping[str, str], at: float
) -> tuple[list[str], list[tuple[str, ...]]]:
    """Return headings of the kinds of compliance that are found, and a row for each load.

    A row has the load in words, its unit, and the compliances.
    """
    here = flat(found).sel(wheel_travel=at, method="nearest")
    loads: dict[str, dict[str, xr.DataArray]] = {}
    for name, data in here.items():
        kind, by, load = str(name).partition("_by_")
        if by and kind in words:
            loads.setdefault(load, {})[kind] = data
    kinds = [kind for kind in words if any(kind in own for own in loads.values())]
    rows = []
    for own in loads.values():
        first = next(own[kind] for kind in kinds if kind in own)
        cells = [significant(float(displayed(own[k]))) if k in own else "-" for k in kinds]
        per = display_of(first.attrs).units.partition("/")[2]
        rows.append((long_name(first).partition(" by ")[2], per, *cells))
    return [words[kind] for kind in kinds], rows


def deflections(found: xr.Dataset, title: str) -> list[Tabulated]:
    """Return tables of curves on bushes, and with rigid joints or to first order.

    There is one of each wheel, and one of values of both wheels together.
    """
    if WHEEL not in found.dims:
        return [_deflections(found, title)]
    of_wheels = [name for name in found if WHEEL in found[name].dims]
    sheets = [
        _deflections(found[of_wheels].sel({WHEEL: wheel}), f"{title}, {wheel} wheel")
        for wheel in map(str, found[WHEEL].values)
    ]
    shared = [name for name in map(str, found) if name not in of_wheels and name in _IN_TABLES]
    shared = [name for name in shared if found[name].ndim > 1]
    return [*sheets, _deflections(found[shared], f"{title}, both")] if shared else sheets


def _deflections(found: xr.Dataset, title: str) -> Tabulated:
    """Return a table of eleven positions at most."""
    over = next(str(name) for name in found.sizes if name != "data_set")
    count = found.sizes[over]
    which = sorted({round(i) for i in np.linspace(0, count - 1, min(count, _MOST))})
    here = found.isel({over: which})
    _, *others = map(str, here["data_set"].values)
    columns = [bracketed(over.replace("_", " "), here[over].attrs)]
    cells = [[f"{value:g}" for value in displayed(here[over])]]
    for name in (name for name in _IN_TABLES if name in here and here[name].ndim > 1):
        word = _WORDS.get(name) or name.removesuffix("_change").replace("_", " ")
        columns += [bracketed(word, here[name].attrs), *(_BESIDE[other] for other in others)]
        cells += [[_number(value) for value in row] for row in displayed(here[name])]
    return Tabulated(title, tuple(columns), tuple(zip(*cells, strict=True)), frozenset())


def _number(value: float) -> str:
    """Return a number with four decimals, and zero without a sign."""
    text = f"{value:.4f}"
    return text.removeprefix("-") if float(text) == 0.0 else text
