"""Messages about sections and keys of an input file, from pydantic's validation errors."""

import reprlib
from collections.abc import Mapping
from typing import Any, get_args, get_origin

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from ...core.legible import short
from ...core.suggestions import nearest, suggestion
from .section import Remedy, Section, metadata_of

_MOST_LOOKED_AT = 200  # errors: each is compared with all known keys
_EXPECTATIONS = {
    "finite_number": "must be a finite number. Enter the measured or estimated value.",
    "float_type": "must be a number. Write digits without quotes, with a point for decimals.",
    "tuple_type": "must be a list of numbers. Write them as [0.0, 1.0, 2.0].",
    "dict_type": "must be sections. Write one for each, such as [bushings.arm_rear].",
    "bool_type": "must be true or false. Write it without quotes.",
    "three_numbers": "must be three numbers. Write them as [x, y, z].",
}


def messages_of(error: ValidationError, model: type[Section], data: Mapping[str, Any]) -> list[str]:
    """Return a message for each problem of a validation, beginning with section and key.

    `model` is the model of the whole file, `data` its content.
    """
    details = error.errors(include_url=False)[:_MOST_LOOKED_AT]
    # a misspelt key is reported once, not a second time as missing
    misspelt = {
        (*place.sections, nearest(place.key, place.model.model_fields))
        for detail in details
        if detail["type"] == "extra_forbidden"
        for place in [_Place(detail["loc"], model, data)]
    }
    return [
        text
        for detail in details
        if detail["type"] != "missing" or detail["loc"] not in misspelt
        for text in _texts(_Place(detail["loc"], model, data), detail)
    ]


class _Place:
    """A place in the file, from pydantic's location: section, key and, for points, component."""

    def __init__(
        self, location: tuple[int | str, ...], model: type[Section], data: Mapping[str, Any]
    ) -> None:
        sections: list[str] = []
        rest = list(location)
        while rest and (below := subsection(model, rest[0])):
            # the free name of a section follows its key; NAME represents a missing one
            parts = 2 if is_named(model, rest[0]) else 1
            model, rest = below, rest if len(rest) >= parts else [*rest, "NAME"]
            for _ in range(parts):
                sections.append(str(rest.pop(0)))
                inner = data.get(sections[-1])
                data = inner if isinstance(inner, Mapping) else {}
        self.sections = tuple(sections)
        self.model = model
        self.key = str(rest[0]) if rest else ""
        self.title = f"[{'.'.join(sections)}]" if sections else ""
        elements = (f", {_element(model, self.key, part)}" for part in rest[1:])
        self.name = f"{self.title} {short(self.key)}{''.join(elements)}".strip()
        self.unit = model.unit_of_key(self.key, data)

    def allowed(self) -> str:
        """Return the range of the key's value, and the remedy for others."""
        limits: dict[str, str] = {}
        remedy = ""
        for one in metadata_of(self.model.model_fields[self.key]):
            remedy = one.text if isinstance(one, Remedy) else remedy
            for name in ("ge", "gt", "le"):
                if hasattr(one, name):
                    limits[name] = f"{getattr(one, name):,.10g} {self.unit}".rstrip()
        if "gt" in limits:
            most = f", at most {limits['le']}" if "le" in limits else ""
            return f"allowed is more than {limits['gt']}{most}. {remedy}"
        most = f"to {limits['le']}" if "le" in limits else "or more"
        return f"allowed is {limits['ge']} {most}. {remedy}"


def subsection(model: type[Section], name: int | str) -> type[Section] | None:
    """Return the model of a subsection, or None if `name` is a key."""
    field = model.model_fields.get(str(name))
    kinds = (field.annotation, *get_args(field.annotation)) if field else ()
    sections = (kind for kind in kinds if isinstance(kind, type) and issubclass(kind, Section))
    return next(sections, None)


def is_named(model: type[Section], name: int | str) -> bool:
    """Return whether a key contains sections with free names."""
    field = model.model_fields.get(str(name))
    return field is not None and get_origin(field.annotation) is dict


def _element(model: type[Section], key: str, index: int | str) -> str:
    """Return the name of an element of a value: x, y, z of a point, the number in a list."""
    if not isinstance(index, int):
        return index
    open_ended = "..." in str(model.model_fields[key].annotation)
    return f"element {index + 1}" if open_ended else "xyz"[index]


def _texts(place: _Place, detail: ErrorDetails) -> list[str]:
    """Return the messages of an error; only a whole section has several."""
    if detail["type"] == "problems":
        return [f"{place.title} {problem}".lstrip() for problem in detail["ctx"]["problems"]]
    if detail["type"] == "extra_forbidden":
        return [_unknown(place, detail["input"])]
    if detail["type"] == "missing":
        return [_missing(place)]
    return [_wrong(place, detail)]


def _wrong(place: _Place, detail: ErrorDetails) -> str:
    """Return the message about a value that cannot be used."""
    value = f"{place.name} = {reprlib.repr(detail['input'])} {place.unit}".rstrip()
    if not place.key:
        return f"{value} must be a section. Write {place.title}, below it {_keys(place.model)}."
    if detail["type"] in {"greater_than", "greater_than_equal", "less_than_equal"}:
        return f"{value} is out of range: {place.allowed()}"
    if detail["type"] == "literal_error":
        expected = detail["ctx"]["expected"]
        remedy = "Choose one of them." if " or " in expected else "Enter it."
        return f"{value} must be {expected}. {remedy}"
    return f"{value} {_EXPECTATIONS.get(detail['type'], 'cannot be used. Correct it.')}"


def _unknown(place: _Place, value: Any) -> str:
    """Return the message about an unknown key or section, with a suggestion."""
    if isinstance(value, Mapping):
        subject = f"[{'.'.join([*place.sections, short(place.key)])}] is not a known section."
    else:
        subject = f"{place.name} is not a known key."
    return f"{subject} {suggestion(place.key, place.model.model_fields)}"


def _missing(place: _Place) -> str:
    """Return the message about a missing key or section, with its meaning."""
    if not place.key:
        return f"{place.title} is missing. Add this section, with {_keys(place.model)}."
    meaning = place.model.model_fields[place.key].description
    unit = f", in {place.unit}" if place.unit else ""
    return f"{place.name} is missing: {meaning}. Add a line `{place.key} = ...`{unit}."


def _keys(model: type[Section]) -> str:
    """Return the required keys of a section."""
    needed = [name for name, field in model.model_fields.items() if field.is_required()]
    return f"at least {', '.join(needed)}"
