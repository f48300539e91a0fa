"""The equations of motion of an axle without sides, and its positions."""

from abc import abstractmethod
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ...core.errors import InputError
from ...core.named_types import Array, ArrayLike
from ...core.validator import Validator, shown
from ...systems.allowed import LengthLimit
from ...systems.system import System
from ..corner.wheel_loads import with_wheel_loads
from .attitudes import attitudes
from .reach import PositionError
from .swing import GOAL, PlacesAlong, march
from .whole_axle import WholeAxle

# Limit of the rotation of axle or arms from design [rad].
_MOST_TURN = np.pi / 4.0
# Rounding of lengths from the same numbers [m].
_ROUNDING = 1e-12
# Greatest step of travel in the search for the range [m].
_STEP = 0.02


class WholeAxleModel(System):
    """The compiled equations of an axle: wheels, springs, dampers, stops and tyres.

    Two states move the wheels up and down; signals and inputs of a side have the prefix ``right_``
    or ``left_``.

    The axle is given by its data, the name of a packaged data set or the path of a TOML file. With
    `wheel_loads` loads on the wheels are inputs, as in `Model`, with these prefixes; such
    equations are derived and compiled at first use.
    """

    AXLE: ClassVar[type[WholeAxle]]
    EQUATIONS: ClassVar[ModuleType]  # packaged
    COORDINATES: ClassVar[tuple[str, str]]  # the states that move the wheels up and down
    ENDS: ClassVar[str]  # the reasons for the end of the range, for a sentence

    axle: Any

    def __init__(self, axle: WholeAxle | str | Path, *, wheel_loads: bool = False) -> None:
        with Validator(type(self).__name__) as given:
            wheel_loads = given.flag("wheel_loads", wheel_loads)
        self.axle, self.wheel_loads = self._axle_of(axle), wheel_loads
        self._check()
        parameters = self.axle.parameters()
        if wheel_loads:
            parameters |= self.axle.wheel_load_parameters()
        equations = self._equations()
        super().__init__(with_wheel_loads(equations) if wheel_loads else equations, parameters)

    def __reduce__(self) -> tuple[Any, ...]:
        return partial(type(self), wheel_loads=self.wheel_loads), (self.axle,)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of a {self.axle.heading()}>"

    @classmethod
    def _axle_of(cls, given: Any) -> Any:
        if isinstance(given, str | Path):
            return cls.AXLE.load(given)
        if isinstance(given, cls.AXLE):
            return given
        name = cls.AXLE.__name__
        article = "an" if name[0] in "AEIOU" else "a"
        problem = f"{article} {name}, a name or a path is needed, not {shown(given)}."
        raise InputError([problem], cls.__name__)

    def _check(self) -> None:
        """Refuse an axle that these equations do not describe."""

    def _equations(self) -> ModuleType:
        """Return the equations without loads on the wheels as inputs."""
        return self.EQUATIONS

    def allowed_lengths(self) -> tuple[LengthLimit, ...]:
        return self.axle.allowed_lengths()

    # -- positions ------------------------------------------------------------------------------

    def inputs_at(self, rack: ArrayLike, velocity: ArrayLike = 0.0) -> Array:
        """Return inputs with a displacement [m] and velocity [m/s] of the steering, (..., inputs).

        They are zero for wheels that are not steered.
        """
        racks, velocities = np.broadcast_arrays(rack, velocity)
        inputs = np.zeros((*racks.shape, len(self.input_names)))
        if self.axle.steered():
            inputs[..., self.input_names.index("rack_position")] = racks
            inputs[..., self.input_names.index("rack_velocity")] = velocities
        return inputs

    def states_at(self, left: ArrayLike, right: ArrayLike, rack: ArrayLike = 0.0) -> Array:
        """Return the states at rest with the wheel centres at some travels, (..., states).

        Parameters
        ----------
        left, right : array_like
            Heights of the wheel centres above design [m].
        rack : array_like, optional
            Displacement of the steering [m].

        Raises
        ------
        PositionError
            If a position is out of reach; the message states the range in this direction.
        """
        with Validator("states_at") as given:
            lefts = given.array("left", left, "m", dimensions=[0, 1])
            rights = given.array("right", right, "m", dimensions=[0, 1])
            racks = given.array("rack", rack, "m", dimensions=[0, 1])
            if lefts.ndim and rights.ndim and lefts.shape != rights.shape:
                given.fail(
                    f"left has {lefts.size} travels, right {rights.size}: equal counts are needed."
                )
            if not given.failed:
                given.broadcast("travels and rack", [lefts.shape, rights.shape, racks.shape])
        lefts, rights, racks = np.broadcast_arrays(lefts, rights, racks)
        ways = np.stack([lefts.ravel(), rights.ravel(), racks.ravel()])
        parts = self.parts_of_ways(*ways)
        missed = parts < 1.0
        if missed.any():
            # the farthest position, which a caller recognises as the end of its range
            far = np.where(missed, np.abs(ways).max(axis=0), -1.0)
            worst = int(far.argmax())
            self._refuse(ways[:, worst], float(parts[worst]))
        return self.placed(lefts, rights, racks)

    @abstractmethod
    def placed(self, left: Array, right: Array, rack: ArrayLike = 0.0) -> Array:
        """Return the states at rest at wheel travels, reachable or not, (..., states).

        They are NaN if there is no such position.

        Parameters
        ----------
        left, right : ndarray
            Heights of the wheel centres above design [m].
        rack : array_like, optional
            Displacement of the steering [m].
        """

    @abstractmethod
    def moved(self, states: Array, left: Array, right: Array, inputs: Array | None = None) -> Array:
        """Return states with the rates for velocities of the wheels.

        Parameters
        ----------
        states : ndarray, shape (..., states)
        left, right : ndarray
            Vertical velocities of the wheel centres [m/s].
        inputs : ndarray, optional
            With the position and the velocity of the steering.
        """

    def with_rates(self, states: Array, rates: ArrayLike) -> Array:
        """Return a copy of states, (..., states), with rates of both coordinates, (..., 2)."""
        found = states.copy()
        found[..., [self.state_names.index(f"{name}_rate") for name in self.COORDINATES]] = rates
        return found

    @abstractmethod
    def turned(self, states: Array) -> Array:
        """Return the largest rotation of a part from design [rad], which is limited to 45 deg."""

    def margins(self, states: Array, inputs: Array | None = None) -> Array:
        """Return the margins of states, (..., margins), positive within the range.

        They are those of the loops, of the dampers' lengths and of the rotation; NaN after one
        that is not positive.
        """
        turns = self.turned(states)
        level = turns < _MOST_TURN
        acting = self.inputs_at(np.zeros(level.shape)) if inputs is None else inputs
        closing = np.full((*level.shape, len(self.equations.GUARDS)), np.nan)
        closing[level] = self.evaluate("margins", states[level], acting[level])
        closes = (closing > 0.0).all(axis=-1)
        allowed = self.allowed_lengths()
        left = np.full((*level.shape, len(allowed)), np.nan)
        if allowed:
            signals = self.signals(states[closes], acting[closes])
            left[closes] = np.stack([one.left(signals) + _ROUNDING for one in allowed], axis=-1)
        return np.concatenate([closing, left, (_MOST_TURN - turns)[..., None]], axis=-1)

    def farthest(self, left: float, right: float, rack: float = 0.0) -> float:
        """Return the reachable part of a path from design, straight in travels and steering [1].

        Parameters
        ----------
        left, right : float
            Travels of the wheels at the end of the path [m].
        rack : float, optional
            Displacement of the steering at its end [m].

        Returns
        -------
        float
            1 if the end is reachable, otherwise less.
        """
        with Validator("farthest") as given:
            left, right = given.number("left", left, "m"), given.number("right", right, "m")
            rack = given.number("rack", rack, "m")
        return float(self.parts_of_ways(*np.array([[left], [right], [rack]]))[0])

    def parts_of_ways(self, lefts: Array, rights: Array, racks: ArrayLike = 0.0) -> Array:
        """Return the reachable part of each path from design, (n,), see `farthest`.

        Its end has travels of the wheels and a displacement of the steering, (n,) each [m].
        """
        ways = np.stack(np.broadcast_arrays(lefts, rights, racks))
        longest = np.abs(ways).max(axis=0)
        # a path of zero length has no direction
        senses = ways / np.where(longest > 0.0, longest, 1.0)

        def look(along: Array, which: NDArray[np.int64]) -> PlacesAlong:
            left, right, rack = senses[:, which, None]
            inputs = self.inputs_at(rack * along, rack)
            states = self.placed(left * along, right * along, rack * along)
            states = self.moved(states, left, right, inputs)
            margins = self.margins(states, inputs)
            fine = np.asarray((margins > 0.0).all(axis=-1))
            stand = attitudes(self, states, inputs, fine)
            no_limits, even = np.zeros(fine.shape, dtype=int), np.ones(fine.shape)
            return PlacesAlong(fine, no_limits, along, even, margins, stand)

        found, limits = march(look, np.zeros(lefts.size), longest, _STEP)
        with np.errstate(invalid="ignore"):
            short = np.minimum(found / longest, np.nextafter(1.0, 0.0))
        return np.where(limits == GOAL, 1.0, short)

    def _refuse(self, way: Array, part: float) -> None:
        """Refuse travels, and a displacement of the steering, of which a part is reachable."""
        ends = np.floor(1e5 * part * np.abs(way)) / 1e2 * np.sign(way)
        (left, right, rack), steers = 1e3 * way, bool(way[2])
        steered = f", and its steering at {rack:+g} mm" if steers else ""
        to = f", the steering to {ends[2]:+.2f} mm" if steers else ""
        message = (
            f"the axle cannot have its left wheel at {left:+g} mm and its right one at "
            f"{right:+g} mm from design{steered}: the motion ends at {ends[0]:+.2f} mm and "
            f"{ends[1]:+.2f} mm{to}, where {self.ENDS}. Choose less."
        )
        raise PositionError(message)


def solved_for_two(slopes: Array, right: Array) -> Array:
    """Return the solution of two linear equations, (..., 2); not finite if they are singular."""
    (a, b), (c, d) = np.moveaxis(slopes, (-2, -1), (0, 1))
    first, second = np.moveaxis(right, -1, 0)
    whole = (a * d - b * c)[..., None]
    return np.stack([d * first - b * second, a * second - c * first], axis=-1) / whole
