"""Steady-state circular driving (ISO 4138), without a simulation.

The branch of steady turns is followed from straight running, in steps of lateral acceleration that
become shorter if a turn is not found, up to the greatest lateral acceleration of a steady turn.
Gradients are the exact tangents of the branch.
"""

from collections.abc import Callable, Sequence
from typing import Any, TypeVar

import numpy as np
import xarray as xr

from ....core.errors import InputError
from ....core.named_types import Array
from ....core.quantities import Display
from ....core.units import KM_PER_H
from ....equations.errors import ModelError
from ...assembly.by_wheel import WHEEL, wheel_coordinate
from ...assembly.quantity import Quantity
from ...models.car.slope import LEVEL, Slope
from ...models.reach import PositionError
from .body_motion import QUANTITIES
from .car import OF_STEERING, STEERED_INPUT, DrivingCar
from .driven import OF_DRIVER, OF_WHEELS, STEER
from .result import HandlingResult, quantity
from .steady import NoSteadyMotionError, Steady, SteadyCondition, SteadyMotion

# Accuracy of the greatest lateral acceleration [m/s^2].
_RESOLVED = 1e-3
# Accuracy of the steepest slope of straight running, as a part of the slope of the road.
_OF_SLOPE = 0.01
# Smallest step from straight running to a turn, as a part of its curvature or steering wheel angle.
_OF_TURN = 0.01
# The part by which the acceleration across the heading may be less than that across the path.
_OF_SIDESLIP = 0.02
# No car on tyres has more lateral acceleration than this [m/s^2].
_MOST = 60.0
# Lateral acceleration at which turns on a given radius begin [m/s^2].
_GENTLE = 0.5
# Speed at which turns of one steering wheel angle begin [m/s], and the factor of its steps.
_SLOW, _FASTER = 2.0, 1.5
# The greatest lateral acceleration of most cars is about this one [m/s^2].
_USUAL = 10.0
_IMAGINARY = 1e-30
# Step of the lateral acceleration in the central difference of a torque: the error is of the second
# power of the step, and rounding is 1e-12 of the forces divided by it [m/s^2].
_STEP = 1e-3
# Steering wheel angle in the difference of the steering ratio [rad].
_SMALL = 1e-4

_PER = "rad s^2/m"
_OF_BODY = ("yaw_rate", "roll_angle", "pitch_angle", "sideslip_angle")
_OF_DRIVER = {
    "steering_wheel_angle": OF_DRIVER["steering_wheel_angle"],
    "steer_angle": ("mean steer angle of the steered wheels, positive to the left", "rad"),
    "travel_speed": ("horizontal speed of the reference point", "m/s"),
    "curvature": ("curvature of the path, positive to the left", "1/m"),
    "drive_torque": OF_DRIVER["drive_torque"],
    "growth": ("growth rate of the least stable small motion, positive unstable", "1/s"),
}
_GRADIENTS = {
    "steering_wheel_gradient": "change of the steering wheel angle by lateral acceleration",
    "roll_gradient": "change of the roll angle by lateral acceleration",
    "sideslip_gradient": "change of the sideslip angle by lateral acceleration",
    "understeer_gradient": "understeer gradient by the steering wheel, positive understeering",
    "understeer_gradient_of_wheels": (
        "understeer gradient by the steered wheels, positive understeering"
    ),
}
_OF_WHEELS = OF_WHEELS | {
    "camber": ("camber to the vertical along the heading, positive with the top outboard", "rad"),
    "steer": STEER,
}
_GRADIENT = "steering_torque_gradient"
_OF_STEERING = {
    "steering_torque": OF_STEERING["steering_torque"],
    _GRADIENT: ("change of the torque of the steering wheel by lateral acceleration", "N m s^2/m"),
    "column_twist": OF_STEERING["column_twist"],
}


def columns_of_turns(wheels: Sequence[str]) -> dict[str, Quantity]:
    """Return the quantities of steady turns by the names of their columns."""
    every = {**_OF_DRIVER, **{name: QUANTITIES[name] for name in _OF_BODY}}
    every |= {name: (words, _PER) for name, words in _GRADIENTS.items()}
    every |= _OF_STEERING
    found = {name: _column(name, *described) for name, described in every.items()}
    by_wheel = [
        _column(name, *words).of_wheel(wheel)
        for name, words in _OF_WHEELS.items()
        for wheel in wheels
    ]
    return found | {each.name: each for each in by_wheel}


