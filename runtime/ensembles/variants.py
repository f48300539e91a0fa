"""Variants of a system: its own parameters, elements of the initial state, inputs and labels."""

import math
from collections.abc import Hashable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ..core.named_types import Array
from ..core.physical import impossible
from ..core.suggestions import suggestion
from ..core.validator import Validator, shown
from ..systems.inputs import derived_inputs
from ..systems.system import System
from .room import Room

CAR = "car"
"""Dimension of variants that are given as rows of numbers."""

TIME, STATE, BOUND, FREQUENCY = "time", "state_element", "bound", "frequency"
"""Dimensions of the results of each system."""

RESULTS = ("success", "valid", "reason", "end_time", "steps", "solver", "final_state", "beyond")
"""The variables that every result has."""

# Ends of the names of parameters that describe the mass of a body.
_OF_MASS = ("_mass", "_com_x", "_com_y", "_com_z", "_inertia_")


@dataclass(frozen=True)
class Variants:
    """The values that differ between systems."""

    # dimensions and their lengths; the systems are all combinations, the last dimension fastest
    shape: dict[Hashable, int]
    # coordinates of the given dataset
    coordinates: dict[Hashable, Any] = field(default_factory=dict)
    # by name, each of shape (count,)
    parameters: dict[str, Array] = field(default_factory=dict)
    states: dict[str, Array] = field(default_factory=dict)
    inputs: dict[str, Array] = field(default_factory=dict)
    # by input: the label of its time series for each system
    labels: dict[str, NDArray[Any]] = field(default_factory=dict)

    @property
    def count(self) -> int:
        """Number of systems."""
        return int(np.prod(list(self.shape.values()), dtype=np.int64))


def variants_of(
    model: System, given: Any, profiles: Mapping[str, Any], rows: int | None, room: Room
) -> Variants:
    """Return the values that differ between systems.

    `profiles` are inputs over time: one series for all systems, or several by label. `rows` is the
    number of initial states, None if there is one for all; `room` the memory of the results.
    """
    choices = {name: several for name, several in profiles.items() if isinstance(several, Mapping)}
    with Validator("ensemble") as arguments:
        for name, several in choices.items():
            arguments.labels(f"inputs {name!r}", several)
        columns = _columns(arguments, model, given, choices)
        if not arguments.failed:
            _check_names(arguments, model, columns, profiles)
            _check_units(arguments, model, columns, choices)
            _check_coordinates(arguments, model, given, columns)
        if not arguments.failed:
            columns, shape = _broadcast(arguments, columns, rows)
            room.refuse_beyond(arguments, math.prod(shape.values()), len(columns))
        if not arguments.failed:
            coordinates = _coordinates(arguments, model, given, columns)
        if arguments.failed:
            return Variants({})
        found = Variants(shape, coordinates)
        homes = (
            (model.equations.PARAMETERS, found.parameters),
            (model.state_names, found.states),
            (choices, found.labels),
            (model.input_names, found.inputs),
        )
        for name, column in columns.items():
            home = next(home for names, home in homes if name in names)
            home[name] = _checked(arguments, name, column, choices.get(name))
    return found


def impossible_sets(model: System, variants: Variants) -> NDArray[np.bool_]:
    """Return which systems have parameters out of range, by the rules of `equations.prepare`."""
    values = {**model.parameters, **variants.parameters}
    return impossible(values, model.equations.PARAMETERS, variants.count)


def numbered(labels: NDArray[Any]) -> tuple[list[Any], NDArray[np.int64]]:
    """Return the distinct labels, of any types, and the index of each label among them."""
    listed = labels.tolist()
    places = {label: place for place, label in enumerate(dict.fromkeys(listed))}
    return list(places), np.array([places[label] for label in listed], dtype=np.int64)


# -- reading --------------------------------------------------------------------------------------


