"""Checks of declarations where they are written: types, names and numbers.

`declared` is for the dataclasses of a declaration, `checked` for functions that make parts of one.
Arguments are validated by pydantic against their annotations, so that a field describes itself in
one place. One `DeclarationError` reports all problems: the name of the thing, the value and a
remedy. Lists are accepted for tuples, and every kind of real number for a float.

Conditions on several fields, or on other parts of the declaration, are in `checks`.
"""

from __future__ import annotations

import inspect
import math
import re
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from functools import wraps
from numbers import Complex, Real
from typing import Annotated, Any, SupportsFloat, TypeVar, cast, get_type_hints

import numpy as np
from pydantic import AfterValidator, BeforeValidator, Field, ValidationError, validate_call
from pydantic_core import CoreSchema, PydanticCustomError
from pydantic_core.core_schema import is_instance_schema

from ...core.errors import KintrafoError
from ...core.legible import strange
from ...core.suggestions import suggestion

Declared = TypeVar("Declared", bound=type)
Function = TypeVar("Function", bound=Callable[..., Any])

_MOST_SHOWN = 90  # characters of a value
_UNNAMED = ("self", "order", "image", "axial")  # arguments that are never written


class DeclarationError(KintrafoError, ValueError):
    """A declaration contradicts itself; the message lists all contradictions.

    Parameters
    ----------
    name
        Kind and name of the declared object.
    problems
        A text for each contradiction: the error, and its remedy.
    """

    def __init__(self, name: str, problems: Sequence[str]) -> None:
        self.name, self.problems = name, tuple(problems)
        # the base class gets the arguments unchanged: pickling hands them to __init__ again
        super().__init__(name, self.problems)

    def __str__(self) -> str:
        """Return the name on top and one line for each problem."""
        return "\n".join([f"{self.name}:", *(f"  - {problem}" for problem in self.problems)])


# -- types of fields ------------------------------------------------------------------------------


def _identifier(name: str) -> str:
    if re.fullmatch("[A-Za-z][A-Za-z0-9_]*", name):
        return name
    message = "cannot be written in C; use letters, digits and underscores, a letter first"
    raise PydanticCustomError("declared", message)


def _real(value: object) -> float:
    """Return a real number of any library as a float."""
    whole_array = isinstance(value, np.ndarray) and value.ndim > 0
    imaginary = isinstance(value, Complex) and not isinstance(value, Real)
    number = math.nan
    if isinstance(value, SupportsFloat) and not whole_array and not imaginary:
        try:
            number = float(value)
        except (TypeError, ValueError, OverflowError):  # a symbol, a signalling NaN, 10**400
            number = math.nan
    if not math.isfinite(number):
        raise PydanticCustomError("declared", "is not a finite real number; give one, in SI units")
    return number


Name = Annotated[str, AfterValidator(_identifier)]
"""An identifier of C and Python."""

Number = Annotated[float, BeforeValidator(_real)]
"""A finite real number."""

Count = Annotated[int, Field(ge=1)]
"""A count of at least one."""

Numeral = Annotated[int, Field(ge=0)]
"""The number of something in a figure."""


# -- the check ------------------------------------------------------------------------------------


def declared(cls: Declared) -> Declared:
    """Return a dataclass that checks its arguments.

    Its objects are checked when they are made: as arguments of others, their type is sufficient.
    """
    # pydantic asks a class for this method
    setattr(cls, "__get_pydantic_core_schema__", classmethod(_of_type))  # noqa: B010 (mypy allows no assignment to a method that it does not know)
    checked_init = _checked(vars(cls)["__init__"], cls.__name__, cls)
    setattr(cls, "__init__", checked_init)  # noqa: B010 (mypy allows no assignment to a method)
    return cls


def _of_type(cls: type, _source: object, _handler: object) -> CoreSchema:
    """Return the schema of an argument that is an object of a class."""
    return is_instance_schema(cls)


def checked(function: Function) -> Function:
    """Return a function that checks its arguments."""
    return cast("Function", _checked(function, function.__name__, function))


def _checked(function: Callable[..., Any], name: str, annotated: Any) -> Callable[..., Any]:
    hints = get_type_hints(annotated, include_extras=True)
    signature = inspect.signature(function)
    known = {k: v for k, v in hints.items() if k in signature.parameters}
    function.__annotations__ = known
    valid = validate_call(config={"strict": True, "arbitrary_types_allowed": True})(function)
    names = list(signature.parameters)
    is_method = names[:1] == ["self"]

    @wraps(function)
    def call(*given: Any, **named: Any) -> Any:
        values = [_with_tuples(value) for value in given]
        keywords = {key: _with_tuples(value) for key, value in named.items()}
        arguments = dict(zip(names, values, strict=False)) | keywords
        problems = [
            f"{key}: {problem}" for key, item in arguments.items() if (problem := strange(item))
        ]
        what = type(given[0]).__name__ if is_method else name
        if problems:
            raise DeclarationError(what, problems)
        try:
            return valid(*values, **keywords)
        except ValidationError as error:
            problems = _problems(error, names, arguments)
            title = f"{what} {own!r}" if isinstance(own := arguments.get("name"), str) else what
            raise DeclarationError(title, problems) from None

    call.__annotations__ = known
    return call


def _with_tuples(value: Any) -> Any:
    """Return a value with tuples instead of lists and iterators."""
    if isinstance(value, list | tuple | Iterator) and not hasattr(value, "_fields"):
        return tuple(_with_tuples(item) for item in value)
    if isinstance(value, Mapping):
        return {key: _with_tuples(item) for key, item in value.items()}
    return value


# -- messages -------------------------------------------------------------------------------------