def _column(name: str, meaning: str, units: str) -> Quantity:
    shown = quantity((), 0.0, meaning, units).attrs
    display = Display(shown["display_units"], shown["display_factor"])
    return Quantity(name, units, shown["long_name"], "", "", display)


_Found = TypeVar("_Found")


class Turns:
    """The branch of steady turns of a car with one condition in common, followed from turn to turn.

    The sense is 1 for turns to the left, else -1; `reached` is the greatest lateral acceleration
    that was found [m/s^2], `slope` the steepest slope on which straight running was found.
    """

    def __init__(self, car: DrivingCar, first: SteadyCondition, sense: int) -> None:
        self.car, self.first, self.sense = car, first, sense
        self.equations = SteadyMotion(car)
        self.reached, self.slope = 0.0, LEVEL
        self._unknown: Array | None = None
        self._tangent: Array | None = None

    def begin(self, acceleration: float) -> Steady:
        """Return the first turn: straight running at a speed, or a gentle turn.

        A turn at a given radius or steering wheel angle has this lateral acceleration, more than
        zero: a car at standstill has no steady turn [m/s^2].
        If none is found, a `NoSteadyMotionError` is raised; on a slope there is straight running up
        to `slope`.
        """
        straight = self.first.kind == "speed"
        begun = 0.0 if straight else self.sense * acceleration
        last = SteadyCondition("lateral_acceleration", begun)
        if straight:
            near = self._up_the_slope(last)
        elif self.first.kind == "curvature":
            near, _ = self._entered(float(np.sqrt(acceleration / abs(self.first.value))))
        else:
            near, found = self._entered(_SLOW)
            near = self._faster(near, found, acceleration)
        unknown, found = self.equations.solve(near, self.first, last)
        self._unknown, self.reached, self._tangent = unknown, last.value, found.tangent
        return found

    def _up_the_slope(self, last: SteadyCondition) -> Array:
        """Return a guess of straight running: on a slope that of its equations, in steps to it."""
        near, whole = self.equations.near_straight(self.first.value), self.car.slope
        if not any(whole):
            return near
        known = [(0.0, near)]

        def solve(share: float) -> Array:
            slope = Slope(share * whole.grade, share * whole.crossfall)
            there = SteadyMotion(self.car.on_slope(slope))
            at, near = known[-1]
            if len(known) > 2:  # the first one is a guess
                before, less = known[-2]
                near = near + (near - less) * (share - at) / (at - before)
            found, _ = there.solve(near, self.first, last)
            known.append((share, found))
            self.slope = slope
            return found

        return _in_steps(solve, 0.0, 1.0, _OF_SLOPE)

    def _entered(self, speed: float) -> tuple[Array, Steady]:
        """Return the turn at a speed, in steps from straight running to a small circle."""
        at = SteadyCondition("speed", speed)
        near = self.equations.near_straight(speed)

        def solve(share: float) -> tuple[Array, Steady]:
            nonlocal near
            around = SteadyCondition(self.first.kind, share * self.first.value)
            near, found = self.equations.solve(near, at, around)
            return near, found

        solve(0.0)
        _in_steps(solve, 0.0, 0.5, _OF_TURN)
        return _in_steps(solve, 0.5, 1.0, _OF_TURN)

    def _faster(self, near: Array, found: Steady, acceleration: float) -> Array:
        """Return the turn of the same steering wheel angle at about a lateral acceleration."""
        own = abs(found.unknowns["forward"] * found.unknowns["yaw_rate"])
        if own == 0.0:
            raise NoSteadyMotionError("the car goes straight on")
        wanted = _SLOW * float(np.sqrt(acceleration / own))
        speed = _SLOW
        while speed != wanted:
            speed = min(max(wanted, speed / _FASTER), speed * _FASTER)
            near, _ = self.equations.solve(near, self.first, SteadyCondition("speed", speed))
        return near

    def to(self, acceleration: float) -> Steady:
        """Return the turn with a lateral acceleration, beyond those that were found before.

        If there is none, a `NoSteadyMotionError` is raised; turns up to `reached` exist.
        """

        def solve(goal: float) -> Steady:
            unknown, found = self._solve(goal)
            self._unknown, self.reached, self._tangent = unknown, goal, found.tangent
            return found

        return _in_steps(solve, self.reached, acceleration, _RESOLVED)

    def to_speed(self, speed: float) -> Steady:
        """Return the turn at a speed [m/s], if it is another quantity that all have in common.

        If there is none, a `NoSteadyMotionError` is raised.
        """
        # the acceleration by the path is a bound of that across the heading
        near = speed * speed * self.first.value * (1.0 - _OF_SIDESLIP)
        if abs(near) > abs(self.reached):
            self.to(near)
        assert self._unknown is not None
        _, found = self.equations.solve(self._unknown, self.first, SteadyCondition("speed", speed))
        return found

    def _solve(self, acceleration: float) -> tuple[Array, Steady]:
        assert self._unknown is not None
        near = self._unknown
        if self._tangent is not None:
            near = near + self._tangent * (acceleration - self.reached)
        last = SteadyCondition("lateral_acceleration", acceleration)
        return self.equations.solve(near, self.first, last)


