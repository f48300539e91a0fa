"""The kinds of suspension, by the names that a file calls them."""

from collections.abc import Mapping
from typing import Any, TypeVar

from ...core.errors import InputError
from ...core.suggestions import suggestion
from ..input.suspension import KIND, Suspension
from .double_wishbone import DoubleWishbone
from .macpherson import MacPherson

KINDS: dict[str, type[Suspension]] = {
    "macpherson": MacPherson,
    "double_wishbone": DoubleWishbone,
}
DEFAULT = "macpherson"

SuspensionT = TypeVar("SuspensionT", bound=Suspension)


def kind_of(data: Mapping[str, Any], wanted: type[SuspensionT]) -> type[SuspensionT]:
    """Return the class that describes the suspension of a file.

    Parameters
    ----------
    data : mapping
        The file's content; not checked yet.
    wanted : type of Suspension
        `Suspension`, or the kind that it has to be.

    Returns
    -------
    type of Suspension

    Raises
    ------
    InputError
        If there is no such kind, it is not the one that is wanted, or it is not said although the
        hardpoints are not those of a MacPherson suspension.
    """
    name = data.get(KIND, DEFAULT)
    if not isinstance(name, str) or name not in KINDS:
        problem = (
            f"{KIND} = {name!r} is not a known kind of suspension. {suggestion(str(name), KINDS)}"
        )
        raise InputError([problem.rstrip()])
    if KIND not in data:
        _refuse_hardpoints_of_another(data)
    kind = KINDS[name]
    if issubclass(kind, wanted):
        return kind
    problem = f'{KIND} = "{name}": a {wanted.TITLE} is needed here. Load it with Suspension.'
    raise InputError([problem])


def _refuse_hardpoints_of_another(data: Mapping[str, Any]) -> None:
    """Refuse data that do not say their kind, where the hardpoints are those of another one."""
    points = data.get("hardpoints")
    if not isinstance(points, Mapping):
        return
    own = _names(DEFAULT)
    for name, kind in KINDS.items():
        strange = [point for point in points if point in _names(name) - own]
        if strange:
            problem = (
                f"[hardpoints] {', '.join(map(str, strange))} are points of a {kind.TITLE}. Add a "
                f'line `{KIND} = "{name}"` above the first section.'
            )
            raise InputError([problem])


def _names(name: str) -> set[str]:
    """Return the names of the hardpoints of a kind."""
    hardpoints = KINDS[name].model_fields["hardpoints"].annotation
    return set(getattr(hardpoints, "model_fields", ()))