def _columns(
    arguments: Validator, model: System, given: Any, choices: Mapping[str, Any]
) -> dict[str, xr.DataArray]:
    """Return the given variants as labelled arrays by name."""
    if given is None:
        return {}
    if isinstance(given, xr.Dataset):
        # coordinates with the name of a variable vary it; others only label the systems
        known = _described(model)
        names = [*given.data_vars, *(name for name in given.coords if name in known)]
        return {str(name): given[name].reset_coords(drop=True) for name in names}
    found = {}
    for name, values in arguments.mapping("variants", given, "names, values").items():
        arguments.text("name in variants", name)
        if isinstance(values, xr.DataArray):
            found[str(name)] = values.reset_coords(drop=True)
            continue
        array = _row(values, exact=name in choices)
        if array is None:
            arguments.fail(
                f"variants {shown(name)} = {shown(values)}: one number, or a row of one for each "
                "system, is needed. For several dimensions, give an xarray.DataArray."
            )
        else:
            found[str(name)] = xr.DataArray(array, dims=(CAR,) * array.ndim)
    return found


def _described(model: System) -> dict[str, Any]:
    """Return the descriptions of everything that can vary, from the manifest."""
    equations = model.equations
    return {**equations.PARAMETERS, **equations.STATE, **equations.INPUTS}


def _row(values: Any, *, exact: bool) -> NDArray[Any] | None:
    """Return one value or a row of values as an array; None for anything else.

    With `exact` they are labels and stay as they are: an array of texts has "1" instead of 1.
    """
    if np.ma.is_masked(values):
        return None
    try:
        array = np.asarray(values)
        given = np.asarray(values, dtype=object)
        if exact and array.tolist() != given.tolist():
            array = given
    except (TypeError, ValueError, OverflowError):
        return None
    labels = str | float | int | np.generic
    plain = array.dtype != object or all(isinstance(v, labels) for v in array.flat)
    return array if array.ndim < 2 and plain else None


def _check_names(
    arguments: Validator, model: System, columns: Mapping[str, Any], profiles: Mapping[str, Any]
) -> None:
    derived = derived_inputs(model.equations.INPUTS)
    known = [name for name in _described(model) if name not in derived]
    for name in columns:
        if name in derived:
            arguments.fail(f"variants {name!r} follows from {derived[name]!r}: vary that.")
        elif name not in known:
            arguments.fail(f"variants {name!r} is not known. {suggestion(name, known)}")
        elif body := without_mass(model, name):
            arguments.fail(
                f"variants {name!r} has no effect: the {body} has no mass in the equations of "
                f"{model.equations.NAME}."
            )
    for name, profile in profiles.items():
        if name in columns and not isinstance(profile, Mapping):
            arguments.fail(f"{name!r} is in both inputs and variants: give one of them.")
        elif isinstance(profile, Mapping) and name not in columns:
            arguments.fail(
                f"inputs {name!r} has several time series: variants needs {name!r}, the label of "
                "one of them for each system."
            )


def _check_units(
    arguments: Validator,
    model: System,
    columns: Mapping[str, xr.DataArray],
    choices: Mapping[str, Any],
) -> None:
    """Refuse numbers with an attribute of another unit; labels have none."""
    described = _described(model)
    for name, column in columns.items():
        text, unit = column.attrs.get("units"), described[name]["unit"]
        if text is not None and text != unit and name not in choices:
            arguments.fail(f"variants {name!r} are in {shown(text)}: they are needed in {unit!r}.")


def _check_coordinates(
    arguments: Validator, model: System, given: Any, columns: Mapping[str, xr.DataArray]
) -> None:
    """Refuse dimensions and coordinates with the name of a result."""
    arrays = [given] if isinstance(given, xr.Dataset) else [*(given or {}).values()]
    labelled = [a for a in arrays if isinstance(a, xr.Dataset | xr.DataArray)]
    taken = {TIME, STATE, BOUND, FREQUENCY, *RESULTS, *model.signal_names}
    if isinstance(given, xr.Dataset):
        _check_dimensions(arguments, model, given, columns)
    for name in {str(n) for a in labelled for n in (*a.dims, *a.coords)} & taken:
        arguments.fail(
            f"variants have a dimension or coordinate {name!r}, a name of the results. Rename it."
        )


