"""A simulation of a car, with the data of pictures of its motion."""

from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ...systems.system import System
from ..assembly.car import CarAssembly
from ..roads.road import Road

Array = NDArray[np.float64]


class MovingCar(Protocol):
    """A car as a picture needs it, and the loads on its parts."""

    @property
    def assembly(self) -> CarAssembly | None:
        """The car with its linkages, if it has some."""

    @property
    def model(self) -> System:
        """Its equations of motion."""

    @property
    def body(self) -> str:
        """The name of its body in these equations."""

    @property
    def wheels(self) -> Sequence[str]:
        """The names of its wheels."""

    @property
    def spins(self) -> Sequence[str]:
        """The angles of the wheels among the states."""

    @property
    def radii(self) -> Sequence[float]:
        """The heights of the wheel centres above the road at rest [m]."""


class Run(NamedTuple):
    """A simulation of a car.

    Attributes
    ----------
    car : MovingCar
    motion : xarray.Dataset
        Its motion over time.
    states, inputs : ndarray, shape (n, states) and (n, inputs)
        Of its equations, at the same times.
    places : ndarray, shape (n, 2)
        Position on the road of the point of the car whose path is shown, axes of the equations [m].
    way : ndarray, shape (n,), optional
        Distance travelled by a car whose equations hold its body at one place [m].
    road : Road, optional
        The road under its wheels; level by default.
    """

    car: MovingCar
    motion: xr.Dataset
    states: Array
    inputs: Array
    places: Array
    way: Array | None = None
    road: Road | None = None