def _problems(error: ValidationError, names: list[str], given: Mapping[str, Any]) -> list[str]:
    """Return one problem for each place, with all types of a choice."""
    places: dict[str, tuple[Any, list[Any]]] = {}
    for detail in error.errors(include_url=False):
        first, *rest = detail["loc"]
        field = names[first] if isinstance(first, int) and first < len(names) else str(first)
        place, value = _place(field, rest, given)
        places.setdefault(place, (value, []))[1].append(detail)
    fields = [name for name in names if name not in _UNNAMED]
    return [_problem(place, value, found, fields) for place, (value, found) in places.items()]


def _place(field: str, rest: Sequence[int | str], given: Mapping[str, Any]) -> tuple[str, Any]:
    """Return a place and its value; names of types are not places."""
    place: str = field
    value: Any = given.get(field)
    for key in rest:
        inside = isinstance(value, tuple) and isinstance(key, int) and key < len(value)
        if not inside and not (isinstance(value, Mapping) and key in value):
            break
        place, value = f"{place}[{key!r}]", value[key]
    return place, value


def _problem(place: str, value: Any, found: list[Any], fields: list[str]) -> str:
    detail, kind = found[0], found[0]["type"]
    if kind == "unexpected_keyword_argument":
        return f"{place} is not one of its fields. {suggestion(place, fields)}"
    if kind == "unexpected_positional_argument":
        known = ", ".join(fields)
        return f"{_shown(detail['input'])} is one argument too many; its fields are {known}"
    if kind == "multiple_argument_values":
        return f"{place} is given twice"
    if kind.startswith("missing"):
        return f"{place} {_missing(kind, value)}"
    if kind == "declared":
        return f"{place} {value!r} {detail['msg']}"
    wanted = list(dict.fromkeys(map(_wanted, found)))
    return f"{place} is {_shown(value)}; {_either(wanted)} is needed{_advice(value, wanted)}"


def _missing(kind: str, value: Any) -> str:
    """Return a description of a missing argument: its name, a part of it, or all of it."""
    if kind == "missing_keyword_only_argument" and value is not None:
        return f"is {_shown(value)} without its name: write its name and = before it"
    return f"is {_shown(value)}, too few" if value else "is missing"


_PARAMETERS = (
    "a SpringRate", "a DamperRate", "a Displacement", "a Length", "a Distance",
    "a Gravity", "a ForceLevel", "a Speed", "a Share", "a Progression",
)  # fmt: skip
_WANTED = {
    "string_type": "a text",
    "int_type": "a whole number",
    "bool_type": "True or False",
    "tuple_type": "a tuple",
    "mapping_type": "a dictionary",
    "dict_type": "a dictionary",
    "too_long": "a shorter tuple",
    "none_required": "None",
}


def _wanted(detail: Any) -> str:
    """Return a description of the value that is needed."""
    context = detail.get("ctx", {})
    if detail["type"] == "literal_error":
        return str(context["expected"])
    if detail["type"] == "greater_than_equal":
        return f"{context['ge']} or more"
    name = context.get("class_name", context.get("class"))
    if name:
        return f"{'an' if name[0] in 'AEIOU' else 'a'} {name}"
    if detail["type"] == "declared":  # "is not a finite real number; give one"
        return str(detail["msg"]).removeprefix("is not ").partition(";")[0]
    return _WANTED.get(detail["type"], str(detail["msg"]))


def _advice(value: Any, wanted: list[str]) -> str:
    """Return the syntax of the value that was probably intended."""
    kind = type(value).__name__
    cases = (
        (isinstance(value, type), f"write {getattr(value, '__name__', '')}(...)"),
        ("a tuple" in wanted, f"write it in brackets, with a comma after it, ({_shown(value)},)"),
        (wanted == ["a Line"], "write Line(point, direction) or Line(point, point)"),
        (wanted == ["a Point"], "write Point(name, place, meaning)"),
        (wanted == ["a Direction"], "write Direction(name, components, meaning)"),
        (
            wanted == ["a Parameter"],
            "write Ratio(name, default, meaning), or Lead or TurnPerTravel if one of both slides",
        ),
        (wanted == ["a Body"], "write Body(name, mass, centre, inertia)"),
        (
            "a ForceElement" in wanted and hasattr(value, "force"),
            f"a law acts in an element, ForceElement(name, path, ({kind}(...),))",
        ),
        (
            isinstance(value, float | int | str) and any(w in _PARAMETERS for w in wanted),
            f"write {wanted[0].split()[-1]}(name, default, meaning)",
        ),
    )
    return next((f": {advice}" for fits, advice in cases if fits), "")


def _shown(value: object) -> str:
    text = repr(value)
    return text if len(text) <= _MOST_SHOWN else f"{text[:_MOST_SHOWN]}..."


def _either(words: Sequence[str]) -> str:
    return " or ".join(filter(None, (", ".join(words[:-1]), words[-1])))


# -- parts of a declaration -----------------------------------------------------------------------


def parts(value: object) -> Iterator[Any]:
    """Yield every dataclass within a declaration, itself first."""
    if isinstance(value, tuple):
        for item in value:
            yield from parts(item)
    elif is_dataclass(value):
        yield value
        for entry in fields(value):
            if entry.name != "image":  # the original is in another mechanism
                yield from parts(getattr(value, entry.name))


def is_own(kind: type) -> bool:
    """Return whether a class is a user's own, not defined in a module of the generator."""
    package = __name__.removesuffix("declare.declared")
    found: Any = sys.modules.get(kind.__module__) if kind.__module__.startswith(package) else None
    for name in kind.__qualname__.split("."):
        found = getattr(found, name, None)
    return found is not kind
