"""A file of Project Chrono as a suspension."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, NoReturn

from ....core.errors import InputError
from ....core.validator import Validator
from ...input.commented_json import content
from ...kinds import Suspension
from ..fitting import ground
from .double_wishbone import DoubleWishboneFile, WishbonePoints
from .keys import Unread, checked, listed, others, shown
from .macpherson import MacPhersonStrut, StrutPoints
from .points_only import with_points
from .semi_trailing_arm import SemiTrailingArm, TrailingPoints
from .suspension_file import PointsFile, SuspensionFile
from .tires import USUAL, Tire, tire_of

_TEMPLATES: Mapping[str, tuple[type[PointsFile], type[SuspensionFile]]] = {
    whole.TEMPLATE: (points, whole)
    for points, whole in (
        (StrutPoints, MacPhersonStrut),
        (WishbonePoints, DoubleWishboneFile),
        (TrailingPoints, SemiTrailingArm),
    )
}
_REFUSED = {
    "MultiLink": (
        " Its spring and damper are attached to the trailing link, beside the line through its "
        "joints. They depend on the rotation of the link about this line, which differs from that "
        "of a link in kintrafo. The motion of the wheel is that of five links: write a multi_link "
        "file with two links to one outer point for the upper arm, and the lateral link, the "
        "trailing link and the tie rod."
    ),
}


class Imported(NamedTuple):
    """A suspension from a file of another program.

    Attributes
    ----------
    suspension : Suspension
        The left side.
    assumptions : tuple of str
        Assumptions, and differences between both programs, one sentence each.
    left_out : tuple of str
        The unread keys of the files, with their values, one line for each part.
    """

    suspension: Suspension
    assumptions: tuple[str, ...]
    left_out: tuple[str, ...]


def read(
    path: str | Path, *, tire: str | Path | None = None, points_only: bool = False
) -> Imported:
    """Return the suspension of a file of Project Chrono.

    Parameters
    ----------
    path : str or Path
        JSON file of the template "MacPhersonStrut", "DoubleWishbone" or "SemiTrailingArm".
    tire : str or Path, optional
        JSON file of a tire of any template; radius, mass and inertia are read.
    points_only : bool, optional
        Whether only hardpoints, camber and toe are read. All other data are then those of the
        packaged file of the kind, moved to the position of the wheel.

    Returns
    -------
    Imported
        The left suspension, the assumptions, and the unread data.

    Raises
    ------
    InputError
        If a file is not JSON or not of this kind, has a key twice or one that is probably misspelt,
        or the data are not valid; with the keys of the file.
    """
    with Validator("read") as arguments:
        arguments.flag("points_only", points_only)
    if points_only and tire is not None:
        problem = "nothing of a tire is taken with points_only. Leave one of them out."
        raise InputError([problem], str(tire))
    data = content(path)
    if points_only:
        return _points_of(checked(_template(data, path)[0], data, path), data, path)
    given = suspension_file(data, path)
    wheel = USUAL if tire is None else tire_of(content(tire), tire)
    found = imported(given, data, path, wheel)
    alone = (*given.assumed_alone(wheel), *found.assumptions, *ground(found.suspension))
    return found._replace(
        assumptions=(*alone, *wheel.assumed), left_out=(*found.left_out, *wheel.left_out)
    )


def suspension_file(data: dict[str, Any], path: str | Path) -> SuspensionFile:
    """Return the content of a suspension's file as a template, or refuse it."""
    return checked(_template(data, path)[1], data, path)


def _template(
    data: dict[str, Any], path: str | Path
) -> tuple[type[PointsFile], type[SuspensionFile]]:
    template = data.get("Template")
    if not isinstance(template, str) or template not in _TEMPLATES:
        _refuse(data, path)
    return _TEMPLATES[str(template)]


def _points_of(given: PointsFile, data: dict[str, Any], path: str | Path) -> Imported:
    """Return the packaged suspension of a kind with the hardpoints of a file."""
    try:
        suspension, assumed = with_points(given.KIND, given.points(), given.alignment(), str(path))
    except InputError as error:
        raise _by_its_keys(error, given.SOURCES, path) from None
    return Imported(suspension, tuple(assumed), _left_out(type(given), data))


def imported(
    given: SuspensionFile, data: dict[str, Any], path: str | Path, wheel: Tire
) -> Imported:
    """Return the left suspension of a file on a tire; unread keys of its content are listed."""
    problems = given.problems()
    if problems:
        raise InputError(problems, str(path))
    try:
        suspension = Suspension.from_dict(given.data(wheel), str(path))
    except InputError as error:
        raise _by_its_keys(error, given.SOURCES, path) from None
    left_out = _left_out(type(given), data, given.without_effect())
    return Imported(suspension, tuple(given.assumptions(wheel)), left_out)


def _left_out(
    model: type[PointsFile], data: dict[str, Any], without_effect: Sequence[Unread] = ()
) -> tuple[str, ...]:
    unread = [(place, value) for place, value, _ in others(model, data)]
    return tuple(listed([*unread, *without_effect]))


def _by_its_keys(error: InputError, sources: Mapping[str, str], path: str | Path) -> InputError:
    """Return the problems of a suspension, with the keys of its file."""
    problems = []
    for problem in error.problems:
        keys = dict.fromkeys(
            theirs
            for ours, theirs in sources.items()
            if re.search(rf"(?<![\w.]){re.escape(ours)}(?![A-Za-z0-9]*\])", problem)
        )
        named = ", ".join(f'"{key}"' for key in keys)
        problems.append(f"{problem} In the file: {named}." if keys else problem)
    return InputError(problems, str(path))


def _refuse(data: dict[str, object], path: str | Path) -> NoReturn:
    """Refuse a file of another template, or without one."""
    if "Template" not in data:
        raise InputError(['"Template" is missing. Give a file of a suspension.'], str(path))
    template = data["Template"]
    known = ", ".join(repr(name) for name in _TEMPLATES)
    why = _REFUSED.get(template, "") if isinstance(template, str) else ""
    problem = f'"Template" is {shown(template)}; only {known} can be read.{why}'
    raise InputError([problem], str(path))
