"""A simulation of a car, with the data of pictures of its motion."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, Self

import xarray as xr

from ...core.named_types import Array
from ...systems.system import System
from ..assembly.car import CarAssembly
from ..roads.road import Road

CAR_ADVICE = (
    "Choose a lower speed or a shorter duration, and check masses, stiffnesses and dampings in the "
    "files of the car."
)
"""Advice for a simulation of a car that could not be finished, without options of the solver."""


@dataclass(frozen=True, kw_only=True)
class MovingCar:
    """A car, with the data for pictures of its motion and for loads on its parts."""

    model: System  # its equations of motion
    # names of the wheels: front ones first, the left one of an axle before the right one
    wheels: Sequence[str]
    spins: Sequence[str]  # names of the angles of the wheels among the states
    radii: Sequence[float]  # heights of the wheel centres above the road at rest [m]
    body: str = "body"  # its name in the equations; empty for an axle on a rig
    assembly: CarAssembly | None = None  # the car with its linkages

    @classmethod
    def at_rest(cls, assembly: CarAssembly, state: Array, inputs: Array, **further: Any) -> Self:
        """Return a car from state and inputs at rest, with further fields."""
        model, names = assembly.model, [assembly.names_of(wheel) for wheel in assembly.wheels]
        signals = model.signals(state, inputs)
        roads = [float(inputs[model.input_names.index(own.road)]) for own in names]
        radii = tuple(
            float(signals[f"{own.signals}wheel_center_z"]) - road
            for own, road in zip(names, roads, strict=True)
        )
        spins = tuple(own.spin for own in names)
        return cls(
            model=model, wheels=assembly.wheels, spins=spins, radii=radii, assembly=assembly,
            **further,
        )  # fmt: skip


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
