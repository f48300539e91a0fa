"""Load cases: loads on the wheels, from a file or an argument."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ....core.named_types import Array
from ....core.suggestions import suggestion
from ....core.validator import Validator
from ...assembly.assembly import HeldAssembly
from ...assembly.of import given_assembly
from ...input.toml_file import read_sections
from ...models.axle.file import TorqueReaction
from ...models.sides import LEFT, RIGHT, SIDES

_RACK = "rack_mm"
_SECTIONS = ("static_load_N", "cases")
_KEYS = (
    _RACK,
    "travel_mm",
    *(f"{place}_{unit}" for place in ("contact", "center") for unit in ("N", "g", "Nm")),
)
# The largest load, in N, N m or parts of the static load.
GREATEST = 1e9


@dataclass(frozen=True)
class Case:
    """Loads on a wheel at rest.

    Forces and moments are in the axes of the tyre (ISO 8855): x forward in the plane of the wheel,
    y left, z up, x and y horizontal.
    """

    name: str
    # at the lowest point of the wheel, whose brake holds it, (3,) [N], [N m]
    contact: Array = field(default_factory=lambda: np.zeros(3))
    contact_moment: Array = field(default_factory=lambda: np.zeros(3))
    # at the wheel centre, such as the traction of a wheel with a drive shaft, (3,) [N], [N m]
    center: Array = field(default_factory=lambda: np.zeros(3))
    center_moment: Array = field(default_factory=lambda: np.zeros(3))
    rack: float = 0.0  # displacement of the rack [m]
    # wheel travel [m], with the vertical force at the contact that holds it there. None: the
    # suspension is in equilibrium under the loads.
    travel: float | None = None

    @property
    def vector(self) -> Array:
        """Forces and moments at the contact, and those at the wheel centre, (12,)."""
        return np.concatenate([self.contact, self.contact_moment, self.center, self.center_moment])


def read(path: str | Path) -> dict[str, Any]:
    """Return the load cases of a TOML file.

    Parameters
    ----------
    path : str or pathlib.Path

    Returns
    -------
    dict
        ``cases``, as for `static`, and ``static_load_N`` if the file has it.

    Raises
    ------
    InputError
        If it cannot be read, or has other keys.
    """
    return read_sections(path, _SECTIONS, needed="cases.NAME")


def cases_of(
    given: Validator,
    assembly: HeldAssembly,
    described: Mapping[str, Any],
    static_loads: Sequence[float],
) -> list[tuple[Case, ...]]:
    """Return load cases, each with a `Case` for every wheel.

    Cases are described by name, each with keys of `docs/suspension/loads.md` for every wheel; one
    of several wheels may have further ones under its name. Static loads are the unit of keys that
    end in ``_g`` [N].
    """
    if not described:
        given.fail("cases: one or more are needed.")
    several = len(assembly.wheels) > 1
    if several:
        for name, table in described.items():
            if any(_RACK in one for one in tables_of({name: table})):
                assembly.refuse_unsteered(given, f"[cases.{name}] {_RACK}")
    found = []
    for wheel, static_load in zip(assembly.wheels, static_loads, strict=True):
        own = described
        if several:
            own = {
                name: _of_wheel(given, name, table, wheel, racks=assembly.steered)
                for name, table in described.items()
            }
        # an error of one wheel may be that of all
        if not given.failed:
            found.append(_cases_of_wheel(given, own, static_load, wheel if several else ""))
    return list(zip(*found, strict=True)) if not given.failed else []


def tables_of(described: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Return all tables in load cases: of all wheels, and of one."""
    every = [*described.values()]
    every += [t.get(side) for t in described.values() if isinstance(t, Mapping) for side in SIDES]
    return [table for table in every if isinstance(table, Mapping)]


def in_parts_of_it(described: Mapping[str, Any]) -> bool:
    """Return whether forces are given in parts of the static load."""
    keys = (str(key) for table in tables_of(described) for key in table)
    return any(key.endswith("_g") for key in keys)


def _of_wheel(given: Validator, name: str, table: Any, wheel: str, *, racks: bool) -> Any:
    """Return the keys of one of several wheels in a case; values that are not tables unchanged."""
    if not isinstance(table, Mapping):
        return table
    both = {key: value for key, value in table.items() if key not in SIDES}
    own = table.get(wheel, {})
    if not isinstance(own, Mapping):
        given.fail(f"[cases.{name}] {wheel} must be a section, as [cases.{name}.{wheel}].")
        return both
    if racks and _RACK in own:
        given.fail(
            f"[cases.{name}.{wheel}] {_RACK}: both sides have one rack. "
            f"Give it to [cases.{name}] itself."
        )
    for key in (key for key in own if key not in _KEYS):
        given.fail(f"[cases.{name}.{wheel}] {key} is not known. {suggestion(str(key), _KEYS)}")
    for key in (key for key in own if key in both):
        given.fail(
            f"[cases.{name}] {key} is that of both wheels, and [cases.{name}.{wheel}] has it, too. "
            "Give it to both, or to left and right."
        )
    return both | dict(own)


