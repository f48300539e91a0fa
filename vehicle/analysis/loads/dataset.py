"""Loads on parts as a dataset, their extremes, and tables of them."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import product
from typing import NamedTuple, Self

import numpy as np
import xarray as xr

from ....core.named_types import Array
from ....core.quantities import attributes, variable
from ....core.validator import Validator
from ....core.vectors import cross
from ....datasets.recording import TIME
from ...assembly.assembly import HeldAssembly
from ...assembly.by_wheel import WHEEL, flat, stacked, wheel_coordinate
from ...assembly.coupling import BodyPose
from ...assembly.load import Load
from ...assembly.part_poses import PartPoses
from ...corner.structure import GROUND
from ...models.reach import PositionError
from .mounts import totals, with_totals
from .reactions import BalanceEquations

CASE, LOAD, AXIS, PART = "case", "load", "axis", "part"
"""Dimensions of the loads."""

AXES = {
    "vehicle": "vehicle: x forward y left z up",
    "part": "part as at design: x forward y left z up",
}
"""Axes of points and components, and their names in tables."""

_ENDS = "min", "min_case", "max", "max_case"
_NEEDED = "a result of kintrafo.loads.static or along is needed"


class BalancedLoads(NamedTuple):
    """The loads in n states of equations of motion, in the axes of the assembly's file."""

    assembly: HeldAssembly
    poses: Mapping[str, PartPoses]  # by suffix
    # all loads on each group of parts, by suffix, those of the joints first
    loads: dict[str, list[Load]]
    holding: list[Array]  # residual vertical force on each wheel, (n,) [N]

    @classmethod
    def of(
        cls, assembly: HeldAssembly, poses: Mapping[str, PartPoses], known: Mapping[str, list[Load]]
    ) -> Self:
        """Return the known loads by suffix, with inertia, and those of the joints."""
        loads: dict[str, list[Load]] = {}
        holding: list[Array] = []
        for suffix, group in poses.items():
            equations = BalanceEquations(group)
            unknowns = equations.solve(equations.applied(known[suffix]))
            loads[suffix] = [*equations.carried(unknowns), *known[suffix]]
            holding += [*unknowns[:, -len(group.wheels) :].T]
        return cls(assembly, poses, loads, holding)

    def dataset(self) -> xr.Dataset:
        """Return the loads over time, as in `kintrafo.loads.along`."""
        found = loads_of(TIME, self.assembly, self.poses, self.loads)
        meaning = "residual vertical force at the wheel"
        return found.assign(holding_force=stacked(TIME, self.holding, attributes(meaning, "N")))


def loads_of(
    over: str,
    assembly: HeldAssembly,
    poses: Mapping[str, PartPoses],
    loads: Mapping[str, Sequence[Load]],
) -> xr.Dataset:
    """Return the loads of an assembly over a dimension, with those between its groups.

    Poses and loads are by suffix.
    """
    every, places = _with_shared(assembly, poses, loads)
    mounted = {
        f"{point}{suffix}": mount and f"{mount}{suffix}"
        for suffix, group in poses.items()
        for point, mount in group.structure.mounted.items()
    }
    found = dataset_of(over, every, places, design_centers(assembly), mounted)
    found = found.assign(assembly.further(over, poses, found))
    return found.assign_coords({WHEEL: wheel_coordinate(assembly.wheels)}).assign_attrs(
        rules="; ".join(assembly.rules)
    )


def _with_shared(
    assembly: HeldAssembly, poses: Mapping[str, PartPoses], loads: Mapping[str, Sequence[Load]]
) -> tuple[list[Load], dict[str, BodyPose]]:
    """Return all loads and the poses of all parts, with those that both sides share."""
    own = [of_side(load, suffix) for suffix, every in loads.items() for load in every]
    places = {
        f"{part}{suffix}": BodyPose(group.centers[part], group.turned[part])
        for suffix, group in poses.items()
        for part in group.structure.parts
    }
    further, shared = assembly.between(poses, own)
    return [*own, *further], places | shared


