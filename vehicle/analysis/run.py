"""A simulation of a car: what pictures of its motion are made of."""

from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ...systems.system import System
from ..roads.road import Road

Array = NDArray[np.float64]


class MovingCar(Protocol):
    """A car as a picture needs it."""

    @property
    def model(self) -> System:
        """Its equations of motion."""

    @property
    def body(self) -> str:
        """The name of its body there."""

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
        Where on the road the point of the car is whose path is shown, in the axes of the equations.
    way : ndarray, shape (n,), optional
        How far a car has travelled whose equations hold its body at one place [m].
    road : Road, optional
        Under its wheels; by default it is level.
    """

    car: MovingCar
    motion: xr.Dataset
    states: Array
    inputs: Array
    places: Array
    way: Array | None = None
    road: Road | None = None
