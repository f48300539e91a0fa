"""The car that a function of this folder is given."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....systems.system import System
from ...assembly.car import CarAssembly
from ...assembly.of import car_assembly_of

Array = NDArray[np.float64]


def car_assembly(source: str, subject: Any, *, riding: bool = True) -> CarAssembly:
    """Return a car, or its equations, as an assembly; refuse what has a body that is held.

    Parameters
    ----------
    source : str
        What asks.
    subject : Any
    riding : bool, optional
        Whether a car that drives is refused, too: its body travels.

    Raises
    ------
    InputError
    """
    found = car_assembly_of(source, subject, _NEEDED)
    if riding:
        found.require_riding()
    return found


@dataclass(frozen=True)
class RidingCar:
    """A car whose equations hold its body at one place of the road, for pictures of its motion.

    Attributes
    ----------
    model : System
    wheels, spins : tuple of str
        The names of the wheels, and their angles among the states.
    radii : tuple of float
        Heights of the wheel centres above the road at rest [m].
    body : str
        The name of its body in the equations.
    """

    model: System
    wheels: tuple[str, ...]
    spins: tuple[str, ...]
    radii: tuple[float, ...]
    body: str = "body"


def riding_car(assembly: CarAssembly, state: Array, inputs: Array) -> RidingCar:
    """Return a car for pictures of its motion.

    Parameters
    ----------
    assembly : CarAssembly
    state, inputs : ndarray
        In which it rests.
    """
    names = [assembly.names_of(wheel) for wheel in assembly.wheels]
    heights = assembly.model.signals(state, inputs)
    roads = [float(inputs[assembly.model.input_names.index(own.road)]) for own in names]
    return RidingCar(
        model=assembly.model,
        wheels=assembly.wheels,
        spins=tuple(own.spin for own in names),
        radii=tuple(
            float(heights[f"{own.signals}wheel_center_z"]) - road
            for own, road in zip(names, roads, strict=True)
        ),
    )


_NEEDED = (
    'a kintrafo.Car, such as kintrafo.load("quarter_car"), is needed; the body of a suspension or '
    "an axle by itself is held"
)