def design_centers(assembly: HeldAssembly) -> dict[str, Array]:
    """Return the centre of each part at design, see `BodyPose`, (3,) [m]."""
    poses = assembly.at_wheel_coordinates(assembly.design_wheel_coordinates[None], np.zeros(1))
    acting, loads = assembly.acting(poses), {}
    for suffix, group in poses.items():
        equations = BalanceEquations(group)
        unknowns, _ = equations.solved(equations.applied(acting[suffix]))
        loads[suffix] = [*equations.carried(unknowns), *acting[suffix]]
    places = _with_shared(assembly, poses, loads)[1]
    return {part: place.center[0] for part, place in places.items()}


def of_side(load: Load, suffix: str) -> Load:
    """Return a load whose names have the suffix of a side, but for those that are not of a side."""
    return replace(
        load,
        part=load.part if load.part in GROUND else load.part + suffix,
        point=load.point if load.point == "mass" else load.point + suffix,
        by=load.by if load.by in (*GROUND, "gravity", "inertia") else load.by + suffix,
    )


def dataset_of(
    over: str,
    loads: Sequence[Load],
    places: Mapping[str, BodyPose],
    design: Mapping[str, Array],
    mounted: Mapping[str, str],
) -> xr.Dataset:
    """Return loads over a dimension, with poses of parts and their centres at design, (3,) [m].

    Points belong to mounts as in `Structure`.
    """
    count = max(len(place.center) for place in places.values())
    fields = {name: _columns(loads, name, count) for name in ("force", "moment", "at")}
    parts = [load.part for load in loads]
    moving = [part for part in places if part in parts]
    rows = {part: [i for i, other in enumerate(parts) if other == part] for part in moving}
    data = {
        "force": (fields["force"], "force on the part, chassis axes", "N"),
        "moment": (fields["moment"], "moment about the point, chassis axes", "N m"),
        "at": (fields["at"], "where it acts, chassis axes", "m"),
    }
    turned = {part: places[part].turned for part in moving}
    for name in ("force", "moment"):
        inside = _in_parts(fields[name], turned, rows)
        meaning = f"{name} on the part, in the axes that the part had at design"
        data[f"{name}_in_part"] = (inside, meaning, data[name][2])
    points = _points_in_parts(fields["at"], places, design, rows)
    data["at_in_part"] = (points, "point of the part where it acts, as placed at design", "m")
    left = [_sum(fields, rows[part], places[part].center) for part in moving]
    residuals = {}
    for name, unit, sums in zip(
        ("", "_moment"), ("N", "N m"), zip(*left, strict=True), strict=True
    ):
        meaning = f"sum of all {'moments' if name else 'forces'} on a part"
        sizes = np.linalg.norm(sums, axis=1)
        residuals[f"residual{name}"] = variable((over, "moving_part"), sizes.T, meaning, unit)
    coordinates = {
        LOAD: [f"{load.part} at {load.point} by {load.by}" for load in loads],
        PART: (LOAD, parts),
        "point": (LOAD, [load.point for load in loads]),
        "by": (LOAD, [load.by for load in loads]),
        AXIS: ["x", "y", "z"],
        "moving_part": moving,
    }
    described = {
        name: variable((over, LOAD, AXIS), np.moveaxis(columns, -1, 0), meaning, unit)
        for name, (columns, meaning, unit) in data.items()
    }
    found = xr.Dataset(described | residuals, coordinates)
    return found.assign(totals(over, loads, mounted, count))


def over_cases(
    found: xr.Dataset, names: Sequence[str], carried: Sequence[int], reasons: Sequence[str]
) -> xr.Dataset:
    """Return the loads over all named cases, from those of cases with an equilibrium, by index.

    The reasons why a case has no equilibrium are empty if it has.
    """
    found = found.assign_coords({CASE: [names[i] for i in carried]}).reindex({CASE: [*names]})
    found["reason"] = variable(CASE, np.array(reasons), "reason for no equilibrium", "1")
    message = f"{len(carried)} of {len(names)} cases have an equilibrium"
    return found.assign_attrs(title="loads in load cases", message=message)


