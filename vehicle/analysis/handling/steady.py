"""Steady motion of a car, straight ahead or along a circle, found without a simulation.

Along a circle on a level road nothing changes but the place, the yaw angle and the angles of the
wheels. Unknown are therefore the height, pitch and roll of the body, the coordinates of the
suspensions, the velocities along and across the heading, the yaw rate, the rates of the wheels, the
deflections of the contacts, and, of the driver, the steering wheel angle and the torque of the
drive. There are as many equations: every speed of the state, in the axes of the body, and every
deflection stays as it is, and two conditions of the driver hold. They are solved by Newton's method
with the exact Jacobian of the equations of motion.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ....core.errors import KintrafoError
from ....core.named_types import Array
from ....equations.errors import ModelError
from .car import DrivingCar

_MOST_STEPS, _HALVINGS = 40, 12
# A step so small, beside 1 in SI units, changes nothing more but rounding.
_LAST_STEP = 1e-11
# Accelerations that are left, beside the greatest slope: rounding of what cancels.
_NOTHING = 1e-9
# Turn of the steering wheel [rad] over which the slope of a ratio is taken.
_SMALL = 1e-4
_IMAGINARY = 1e-30

_BODY = ("height", "pitch", "roll", "forward", "left", "yaw_rate")
_DRIVER = ("steering_wheel", "drive")


class NoSteadyMotionError(KintrafoError):
    """There is no steady motion near where it was looked for."""


@dataclass(frozen=True)
class SteadyCondition:
    """What holds in a steady motion: a value of a function of the unknowns.

    Attributes
    ----------
    kind : str
        ``speed`` [m/s], ``curvature`` [1/m], ``lateral_acceleration`` [m/s^2] or
        ``steering_wheel`` [rad].
    value : float
    """

    kind: str
    value: float

    def turned(self, sense: int) -> "SteadyCondition":
        """Return the condition in turns to the left, sense 1, or to the right, -1."""
        return self if self.kind == "speed" else SteadyCondition(self.kind, sense * self.value)

    def off(self, unknown: Mapping[str, float]) -> tuple[float, dict[str, float]]:
        """Return how far it is from its value, and the derivatives by unknowns."""
        v, w, r = unknown["forward"], unknown["left"], unknown["yaw_rate"]
        size = float(np.hypot(v, w))
        if self.kind == "speed":
            return size - self.value, {"forward": v / size, "left": w / size}
        if self.kind == "curvature":
            slope = -r / size**3
            own = {"forward": slope * v, "left": slope * w, "yaw_rate": 1.0 / size}
            return r / size - self.value, own
        if self.kind == "lateral_acceleration":
            # nothing changes along the heading axes: what is left is their turn
            return v * r - self.value, {"forward": r, "yaw_rate": v}
        return unknown["steering_wheel"] - self.value, {"steering_wheel": 1.0}


@dataclass(frozen=True)
class Steady:
    """A steady motion.

    Attributes
    ----------
    unknowns : dict of str to float
        Of the body and the driver, SI units.
    state, inputs : ndarray
        At yaw angle zero, above the origin of the road.
    slopes : dict of str to float
        How these change with the value of the last condition.
    tangent : ndarray
        How all unknowns do.
    state_slope, input_slope : ndarray
        How state and inputs do.
    """

    unknowns: Mapping[str, float]
    slopes: Mapping[str, float]
    state: Array
    inputs: Array
    tangent: Array
    state_slope: Array
    input_slope: Array


class SteadyMotion:
    """The equations of steady motion of a car.

    Parameters
    ----------
    car : DrivingCar
    """

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
        """Return unknowns to begin with: the rest of the car, rolling."""
        rest = np.asarray(self._car.rest)
        found = np.zeros(len(self._unknown))
        for name, row in zip(("height",), self._rows[:1], strict=True):
            found[self._places[name]] = rest[row]
        e0, e1, e2, e3 = rest[self._rows[1:5]]
        found[self._places["pitch"]] = np.arcsin(2.0 * (e0 * e2 - e3 * e1))
        found[self._places["roll"]] = np.arctan2(2.0 * (e0 * e1 + e2 * e3), 1 - 2 * (e1**2 + e2**2))
        found[self._places["forward"]] = speed
        for row in self._joints:
            found[self._places[self._car.model.state_names[row]]] = rest[row]
        for row, radius in zip(self._spin_rates, self._radii, strict=True):
            found[self._places[self._car.model.state_names[row]]] = speed / radius
        return found

    @cached_property
    def _radii(self) -> list[float]:
        by_spin = dict(zip(self._car.spins, self._car.radii, strict=True))
        return [by_spin[self._car.model.state_names[row]] for row in self._turned]

    def state(self, unknown: Array) -> Array:
        """Return the state of some unknowns, complex ones too."""
        z, pitch, roll, forward, left, yaw_rate = unknown[: len(_BODY)]
        cp, sp, cr, sr = (
            np.cos(0.5 * pitch), np.sin(0.5 * pitch), np.cos(0.5 * roll), np.sin(0.5 * roll),
        )  # fmt: skip
        c, s, k, m = np.cos(pitch), np.sin(pitch), np.cos(roll), np.sin(roll)
        # the axes of the body turn by pitch about y, then by roll about x: its rows in the world
        turn = np.array([[c, s * m, s * k], [0.0 * c, k, -m], [-s, c * m, c * k]])
        omega = turn.T @ np.array([0.0 * yaw_rate, 0.0 * yaw_rate, yaw_rate])
        at = turn.T @ np.array([forward, left, 0.0 * left])
        motion = self._car.motion
        velocity = at - np.cross(omega, motion.reference - motion.center)
        found = np.array(self._car.model.design_state, dtype=unknown.dtype)
        found[self._rows] = [z, cp * cr, cp * sr, sp * cr, -sp * sr, *velocity, *omega]
        found[[*self._joints, *self._spin_rates, *self._internal]] = unknown[
            len(_BODY) : -len(_DRIVER)
        ]
        return found

    def inputs(self, unknown: Array) -> Array:
        """Return the inputs of some unknowns."""
        wheel, drive = unknown[-len(_DRIVER) :]
        return self._car.inputs(wheel, 0.0, 0.0, drive, 0.0)

    def solve(
        self, near: Array, first: SteadyCondition, last: SteadyCondition
    ) -> tuple[Array, Steady]:
        """Return the unknowns, and the motion, that fulfil two conditions.

        Parameters
        ----------
        near : ndarray
            Unknowns to begin with.
        first, last : SteadyCondition
            Tangents are by the value of the last one.

        Raises
        ------
        NoSteadyMotionError
            If there is none near.
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
        """Return where a step leads, halved until it leads nearer; or nowhere."""
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
        """Return the rates of speeds and deflections, and what conditions are off by."""
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
        """Return how state and inputs change with the unknowns."""
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
