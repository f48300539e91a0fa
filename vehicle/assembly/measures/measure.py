"""A measure: a characteristic of a wheel or of an axle, with its formula and the data it needs."""

from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

from ....core.named_types import Array
from ...corner.corner import Corner
from ..quantity import Quantity
from .quantities import QUANTITIES

Scope = Literal["wheel", "axle"]


@dataclass(frozen=True)
class Measure:
    """A characteristic of an assembly."""

    quantity: Quantity  # name, unit, definition and sign
    # takes the kinematics of the assembly (`MirroredCorner`, `AxleKinematics` or
    # `WholeAxleKinematics`), with scope 'wheel' also the name of a wheel, and returns an array over
    # the positions
    formula: Callable[..., Array]
    scope: Scope  # whether it belongs to each wheel or to the axle
    needs: tuple[str, ...] = ()  # attributes of `Vehicle` without which it is not defined
    # takes the kinematics, returns whether all further data that it needs are known
    known_to: Callable[[Any], bool] = lambda _: True

    @property
    def name(self) -> str:
        """The name of its variable."""
        return self.quantity.name

    def defined_for(self, of: Any) -> bool:
        """Return whether all data that it needs are known."""
        given = (getattr(v, need) is not None for need in self.needs for v in of.vehicles)
        return all(given) and self.known_to(of)

    def at(self, of: Any, wheel: str) -> Array:
        """Return the values of a wheel; those of an axle for any wheel."""
        return self.formula(of, wheel) if self.scope == "wheel" else self.formula(of)

    def columns(self, wheels: Sequence[str]) -> dict[str, str]:
        """Return the wheel of each column in a flat table, by its name; '' for the axle."""
        if self.scope == "axle":
            return {self.name: ""}
        if len(wheels) == 1:
            return {self.name: wheels[0]}
        return {f"{self.name}_{wheel}": wheel for wheel in wheels}


def of_wheel(
    name: str,
    formula: Callable[[Any, str], Array],
    needs: tuple[str, ...] = (),
    known_to: Callable[[Any], bool] = lambda _: True,
    definition: str = "",
) -> Measure:
    """Return a measure of each wheel; `formula` takes the kinematics and the name of a wheel.

    `name` is one of `QUANTITIES`, whose definition is the default; `needs` and `known_to` are as in
    `Measure`.
    """
    return Measure(_quantity(name, definition), formula, "wheel", needs, known_to)


def of_axle(
    name: str,
    formula: Callable[[Any], Array],
    needs: tuple[str, ...] = (),
    known_to: Callable[[Any], bool] = lambda _: True,
    definition: str = "",
) -> Measure:
    """Return a measure of an axle, as `of_wheel`; the formula takes the kinematics alone."""
    return Measure(_quantity(name, definition), formula, "axle", needs, known_to)


def of_corner(
    name: str, formula: Callable[[Corner], Array], needs: tuple[str, ...] = ()
) -> Measure:
    """Return a measure of each wheel that is independent of others; `formula` takes a `Corner`."""
    return of_wheel(name, lambda of, wheel: formula(of.corners[wheel]), needs)


def _quantity(name: str, definition: str) -> Quantity:
    found = QUANTITIES[name]
    return replace(found, definition=definition) if definition else found


def values(
    measures: Iterable[Measure],
    of: Any,
    wheels: Sequence[str],
    names: Container[str] | None = None,
) -> dict[str, Array]:
    """Return all or some measures that are defined, by the names of their columns.

    `of` has the kinematics in n positions, of the `wheels` by name; `names` are those of columns.
    Values have the shape (n,), SI units.
    """
    return {
        name: measure.at(of, wheel)
        for measure, columns in _wanted(measures, wheels, names)
        if measure.defined_for(of)
        for name, wheel in columns.items()
    }


def columns(measures: Iterable[Measure], wheels: Sequence[str]) -> dict[str, Quantity]:
    """Return the quantities of measures by the names of their columns in a flat table."""
    return {
        name: measure.quantity if name == measure.name else measure.quantity.of_wheel(wheel)
        for measure in measures
        for name, wheel in measure.columns(wheels).items()
    }


def _wanted(
    measures: Iterable[Measure], wheels: Sequence[str], names: Container[str] | None
) -> Iterator[tuple[Measure, Mapping[str, str]]]:
    """Yield the measures with columns of these names, and those columns."""
    for measure in measures:
        every = measure.columns(wheels)
        chosen = {n: w for n, w in every.items() if names is None or n in names}
        if chosen:
            yield measure, chosen
