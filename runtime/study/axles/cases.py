"""Load cases of an axle: of both wheels what a case says, or of each what it says of that side."""

from collections.abc import Mapping
from typing import Any

from ...assembly.axle_coupling import SIDES
from ...core.arguments import Arguments
from ..loads.cases import Case, cases_of

_RACK = "rack_mm"


def cases_of_sides(
    given: Arguments, described: Mapping[str, Any], static_loads: Mapping[str, float]
) -> dict[str, list[Case]]:
    """Read load cases of both wheels, by their sides.

    Parameters
    ----------
    given : Arguments
        Gets what is wrong.
    described : mapping
        By name, each with keys of `docs/loads.md` for both wheels, and in ``left`` and ``right``
        those of one.
    static_loads : mapping of str to float
        Of each wheel, in parts of which forces may be given [N].
    """
    tables = {
        side: {n: _of_side(given, n, t, side) for n, t in described.items()} for side in SIDES
    }
    found: dict[str, list[Case]] = {}
    for side in SIDES:
        # what both have is told once
        if not given.refused:
            found[side] = cases_of(given, tables[side], static_loads[side], of=side)
    return found


def _of_side(given: Arguments, name: str, table: Any, side: str) -> Any:
    """Return what a case says of one side; what is no table as it is."""
    if not isinstance(table, Mapping):
        return table
    both = {key: value for key, value in table.items() if key not in SIDES}
    own = table.get(side, {})
    if not isinstance(own, Mapping):
        given.refuse(f"[cases.{name}] {side} must be a section, as [cases.{name}.{side}].")
        return both
    if _RACK in own:
        given.refuse(
            f"[cases.{name}.{side}] {_RACK}: both sides have one rack. "
            f"Give it to [cases.{name}] itself."
        )
    for key in (key for key in own if key in both):
        given.refuse(
            f"[cases.{name}] {key} is that of both wheels, and [cases.{name}.{side}] has it, too. "
            f"Give it to both by itself, or to left and right."
        )
    return both | dict(own)


def tables_of(described: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Return all tables that there are in load cases: of both wheels, and of one."""
    every = [*described.values()]
    every += [t.get(side) for t in described.values() if isinstance(t, Mapping) for side in SIDES]
    return [table for table in every if isinstance(table, Mapping)]


def standard_cases() -> dict[str, dict[str, Any]]:
    """Return the usual load cases of an axle, in parts of the static load of each wheel.

    In those that are not even the right wheel has the greater load.

    Returns
    -------
    dict
        As `static_loads` takes them.

    Examples
    --------
    >>> standard_cases()["corner"]["right"]
    {'contact_g': [0.0, 1.2, 1.5]}
    """
    return {
        "static": {"contact_g": [0.0, 0.0, 1.0]},
        "brake": {"contact_g": [-1.3, 0.0, 1.3]},
        "reverse": {"contact_g": [0.8, 0.0, 0.9]},
        "drive": {"contact_g": [0.0, 0.0, 0.9], "center_g": [0.5, 0.0, 0.0]},
        "corner": _uneven([0.0, 0.4, 0.5], [0.0, 1.2, 1.5]),
        "trail_brake": _uneven([-0.5, 0.4, 0.7], [-0.9, 0.9, 1.5]),
        "kerb": _uneven([0.0, 0.0, 1.0], [0.0, 1.5, 2.0]),
        "bump": _uneven([0.0, 0.0, 1.0], [0.0, 0.0, 2.5]),
        "pothole": _uneven([0.0, 0.0, 1.0], [-1.5, 0.0, 3.0]),
    }


def _uneven(left: list[float], right: list[float]) -> dict[str, Any]:
    return {"left": {"contact_g": left}, "right": {"contact_g": right}}