def _check_dimensions(
    arguments: Validator, model: System, given: xr.Dataset, columns: Mapping[str, xr.DataArray]
) -> None:
    """Refuse dimensions that no variable has: the name is probably misspelt."""
    over = {dimension for column in columns.values() for dimension in column.dims}
    for dimension in given.dims:
        if dimension not in over:
            arguments.fail(
                f"variants: no value has the dimension {dimension!r}. "
                f"{suggestion(str(dimension), _described(model))}"
            )


def without_mass(model: System, name: str) -> str:
    """Return the body whose mass a parameter describes, if the equations leave it out; or ""."""
    equations = model.equations
    out = [body for body in equations.BODIES if body not in equations.MASSIVE_BODIES]
    return next((b for b in out if name.startswith(tuple(f"{b}{end}" for end in _OF_MASS))), "")


def _broadcast(
    arguments: Validator, columns: dict[str, xr.DataArray], rows: int | None
) -> tuple[dict[str, xr.DataArray], dict[Hashable, int]]:
    """Return the columns over all dimensions, and these with their lengths."""
    start = {} if rows is None else {"": xr.DataArray(np.zeros(rows), dims=CAR)}
    try:
        # labels in another order would assign initial states to other systems
        alike = xr.align(*start.values(), *columns.values(), join="exact")
        together = xr.broadcast(*alike)
    except ValueError:
        what = "variants" if rows is None else "variants and the rows of y0"
        sizes = {name: dict(column.sizes) for name, column in columns.items()}
        sizes |= {} if rows is None else {"y0": {CAR: rows}}
        arguments.fail(
            f"{what} do not match: rows of equal length, and the same labels in the "
            f"same order, are needed. Sizes are {sizes}."
        )
        return {}, {}
    shape = dict(together[0].sizes) if together else {}
    if rows is not None and shape != {CAR: rows}:
        arguments.fail(
            f"y0 has {rows} rows, and variants have the dimensions {', '.join(map(str, shape))}: "
            "vary elements of the state by name in variants."
        )
    wide = dict(zip(columns, together[len(start) :], strict=True))
    return wide, shape or {CAR: 1}


def _coordinates(
    arguments: Validator, model: System, given: Any, columns: Mapping[str, xr.DataArray]
) -> dict[Hashable, Any]:
    """Return the given labels of systems; refuse contradictory and misleading ones."""
    arrays = [given] if isinstance(given, xr.Dataset) else [*(given or {}).values()]
    labelled = [array for array in arrays if isinstance(array, xr.Dataset | xr.DataArray)]
    found: dict[Hashable, Any] = {}
    for name, labels in (item for array in labelled for item in array.coords.items()):
        if labels.dims and not found.setdefault(name, labels.variable).equals(labels.variable):
            arguments.fail(
                f"variants: coordinates {name!r} differ between variants. Make them equal."
            )
    for name, values in found.items():
        if name not in _described(model):
            continue
        column = columns.get(str(name))
        if column is None or not np.all(column.variable == values):
            arguments.fail(
                f"variants have a coordinate {name!r} that does not have the values of {name!r}: "
                "coordinates of a dict are only labels. Give an xarray.Dataset, or rename the "
                "coordinate."
            )
    return found


def _checked(
    arguments: Validator, name: str, column: xr.DataArray, choices: Mapping[Any, Any] | None
) -> NDArray[Any]:
    """Return one value for each system."""
    values = column.values.flatten()
    if not values.size:
        arguments.fail(f"variants {name!r} is empty: one system or more is needed.")
    if choices is None:
        return arguments.array(f"variants {name!r}", values, dimensions=[1])
    strange = [label for label in numbered(values)[0] if label not in choices]
    if strange:
        arguments.fail(
            f"variants {name!r} has the label {shown(strange[0])}; its time series are "
            f"{', '.join(map(shown, choices))}."
        )
    return values