def _in_steps(
    solve: Callable[[float], _Found], reached: float, wanted: float, least: float
) -> _Found:
    """Return the solution at a value of a parameter, in steps from a value that was reached.

    Each solution is the first guess of the next one. A step without a solution is halved; below
    `least` it raises a `NoSteadyMotionError`.
    """
    step = abs(wanted - reached)
    while True:
        left = wanted - reached
        goal = float(reached + np.sign(left) * min(step, abs(left)))
        try:
            found = solve(goal)
        except (NoSteadyMotionError, ModelError):
            step *= 0.5
            if step < least:
                raise NoSteadyMotionError(f"{wanted:g}") from None
            continue
        if goal == wanted:
            return found
        reached = goal
        step *= 1.5


def steady_turns(
    car: DrivingCar,
    first: SteadyCondition,
    *,
    sense: int = 1,
    step: float = 0.25,
    wanted: Array | None = None,
    progress: Callable[[float], None] | None = None,
) -> HandlingResult:
    """Return the steady turns of a car by lateral acceleration (ISO 4138), with their gradients.

    All turns have the condition `first` in common: speed, curvature or steering wheel angle. They
    are in steps of lateral acceleration up to the greatest one of a steady turn, or at the wanted
    ones, positive and rising [m/s^2]; `sense` is 1 for turns to the left, else -1. The error of a
    car without such a turn is an `InputError`.
    """
    turns = Turns(car, first, sense)
    asked = step * np.arange(1.0, int(_MOST / step), dtype=np.float64) if wanted is None else wanted
    try:
        slowest = turns.begin(min(float(asked[0]), _GENTLE))
    except NoSteadyMotionError:
        raise InputError([_none(first)], "circle") from None
    found, limit = _followed(turns, {turns.reached: slowest}, asked, progress)
    if wanted is not None:
        found = {a: each for a, each in found.items() if (wanted == abs(a)).any()}
    if not found:
        raise InputError([_beyond(first, limit)], "circle")
    return HandlingResult(*described(turns, slowest, found, limit))


def turns_at(car: DrivingCar, first: SteadyCondition, accelerations: Array) -> xr.Dataset:
    """Return steady turns at lateral accelerations of either sign, as the curves of `steady_turns`.

    The condition `first` has the sign of turns to the left, as positive lateral accelerations, (n,)
    [m/s^2]; at a speed they may be zero. A turn that the tyres do not allow, or a speed that the
    drive does not, is a `PositionError`.
    """
    found: dict[float, Steady] = {}
    slowest: Steady | None = None
    straight = first.kind == "speed"
    if not straight and (accelerations == 0.0).any():
        raise PositionError(
            f"lateral_acceleration: at a {_words(first)} a car without lateral acceleration does "
            "not move. Choose more or less than 0 m/s^2."
        )
    for sense in (1, -1):
        asked = np.unique(sense * accelerations[sense * accelerations > 0.0])
        if not asked.size and not (straight and sense > 0):
            continue
        turns = Turns(car, first.turned(sense), sense)
        try:
            begun = turns.begin(0.0 if straight else min(float(asked[0]), _GENTLE))
        except (NoSteadyMotionError, ModelError):
            raise PositionError(_none(first)) from None
        slowest = slowest or begun
        own, limit = _followed(turns, {turns.reached: begun}, asked, None)
        if np.isfinite(limit):
            raise PositionError(_beyond(first, limit))
        found |= own
        turned = turns
    assert slowest is not None
    _, curves = described(turned, slowest, found, np.nan)
    order = [*found]
    places = [order.index(value) for value in (accelerations + 0.0).tolist()]
    return curves[""].isel(lateral_acceleration=places)