def refuse_if_none(names: Sequence[str], carried: Sequence[int], reasons: Sequence[str]) -> None:
    """Raise a `PositionError` if no case has an equilibrium, see `over_cases`."""
    if not carried:
        lines = [f"{name}: {reason}" for name, reason in zip(names, reasons, strict=True)]
        raise PositionError("\n  - ".join(["none of the cases has an equilibrium", *lines[:3]]))


def _sum(fields: dict[str, Array], rows: list[int], about: Array) -> tuple[Array, Array]:
    """Return the sum of some loads, and of their moments about a point, (3, count)."""
    force, moment, at = (fields[name][rows] for name in ("force", "moment", "at"))
    turning = cross(np.moveaxis(at - about.T, 1, -1), np.moveaxis(force, 1, -1))
    return force.sum(axis=0), moment.sum(axis=0) + turning.sum(axis=0).T


def envelope(dataset: xr.Dataset) -> xr.Dataset:
    """Return the least and the greatest component of every load, and their cases.

    Parameters
    ----------
    dataset : xarray.Dataset
        Result of `static`; cases without equilibrium are left out.

    Returns
    -------
    xarray.Dataset
        ``force_min``, ``force_max`` [N], ``moment_min``, ``moment_max`` [N m] over ``load`` and
        ``axis``, in chassis axes, and the case of each, ``force_min_case`` and so on.
    """
    with Validator("envelope") as given:
        given.instance("dataset", dataset, xr.Dataset, _NEEDED)
        _check(given, dataset, CASE)
    found = {}
    for name in ("force", "moment"):
        for end in ("min", "max"):
            values = dataset[name]
            key = f"{name}_{end}"
            found[key] = getattr(values, end)(CASE).assign_attrs(values.attrs)
            found[f"{key}_case"] = getattr(values, f"idx{end}")(CASE).drop_attrs()
    return xr.Dataset(found, attrs={"title": "envelope of the loads"})


def peaks(dataset: xr.Dataset) -> xr.Dataset:
    """Return the greatest force and moment of every load during a motion, and their times.

    Parameters
    ----------
    dataset : xarray.Dataset
        Result of `along`.

    Returns
    -------
    xarray.Dataset
        Over ``load``: the greatest magnitudes, ``force_peak`` [N] and ``moment_peak`` [N m], and
        their times ``force_peak_time`` and ``moment_peak_time`` [s]; also over ``axis`` the
        components at these times, ``force`` [N] and ``moment`` [N m], in chassis axes.
    """
    with Validator("peaks") as given:
        given.instance("dataset", dataset, xr.Dataset, _NEEDED)
        _check(given, dataset, TIME)
    found = {}
    for name in ("force", "moment"):
        components = dataset[name].transpose(TIME, LOAD, AXIS)
        sizes = np.linalg.norm(components.values, axis=-1)
        when = sizes.argmax(axis=0)
        unit, rows = str(components.attrs["units"]), np.arange(sizes.shape[1])
        found[f"{name}_peak"] = variable(
            LOAD, sizes[when, rows], f"greatest magnitude of the {name}", unit
        )
        times = dataset[TIME].values[when]
        found[f"{name}_peak_time"] = variable(LOAD, times, f"when the {name} is greatest", "s")
        meaning = f"{name} on the part then, chassis axes"
        found[name] = variable((LOAD, AXIS), components.values[when, rows], meaning, unit)
    labels = {name: dataset[name] for name in (LOAD, PART, "point", "by", AXIS)}
    return xr.Dataset(found, labels, {"title": "greatest loads along a motion"})


