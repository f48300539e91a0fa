"""Keys of Project Chrono's files: read, unread and misspelt ones.

Every key of a file is a field of a `Part`, is listed with its value as left out, or is refused.
"""

import difflib
import json
import re
from collections.abc import Collection, Iterable, Iterator
from pathlib import Path
from typing import Any, ClassVar, NamedTuple, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError, field_validator
from pydantic_core import PydanticCustomError

from ....core.errors import InputError
from ....core.legible import legible, short

_SIMILAR = 0.8  # similarity of a misspelt key, by `difflib`
_NEEDED = {
    "tuple_type": "a list is needed, such as [0.0, 1.0]",
    "model_type": "keys with values are needed, in braces",
    "float_type": "a number is needed, without quotes",
    "finite_number": "a finite number is needed",
    "bool_type": "true or false is needed, without quotes",
    "null": "null is not a value",
}
# Ranges by the type of an error: the key of the limit, and its words.
_RANGES = {
    "greater_than": ("gt", "more than {:g} is needed"),
    "greater_than_equal": ("ge", "{:g} or more is needed"),
    "less_than": ("lt", "less than {:g} is needed"),
    "less_than_equal": ("le", "{:g} or less is needed"),
}
_DEEP = 6  # keys within each other; templates have three

Place = tuple[str, ...]
Unread = tuple[Place, Any]


class Part(BaseModel):
    """A part of a file."""

    # other keys are listed, or refused: see `others`
    model_config = ConfigDict(extra="ignore")

    UNREAD: ClassVar[frozenset[str]] = frozenset()  # further keys of Chrono's templates

    @field_validator("*", mode="before")
    @classmethod
    def _is_there(cls, value: Any) -> Any:
        """Refuse null, which is not a value."""
        if value is None:
            raise PydanticCustomError("null", "null is not a value")
        return value


class Other(NamedTuple):
    """A key that is not read."""

    place: Place  # key, after those that contain it
    value: Any
    part: type[Part]  # part with the key


Kind = TypeVar("Kind", bound=Part)


def checked(model: type[Kind], data: dict[str, Any], path: str | Path) -> Kind:
    """Return the content of a file as a part, or raise an `InputError` with its problems."""
    slips = _slips(others(model, data))
    try:
        found = model.model_validate(data)
    except ValidationError as error:
        details = _causes(error)
        # in another kind of file, no other problem matters
        other = [detail for detail in details if detail["type"] == "literal_error"]
        problems = [problem_of(detail) for detail in other or details]
        raise InputError(problems if other else [*problems, *slips], str(path)) from None
    if slips:
        raise InputError(slips, str(path))
    return found


def others(model: type[Part], data: dict[str, Any], place: Place = ()) -> Iterator[Other]:
    """Yield the keys of a file that a model does not have."""
    fields = {field.alias: field.annotation for field in model.model_fields.values()}
    for key, value in data.items():
        inner = fields.get(key)
        if key not in fields:
            yield Other((*place, key), value, model)
        elif isinstance(value, dict) and isinstance(inner, type) and issubclass(inner, Part):
            yield from others(inner, value, (*place, key))


def listed(found: Iterable[Unread]) -> list[str]:
    """Return keys with their values, one line for each place."""
    lines: dict[str, list[str]] = {}
    for (*above, key), value in leaves(found):
        lines.setdefault(_words(above), []).append(f"{legible(short(key))} = {shown(value)}")
    return [": ".join([*filter(None, [head]), ", ".join(keys)]) for head, keys in lines.items()]


def leaves(found: Iterable[Unread]) -> Iterator[Unread]:
    """Yield the innermost keys with their values."""
    for place, value in found:
        if isinstance(value, dict) and value and len(place) < _DEEP:
            yield from leaves(((*place, key), inner) for key, inner in value.items())
        else:
            yield place, value


def meant(key: str, known: Collection[str]) -> str:
    """Return the known key of which a key is probably another spelling, or an empty text."""
    same = {_plain(name): name for name in known}
    if _plain(key) in same:
        return same[_plain(key)]
    lower = {name.lower(): name for name in known}
    near = difflib.get_close_matches(key.lower(), lower, n=1, cutoff=_SIMILAR)
    return lower[near[0]] if near else ""


def slip(place: Place, right: str) -> str:
    """Return the problem of a key that is probably misspelt."""
    return (
        f'"{_words(place)}" is not a key of Chrono\'s templates. Is it "{right}"? Correct it, or '
        "remove it."
    )


def problem_of(detail: Any, place: Place | None = None) -> str:
    """Return the message of an error of pydantic, with the file's keys."""
    words = _words(place or (str(part) for part in detail["loc"]))
    given = shown(detail["input"])
    if detail["type"] == "missing":
        return f'"{words}" is missing. Add it, in SI units.'
    if detail["type"] in {"too_short", "too_long"}:
        least, most = detail["ctx"].get("min_length"), detail["ctx"].get("max_length")
        wanted = f"at least {least} are needed" if most is None else f"{most} are needed"
        return f'"{words}" = {given} has {len(detail["input"])} values; {wanted}.'
    if detail["type"] == "literal_error":
        return f'"{words}" is {given}; only {detail["ctx"]["expected"]} can be read.'
    if detail["type"] in _RANGES:
        key, needed = _RANGES[detail["type"]]
        return f'"{words}" = {given}: {needed.format(detail["ctx"][key])}.'
    return f'"{words}" = {given}: {_NEEDED.get(detail["type"], "another value is needed")}.'


def shown(value: Any) -> str:
    """Return a value as in the file, shortened."""
    try:
        return legible(short(json.dumps(value, default=str)))
    except RecursionError:  # deeply nested lists
        return "..."


def _causes(error: ValidationError) -> list[Any]:
    """Return the errors of pydantic, without lists that are too short because of an element."""
    details = error.errors()
    return [
        one
        for one in details
        if one["type"] != "too_short"
        or not any(
            other["loc"][: len(one["loc"])] == one["loc"] for other in details if other is not one
        )
    ]


def _slips(found: Iterable[Other]) -> list[str]:
    """Return the problems of keys that are probably misspelt, whose values would be lost."""
    problems = []
    for place, _, part in found:
        right = meant(place[-1], [field.alias or "" for field in part.model_fields.values()])
        if right and place[-1] not in part.UNREAD:
            problems.append(slip(place, right))
    return problems


def _words(place: Iterable[str]) -> str:
    return " > ".join(legible(short(part)) for part in place)


def _plain(key: str) -> str:
    return re.sub(r"[^a-z0-9]+", "", key.casefold())
