"""Measurements of a tyre: states and forces from a table or from arrays."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.errors import InputError
from ...core.named_types import Array
from ...core.tables import read_table
from ...core.validator import Validator

if TYPE_CHECKING:
    from pathlib import Path

STATES: Mapping[str, str] = {
    "load": "N", "slip_angle": "rad", "slip": "1", "camber": "rad", "speed": "m/s",
    "pressure": "Pa",
}  # fmt: skip
"""SI units of the states, which are arguments of `Tyre.evaluate`."""
FORCES: Mapping[str, str] = {"fx": "N", "fy": "N", "mx": "N m", "my": "N m", "mz": "N m"}
"""SI units of the measured forces, which are attributes of `TyreState`."""
_ALL = {**STATES, **FORCES}


@dataclass(frozen=True)
class Measured:
    """Rows of a measurement."""

    # the measured ones of `STATES` and `FORCES`, in SI units and the axes of ISO 8855, (n,)
    states: dict[str, Array]
    forces: dict[str, Array]
    source: str
    left_out: tuple[str, ...] = ()  # columns that were not read

    @property
    def count(self) -> int:
        """Number of rows."""
        return len(self.states["load"])


def measured(data: "str | Path | Mapping[str, Any]") -> Measured:
    """Return a measurement with the load, other states, and at least one force.

    It is a CSV file whose columns are named with their units, such as ``load_N``,
    ``slip_angle_deg``, ``slip``, ``camber_deg``, ``fy_N``, ``mz_Nm``; or arrays by name, in SI
    units. Raises `InputError` if it cannot be read, or has no load or no force.
    """
    if isinstance(data, Mapping):
        return _checked(_of_arrays(data), "fit", ())
    with Validator("fit") as given:
        given.path("data", data)
    sheet = read_table(data)
    columns = sheet.columns(_ALL)
    if problems := sheet.problems_of(columns, _ALL):
        raise InputError(problems, sheet.source)
    others = tuple(heading.text for heading in sheet.without(columns))
    return _checked(sheet.values_of(columns, _ALL), sheet.source, others)


def _of_arrays(data: Mapping[str, Any]) -> dict[str, Array]:
    with Validator("fit") as given:
        for name in data:
            given.among("data", name, _ALL)
        values = {
            k: given.array(k, v, _ALL[k], dimensions=(1,)) for k, v in data.items() if k in _ALL
        }
        lengths = {len(value) for value in values.values()}
        if len(lengths) > 1 and not given.failed:
            given.fail(f"data: columns have {sorted(lengths)} rows; equal numbers are needed.")
    return values


def _checked(values: dict[str, Array], source: str, left_out: tuple[str, ...]) -> Measured:
    states = {name: values[name] for name in STATES if name in values}
    forces = {name: values[name] for name in FORCES if name in values}
    problems = []
    if "load" not in states:
        problems.append("the load is missing: a column load_N, positive upward on the tyre.")
    elif np.any(states["load"] <= 0.0):
        problems.append(
            f"load = {states['load'].min():g} N: more than zero is needed (upward on the tyre)."
        )
    if not forces:
        problems.append(f"no force is there: a column of {', '.join(FORCES)} is needed.")
    if problems:
        raise InputError(problems, source)
    return Measured(states, forces, source, left_out)
