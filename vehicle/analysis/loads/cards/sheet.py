"""The load cards of a part: loads point by point, nodes, cases and units."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from textwrap import wrap
from typing import NamedTuple

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
LENGTHS = {"mm": 1e3, "m": 1.0}
"""Units of length, and their number in a metre."""

# Above the numbers of usual meshes, and below the limit of Nastran.
FIRST_NODE = 99_000_001

_AXES = {
    "part": "Axes of the part, at its design position",
    "vehicle": "Axes of the vehicle, with the part at its position in each case",
}
_DIRECTIONS = "x forward, y left, z up, with the origin of the hardpoints"
_CHASSIS = (
    "These are the totals at the mounts; the body is held by its inertia and other suspensions."
)
_MASSES = "Weight and inertia are included, at the centre of mass."
_WIDTH = 70


@dataclass(frozen=True)
class LoadedPoint:
    """A point of a part with the loads there in each case."""

    name: str
    by: tuple[str, ...]  # names of the loads
    force: Array  # (cases, 3) [N]
    moment: Array  # (cases, 3) [N m]
    at: Array  # (cases, 3) [m]

    @property
    def fixed(self) -> bool:
        """Whether it is at the same position in all cases."""
        return bool((np.abs(self.at - self.at[0]) < _SAME).all())


class Node(NamedTuple):
    """A node with its force and moment by the index of the case; units of the file."""

    number: int
    name: str
    by: Sequence[str]
    at: Array
    loads: dict[int, tuple[Array, Array]]


@dataclass(frozen=True)
class CardSheet:
    """The cards of a part with its loads in load cases."""

    part: str
    # ``part``, those of the part at design; ``vehicle``, with the part in its position in each case
    axes: str
    length: str  # unit of length: mm or m
    source: str  # name of the suspension or axle
    cases: tuple[str, ...]  # names of the cases with an equilibrium
    numbers: tuple[int, ...]  # their numbers among all cases, from 1
    left_out: tuple[str, ...]  # the other cases, each with the reason
    points: tuple[LoadedPoint, ...]

    @classmethod
    def of(cls, dataset: xr.Dataset, part: str, axes: str, length: str, source: str) -> "CardSheet":
        """Return the cards of a part over cases; the chassis has the totals at its mounts."""
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
        return cls(part, axes, length, source, names, tuple(numbers), tuple(reasons), points)

    def nodes(self) -> list[Node]:
        """Return a node for each point, or for each case if the point moves on the part."""
        scale = LENGTHS[self.length]
        found: list[Node] = []
        for point in self.points:
            every = range(len(self.cases))
            for places in [every] if point.fixed else [[place] for place in every]:
                loads = {
                    place: (point.force[place], scale * point.moment[place])
                    for place in places
                    if point.force[place].any() or point.moment[place].any()
                }
                if not loads:
                    continue
                name = point.name if point.fixed else f"{point.name}_{self.cases[places[0]]}"
                number, at = FIRST_NODE + len(found), scale * point.at[places[0]]
                found.append(Node(number, name, point.by, at, loads))
        return found

    def remarks(self, digits: int) -> Iterator[str]:
        """Yield remarks on units, axes and sums of numbers with some digits."""
        moment = f"N {self.length}"
        yield from wrap(f"Loads on the part {self.part} of {self.source}, by kintrafo.", _WIDTH)
        yield f"Units: N, {self.length}, {moment}."
        yield from wrap(f"{_AXES[self.axes]}: {_DIRECTIONS}.", _WIDTH)
        forces, moments = self.left(digits)
        yield from wrap(
            f"Sums of these forces, and of moments about the origin: at most {forces:.1e} N and "
            f"{moments:.1e} {moment}. {_CHASSIS if self.part == CHASSIS else _MASSES}",
            _WIDTH,
        )
        for line in self.left_out:
            yield from wrap(f"Not carried: {line}", _WIDTH)

    def left(self, digits: int) -> tuple[float, float]:
        """Return the greatest sums of forces and of moments of a case, with numbers as written."""

        def written(values: Array) -> Array:
            return np.array([float(f"{value:.{digits - 1}e}") for value in values])

        sums = np.zeros((len(self.cases), 6))
        for node in self.nodes():
            for place, load in node.loads.items():
                at, force, moment = (written(values) for values in (node.at, *load))
                sums[place] += wrench_about(np.zeros(3), at, force, moment)
        forces, moments = (np.linalg.norm(part, axis=1) for part in (sums[:, :3], sums[:, 3:]))
        return float(forces.max(initial=0.0)), float(moments.max(initial=0.0))


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
