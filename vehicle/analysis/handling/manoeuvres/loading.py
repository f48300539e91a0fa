"""Reading of files of manoeuvres."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, get_args

from pydantic import ValidationError

from .....core.errors import InputError
from .....core.legible import short
from .....core.suggestions import suggestion
from .....core.validator import Validator
from ....data import find
from ....data.starter import manoeuvres
from ....input.messages import messages_of
from ....input.places import put
from ....input.toml_file import problems_in, read_toml
from .acceleration import Acceleration
from .braking import StraightBraking
from .braking_in_turn import BrakingInTurn
from .circle import Circle
from .coast_down import CoastDown
from .double_lane_change import DoubleLaneChange
from .manoeuvre import Manoeuvre
from .parking import Parking
from .path_following import PathFollowing
from .sine_sweep import SineSweep
from .sine_with_dwell import SineWithDwell
from .slowly_increasing_steer import SlowlyIncreasingSteer
from .speed_range import SpeedRange
from .step_steer import StepSteer
from .straight import Straight

_KEY = "manoeuvre"
_CLASSES: tuple[type[Manoeuvre], ...] = (
    StepSteer, SineSweep, SlowlyIncreasingSteer, SineWithDwell, DoubleLaneChange, PathFollowing,
    StraightBraking, BrakingInTurn, Acceleration, CoastDown, Circle, SpeedRange,
    Parking, Straight,
)  # fmt: skip

MANOEUVRES: Mapping[str, type[Manoeuvre]] = {
    get_args(one.model_fields[_KEY].annotation)[0]: one for one in _CLASSES
}
"""Manoeuvres by their names in files."""


def load_manoeuvre(
    path_or_name: str | Path | Mapping[str, Any], changes: Mapping[str, Any] | None = None
) -> Manoeuvre:
    """Return the manoeuvre that a TOML file describes, with its checked values as attributes.

    Parameters
    ----------
    path_or_name : str, pathlib.Path or mapping
        The file; as a string, also the name of a packaged one, such as ``"step_steer"``; or its
        content.
    changes : mapping of str to Any, optional
        Values that replace those of the file, in its units. A name is the key, such as
        ``speed_km_per_h``, in a section ``section.key``. None removes an optional key.

    Returns
    -------
    Manoeuvre
        For `drive`.

    Raises
    ------
    InputError
        If the file cannot be read, or has wrong values; the message lists all of them.

    Examples
    --------
    >>> from kintrafo import handling
    >>> handling.load_manoeuvre("step_steer", {"speed_km_per_h": 100.0}).speed_km_per_h
    100.0
    """
    if isinstance(path_or_name, Mapping):
        return _manoeuvre(dict(path_or_name), changes or {}, _KEY)
    with Validator(_KEY) as given:
        given.path("path_or_name", path_or_name)
    file, source = find(path_or_name, manoeuvres()), str(path_or_name)
    data = read_toml(file)
    # a line of the file has another value than a change
    with problems_in(None if changes else file, source):
        return _manoeuvre(data, changes or {}, source)


def _manoeuvre(data: dict[str, Any], changes: Mapping[str, Any], source: str) -> Manoeuvre:
    """Return the manoeuvre of the content of a file with changes."""
    for place, value in changes.items():
        if value is None:
            data.pop(place, None)
        elif "." not in place:
            data[place] = value
        elif problem := put(data, place, value):
            raise InputError([problem], source)
    kind = str(data.get(_KEY, ""))
    if kind not in MANOEUVRES:
        what = f'{_KEY} = "{short(kind)}" is none' if _KEY in data else f"{_KEY} is missing"
        known = ", ".join(f'"{one}"' for one in MANOEUVRES)
        hint = suggestion(kind, MANOEUVRES) if kind else f'Add a line `{_KEY} = "step_steer"`.'
        problem = f"{what}: it names the manoeuvre, one of {known}. {hint}"
        raise InputError([problem], source)
    model = MANOEUVRES[kind]
    try:
        return model(**data)
    except ValidationError as error:
        raise InputError(messages_of(error, model, data), source) from None
