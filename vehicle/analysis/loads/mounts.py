"""Total loads on each mount, a point of the chassis to which parts are bolted.

Loads at a mount, and at points that coincide with it or belong to it, such as the seat of a spring
beside the top of its strut, are summed, with moments about the mount.
"""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from ....core.quantities import variable
from ...assembly.load import Load
from ...assembly.part_poses import wrench_about

MOUNT, ALL = "mount", "total"
"""Dimension of the totals, and the name of their part in tables."""

CHASSIS = "chassis"
# Points closer than this coincide [m].
_SAME = 1e-9
_FIELDS = ("force", "moment", "at")
_MEANINGS = {
    "force": ("sum of the forces on the chassis at a mount, chassis axes", "N"),
    "moment": ("sum of the moments on the chassis about a mount, chassis axes", "N m"),
    "at": ("where the mount is, chassis axes", "m"),
}


def totals(
    over: str, loads: Sequence[Load], mounted: Mapping[str, str], count: int
) -> dict[str, xr.Variable]:
    """Return the total loads on each mount at a number of positions, as variables.

    They are ``total_force``, ``total_moment`` and ``total_at`` over the positions, ``mount`` and
    axis; the names of the mounts, and in ``total_by`` those of the loads. Points may belong to a
    mount at another one, or to none (an empty text).
    """
    groups = _groups([load for load in loads if load.part == CHASSIS], mounted)
    found = np.empty((3, count, len(groups), 3))
    for which, own in enumerate(groups.values()):
        at = own[0].at
        wrenches = [wrench_about(at, load.at, load.force, load.moment) for load in own]
        total = np.sum(np.broadcast_arrays(*wrenches), axis=0)
        found[:, :, which] = total[..., :3], total[..., 3:], at
    dims = (over, MOUNT, "axis")
    data = {
        f"total_{name}": variable(dims, values, *_MEANINGS[name])
        for name, values in zip(_FIELDS, found, strict=True)
    }
    acting = [", ".join(dict.fromkeys(load.by for load in own)) for own in groups.values()]
    words = "loads on the chassis at a mount"
    return data | {
        MOUNT: xr.Variable(MOUNT, np.array([*groups], dtype=str)),
        "total_by": variable(MOUNT, np.array(acting, dtype=str), words, "1"),
    }


def with_totals(dataset: xr.Dataset, *, several: bool = False) -> xr.Dataset:
    """Return loads with the totals at the mounts as further loads, on the part ``total``.

    Those at mounts with one load may be left out.
    """
    if MOUNT not in dataset.dims:
        return dataset
    acting = [str(by) for by in dataset["total_by"].values]
    rows = [i for i, by in enumerate(acting) if not several or ", " in by]
    here = dataset.isel({MOUNT: rows})
    names = [str(name) for name in here[MOUNT].values]
    further = {
        name: here[f"total_{name.removesuffix('_in_part')}"].rename({MOUNT: "load"})
        for name in (*_FIELDS, *(f"{name}_in_part" for name in _FIELDS))
    }
    labels = {
        "load": [f"{ALL} at {name} by {acting[i]}" for name, i in zip(names, rows, strict=True)],
        "part": ("load", [ALL] * len(rows)),
        "point": ("load", names),
        "by": ("load", [acting[i] for i in rows]),
    }
    more = xr.Dataset(further).drop_vars(MOUNT, errors="ignore").assign_coords(labels)
    own = dataset.drop_dims(MOUNT)
    loads = xr.concat(
        [own[[*further]], more], "load", coords="minimal", compat="override",
        combine_attrs="override",
    )  # fmt: skip
    return own.drop_dims("load").merge(loads).assign_attrs(dataset.attrs)


def _groups(loads: Sequence[Load], mounted: Mapping[str, str]) -> dict[str, list[Load]]:
    """Return the loads on the chassis by the mounts at which they act, in the order of loads."""
    groups: dict[str, list[Load]] = {}
    for load in sorted(loads, key=lambda load: load.point in mounted):
        point = mounted.get(load.point, load.point)
        if not point:
            continue
        if point not in groups:  # unless a mount coincides with it
            near = (m for m, own in groups.items() if np.abs(own[0].at - load.at).max() < _SAME)
            point = next(near, point)
        groups.setdefault(point, []).append(load)
    return groups
