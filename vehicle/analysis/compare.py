"""Characteristics of several suspensions or axles over one motion, and their differences."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from ...core.errors import InputError
from ...core.memory import positions_given
from ...core.named_types import Array, ArrayLike
from ...core.validator import Validator
from ..assembly.assembly import Assembly
from ..assembly.by_wheel import flat
from ..assembly.of import given_assemblies
from ..assembly.quantity import RACK
from .characteristics.datasets import DATA_SET, dataset, given_motion
from .compliance.flexibility import HELD, WheelSupport
from .compliance.linear import linear

# Positions this close to each other are the same one, also of a rig [m] or [rad].
_AT_DESIGN = 5e-4


def compare(
    subjects: Mapping[str, Any],
    along: ArrayLike | None = None,
    *,
    over: str | None = None,
    held: WheelSupport | None = None,
    progress: Callable[[float], None] | None = None,
) -> xr.Dataset:
    """Return the characteristics of several suspensions, axles or cars over the same positions.

    Parameters
    ----------
    subjects : mapping of str to Suspension, Axle, RigidAxle, Car or their models
        Two or more with a common motion, each with the name of its curves.
    along : array_like, shape (n,), optional
        Positions as in `kintrafo.characteristics.over` [m] or [rad]; by default the usual range
        that all of them reach.
    over : str, optional
        The motion; by default 'travel', of axles 'bump', of cars 'heave'. If one of them has no
        steering ratio, 'steer' is over the rack for all.
    held : {'height', 'tyre', 'spring', 'locked'}, optional
        Support of the wheels under loads, see `kintrafo.compliance.linear`; the result then also
        has the compliance on the bushes of the files, over wheel travel.
    progress : callable, optional
        Called with the completed fraction, up to 1.

    Returns
    -------
    xarray.Dataset
        As from `kintrafo.characteristics.over`, with the further dimension ``data_set``: the names
        in `subjects`. It contains the characteristics that all subjects have.

    Raises
    ------
    InputError
        If an argument cannot be used.
    PositionError
        If one of them does not reach a position.
    """
    with Validator("compare") as given:
        assemblies = given_assemblies(given, "subjects", subjects, cars=True)
        given.function("progress", progress)
    if len(assemblies) < 2:
        problem = f"{len(assemblies)} data set; two or more are needed for a comparison."
        raise InputError([problem], "compare")
    motion = _common_motion(assemblies, over)
    with Validator("compare") as given:
        if along is not None:
            units = next(iter(assemblies.values())).motions[motion].along.units
            along = positions_given(given, "along", along, units)
            for assembly in assemblies.values() if not given.failed else ():
                assembly.refuse_positions(given, motion, along)
        if held is not None:
            given.among("held", held, HELD)
            _refuse_compliance(given, assemblies, motion)
    positions = common_positions([*assemblies.values()], motion) if along is None else along
    datasets = []
    for index, assembly in enumerate(assemblies.values()):
        found = dataset(assembly, motion, positions)
        if held is not None:
            found = with_compliance(found, assembly, positions, held)
        datasets.append(found)
        if progress is not None:
            progress((index + 1) / len(assemblies))
    return beside_each_other(assemblies, datasets)


def beside_each_other(names: Mapping[str, Any], datasets: Sequence[xr.Dataset]) -> xr.Dataset:
    """Return datasets over one motion as one, with the dimension ``data_set``."""
    common = [
        name
        for name, first in datasets[0].items()
        if all(name in each and each[name].dims == first.dims for each in datasets)
    ]
    parts = [each[common] for each in datasets]
    if not all(RACK.name in each.coords for each in datasets):  # some have no rack
        parts = [each.drop_vars(RACK.name, errors="ignore") for each in parts]
    return side_by_side(parts, xr.Variable(DATA_SET, list(names), {"long_name": "data set"}))


def side_by_side(parts: Sequence[xr.Dataset], labels: xr.Variable) -> xr.Dataset:
    """Return datasets at the same positions, which may repeat, over a further dimension."""
    return xr.concat(
        parts, labels, join="override", coords="minimal", compat="override",
        combine_attrs="override",
    )  # fmt: skip


def _common_motion(assemblies: Mapping[str, Assembly], over: str | None) -> str:
    """Return the motion over which all assemblies are compared, or raise an `InputError`."""
    first = next(iter(assemblies.values()))
    for name, assembly in assemblies.items():
        if assembly.usual_motion != first.usual_motion:
            problem = (
                f"{name} has the motions {', '.join(assembly.motions)}, and the first one "
                f"{', '.join(first.motions)}: suspensions are not compared with axles."
            )
            raise InputError([problem], "compare")
    for assembly in assemblies.values():
        motion = given_motion(assembly, over, "over")
    if len({assembly.motions[motion].along.name for assembly in assemblies.values()}) > 1:
        return "rack"  # some files have no steering ratio
    return motion


def _refuse_compliance(given: Validator, assemblies: Mapping[str, Assembly], motion: str) -> None:
    """Refuse compliance over other motions than the usual one, and that of rigid joints."""
    usual = next(iter(assemblies.values())).usual_motion
    if motion != usual:
        given.fail(
            f"held: compliance is over wheel travel, {usual!r}. Leave it out over {motion!r}."
        )
    for name, assembly in assemblies.items():
        if not assembly.has_bushes:
            given.fail(f"held: {name} has no [bushings], and nothing in it deflects.")


def with_compliance(
    found: xr.Dataset,
    assembly: Assembly,
    travels: Array,
    held: WheelSupport,
    rack_position: float = 0.0,
) -> xr.Dataset:
    """Return characteristics and compliance at the same travels, of an axle in parallel [m]."""
    soft = linear(assembly, None, travels, held=held, rack_position=rack_position)
    curves = soft.drop_dims(["moved", "by"])
    return found.assign({str(name): data.variable for name, data in curves.items()})


def common_positions(assemblies: Sequence[Assembly], motion: str) -> Array:
    """Return the usual positions of the first assembly within the range of all [m] or [rad]."""
    grids = [assembly.usual(motion) for assembly in assemblies]
    low, high = max(grid[0] for grid in grids), min(grid[-1] for grid in grids)
    return np.union1d(grids[0][(grids[0] > low) & (grids[0] < high)], [low, high])


@dataclass(frozen=True)
class Difference:
    """Difference of a characteristic between a suspension or axle and the first one, SI units.

    Attributes
    ----------
    name, data_set : str
        Characteristic, as in a flat table, and the name of the suspension that is compared with the
        first one.
    first, other : float
        Both values at the position of the comparison, by default that of design; NaN where they are
        not defined.
    largest : float
        The difference, other minus first, at the position where its absolute value is largest; NaN
        if both are defined nowhere.
    where : float
        Position of the largest difference [m] or [rad].
    """

    name: str
    data_set: str
    first: float
    other: float
    largest: float
    where: float

    @property
    def at_design(self) -> float:
        """The difference at the design position."""
        return self.other - self.first


def differences(dataset: xr.Dataset, at: float = 0.0) -> list[Difference]:
    """Return the differences of all suspensions of a comparison from the first one.

    Parameters
    ----------
    dataset : xarray.Dataset
        Result of `compare`; of axles each wheel has differences of its own.
    at : float, optional
        The position at which `Difference.first` and `Difference.other` are taken [m] or [rad]; by
        default that of design.

    Returns
    -------
    list of Difference
        In the order of the characteristics, then of the suspensions.

    Examples
    --------
    >>> import xarray as xr
    >>> from kintrafo import compare
    >>> angles = (("data_set", "wheel_travel"), [[0.0, 1.0], [0.5, 3.0]])
    >>> places = {"data_set": ["a", "b"], "wheel_travel": [0.0, 0.1]}
    >>> [found] = compare.differences(xr.Dataset({"camber": angles}, places))
    >>> found.at_design, found.largest, found.where
    (0.5, 2.0, 0.1)
    """
    with Validator("differences") as given:
        given.dataset(dataset, over=DATA_SET)
    curves = {str(n): data for n, data in flat(dataset).items() if DATA_SET in data.dims}
    return [
        _difference(name, data, label, at)
        for name, data in curves.items()
        for label in map(str, dataset[DATA_SET].values[1:])
    ]


def _difference(name: str, data: xr.DataArray, label: str, at: float) -> Difference:
    along = next(d for d in data.dims if d != DATA_SET)
    positions = np.asarray(data[along].values, dtype=np.float64)
    first = np.asarray(data.isel({DATA_SET: 0}).values, dtype=np.float64)
    other = np.asarray(data.sel({DATA_SET: label}).values, dtype=np.float64)
    both = np.isfinite(first) & np.isfinite(other)
    change = np.subtract(other, first, out=np.full(first.shape, np.nan), where=both)
    defined = both if both.any() else np.isfinite(first) | np.isfinite(other)
    design = int(np.argmin(np.where(defined, np.abs(positions - at), np.inf)))
    worst = int(np.nanargmax(np.abs(change))) if both.any() else design
    if not abs(positions[design] - at) <= _AT_DESIGN:
        first, other = np.full((2, positions.size), np.nan)
    numbers = (first[design], other[design], change[worst], positions[worst])
    return Difference(name, label, *map(float, numbers))
