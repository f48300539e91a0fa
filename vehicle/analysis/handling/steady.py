"""Steady motion of a car, straight ahead or along a circle, without a simulation.

Along a circle on a level road only position, yaw angle and the angles of the wheels change. The
unknowns are height, pitch and roll of the body, the coordinates of the suspensions, the velocities
along and across the heading, the yaw rate, the rates of the wheels, the deflections of the
contacts, the steering wheel angle and the torque of the drive. The equations, as many, are zero
rates of all speeds in the axes of the body and of all deflections, and two conditions. They are
solved by Newton's method with the exact Jacobian of the equations of motion.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ....core.errors import KintrafoError
from ....core.named_types import Array
from ....equations.errors import ModelError
from .car import DrivingCar

_MOST_STEPS, _HALVINGS = 40, 12
# A step this small, relative to 1 in SI units, is at the level of rounding.
_LAST_STEP = 1e-11
# Residual accelerations, relative to the greatest slope, from cancellation.
_NOTHING = 1e-9
# Steering wheel angle in differences [rad].
_SMALL = 1e-4
_IMAGINARY = 1e-30

_BODY = ("height", "pitch", "roll", "forward", "left", "yaw_rate")
_DRIVER = ("steering_wheel", "drive")


class NoSteadyMotionError(KintrafoError):
    """There is no steady motion near the start of the search."""


@dataclass(frozen=True)
class SteadyCondition:
    """A condition of a steady motion: the value of a function of the unknowns."""

    kind: str  # speed, curvature, lateral_acceleration or steering_wheel; SI units
    value: float

    def turned(self, sense: int) -> "SteadyCondition":
        """Return the condition in turns to the left, sense 1, or to the right, -1."""
        return self if self.kind == "speed" else SteadyCondition(self.kind, sense * self.value)

    def off(self, unknown: Mapping[str, float]) -> tuple[float, dict[str, float]]:
        """Return the residual of the condition, and its derivatives by the name of the unknown."""
        v, w, r = unknown["forward"], unknown["left"], unknown["yaw_rate"]
        size = float(np.hypot(v, w))
        if self.kind == "speed":
            return size - self.value, {"forward": v / size, "left": w / size}
        if self.kind == "curvature":
            slope = -r / size**3
            own = {"forward": slope * v, "left": slope * w, "yaw_rate": 1.0 / size}
            return r / size - self.value, own
        if self.kind == "lateral_acceleration":
            # velocities along the heading axes are constant: only the axes turn
            return v * r - self.value, {"forward": r, "yaw_rate": v}
        return unknown["steering_wheel"] - self.value, {"steering_wheel": 1.0}


@dataclass(frozen=True)
class Steady:
    """A steady motion."""

    unknowns: Mapping[str, float]  # unknowns of the body and the driver, SI units
    slopes: Mapping[str, float]  # their derivatives in the value of the last condition
    # above the origin of the road, at yaw angle zero; on a slope the car moves along x
    state: Array
    inputs: Array
    tangent: Array  # derivatives of all unknowns
    # derivatives of state and inputs
    state_slope: Array
    input_slope: Array


class SteadyMotion:
    """The equations of steady motion of a car."""

    def __init__(self, car: DrivingCar) -> None:
        self._car = car
        model = car.model
        layout, names = model.layout, model.state_names
        spins = {names.index(name) for name in car.spins}
        self._joints = [i for i in layout.joints if i not in spins]
        self._turned = sorted(spins)
        rates = [layout.speed_of[i] for i in self._turned]
        self._spin_rates = [layout.positions + int(rate or 0) for rate in rates]
        self._internal = list(range(layout.positions + layout.speeds, len(names)))
        self._unknown = [
            *_BODY, *(names[i] for i in self._joints), *(names[i] for i in self._spin_rates),
            *(names[i] for i in self._internal), *_DRIVER,
        ]  # fmt: skip
        self._places = {name: i for i, name in enumerate(self._unknown)}
        motion = car.motion
        self._rows = motion.rows(("z", "e0", "e1", "e2", "e3", "u", "v", "w", "p", "q", "r"))

    def near_straight(self, speed: float) -> Array:
        """Return a first guess of the unknowns: the car at rest, but with rolling wheels."""
        rest = np.asarray(self._car.rest)
        found = np.zeros(len(self._unknown))
        found[self._places["height"]] = rest[self._rows[0]]
        e0, e1, e2, e3 = rest[self._rows[1:5]]
        found[self._places["pitch"]] = np.arcsin(2.0 * (e0 * e2 - e3 * e1))
        found[self._places["roll"]] = np.arctan2(2.0 * (e0 * e1 + e2 * e3), 1 - 2 * (e1**2 + e2**2))
        found[self._places["forward"]] = speed
        for row in self._joints:
            found[self._places[self._car.model.state_names[row]]] = rest[row]
        radii = dict(zip(self._car.spins, self._car.radii, strict=True))
        names = self._car.model.state_names
        for spin, row in zip(self._turned, self._spin_rates, strict=True):
            found[self._places[names[row]]] = speed / radii[names[spin]]
        return found

    def state(self, unknown: Array) -> Array:
        """Return the state of some unknowns, which may be complex."""
        z, pitch, roll, forward, left, yaw_rate = unknown[: len(_BODY)]
        cp, sp, cr, sr = (
            np.cos(0.5 * pitch), np.sin(0.5 * pitch), np.cos(0.5 * roll), np.sin(0.5 * roll),
        )  # fmt: skip
        c, s, k, m = np.cos(pitch), np.sin(pitch), np.cos(roll), np.sin(roll)
        # rotation of the body by pitch about y, then by roll about x
        turn = np.array([[c, s * m, s * k], [0.0 * c, k, -m], [-s, c * m, c * k]])
        omega = turn.T @ np.array([0.0 * yaw_rate, 0.0 * yaw_rate, yaw_rate])
        at = turn.T @ np.array([forward, left, 0.0 * left])
        motion = self._car.motion
        velocity = at - np.cross(omega, motion.reference - motion.center)
        turned = self._headed(forward, left, (cp * cr, cp * sr, sp * cr, -sp * sr))
        found = np.array(self._car.model.design_state, dtype=unknown.dtype)
        found[self._rows] = [z, *turned, *velocity, *omega]
        found[[*self._joints, *self._spin_rates, *self._internal]] = unknown[
            len(_BODY) : -len(_DRIVER)
        ]
        return found

    def _headed(self, forward: Any, left: Any, quaternion: tuple[Any, ...]) -> tuple[Any, ...]:
        """Return the rotation of the body at its yaw angle: on a slope the car moves along x."""
        if not any(self._car.slope):
            return quaternion
        w, x, y, z = quaternion
        # cosine and sine of half the yaw angle, whose tangent is -left / forward; the speed has a
        # square root, since abs is not analytic
        speed = np.sqrt(forward * forward + left * left)
        c = np.sqrt(0.5 + 0.5 * forward / speed)
        s = -0.5 * left / (speed * c)
        return c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w

    def inputs(self, unknown: Array) -> Array:
        """Return the inputs of some unknowns."""
        wheel, drive = unknown[-len(_DRIVER) :]
        return self._car.inputs(wheel, 0.0, 0.0, drive, 0.0)

    def solve(
        self, near: Array, first: SteadyCondition, last: SteadyCondition
    ) -> tuple[Array, Steady]:
        """Return the unknowns, and the motion, that fulfil two conditions, from a first guess.

        Tangents are derivatives in the value of the last condition. If nothing is found, the error
        is a `NoSteadyMotionError`.
        """
        unknown = np.array(near)
        left = self._left(unknown, (first, last))
        for _ in range(_MOST_STEPS):
            slopes = self._slopes(unknown, (first, last))
            try:
                step: Array = -np.linalg.solve(slopes, left).astype(np.float64)
            except np.linalg.LinAlgError:
                break
            unknown, left, part = self._shortened(unknown, left, step, (first, last))
            if np.abs(part * step / np.maximum(1.0, np.abs(unknown))).max() <= _LAST_STEP:
                break
        slopes = self._slopes(unknown, (first, last))
        if not np.abs(left).max() <= _NOTHING * np.abs(slopes).max():
            raise NoSteadyMotionError(f"{last.kind} = {last.value:g}")
        return unknown, self._steady(unknown, slopes)

    def _steady(self, unknown: Array, slopes: Array) -> Steady:
        by_last = np.zeros(len(unknown))
        by_last[-1] = 1.0
        tangent: Array = np.linalg.solve(slopes, by_last).astype(np.float64)
        moved, entered = self._directions(unknown)
        return Steady(
            self._known(unknown),
            self._known(tangent),
            np.asarray(self.state(unknown)),
            self.inputs(unknown),
            tangent,
            moved @ tangent,
            entered @ tangent,
        )

    def _shortened(
        self, unknown: Array, left: Array, step: Array, conditions: Sequence[SteadyCondition]
    ) -> tuple[Array, Array, float]:
        """Return unknowns, residual and part after a step, halved until the residual decreases."""
        part = 1.0
        for _ in range(_HALVINGS):
            moved = unknown + part * step
            try:
                after = self._left(moved, conditions)
            except ModelError:
                part *= 0.5
                continue
            if np.linalg.norm(after) < np.linalg.norm(left):
                return moved, after, part
            part *= 0.5
        return unknown, left, 0.0

    def _known(self, unknown: Array) -> dict[str, float]:
        return {name: float(unknown[self._places[name]]) for name in (*_BODY, *_DRIVER)}

    def _left(self, unknown: Array, conditions: Sequence[SteadyCondition]) -> Array:
        """Return the rates of speeds and deflections, and the residuals of the conditions."""
        rates = self._car.model.evaluate("rhs", self.state(unknown), self.inputs(unknown))
        known = self._known(unknown)
        first = self._car.model.layout.positions
        return np.concatenate([rates[first:], [each.off(known)[0] for each in conditions]])

    def _slopes(self, unknown: Array, conditions: Sequence[SteadyCondition]) -> Array:
        model, state, inputs = self._car.model, self.state(unknown), self.inputs(unknown)
        first = model.layout.positions
        moved, entered = self._directions(unknown)
        found = model.evaluate("rhs_jacobian", state, inputs)[first:] @ moved
        found += model.evaluate("rhs_input_jacobian", state, inputs)[first:] @ entered
        known = self._known(unknown)
        rows = np.zeros((len(conditions), len(unknown)))
        for row, condition in zip(rows, conditions, strict=True):
            for name, slope in condition.off(known)[1].items():
                row[self._places[name]] = slope
        return np.concatenate([found, rows])

    def _directions(self, unknown: Array) -> tuple[Array, Array]:
        """Return the derivatives of state and inputs in the unknowns."""
        moved = np.zeros((len(self._car.model.state_names), len(unknown)))
        for i in range(len(_BODY)):
            ahead = unknown.astype(complex)
            ahead[i] += 1j * _IMAGINARY
            moved[:, i] = np.imag(self.state(ahead)) / _IMAGINARY
        own = [*self._joints, *self._spin_rates, *self._internal]
        for column, row in enumerate(own, len(_BODY)):
            moved[row, column] = 1.0
        entered = np.zeros((len(self._car.model.input_names), len(unknown)))
        for i, far in ((-2, _SMALL), (-1, 1.0)):
            more, less = np.array(unknown), np.array(unknown)
            more[i], less[i] = unknown[i] + far, unknown[i] - far
            entered[:, i] = (self.inputs(more) - self.inputs(less)) / (2.0 * far)
        return moved, entered
