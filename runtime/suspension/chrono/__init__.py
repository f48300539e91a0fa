"""Suspensions of Project Chrono, as JSON: its templates MacPhersonStrut and DoubleWishbone.

The format is that of Chrono::Vehicle (https://projectchrono.org): points and vectors in metres, in
the axes of the vehicle (ISO 8855), for the *left* side; the right one is its mirror image. What its
files leave open is assumed, and each assumption is told.
"""

import json
from pathlib import Path
from typing import NamedTuple

from ...core.errors import InputError
from ...core.legible import short
from ..kinds import Suspension
from .double_wishbone import DoubleWishbone
from .json_file import checked, content
from .macpherson import MacPhersonStrut
from .parts import TYRE_RATE, USUAL, SuspensionFile, Tire

__all__ = ["TYRE_RATE", "Imported", "read"]

_TEMPLATES: dict[str, type[SuspensionFile]] = {
    template.TEMPLATE: template for template in (MacPhersonStrut, DoubleWishbone)
}
_REFUSED = {
    "MultiLink": (
        " Its spring and damper stand on the trailing link, beside the line through its joints, so "
        "that they depend on how its universal joint lets it turn about that line; links of this "
        "project turn otherwise. The wheel moves alike on five links: write a multi_link file in "
        "which the upper arm is two links with one outer point, beside lateral, trailing link and "
        "tie rod."
    ),
}


class Imported(NamedTuple):
    """A suspension from a file of another program.

    Attributes
    ----------
    suspension : Suspension
        Of the left side.
    assumptions : tuple of str
        What the file leaves open or this project has no place for, one sentence each.
    """

    suspension: Suspension
    assumptions: tuple[str, ...]


def read(path: str | Path, *, tire: str | Path | None = None) -> Imported:
    """Read a suspension of Project Chrono.

    Parameters
    ----------
    path : str or Path
        JSON file of the template "MacPhersonStrut" or "DoubleWishbone".
    tire : str or Path, optional
        JSON file of a tire with radius, mass and inertia.

    Returns
    -------
    Imported
        The left suspension, and what had to be assumed.

    Raises
    ------
    InputError
        If a file is not JSON or not of this kind, or no suspension can be like this.
    """
    data = content(path)
    template = data.get("Template")
    if not isinstance(template, str) or template not in _TEMPLATES:
        _refuse(data, path)
    given = checked(_TEMPLATES[str(template)], data, path)
    wheel = USUAL if tire is None else checked(Tire, content(tire), tire)
    suspension = Suspension.from_dict(given.data(wheel), str(path))
    return Imported(suspension, given.assumptions(wheel))


def _refuse(data: dict[str, object], path: str | Path) -> None:
    """Refuse a file of another template, or of something else."""
    if "Template" not in data:
        raise InputError(['"Template" is missing. Give a file of a suspension.'], str(path))
    template = data["Template"]
    known = " and ".join(repr(name) for name in _TEMPLATES)
    why = _REFUSED.get(template, "") if isinstance(template, str) else ""
    problem = f'"Template" is {short(json.dumps(template))}; only {known} can be read.{why}'
    raise InputError([problem], str(path))