def _followed(
    turns: Turns, found: dict[float, Steady], asked: Array, progress: Callable[[float], None] | None
) -> tuple[dict[float, Steady], float]:
    """Return turns by lateral acceleration, and the greatest one, NaN if all wanted are found."""
    far = min(_USUAL, float(asked[-1])) if asked.size else _USUAL
    for each in asked.tolist():
        if turns.sense * each == turns.reached:
            continue
        try:
            found[turns.sense * each] = turns.to(turns.sense * each)
        except NoSteadyMotionError:
            return found, abs(turns.reached)
        if progress is not None:
            progress(min(each / far, 1.0))
    return found, np.nan


def described(
    turns: Turns, slowest: Steady, found: dict[float, Steady], limit: float
) -> tuple[xr.Dataset, dict[str, xr.Dataset]]:
    """Return the gradients of the first turn, and all curves; the ratio is of the slowest turn."""
    axis, steady = np.array(list(found)), list(found.values())
    of_turns = [_of_turn(turns.car, one) for one in steady]
    values, slopes = (
        {name: np.array([each[which][name] for each in of_turns]) for name in of_turns[0][which]}
        for which in (0, 1)
    )
    ratio = steering_ratio(turns.car, slowest)
    ackermann = turns.car.wheelbase * slopes["curvature"]
    gradients = {
        "steering_wheel_gradient": slopes["steering_wheel_angle"],
        "roll_gradient": slopes["roll_angle"],
        "sideslip_gradient": slopes["sideslip_angle"],
        "understeer_gradient": slopes["steering_wheel_angle"] / ratio - ackermann,
        "understeer_gradient_of_wheels": slopes["steer_angle"] - ackermann,
    }
    along = "lateral_acceleration"
    curves: dict[str, Any] = {
        name: quantity(along, values[name], *words)
        for name, words in (_OF_DRIVER | {n: QUANTITIES[n] for n in _OF_BODY}).items()
    }
    curves |= {
        name: quantity(along, gradients[name], words, _PER) for name, words in _GRADIENTS.items()
    }
    steering = _of_steering(turns.car, steady)
    curves |= {name: quantity(along, steering[name], *_OF_STEERING[name]) for name in steering}
    model, wheels = turns.car.model, turns.car.wheels
    signals = np.array([model.evaluate("signals", one.state, one.inputs) for one in steady]).T
    for name, words in _OF_WHEELS.items():
        rows = signals[turns.car.signal_rows(name, wheels)]
        curves[name] = quantity((WHEEL, along), rows, *words)
    coordinates = {
        along: quantity(along, axis, *QUANTITIES[along]),
        WHEEL: wheel_coordinate(wheels),
    }
    title = f"steady-state circle, {_words(turns.first)}"
    dataset = xr.Dataset(curves, coordinates, {"title": title})
    metrics = {name: quantity((), gradients[name][0], _GRADIENTS[name], _PER) for name in gradients}
    if steering:
        metrics[_GRADIENT] = quantity((), steering[_GRADIENT][0], *_OF_STEERING[_GRADIENT])
    metrics["steering_ratio"] = quantity((), ratio, "overall steering ratio, straight ahead", "1")
    if np.isfinite(limit):  # otherwise there may be turns beyond the last one wanted
        metrics["greatest_lateral_acceleration"] = quantity(
            (), limit, "greatest lateral acceleration of a steady turn", "m/s^2"
        )
    return xr.Dataset(metrics, attrs={"title": title}), {"": dataset}


def _beyond(first: SteadyCondition, limit: float) -> str:
    return (
        f"lateral_acceleration: the tyres of this car carry no steady turn above {limit:.2f} m/s^2 "
        f"at a {_words(first)}. Choose less."
    )


