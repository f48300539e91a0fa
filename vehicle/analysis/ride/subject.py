"""The car of an analysis of its ride."""

from dataclasses import dataclass
from typing import Any

from ....core.named_types import Array
from ....systems.system import System
from ...assembly.car import CarAssembly
from ...assembly.of import car_assembly_of


def car_assembly(source: str, subject: Any, *, riding: bool = True) -> CarAssembly:
    """Return a car, or its equations, as an assembly.

    Raises
    ------
    InputError
        If the body is held; for `riding` also if it travels, as of a car that drives.
    """
    found = car_assembly_of(source, subject, _NEEDED)
    if riding:
        found.require_riding()
    return found


@dataclass(frozen=True)
class RidingCar:
    """A car whose body does not travel along the road, for pictures of its motion.

    Attributes
    ----------
    assembly : CarAssembly
    radii : tuple of float
        Heights of the wheel centres above the road at rest [m].
    body : str
        The name of its body in the equations.
    """

    assembly: CarAssembly
    radii: tuple[float, ...]
    body: str = "body"

    @property
    def model(self) -> System:
        """Its equations."""
        return self.assembly.model

    @property
    def wheels(self) -> tuple[str, ...]:
        """The names of its wheels."""
        return self.assembly.wheels

    @property
    def spins(self) -> tuple[str, ...]:
        """The angles of the wheels among the states."""
        return tuple(self.assembly.names_of(wheel).spin for wheel in self.wheels)


def riding_car(assembly: CarAssembly, state: Array, inputs: Array) -> RidingCar:
    """Return a car for pictures of its motion, from state and inputs at rest."""
    names = [assembly.names_of(wheel) for wheel in assembly.wheels]
    heights = assembly.model.signals(state, inputs)
    roads = [float(inputs[assembly.model.input_names.index(own.road)]) for own in names]
    radii = tuple(
        float(heights[f"{own.signals}wheel_center_z"]) - road
        for own, road in zip(names, roads, strict=True)
    )
    return RidingCar(assembly, radii)


_NEEDED = (
    'a kintrafo.Car, such as kintrafo.load("quarter_car"), is needed; the body of a suspension or '
    "an axle alone is held"
)
