"""Load cases: what acts on the wheel, as a file or a caller gives them."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.arguments import Arguments
from ...core.suggestions import suggestion
from ...suspension.input.toml_file import read_sections

Array = NDArray[np.float64]

_SECTIONS = ("static_load_N", "cases")
_KEYS = (
    "rack_mm",
    "travel_mm",
    *(f"{place}_{unit}" for place in ("contact", "center") for unit in ("N", "g", "Nm")),
)
# No suspension carries more than this, in N, N m or parts of its static load.
GREATEST = 1e9


@dataclass(frozen=True)
class Case:
    """What acts on a wheel at rest.

    Forces and moments have the axes of the tyre (ISO 8855): x forward in the plane of the wheel, y
    left, z up, x and y horizontal.

    Attributes
    ----------
    name : str
    contact, contact_moment : ndarray, shape (3,)
        At the lowest point of the wheel [N], [N m]. The brake holds the wheel.
    center, center_moment : ndarray, shape (3,)
        At the wheel centre: what a drive shaft leaves of the traction of a wheel that it turns
        [N], [N m].
    rack : float
        Displacement of the rack [m].
    travel : float or None
        Wheel travel at which the suspension stands [m]; the vertical force at the contact is that
        which holds it there. None: the suspension goes to where it carries the loads.
    """

    name: str
    contact: Array = field(default_factory=lambda: np.zeros(3))
    contact_moment: Array = field(default_factory=lambda: np.zeros(3))
    center: Array = field(default_factory=lambda: np.zeros(3))
    center_moment: Array = field(default_factory=lambda: np.zeros(3))
    rack: float = 0.0
    travel: float | None = None

    @property
    def vector(self) -> Array:
        """Forces and moments at the contact, and those at the wheel centre, (12,)."""
        return np.concatenate([self.contact, self.contact_moment, self.center, self.center_moment])


def read(path: str | Path) -> dict[str, Any]:
    """Read a TOML file of load cases.

    Parameters
    ----------
    path : str or pathlib.Path

    Returns
    -------
    dict
        ``cases``, and ``static_load_N`` where the file has it.

    Raises
    ------
    InputError
        If it cannot be read, or has something else.
    """
    return read_sections(path, _SECTIONS, needed="cases.NAME")


def cases_of(
    given: Arguments, described: Mapping[str, Any], static_load: float, *, of: str = ""
) -> list[Case]:
    """Read load cases by their names.

    Parameters
    ----------
    given : Arguments
        Gets what is wrong.
    described : mapping
        By name, each with keys of `docs/loads.md`.
    static_load : float
        Of the wheel, in parts of which forces may be given [N].
    of : str, optional
        Of which side of an axle they are.
    """
    cases = []
    for name, table in described.items():
        title = f"[cases.{name}]{of and ' '}{of}"
        if not (isinstance(name, str) and re.fullmatch(r"[\w.-]+", name)):
            given.refuse(f"{title}: a name is a text of letters, digits, and _ - . only.")
        if not isinstance(table, Mapping):
            given.refuse(f"{title} must be a section, with {', '.join(_KEYS)}.")
            continue
        for key in (key for key in table if key not in _KEYS):
            given.refuse(f"{title} {key} is not known. {suggestion(str(key), _KEYS)}")
        travel = _number(given, title, table, "travel_mm")
        found = {
            place: _vector(given, title, table, f"{place}_N")
            + static_load * _vector(given, title, table, f"{place}_g")
            for place in ("contact", "center")
        }
        if travel is not None and found["contact"][2] != 0.0:
            given.refuse(
                f"{title}: travel_mm holds the suspension by the vertical force at the contact, "
                "which cannot be given besides. Leave one of them out (a third number of 0)."
            )
        if found["contact"][2] < 0.0:
            given.refuse(
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


def standard_cases(side: float) -> dict[str, dict[str, Any]]:
    """Return the usual load cases, in parts of the static load.

    Parameters
    ----------
    side : float
        +1 of a left wheel, -1 of a right one: sideways forces push inward.
    """
    with Arguments("standard_cases") as given:
        if abs(given.number("side", side)) != 1.0 and not given.refused:
            given.refuse(f"side = {side:g}: 1 of a left wheel or -1 of a right one is needed.")
    inward = -side
    return {
        "static": {"contact_g": [0.0, 0.0, 1.0]},
        "brake": {"contact_g": [-1.3, 0.0, 1.3]},
        "reverse": {"contact_g": [0.8, 0.0, 0.9]},
        "drive": {"contact_g": [0.0, 0.0, 0.9], "center_g": [0.5, 0.0, 0.0]},
        "corner": {"contact_g": [0.0, 1.2 * inward, 1.5]},
        "trail_brake": {"contact_g": [-0.9, 0.9 * inward, 1.5]},
        "kerb": {"contact_g": [0.0, 1.5 * inward, 2.0]},
        "pothole": {"contact_g": [-1.5, 0.0, 3.0]},
    }


def _number(given: Arguments, title: str, table: Mapping[str, Any], key: str) -> float | None:
    if key not in table:
        return None
    unit = key.rpartition("_")[2]
    return given.number(f"{title} {key}", table[key], unit, least=-GREATEST, below=GREATEST)


def _vector(given: Arguments, title: str, table: Mapping[str, Any], key: str) -> Array:
    """Return three numbers, zeros where there are none."""
    if key not in table:
        return np.zeros(3)
    unit = key.rpartition("_")[2]
    values = given.array(f"{title} {key}", table[key], unit, dimensions=[1])
    if values.shape == (3,) and (np.abs(values) < GREATEST).all():
        return values
    given.refuse(f"{title} {key}: three numbers are needed, x, y and z, each below {GREATEST:g}.")
    return np.zeros(3)
