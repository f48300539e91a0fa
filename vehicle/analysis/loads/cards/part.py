"""Loads on one part, point by point: those at the same point are summed."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from .....core.named_types import Array
from ....assembly.part_poses import wrench_about
from ..dataset import CASE, LOAD
from ..mounts import ALL, CHASSIS, with_totals

# Points closer than this are one [m]; rounding of coordinates is 1e-15.
_SAME = 1e-9
# Values below this part of the greatest are rounding errors.
_ROUNDING = 1e-12
_FIELDS = ("force", "moment", "at")


@dataclass(frozen=True)
class LoadedPoint:
    """A point of a part with the loads there in each case.

    Attributes
    ----------
    name : str
    by : tuple of str
        Names of the loads.
    force, moment, at : ndarray, shape (cases, 3)
        [N], [N m], [m].
    """

    name: str
    by: tuple[str, ...]
    force: Array
    moment: Array
    at: Array

    @property
    def fixed(self) -> bool:
        """Whether it is at the same position in all cases."""
        return bool((np.abs(self.at - self.at[0]) < _SAME).all())


@dataclass(frozen=True)
class LoadedPart:
    """A part with its loads in load cases.

    Attributes
    ----------
    part : str
    axes : str
        ``part``, those of the part at design; or ``vehicle``, with the part in its position in each
        case.
    cases : tuple of str
        Names of the cases with an equilibrium.
    numbers : tuple of int
        Their numbers among all cases, from 1.
    left_out : tuple of str
        The other cases, each with the reason.
    points : tuple of LoadedPoint
    """

    part: str
    axes: str
    cases: tuple[str, ...]
    numbers: tuple[int, ...]
    left_out: tuple[str, ...]
    points: tuple[LoadedPoint, ...]

    @classmethod
    def of(cls, dataset: xr.Dataset, part: str, axes: str) -> "LoadedPart":
        """Return a part of a dataset over cases; the chassis has the totals at its mounts."""
        every, numbers, reasons = [str(name) for name in dataset[CASE].values], [], []
        for number, name in enumerate(every, 1):
            reason = str(dataset["reason"].values[number - 1]) if "reason" in dataset else ""
            if reason:
                reasons.append(f"{name}: {reason}")
            else:
                numbers.append(number)
        carried = dataset.isel({CASE: [number - 1 for number in numbers]})
        points = tuple(_rounded(_joined(_points(carried, part, axes))))
        names = tuple(every[number - 1] for number in numbers)
        return cls(part, axes, names, tuple(numbers), tuple(reasons), points)


def _points(dataset: xr.Dataset, part: str, axes: str) -> list[LoadedPoint]:
    """Return the loads on a part, each as a point."""
    with_sums = with_totals(dataset) if part == CHASSIS else dataset
    end = "_in_part" if axes == "part" else ""
    values = {name: with_sums[f"{name}{end}"].transpose(CASE, LOAD, "axis") for name in _FIELDS}
    of = [str(name) for name in with_sums["part"].values]
    own = [row for row, name in enumerate(of) if name in {part, ALL}]
    if part == CHASSIS:
        own = _in_no_mount(with_sums, own)
    return [
        LoadedPoint(
            str(with_sums["point"].values[row]),
            tuple(str(with_sums["by"].values[row]).split(", ")),
            *(values[name].values[:, row] for name in _FIELDS),
        )
        for row in own
    ]


def _in_no_mount(dataset: xr.Dataset, rows: Sequence[int]) -> list[int]:
    """Return the rows of totals, and of loads on the chassis that are in no total."""
    part, by = ([str(name) for name in dataset[key].values] for key in ("part", "by"))
    counted = {each for row in rows if part[row] == ALL for each in by[row].split(", ")}
    return [row for row in rows if part[row] == ALL or by[row] not in counted]


def _joined(points: Sequence[LoadedPoint]) -> list[LoadedPoint]:
    """Return points with the sums of the loads on them.

    Points with different names remain separate even if they coincide: a tie rod and the guide of a
    rack have different nodes in a mesh.
    """
    found: dict[str, LoadedPoint] = {}
    for point in points:
        one = found.setdefault(point.name, point)
        if one is not point:
            more = wrench_about(one.at, point.at, point.force, point.moment)
            by = tuple(dict.fromkeys((*one.by, *point.by)))
            force, moment = one.force + more[:, :3], one.moment + more[:, 3:]
            found[point.name] = replace(one, by=by, force=force, moment=moment)
    return [*found.values()]


def _rounded(points: Sequence[LoadedPoint]) -> list[LoadedPoint]:
    """Return points with loads, with zeros for rounding errors."""
    if not points:
        return []
    forces, moments = (
        np.array([getattr(point, name) for point in points]) for name in ("force", "moment")
    )
    forces[np.abs(forces) <= _ROUNDING * np.abs(forces).max(initial=0.0)] = 0.0
    moments[np.abs(moments) <= _ROUNDING * np.abs(moments).max(initial=0.0)] = 0.0
    return [
        replace(
            point,
            force=force + 0.0,
            moment=moment + 0.0,
            at=np.where(np.abs(point.at) < _SAME, 0.0, point.at),
        )
        for point, force, moment in zip(points, forces, moments, strict=True)
        if force.any() or moment.any()
    ]