def _cases_of_wheel(
    given: Validator, described: Mapping[str, Any], static_load: float, of: str
) -> list[Case]:
    cases = []
    for name, table in described.items():
        title = f"[cases.{name}]{of and ' '}{of}"
        if not (isinstance(name, str) and re.fullmatch(r"[\w.-]+", name)):
            given.fail(f"{title}: a name is a text of letters, digits, and _ - . only.")
        if not isinstance(table, Mapping):
            given.fail(f"{title} must be a section, with {', '.join(_KEYS)}.")
            continue
        known = (*_KEYS, *SIDES) if of else _KEYS
        for key in (key for key in table if key not in _KEYS):
            given.fail(f"[cases.{name}] {key} is not known. {suggestion(str(key), known)}")
        travel = _number(given, title, table, "travel_mm")
        found = {
            place: _vector(given, title, table, f"{place}_N")
            + static_load * _vector(given, title, table, f"{place}_g")
            for place in ("contact", "center")
        }
        if travel is not None and found["contact"][2] != 0.0:
            given.fail(
                f"{title}: travel_mm holds the suspension by the vertical force at the contact, "
                "which cannot be given besides. Leave one of them out (a third number of 0)."
            )
        if found["contact"][2] < 0.0:
            given.fail(
                f"{title}: the vertical force at the contact is {found['contact'][2]:.4g} N, and a "
                "road only pushes: 0 N or more is needed. What pulls belongs to center_N."
            )
        cases.append(
            Case(
                name,
                contact=found["contact"],
                contact_moment=_vector(given, title, table, "contact_Nm"),
                center=found["center"],
                center_moment=_vector(given, title, table, "center_Nm"),
                rack=(_number(given, title, table, "rack_mm") or 0.0) / 1e3,
                travel=None if travel is None else travel / 1e3,
            )
        )
    return cases


def standard_cases(subject: Any) -> dict[str, dict[str, Any]]:
    """Return the standard load cases, as fractions of the static load of each wheel.

    Lateral forces push the wheel of a corner inward. In cases that differ between the wheels of an
    axle the right one has the greater load. Forces along x act at the contact if the brake or the
    drive is on the carrier or the axle, and at the wheel centre if it is on the body. An axle
    without ``drive`` in its file has no case ``drive``.

    Parameters
    ----------
    subject : Suspension, Model, Axle, AxleModel, RigidAxle or RigidAxleModel

    Returns
    -------
    dict
        By the names of the cases, each as for `static`.

    Examples
    --------
    >>> from kintrafo import Axle, loads
    >>> loads.standard_cases(Axle.load("reference_axle"))["corner"]["right"]
    {'contact_g': [0.0, 1.2, 1.5]}
    """
    with Validator("standard_cases") as given:
        assembly = given_assembly(given, subject)
    several = len(assembly.wheels) > 1
    usual = _OF_AXLES if several else _of_corner(-1.0 if assembly.wheels[0] == LEFT else 1.0)
    held = {name: assembly.torque_on("drive" if name == "drive" else "brakes") for name in usual}
    return {name: _with_torque_on(usual[name], of) for name, of in held.items() if of is not None}


def _of_corner(inward: float) -> dict[str, dict[str, Any]]:
    return _EVEN | {
        "corner": {"contact_g": [0.0, 1.2 * inward, 1.5]},
        "trail_brake": {"contact_g": [-0.9, 0.9 * inward, 1.5]},
        "kerb": {"contact_g": [0.0, 1.5 * inward, 2.0]},
        "pothole": {"contact_g": [-1.5, 0.0, 3.0]},
    }


def _uneven(left: list[float], right: list[float]) -> dict[str, Any]:
    return {LEFT: {"contact_g": left}, RIGHT: {"contact_g": right}}


_EVEN = {
    "static": {"contact_g": [0.0, 0.0, 1.0]},
    "brake": {"contact_g": [-1.3, 0.0, 1.3]},
    "reverse": {"contact_g": [0.8, 0.0, 0.9]},
    "drive": {"contact_g": [0.5, 0.0, 0.9]},
}
_OF_AXLES = _EVEN | {
    "corner": _uneven([0.0, 0.4, 0.5], [0.0, 1.2, 1.5]),
    "trail_brake": _uneven([-0.5, 0.4, 0.7], [-0.9, 0.9, 1.5]),
    "kerb": _uneven([0.0, 0.0, 1.0], [0.0, 1.5, 2.0]),
    "bump": _uneven([0.0, 0.0, 1.0], [0.0, 0.0, 2.5]),
    "pothole": _uneven([0.0, 0.0, 1.0], [-1.5, 0.0, 3.0]),
}


def _with_torque_on(case: Mapping[str, Any], held: TorqueReaction) -> dict[str, Any]:
    """Return a case with its forces along x at the wheel centre if the torque is on the body."""
    if "contact_g" not in case:
        return {side: _with_torque_on(own, held) for side, own in case.items()}
    x, y, z = case["contact_g"]
    if held == "carrier" or x == 0.0:
        return {"contact_g": [x, y, z]}
    return {"contact_g": [0.0, y, z], "center_g": [x, 0.0, 0.0]}


def _number(given: Validator, title: str, table: Mapping[str, Any], key: str) -> float | None:
    if key not in table:
        return None
    unit = key.rpartition("_")[2]
    return given.number(f"{title} {key}", table[key], unit, least=-GREATEST, below=GREATEST)


def _vector(given: Validator, title: str, table: Mapping[str, Any], key: str) -> Array:
    """Return three numbers, zeros for a missing key."""
    if key not in table:
        return np.zeros(3)
    values = given.array(f"{title} {key}", table[key], key.rpartition("_")[2], dimensions=[1])
    if values.shape == (3,) and (np.abs(values) < GREATEST).all():
        return values
    given.fail(f"{title} {key}: three numbers are needed, x, y and z, each below {GREATEST:g}.")
    return np.zeros(3)
