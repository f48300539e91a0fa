"""A simulation of a car, with the data of pictures of its motion."""

from collections.abc import Sequence
from typing import NamedTuple, Protocol

import xarray as xr

from ...core.named_types import Array
from ...systems.system import System
from ..assembly.car import CarAssembly
from ..roads.road import Road


class MovingCar(Protocol):
    """Properties of a car that pictures of its motion and loads on its parts need."""

    @property
    def assembly(self) -> CarAssembly | None:
        """The car with its linkages; None if it has none."""

    @property
    def model(self) -> System:
        """Its equations of motion."""

    @property
    def body(self) -> str:
        """The name of its body in these equations; empty for an axle on a rig."""

    @property
    def wheels(self) -> Sequence[str]:
        """The names of its wheels."""

    @property
    def spins(self) -> Sequence[str]:
        """The names of the angles of the wheels among the states."""

    @property
    def radii(self) -> Sequence[float]:
        """The heights of the wheel centres above the road at rest [m]."""


class Run(NamedTuple):
    """A simulation of a car.

    Attributes
    ----------
    car : MovingCar
        The car, with its equations.
    motion : xarray.Dataset
        Its motion over time.
    states, inputs : ndarray, shape (n, states) and (n, inputs)
        States and inputs of its equations, at the same times.
    places : ndarray, shape (n, 2)
        Position on the road of the point of the car whose path is shown, axes of the equations [m].
    way : ndarray, shape (n,), optional
        Distance travelled [m], if the body has no coordinate along the road.
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
