"""The base of sections of input files, and the types of their values."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Self, get_args

import numpy as np
from pydantic import AllowInfNan, BaseModel, BeforeValidator, ConfigDict, Field, Strict
from pydantic import model_validator as validator_of_model
from pydantic.fields import FieldInfo
from pydantic_core import PydanticCustomError

from ...core.columns import hypot
from .units import unit_of


@dataclass(frozen=True)
class Remedy:
    """A remedy for a value out of its range, for the error message."""

    text: str


def _plain(value: Any) -> Any:
    """Return NumPy's numbers and arrays as Python's, which the checks below expect."""
    return value.tolist() if isinstance(value, (np.generic, np.ndarray)) else value


def _three_numbers(value: Any) -> Any:
    """Return three components, each of which is checked afterwards; refuse other values."""
    value = _plain(value)
    if not isinstance(value, (list, tuple)) or len(value) != 3:
        raise PydanticCustomError("three_numbers", "not three numbers")
    return value


# Strict: neither true nor "5" is a number.
Number = Annotated[float, BeforeValidator(_plain), Strict(), AllowInfNan(False)]

Flag = Annotated[bool, Strict()]

CHECK_UNIT = Remedy("Check the unit of the value.")

NonNegative = Annotated[
    Number,
    Field(ge=0.0),
    Remedy("Remove the minus sign, or enter 0 to leave it out of the model."),
]

Positive = Annotated[Number, Field(gt=0.0), Remedy("Enter a positive value.")]

Triple = Annotated[tuple[Number, Number, Number], BeforeValidator(_three_numbers)]


def metadata_of(field: FieldInfo) -> Iterator[Any]:
    """Yield limits and remedies of the type of a key, and of the types that it consists of."""
    yield from field.metadata
    yield from _metadata(field.annotation)


def _metadata(annotation: Any) -> Iterator[Any]:
    for one in getattr(annotation, "__metadata__", ()):
        yield one
        yield from getattr(one, "metadata", ())  # of a `Field` below the top
    for part in get_args(annotation):
        yield from _metadata(part)


def without_direction(axes: Mapping[str, Triple | None], remedy: str) -> list[str]:
    """Return the problems of axes by key whose length is hardly more than zero, with a remedy."""
    return [
        f"{key} = {list(axis)} (without unit) has the length {hypot(*axis):g} and no direction; "
        f"allowed are lengths of more than 1e-6. {remedy}"
        for key, axis in axes.items()
        if axis is not None and not 1e-6 < hypot(*axis) < math.inf
    ]


_THEIRS = frozenset(dir(BaseModel))


class Section(BaseModel):
    """A section of an input file: immutable, and without unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    def __dir__(self) -> list[str]:
        """Return the names for completion, without those of pydantic."""
        return [name for name in super().__dir__() if name.startswith("_") or name not in _THEIRS]

    @classmethod
    def unit_of_key(cls, key: str, table: Mapping[str, Any]) -> str:
        """Return the printed unit of a key, or "", from the unchecked content of its section."""
        return unit_of(key)

    def problems(self) -> list[str]:
        """Return the problems of the values together, each a text that begins with the key.

        Each value alone is in its range.
        """
        return []

    @validator_of_model(mode="after")
    def _refuse_problems(self) -> Self:
        problems = self.problems()
        if problems:
            raise PydanticCustomError("problems", "not possible", {"problems": problems})
        return self
