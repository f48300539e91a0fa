"""The base of all manoeuvres."""

from abc import abstractmethod
from collections.abc import Callable
from typing import ClassVar

from ....input.section import Section
from ....models.car.car import Car
from ..car import DrivingCar
from ..result import HandlingResult
from ..subject import require_controls

Progress = Callable[[float], None]
Number = tuple[float, str, str]
"""A metric of a manoeuvre: value, meaning and SI unit."""


class Manoeuvre(Section):
    """A manoeuvre with the keys of its file."""

    TITLE: ClassVar[str]
    """The manoeuvre in a few words."""
    CURVES: ClassVar[tuple[str, ...]] = ("",)
    """The endings of the names of files with its curves."""
    TRAVELS: ClassVar[bool] = True
    """Whether the car drives along a path that can be drawn."""

    def check(self, car: Car) -> None:
        """Raise an `InputError` for a car that cannot drive it, before equations are derived."""
        require_controls(car)

    @abstractmethod
    def run(self, car: DrivingCar, progress: Progress) -> HandlingResult:
        """Return metrics and curves of a car; `progress` is called with the done part, up to 1."""
