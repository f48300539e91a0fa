"""The base of all manoeuvres."""

from abc import abstractmethod
from collections.abc import Callable
from typing import ClassVar

import numpy as np
from pydantic import GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema

from .....core.named_types import Array
from ....assembly.quantity import GREATEST_SPEED, LEAST_SPEED
from ....input.section import Section
from ....input.units import unit_of
from ....models.car.car import Car
from ..car import DrivingCar
from ..result import HandlingResult
from ..subject import require_controls

Progress = Callable[[float], None]
Number = tuple[float, str, str]
"""A metric of a manoeuvre: value, meaning and SI unit."""

# The allowed ranges of the values of a file by key or unit; others are mistakes, such as of units.
_RANGES = {
    "radius_m": (1.0, 1e5),
    "duration_s": (0.1, 3600.0),
    "step_km_per_h": (1e-3, GREATEST_SPEED),
    "step_m_per_s2": (1e-3, 5.0),  # some ten thousand turns of a circle, or one or two
    "km/h": (LEAST_SPEED, GREATEST_SPEED),
    "m/s^2": (1e-3, 60.0),
    "deg": (1e-3, 2000.0),
    "deg/s": (1e-3, 1e4),
    "Hz": (1e-3, 100.0),
    "m": (-1e5, 1e5),
    "mm": (0.0, 2e4),
    "s": (0.0, 3600.0),
    "ms": (0.01, 1e4),
    "N m": (1e-3, 1e6),
}


def _range_of(key: str) -> tuple[float, float]:
    """Return the allowed range of the value of a key, in its unit."""
    return _RANGES.get(key) or _RANGES.get(unit_of(key), (-np.inf, np.inf))


class Manoeuvre(Section):
    """A manoeuvre with the keys of its file."""

    TITLE: ClassVar[str]
    """The manoeuvre in a few words."""
    CURVES: ClassVar[tuple[str, ...]] = ("",)
    """The endings of the names of files with its curves."""
    TRAVELS: ClassVar[bool] = True
    """Whether the car drives along a path that can be drawn."""

    def problems(self) -> list[str]:
        """Return the problems of the values together, and those outside of the range of a unit."""
        return [
            f"{key} = {value:g} {unit}: {least:g} to {most:g} {unit} are allowed."
            for key in type(self).model_fields
            for value in np.ravel(getattr(self, key))
            for unit in [unit_of(key)]
            if unit and value is not None
            for least, most in [_range_of(key)]
            if not least <= value <= most
        ]

    def one_of(self, *keys: str) -> list[str]:
        """Return a problem, unless exactly one of some keys has a value."""
        given = [f"{key} = {value:g}" for key in keys if (value := getattr(self, key)) is not None]
        if len(given) == 1:
            return []
        found = f", not {' and '.join(given)}" if given else ""
        remedy = " Remove all but one from the file; in Python, None removes a key." * bool(given)
        count = {2: "two", 3: "three"}[len(keys)]
        return [f"{', '.join(keys)}: give one of the {count}{found}.{remedy}"]

    @classmethod
    def __get_pydantic_json_schema__(
        cls, core: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Return the JSON Schema with the ranges of numbers, for the reference of input files."""
        made = handler(core)
        for key, entry in handler.resolve_ref_schema(made)["properties"].items():
            least, most = _range_of(key)
            for option in (entry, *entry.get("anyOf", ())):
                if option.get("type") == "number" and np.isfinite(most):
                    option["le"] = most
                    if least > option.get("ge", option.get("gt", -np.inf)):
                        option.pop("gt", None)
                        option["ge"] = least
        return made

    SLOPES: ClassVar[bool] = False
    """Whether it may be driven on a slope: straight ahead, without steady turns."""

    @property
    def greatest_distance(self) -> float:
        """The distance that the car travels at most [m]; 0 if nothing is simulated."""
        return 0.0

    def check(self, car: Car) -> None:
        """Raise an `InputError` for a car that cannot drive it, before equations are derived."""
        require_controls(car)

    def wanted_path(self) -> Array:
        """Return points of the path that the driver follows [m], shape (n, 2); none by default."""
        return np.empty((0, 2))

    @abstractmethod
    def run(self, car: DrivingCar, progress: Progress) -> HandlingResult:
        """Return metrics and curves of a car.

        Parameters
        ----------
        car : DrivingCar
            A car and its equations.
        progress : callable
            Called with the completed fraction, up to 1.
        """
