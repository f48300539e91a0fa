"""Positions of a suspension: its reachable range, a given wheel height, static equilibrium."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from .errors import KintrafoError
from .generated.macpherson import ClosureError
from .model import Model

Array = NDArray[np.float64]

# Arm angles are searched in steps of this size [rad], up to a right angle from the design position.
_STEP = np.deg2rad(0.5)
_LARGEST_SWING = np.deg2rad(90.0)


class PositionError(KintrafoError, ValueError):
    """A position that the suspension cannot take."""


@dataclass(frozen=True)
class Range:
    """Arm angles over which the wheel height changes monotonically, the design position inside.

    Attributes
    ----------
    arm_angle : tuple of float
        At the lowest and at the highest wheel position [rad].
    height : tuple of float
        Lowest and highest height of the wheel centre [m].
    lower_limit, upper_limit : str
        What ends the range.
    """

    arm_angle: tuple[float, float]
    height: tuple[float, float]
    lower_limit: str
    upper_limit: str


class _Rest:
    """A suspension at rest with its rack held: everything as a function of the arm angle."""

    def __init__(self, model: Model, rack_position: float) -> None:
        self.model = model
        self.rack_position = rack_position
        given = {} if model.free_rack else {"rack_position": rack_position}
        self.inputs = model.inputs(given)

    def state(self, arm_angle: float, spin_rate: float = 0.0) -> Array:
        """Return the state of rest."""
        rack = {"beta9": self.rack_position} if self.model.free_rack else {}
        return self.model.state(beta1=arm_angle, beta5_rate=spin_rate, **rack)

    def height(self, arm_angle: float) -> float:
        """Return the height of the wheel centre [m]."""
        return float(self.model.signal("wheel_center_z", self.state(arm_angle), self.inputs))

    def moment(self, arm_angle: float) -> float:
        """Return the generalised force on the arm [N m]."""
        return float(self.model.evaluate("forces", self.state(arm_angle), self.inputs)[0])


def travel_range(model: Model, rack_position: float = 0.0) -> Range:
    """Return the travel that the wheel can make from the design position.

    Parameters
    ----------
    model : Model
    rack_position : float, optional
        Displacement of the rack [m].

    Returns
    -------
    Range
    """
    rest = _Rest(model, rack_position)
    # beta1 falls as the wheel rises (Eq. 6)
    low, low_limit = _search(rest, +1.0)
    high, high_limit = _search(rest, -1.0)
    return Range((low, high), (rest.height(low), rest.height(high)), low_limit, high_limit)


def _search(rest: _Rest, direction: float) -> tuple[float, str]:
    """Swing the arm until the wheel turns back or a loop cannot close; return the last angle."""
    angle = float(rest.model.design_state[0])
    height = _design_height(rest, angle)
    for _ in range(int(_LARGEST_SWING / _STEP)):
        following = angle + direction * _STEP
        try:
            next_height = rest.height(following)
        except ClosureError as error:
            return angle, "; ".join(error.reasons)
        if (next_height - height) * direction >= 0.0:
            return angle, "the wheel centre turns back there"
        angle, height = following, next_height
    return angle, "the arm has swung by a right angle"


def _design_height(rest: _Rest, angle: float) -> float:
    try:
        return rest.height(angle)
    except ClosureError as error:
        message = (
            f"the rack cannot be at {rest.rack_position * 1e3:g} mm with the control arm in its "
            f"design position: {'; '.join(error.reasons)}. Choose a smaller displacement."
        )
        raise PositionError(message) from error


def state_at_height(
    model: Model, height: float, *, rack_position: float = 0.0, spin_rate: float = 0.0
) -> Array:
    """Return the state of rest with the wheel centre at a given height.

    Parameters
    ----------
    model : Model
    height : float
        Height of the wheel centre, chassis axes [m].
    rack_position : float, optional
        Displacement of the rack [m].
    spin_rate : float, optional
        Rate of the wheel relative to the knuckle, positive rolling forward [rad/s].

    Returns
    -------
    ndarray
        State with zero rates but that of the wheel's spin.

    Raises
    ------
    PositionError
        If the height is out of reach; the message states the range.

    Examples
    --------
    >>> model = Model("reference_car")
    >>> state = state_at_height(model, 0.325)
    >>> round(float(model.design_state[0] - state[0]), 10)
    0.068123601
    """
    rest = _Rest(model, rack_position)
    reach = travel_range(model, rack_position)
    if not reach.height[0] <= height <= reach.height[1]:
        message = (
            f"wheel height {height * 1e3:.6g} mm is out of reach: from "
            f"{reach.height[0] * 1e3:.1f} mm ({reach.lower_limit}) to "
            f"{reach.height[1] * 1e3:.1f} mm ({reach.upper_limit}) with the rack at "
            f"{rack_position * 1e3:g} mm. Choose a height within this range."
        )
        raise PositionError(message)
    angle = _root(lambda a: rest.height(a) - height, *reach.arm_angle)
    return rest.state(angle, spin_rate)


def equilibrium(
    model: Model,
    *,
    rack_position: float = 0.0,
    road_height: float = 0.0,
    strut_force: float = 0.0,
    spin_rate: float = 0.0,
) -> Array:
    """Return the stable state of rest under spring, tyre and weight.

    Parameters
    ----------
    model : Model
    rack_position : float, optional
        Displacement at which the rack is held [m]. With a free rack, what holds it there is minus
        the third generalised force (``forces`` of the compiled module).
    road_height : float, optional
        Height of the road under the tyre [m].
    strut_force : float, optional
        Actuator force in the strut [N].
    spin_rate : float, optional
        Rate of the wheel relative to the knuckle [rad/s].

    Returns
    -------
    ndarray
        State with zero rates but that of the wheel's spin.

    Raises
    ------
    PositionError
        If there is no stable equilibrium within the travel.

    Examples
    --------
    >>> model = Model("reference_car")
    >>> round(float(model.signal("wheel_center_z", equilibrium(model))), 10)
    0.3
    """
    rest = _Rest(model, rack_position)
    names = model.input_names
    rest.inputs[names.index("road_height")] = road_height
    rest.inputs[names.index("strut_force")] = strut_force
    reach = travel_range(model, rack_position)
    grid = np.linspace(*reach.arm_angle, 1 + round(abs(np.subtract(*reach.arm_angle)) / _STEP))
    values = np.array([rest.moment(a) for a in grid])
    # from low to high wheel position beta1 falls, so a stable moment goes from negative to positive
    stable = np.flatnonzero((values[:-1] <= 0.0) & (values[1:] > 0.0))
    if stable.size == 0:
        message = (
            "no stable equilibrium between wheel heights "
            f"{reach.height[0] * 1e3:.1f} mm and {reach.height[1] * 1e3:.1f} mm: the moment about "
            f"the arm's hinge is {values[0]:.4g} N m at the lower and {values[-1]:.4g} N m at the "
            "upper end. Check spring rate, spring_free_slide, tyre rate and free height."
        )
        raise PositionError(message)
    nearest = stable[np.argmin(np.abs(grid[stable] - model.design_state[0]))]
    angle = _root(rest.moment, grid[nearest], grid[nearest + 1])
    return rest.state(angle, spin_rate)


def _root(function: Callable[[float], float], first: float, last: float) -> float:
    """Return the root between two arguments, to the last digits."""
    return float(brentq(function, first, last, xtol=1e-15, rtol=4 * np.finfo(float).eps))
