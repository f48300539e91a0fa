"""Steering wheel and pedals as inputs of the equations of a car."""

from functools import cached_property
from typing import Any

import numpy as np

from ...core.errors import InputError
from ...core.named_types import Array, ArrayLike
from ...core.validator import Validator
from ..models.car.car import Car
from ..models.sides import SIDES
from .axle import axle_assembly
from .steered import SteerableAssembly
from .steering_wheel import SteeringWheel

RACK = ("rack_position", "rack_velocity", "rack_acceleration")
"""Names of the inputs of a rack."""


class Controls:
    """Inputs of the equations of a driving car, from steering wheel and pedals.

    Each method takes numbers or arrays and returns values by the names of inputs.

    Examples
    --------
    >>> import kintrafo
    >>> controls = Controls(kintrafo.load("driving_car"))
    >>> controls.brakes(0.5)["front_left_brake_torque"]
    1400.0
    """

    def __init__(self, car: Car) -> None:
        self.car = car

    @cached_property
    def _front(self) -> SteerableAssembly:
        """The front axle, cached as the sense of its steering wheel needs its kinematics."""
        return axle_assembly(self.car.axles["front"])

    @property
    def _steering_wheel(self) -> SteeringWheel:
        return self._front.steering_wheel

    def rack(
        self, angle: ArrayLike, rate: ArrayLike = 0.0, acceleration: ArrayLike = 0.0
    ) -> dict[str, Any]:
        """Return the motion of the rack for angles of the steering wheel, positive to the left.

        Units are rad, rad/s and rad/s^2. Raises `InputError` if the car has no rack, its files have
        no rack travel per turn of the steering wheel, or the angle is beyond a curve of the file.
        """
        with Validator("rack") as given:
            values = [
                given.array(name, value, unit, empty=True)
                for name, value, unit in (
                    ("angle", angle, "rad"),
                    ("rate", rate, "rad/s"),
                    ("acceleration", acceleration, "rad/s^2"),
                )
            ]
            self._front.refuse_unsteered(given, "angle")
        if not self._steering_wheel.known:
            raise InputError([f"front: {self._front.missing_ratio}"], self.car.heading())
        found = self._steering_wheel.motion(*np.broadcast_arrays(*values))
        return {name: _plain(value) for name, value in zip(RACK, found, strict=True)}

    def rack_at(self, angle: float, rate: float, acceleration: float) -> tuple[Array, Array, Array]:
        """Return the values of `rack` for one angle, for each step of a simulation.

        The files of the car are checked once.
        """
        values = np.array([angle, rate, acceleration], dtype=np.float64)
        if not np.isfinite(values).all():
            self.rack(*values)  # which raises
        return self._known_steering_wheel.motion(*values)

    @cached_property
    def _known_steering_wheel(self) -> SteeringWheel:
        self.rack(0.0)
        return self._steering_wheel

    def brakes(self, pedal: ArrayLike) -> dict[str, Any]:
        """Return the torques of the brakes [N m], half of an axle's at each of its wheels.

        The pedal is from 0 (released) to 1 (down). Raises `InputError` if it is outside this range,
        or the file has no brakes.
        """
        with Validator("brakes") as given:
            pressed = given.array("pedal", pedal, empty=True)
            if np.any((pressed < 0.0) | (pressed > 1.0)):
                given.fail("pedal: 0 to 1 is needed, 1 with the pedal fully down.")
            brakes, front = self.car.described.brakes, self.car.front_brake_share
            if brakes is None:
                given.fail(
                    "[brakes] is missing in the car's file. Add it, with torque_Nm of all wheels."
                )
        assert brakes is not None
        assert front is not None
        half = 0.5 * brakes.torque_Nm * pressed
        shares = {"front": front, "rear": 1.0 - front}
        return {
            f"{end}_{side}_brake_torque": _plain(share * half)
            for end, share in shares.items()
            for side in SIDES
        }

    def drive(self, torque: ArrayLike) -> dict[str, Any]:
        """Return the torques of the drive [N m], by the axles' shares, equal left and right.

        `torque` is the sum at all wheels, positive forward [N m]. Raises `InputError` if no axle is
        driven.
        """
        with Validator("drive") as given:
            whole = given.array("torque", torque, "N m", empty=True)
            if not self.car.drive_shares:
                given.fail("no axle is driven. Add [drive] with share to the file of an axle.")
        return {
            f"{end}_{side}_drive_torque": _plain(0.5 * share * whole)
            for end, share in self.car.drive_shares.items()
            for side in SIDES
        }


def _plain(value: Array) -> Any:
    """Return a single value as a number, others as they are."""
    return float(value) if np.ndim(value) == 0 else value
