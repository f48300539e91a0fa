"""Compliance as tables for the terminal and the report."""

from collections.abc import Iterable, Sequence

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
    """Return a table of compliances with a row for each load, as in the summary of a rig.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `linear`.
    title : str
    at : float, optional
        Wheel travel [m].
    """
    here = flat(found).sel(wheel_travel=at, method="nearest")
    names = [str(name) for name in here.data_vars]
    on_axle = any(without_side(name) != name for name in names)
    kinds = [kind for kind in _COMPLIANCES if _by(names, [kind])]
    rows = []
    for load in _by(names, kinds):
        cells, name = _cells(here, kinds, load)
        words = long_name(here[name]).partition(" by ")[2].removeprefix("a ")
        by, wheel = words.rsplit(", ", 1) if on_axle else (words, "")
        rows.append((by, *[wheel][: int(on_axle)], _per(here[name]), *cells))
    first = ("by", "wheel", "per") if on_axle else ("by", "per")
    columns = (*first, *(_COMPLIANCES[kind] for kind in kinds))
    return Tabulated(title, columns, tuple(rows), frozenset(range(len(first))))


def _by(names: Sequence[str], kinds: Iterable[str]) -> list[str]:
    """Return the loads in the names of some kinds of compliance, each once."""
    heads = [f"{kind}_by_" for kind in kinds]
    loads = (n.removeprefix(head) for n in names for head in heads if n.startswith(head))
    return list(dict.fromkeys(loads))


def _cells(here: xr.Dataset, kinds: Sequence[str], load: str) -> tuple[list[str], str]:
    """Return the compliances of some kinds under a load, and the name of the first variable."""
    keys = [f"{kind}_by_{load}" for kind in kinds]
    cells = [significant(float(displayed(here[k]))) if k in here else "-" for k in keys]
    return cells, next(key for key in keys if key in here)


def _per(data: xr.DataArray) -> str:
    return display_of(data.attrs).units.partition("/")[2]


def compliances_of_beam(found: xr.Dataset, title: str, at: float = 0.0) -> list[Tabulated]:
    """Return a table of the compliances of the beam of a rigid axle; none for other assemblies.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `linear`.
    title : str
    at : float, optional
        Wheel travel [m].
    """
    here = flat(found).sel(wheel_travel=at, method="nearest")
    names = [str(name) for name in here.data_vars]
    kinds = [kind for kind in _OF_AXLES if _by(names, [kind])]
    rows = []
    for load in _by(names, kinds):
        cells, name = _cells(here, kinds, load)
        rows.append((long_name(here[name]).partition(" by ")[2], _per(here[name]), *cells))
    columns = ("by", "per, each wheel", *(_OF_AXLES[kind] for kind in kinds))
    return [Tabulated(title, columns, tuple(rows), frozenset({0, 1}))] if rows else []


def deflections(found: xr.Dataset, title: str) -> list[Tabulated]:
    """Return tables of curves on bushes, and with rigid joints or to first order.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `elastokinematics` or `nonlinear`.
    title : str

    Returns
    -------
    list of Tabulated
        One of each wheel, and one of values of both wheels together.
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
