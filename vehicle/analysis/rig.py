"""Curves measured on a rig, and characteristics at the same positions."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ...core.errors import InputError
from ...core.named_types import Array
from ...core.suggestions import nearest
from ...core.tables import Column, Table, read_table
from ...core.validator import Validator
from ..assembly.assembly import Assembly
from ..assembly.by_wheel import flat
from ..assembly.of import given_assemblies
from ..assembly.quantity import (
    HEAVE,
    LATERAL_ACCELERATION,
    PITCH,
    RACK,
    ROLL,
    STEERING_WHEEL,
    TRAVEL,
    Quantity,
)
from ..models.car.car import WHEELS
from .characteristics.datasets import ALONG, DATA_SET, KNOWN, OF_AXLES, OF_CARS, dataset
from .compare import side_by_side, with_compliance
from .compliance.flexibility import HELD, WheelSupport
from .compliance.linear import COMPLIANCES, COMPLIANCES_OF_AXLES
from .handling.circle import columns_of_turns

_OF_BODY = (HEAVE, PITCH, LATERAL_ACCELERATION)
_ALONG = {
    quantity.name: quantity for quantity in (*ALONG.values(), ROLL, STEERING_WHEEL, *_OF_BODY)
}
_SOFT = COMPLIANCES_OF_AXLES | COMPLIANCES
_KNOWN: dict[str, dict[str, Quantity]] = {name: dict(known) for name, known in OF_AXLES.items()}
for _over, _known in KNOWN.items():
    _KNOWN[ALONG[_over].name] |= _known
_KNOWN[TRAVEL.name] |= _SOFT
# quantities of a car with a wheel or an axle in their names: others are of suspensions and axles
_OF_ENDS = {name: q for name, q in OF_CARS.items() if {"front", "rear"} & {*name.split("_")}}
_KNOWN[ROLL.name] |= _OF_ENDS
_KNOWN |= {HEAVE.name: dict(_OF_ENDS), PITCH.name: dict(_OF_ENDS)}
_KNOWN[LATERAL_ACCELERATION.name] = columns_of_turns(WHEELS)
_EVERY = {
    name: quantity
    for known in _KNOWN.values()
    for name, quantity in known.items()
    if name not in _ALONG
}
# A held position varies by less than this [m], and by less than this part of the one that varies.
_NOISE, _PART_OF_NOISE = 1e-4, 1e-2


def measured_curves(path: str | Path) -> xr.Dataset:
    """Return measured curves of a suspension, an axle or a car from a CSV file.

    The first line has the names of the columns, each with its unit: ``wheel_travel [mm]`` or
    ``rack_position [mm]``, and characteristics, such as ``toe [deg]`` or ``wheel_rate [N/mm]``, by
    their names in kintrafo; over wheel travel also compliance, ``toe_by_lateral [deg/kN]``. For an
    axle they are over ``wheel_travel`` of both wheels, ``roll_angle [deg]``, ``rack_position`` or
    ``steering_wheel_angle [deg]``, and names of characteristics of a wheel end in ``_left`` or
    ``_right``, ``toe_left [deg]``. For a car they are over ``body_heave``, ``body_pitch`` or
    ``roll_angle``, or over the ``lateral_acceleration [m/s^2]`` of steady turns, such as
    ``steering_wheel_angle [deg]``. Other columns are left out. `kintrafo.core.tables` describes the
    spellings of names and units, such as ``Wheel Travel (mm)``; units may be in a separate row or
    comment. Rows may be in any order, and positions may repeat, as in a loop with friction. A cell
    may be empty. If there are columns of two positions, one of them must be constant to 0.1 mm; the
    suspension is then held at the mean of this column.

    Parameters
    ----------
    path : str or pathlib.Path

    Returns
    -------
    xarray.Dataset
        Over the positions, such as ``wheel_travel`` [m]; SI units. The attribute ``left_out`` has
        the names of columns that were not read.

    Raises
    ------
    InputError
        If the file cannot be used.
    """
    with Validator("measured_curves") as given:
        given.path("path", path)
    sheet = read_table(path)
    columns = sheet.columns([*_ALONG, *_EVERY])
    units = {column.name: _quantity(column.name).units for column in columns}
    _check(sheet, columns, units)
    curves = {name: _EVERY[name] for name in units if name in _EVERY}
    moved = _moved(units)
    curves |= moved
    places = [
        column.name for column in columns if column.name in _ALONG and column.name not in moved
    ]
    may_be_empty = [column.at for column in columns if column.name in curves]
    table = sheet.values_of(columns, units, may_be_empty)
    varying, held = _separated(sheet, {name: table[name] for name in places})
    along = _ALONG[varying]
    data = {
        quantity.name: xr.Variable(varying, table[quantity.name], quantity.attributes())
        for quantity in curves.values()
        if quantity.name in _KNOWN[varying]
    }
    if not data:
        names = [quantity.name for quantity in curves.values()]
        others = [over for over, known in _KNOWN.items() if {*names} & {*known}]
        problem = f"{', '.join(names)}: computed over {' and '.join(others)} only."
        raise InputError([problem], sheet.source)
    coordinates = {varying: xr.Variable(varying, table[varying], along.attributes())}
    coordinates |= {name: xr.Variable((), at, _ALONG[name].attributes()) for name, at in held}
    read = [column for column in columns if column.name in (*places, *data)]
    left = ", ".join(heading.text for heading in sheet.without(read))
    return xr.Dataset(data, coordinates, {"title": "measured curves", "left_out": left})


def _moved(names: Mapping[str, Any]) -> dict[str, Quantity]:
    """Return the quantities that vary along other curves but are curves in this table."""
    if LATERAL_ACCELERATION.name in names:  # in steady turns the steering wheel angle is a curve
        turns = _KNOWN[LATERAL_ACCELERATION.name]
        return {name: turns[name] for name in names if name in turns}
    # over the angle of the steering wheel the displacement of the rack is a curve
    return {RACK.name: RACK} if {STEERING_WHEEL.name, RACK.name} <= names.keys() else {}


def _quantity(name: str) -> Quantity:
    return _ALONG[name] if name in _ALONG else _EVERY[name]


def _separated(sheet: Table, places: Mapping[str, Array]) -> tuple[str, list[tuple[str, float]]]:
    """Return the name of the position that varies, and the others with their mean [m] or [rad]."""
    spread = {name: float(np.ptp(values)) for name, values in places.items()}
    least = min(_NOISE, _PART_OF_NOISE * max(spread.values()))
    varying = [name for name in places if spread[name] > least]
    if len(varying) != 1:
        problem = (
            f"exactly one of the positions must vary along the curves; of {' and '.join(places)} "
            f"{len(varying)} vary."
        )
        raise InputError([problem], sheet.source)
    held = [(name, float(v.mean())) for name, v in places.items() if name not in varying]
    return varying[0], held


def beside(
    measured: xr.Dataset,
    subjects: Mapping[str, Any],
    name: str = "measured",
    *,
    held: WheelSupport = "height",
) -> xr.Dataset:
    """Return measured curves together with computed characteristics at the same positions.

    Parameters
    ----------
    measured : xarray.Dataset
        Result of `measured_curves`.
    subjects : mapping of str to Suspension, Model, Axle, AxleModel, RigidAxle or RigidAxleModel
        By the names of their curves.
    name : str, optional
        Name of the measurement in ``data_set``.
    held : {'height', 'tyre', 'spring', 'locked'}, optional
        Support of the wheels when compliance was measured, see `kintrafo.compliance.linear`.

    Returns
    -------
    xarray.Dataset
        The measured curves, by the names of their columns, over ``data_set``: the measurement, then
        the `subjects`; for `kintrafo.compare.differences`.

    Raises
    ------
    InputError
        If an argument cannot be used.
    PositionError
        If a suspension does not reach a position.
    """
    with Validator("beside") as given:
        given.dataset(measured)
        assemblies = given_assemblies(given, "subjects", subjects)
        given.text("name", name)
        given.among("held", held, HELD)
        if not given.failed and name in assemblies:
            given.fail(f"name = {name!r} is that of a subject, too. Choose another one.")
        if not (assemblies or given.failed):
            given.fail("subjects is empty: one or more are needed.")
        if not given.failed and len({*measured.dims} & {*_ALONG}) != 1:
            given.fail("measured: a result of kintrafo.rig.measured_curves is needed.")
        if not given.failed:
            for label, assembly in assemblies.items():
                _refuse_other_motions(given, label, assembly, measured)
    found = [measured]
    for label, assembly in assemblies.items():
        whole = flat(_curves(assembly, measured, held))
        computed = [n for n in map(str, measured) if n in whole]
        if not computed:
            curves = ", ".join(map(str, measured))
            problem = f"measured: {label} has no characteristic of the measured ones: {curves}."
            raise InputError([problem], "beside")
        found.append(whole[computed])
    attributes = {"long_name": "data set", "measured": 1}  # the first one is measured
    return side_by_side(found, xr.Variable(DATA_SET, [name, *assemblies], attributes))


def motion_of(assembly: Assembly, measured: xr.Dataset) -> str | None:
    """Return the first motion of an assembly over the position of measured curves, or None."""
    motions = assembly.motions.items()
    return next((name for name, how in motions if how.along.name in measured.dims), None)


def _refuse_other_motions(
    given: Validator, name: str, assembly: Assembly, measured: xr.Dataset
) -> None:
    """Raise an error for curves over a position that no motion of the assembly has."""
    if motion_of(assembly, measured) is None:
        (along,) = {*measured.dims} & {*_ALONG}
        known = ", ".join(dict.fromkeys(how.along.name for how in assembly.motions.values()))
        given.fail(f"measured: curves over {along}, which {name} does not have; there is {known}.")


def _curves(assembly: Assembly, measured: xr.Dataset, held_by: WheelSupport) -> xr.Dataset:
    """Return the characteristics at the positions of a measurement."""

    def held(quantity: Quantity) -> float:
        return float(measured[quantity.name]) if quantity.name in measured.coords else 0.0

    motion = motion_of(assembly, measured)
    assert motion is not None  # checked by `beside`
    along = assembly.motions[motion].along
    travel = 0.0 if along is TRAVEL else held(TRAVEL)
    rack = 0.0 if along.name == RACK.name or not assembly.steered else held(RACK)
    values = measured[along.name].values
    found = dataset(assembly, motion, values, travel=travel, rack=rack)
    if along is TRAVEL and assembly.has_bushes and {*map(str, measured)} & {*_SOFT}:
        return with_compliance(found, assembly, values, held_by, rack)
    return found


def _check(sheet: Table, columns: Sequence[Column], units: Mapping[str, str]) -> None:
    names = [column.name for column in columns]
    problems = sheet.problems_of(columns, units)
    if {*names}.isdisjoint(_ALONG):
        problems.append(
            f"one column {TRAVEL.name} [mm] or {RACK.name} [mm] is needed; the first line has "
            f"{sheet.names}."
        )
    of_turns = _moved(units) if LATERAL_ACCELERATION.name in names else {}
    if {*names}.isdisjoint(_EVERY) and not of_turns and not problems:
        likely = (nearest(heading.label, _EVERY) for heading in sheet.without(columns))
        hints = [f"Did you mean {name}?" for name in likely if name]
        problems.append(
            " ".join([f"no characteristic is among the columns {sheet.names}.", *hints[:1]])
        )
    if problems:
        raise InputError(problems, sheet.source)
