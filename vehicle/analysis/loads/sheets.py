"""Loads as tables that a person reads."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from ....core.tabulated import Tabulated, whole
from ...assembly.by_wheel import flat
from .mounts import ALL, CHASSIS, with_totals

_ACTING = ("spring", "damper", "road", "drive", "steering", "bar")


def acts(by: str) -> bool:
    """Return whether something acts by itself, not between parts at a joint."""
    return without_side(by) in _ACTING


def without_side(name: str) -> str:
    """Return a name of an axle, or of a car, without its side and its end."""
    without = name.removesuffix("_left").removesuffix("_right")
    return without.removesuffix("_front").removesuffix("_rear")


def overview(found: xr.Dataset, title: str, parts: Sequence[str] = ()) -> Tabulated:
    """Return the size of every force in every case.

    Parameters
    ----------
    found : xarray.Dataset
        From `static`.
    title : str
    parts : sequence of str, optional
        Loads on these parts, with all that act on them; by default each joint once. The part
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
        # a rod has its row, and the torque of a bar
        if part not in rods and by not in rods and np.nan_to_num(sizes[:, i]).any():
            name = by if acts(by) else point
            name = f"{point}, total" if part == ALL else name
            rows.append((name, *(whole(float(size)) for size in sizes[:, i])))
    return Tabulated(title, ("at", *map(str, found["case"].values)), tuple(rows))


def _named(found: xr.Dataset, stem: str) -> list[str]:
    """Return what there is of a wheel, or of both of an axle."""
    return [name for name in map(str, found) if without_side(name) == stem]


def _words(name: str) -> str:
    return name.replace("_", " ")


def shown_rows(found: xr.Dataset, parts: Sequence[str] = ()) -> list[int]:
    """Return the loads that are shown: of what two parts exert on each other one, if not asked.

    Totals at mounts go with the loads on the chassis.
    """
    given = [str(part) for part in found["part"].values]
    sizes = np.abs(found["force"].values) + np.abs(found["moment"].values)
    strong = np.nan_to_num(sizes).max(axis=(0, 2)) > 0.0
    if parts:
        wanted = {*parts, ALL} if CHASSIS in parts else {*parts}
        return [i for i, name in enumerate(given) if name in wanted and strong[i]]
    seen: set[frozenset[str]] = set()
    rows = []
    for i, (name, point, by) in enumerate(
        zip(given, found["point"].values, found["by"].values, strict=True)
    ):
        pair = frozenset((by,) if acts(by) else (f"{name} {point}", f"{by} {point}"))
        if strong[i] and pair not in seen and by != "gravity":
            rows.append(i)
            seen.add(pair)
    return rows
