"""Loads as tables for the terminal and the report."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from ....core.tabulated import Tabulated, whole
from ...assembly.by_wheel import flat, without_side
from .mounts import ALL, CHASSIS, with_totals

_ACTING = ("spring", "damper", "road", "drive", "steering", "bar")


def acts(by: str) -> bool:
    """Return whether a load is applied, rather than that of a joint."""
    return without_side(by) in _ACTING


def overview(found: xr.Dataset, title: str, parts: Sequence[str] = ()) -> Tabulated:
    """Return the size of every force in every case of a result of `static`.

    All loads of chosen parts are shown; by default the table has each joint once. The part
    ``total`` has the sums at all mounts.
    """
    found = flat(found)
    rows = [
        (_words(n), *(whole(float(load)) for load in found[n].values))
        for n in _named(found, "wheel_load")
    ]
    for name in _named(found, "travel"):
        travels = (f"{1e3 * travel:.1f}" for travel in found[name].values)
        texts = (text.replace("-0.0", "0.0").replace("nan", "-") for text in travels)
        rows.append((f"wheel {_words(name)} [mm]", *texts))
    if "bar_torque" in found:
        rows.append(("bar torque [N m]", *(whole(float(m)) for m in found["bar_torque"].values)))
    rods = [] if parts or "rod_force" not in found else [str(name) for name in found["rod"].values]
    for rod in rods:
        pulls = found["rod_force"].sel(rod=rod).values
        rows.append((f"{rod}, pull", *(whole(float(pull)) for pull in pulls)))
    found = with_totals(found, several=ALL not in parts)
    sizes = np.linalg.norm(found["force"].values, axis=-1)
    for i in shown_rows(found, parts):
        part, point, by = (str(found[name].values[i]) for name in ("part", "point", "by"))
        # rods have their own rows
        if part not in rods and by not in rods and np.nan_to_num(sizes[:, i]).any():
            name = by if acts(by) else point
            name = f"{point}, total" if part == ALL else name
            rows.append((name, *(whole(float(size)) for size in sizes[:, i])))
    return Tabulated(title, ("at", *map(str, found["case"].values)), tuple(rows))


def _named(found: xr.Dataset, stem: str) -> list[str]:
    """Return the names of a variable of one wheel or of both."""
    return [name for name in map(str, found) if without_side(name) == stem]


def _words(name: str) -> str:
    return name.replace("_", " ")


def shown_rows(found: xr.Dataset, parts: Sequence[str] = ()) -> list[int]:
    """Return the indices of the shown loads: all on some parts, or one of each pair of opposites.

    Totals at mounts are shown with the loads on the chassis.
    """
    given = [str(part) for part in found["part"].values]
    sizes = np.abs(found["force"].values) + np.abs(found["moment"].values)
    strong = np.nan_to_num(sizes).max(axis=(0, 2)) > 0.0
    if parts:
        wanted = {*parts, ALL} if CHASSIS in parts else {*parts}
        return [i for i, name in enumerate(given) if name in wanted and strong[i]]
    return [i for i in once(found) if strong[i]]


def once(found: xr.Dataset) -> list[int]:
    """Return the indices of the loads other than weights, one of each pair of opposites."""
    seen: set[frozenset[str]] = set()
    rows = []
    labels = (found[name].values.astype(str) for name in ("part", "point", "by"))
    for i, (part, point, by) in enumerate(zip(*labels, strict=True)):
        pair = frozenset((by,) if acts(by) else (f"{part} {point}", f"{by} {point}"))
        if pair not in seen and by != "gravity":
            rows.append(i)
            seen.add(pair)
    return rows