def table(dataset: xr.Dataset, axes: str = "vehicle") -> xr.Dataset:
    """Return loads as a table with a column for each component, for strength analysis.

    Parameters
    ----------
    dataset : xarray.Dataset
        Result of `static` or `along`.
    axes : {"vehicle", "part"}, optional
        Axes of points and components: those of the vehicle, or of each part at design.

    Returns
    -------
    xarray.Dataset
        ``force_x`` to ``force_z`` [N], ``moment_x`` to ``moment_z`` [N m] and ``at_x`` to ``at_z``
        [m] over case, or time, and load: a row for each load on each part. Totals at the mounts of
        the chassis are rows of a part ``total``. The column ``axes`` has the name of the axes.
    """
    with Validator("table") as given:
        given.instance("dataset", dataset, xr.Dataset, _NEEDED)
        _check(given, dataset)
        given.among("axes", axes, AXES)
    end = "_in_part" if axes == "part" else ""
    dataset = with_totals(flat(dataset))
    columns = {
        f"{name}_{axis}": dataset[f"{name}{end}"].sel({AXIS: axis}, drop=True)
        for name in ("force", "moment", "at")
        for axis in dataset[AXIS].values
    }
    for name, column in columns.items():
        words = str(column.attrs["long_name"]).split(",", maxsplit=1)
        column.attrs["long_name"] = f"{words[0]}, {name[-1]}"
    if "reason" in dataset:
        columns["reason"] = dataset["reason"]
    columns["axes"] = xr.DataArray(variable((), AXES[axes], "axes of points and components", "1"))
    return xr.Dataset(columns, attrs=dataset.attrs)


def workbook(dataset: xr.Dataset, axes: str = "vehicle") -> dict[str, xr.Dataset]:
    """Return loads as the sheets of an Excel workbook, see `kintrafo.export.write`.

    Parameters
    ----------
    dataset : xarray.Dataset
        Result of `static` or `along`.
    axes : {"vehicle", "part"}, optional
        Axes of the sheet ``loads``, see `table`; the extremes are in those of the vehicle.

    Returns
    -------
    dict of str to xarray.Dataset
        ``loads``, from `table`; for load cases also ``envelope``, with a row for each load, and the
        least and greatest value of every component with its case.
    """
    found = {"loads": table(dataset, axes)}
    if CASE not in dataset.dims:
        return found
    ends = envelope(with_totals(flat(dataset)))
    columns = {
        f"{name}_{axis}_{end}": ends[f"{name}_{end}"].sel({AXIS: axis}, drop=True)
        for name, axis, end in product(("force", "moment"), "xyz", _ENDS)
    }
    return found | {"envelope": xr.Dataset(columns, attrs=ends.attrs)}


def _check(given: Validator, dataset: xr.Dataset, *further: str) -> None:
    """Add an error for a dataset without loads."""
    if given.failed:
        return
    dimensions = {LOAD, AXIS, *further} <= {*dataset.dims}
    if not (dimensions and {"force", "moment", "at"} <= {*map(str, dataset)}):
        given.fail(f"dataset: {_NEEDED}, over {', '.join((*further, LOAD, AXIS))}.")


def _columns(loads: Sequence[Load], name: str, count: int) -> Array:
    """Return a vector of each load, (loads, 3, count), contiguous over positions."""
    found = np.empty((len(loads), 3, count))
    for columns, load in zip(found, loads, strict=True):
        columns.T[...] = getattr(load, name)
    return found


def _in_parts(
    columns: Array, turned: Mapping[str, Array], rows: Mapping[str, Sequence[int]]
) -> Array:
    """Return vectors, (loads, 3, count), in the axes that each part had at design."""
    found = columns.copy()
    for part, rotation in turned.items():
        own = np.ascontiguousarray(np.moveaxis(rotation, 0, -1))
        found[rows[part]] = np.einsum("ijn,lin->ljn", own, columns[rows[part]])
    return found


def _points_in_parts(
    at: Array,
    places: Mapping[str, BodyPose],
    design: Mapping[str, Array],
    rows: Mapping[str, Sequence[int]],
) -> Array:
    """Return the positions of points on the parts at design, (loads, 3, count)."""
    arms = at.copy()
    for part, own in rows.items():
        arms[own] -= places[part].center.T
    found = _in_parts(arms, {part: places[part].turned for part in rows}, rows)
    for part, own in rows.items():
        found[own] += design[part][:, None]
    return found