def _none(first: SteadyCondition) -> str:
    return (
        f"there is no steady turn at a {_words(first)}: the steering does not go so far, or the "
        "car is too fast for its drive. Choose a larger radius, or another speed."
    )


def _words(first: SteadyCondition) -> str:
    if first.kind == "speed":
        return f"constant speed of {KM_PER_H * first.value:g} km/h"
    if first.kind == "steering_wheel":
        return f"constant steering wheel angle of {np.rad2deg(abs(first.value)):g} deg"
    return f"constant radius of {abs(1.0 / first.value):g} m"


def _of_turn(car: DrivingCar, steady: Steady) -> tuple[dict[str, float], dict[str, float]]:
    """Return values of a turn, and their derivatives in lateral acceleration."""
    moved = steady.state + 1j * _IMAGINARY * steady.state_slope
    # speeds are constant in the axes of the body
    body = car.motion.of(moved, np.zeros_like(moved))
    body["travel_speed"] = np.sqrt(body["speed"] ** 2 + body["lateral_velocity"] ** 2)
    body["curvature"] = body["yaw_rate"] / body["travel_speed"]
    values = {name: float(np.real(value)) for name, value in body.items()}
    slopes = {name: float(np.imag(value)) / _IMAGINARY for name, value in body.items()}
    values["growth"] = float(car.model.eigenvalues(steady.state, steady.inputs).real.max())
    slopes["growth"] = np.nan
    names = {"steering_wheel_angle": "steering_wheel", "drive_torque": "drive"}
    for name, unknown in names.items():
        values[name] = steady.unknowns[unknown]
        slopes[name] = steady.slopes[unknown]
    rows = car.signal_rows("steer", car.front_wheels)
    signals = car.model.evaluate("signals", steady.state, steady.inputs)[rows]
    by_state = car.model.evaluate("signals_jacobian", steady.state, steady.inputs)[rows]
    by_input = car.model.evaluate("signals_input_jacobian", steady.state, steady.inputs)[rows]
    values["steer_angle"] = float(signals.mean())
    changed = by_state @ steady.state_slope + by_input @ steady.input_slope
    slopes["steer_angle"] = float(changed.mean())
    return values, slopes


def _of_steering(car: DrivingCar, steady: Sequence[Steady]) -> dict[str, Array]:
    """Return `OF_STEERING` and the gradient of the torque; empty without linkages."""
    steps = _STEP * np.array([0.0, 1.0, -1.0])[:, None]
    angles, states, inputs = (
        np.concatenate([np.atleast_1d(value) + steps * slope for value, slope in rows])
        for rows in (
            [
                (one.unknowns["steering_wheel"], np.array([one.slopes["steering_wheel"]]))
                for one in steady
            ],
            [(one.state, one.state_slope) for one in steady],
            [(one.inputs, one.input_slope) for one in steady],
        )
    )
    found = car.of_steering(angles[:, 0], states, inputs)
    if not found:
        return {}
    here, more, less = found["steering_torque"].reshape(-1, 3).T
    twist = {name: values[::3] for name, values in found.items() if name == "column_twist"}
    return twist | {"steering_torque": here, _GRADIENT: (more - less) / (2.0 * _STEP)}


def steering_ratio(car: DrivingCar, steady: Steady) -> float:
    """Return steering wheel angle by steer angle, body and suspensions held in a steady motion."""
    rows = car.signal_rows("steer", car.front_wheels)
    angle = steady.unknowns["steering_wheel"]
    more, less = (car.inputs(angle + d, 0.0, 0.0, 0.0, 0.0) for d in (_SMALL, -_SMALL))
    moved = more - less
    if car.rack_state is None:
        by_input = car.model.evaluate("signals_input_jacobian", steady.state, steady.inputs)[rows]
        return float(2.0 * _SMALL / (by_input @ moved).mean())
    # the rack moves as far as on a rigid column
    by_state = car.model.evaluate("signals_jacobian", steady.state, steady.inputs)[rows]
    by_rack = by_state[:, car.model.state_names.index(car.rack_state)]
    travel = moved[car.model.input_names.index(STEERED_INPUT)]
    return float(2.0 * _SMALL / (by_rack * travel).mean())
