"""The equations of motion of an axle that one file describes, and the positions that it takes."""

from abc import abstractmethod
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ...core.errors import InputError
from ...core.named_types import ArrayLike
from ...core.validator import Validator, shown
from ...systems.allowed import LengthLimit
from ...systems.system import System
from ..corner.corner import Array
from ..corner.wheel_loads import with_wheel_loads
from .attitudes import attitudes
from .reach import PositionError
from .swing import GOAL, PlacesAlong, march
from .whole_axle import WholeAxle

# What turns as far stands on its end [rad].
_MOST_TURN = np.pi / 4.0
# Lengths at design are read from the same numbers [m].
_ROUNDING = 1e-12
# A way is looked at in steps of this travel at most [m].
_STEP = 0.02


class WholeAxleModel(System):
    """The compiled equations of an axle: wheels, springs, dampers, stops and tyres.

    Two states move the wheels up and down; signals and inputs of a side begin with ``right_`` or
    ``left_``.

    Parameters
    ----------
    axle : WholeAxle, str or Path
        The data, or the name of a packaged data set or path of a TOML file.
    wheel_loads : bool, optional
        Whether loads on the wheels are inputs, as in `Model`, after ``right_`` and ``left_``.
        These equations are derived and compiled when they are first needed.

    Attributes
    ----------
    axle : WholeAxle
    parameters, constants, design_state
        As of `System`.
    AXLE : type of WholeAxle
        What it takes.
    EQUATIONS : module
        Those that come with the project.
    COORDINATES : tuple of str
        The states that move the wheels up and down.
    ENDS : str
        What ends a way, in words.
    """

    AXLE: ClassVar[type[WholeAxle]]
    EQUATIONS: ClassVar[ModuleType]
    COORDINATES: ClassVar[tuple[str, str]]
    ENDS: ClassVar[str]

    axle: Any

    def __init__(self, axle: WholeAxle | str | Path, *, wheel_loads: bool = False) -> None:
        with Validator(type(self).__name__) as given:
            wheel_loads = given.flag("wheel_loads", wheel_loads)
        self.axle, self.wheel_loads = self._axle_of(axle), wheel_loads
        self._check()
        parameters = self.axle.parameters()
        if wheel_loads:
            parameters |= self.axle.wheel_load_parameters()
        equations = with_wheel_loads(self.EQUATIONS) if wheel_loads else self.EQUATIONS
        super().__init__(equations, parameters)

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
        """Refuse an axle that these equations do not move."""

    def allowed_lengths(self) -> tuple[LengthLimit, ...]:
        """Return the lengths of the dampers that the file allows."""
        found: tuple[LengthLimit, ...] = self.axle.allowed_lengths()
        return found

    # -- positions ------------------------------------------------------------------------------

    def states_at(self, left: ArrayLike, right: ArrayLike) -> Array:
        """Return the states at rest with the wheel centres at some travels.

        Parameters
        ----------
        left, right : array_like
            Heights of the wheel centres above design [m].

        Returns
        -------
        ndarray, shape (..., states)

        Raises
        ------
        PositionError
            If the axle cannot be there; the message states how far it goes on this way.
        """
        with Validator("states_at") as given:
            lefts = given.array("left", left, "m", dimensions=[0, 1])
            rights = given.array("right", right, "m", dimensions=[0, 1])
            if lefts.ndim and rights.ndim and lefts.shape != rights.shape:
                given.fail(
                    f"left has {lefts.size} travels, right {rights.size}: equal counts are needed."
                )
        lefts, rights = np.broadcast_arrays(lefts, rights)
        parts = self.parts_of_ways(lefts.ravel(), rights.ravel())
        missed = parts < 1.0
        if missed.any():
            # the position asked for is at the end of a range
            far = np.where(missed, np.maximum(np.abs(lefts), np.abs(rights)).ravel(), -1.0)
            worst = int(far.argmax())
            where = float(lefts.ravel()[worst]), float(rights.ravel()[worst])
            self._refuse(*where, float(parts[worst]))
        return self.placed(lefts, rights)

    @abstractmethod
    def placed(self, left: Array, right: Array) -> Array:
        """Return the states at rest with the wheels at some travels, whether it gets there or not.

        Parameters
        ----------
        left, right : ndarray, shape (...)
            Heights of the wheel centres above design [m].

        Returns
        -------
        ndarray, shape (..., states)
            NaN where there is no such position.
        """

    @abstractmethod
    def moved(self, states: Array, left: Array, right: Array) -> Array:
        """Return states with the rates at which the wheels travel so fast [m/s].

        Parameters
        ----------
        states : ndarray, shape (..., states)
        left, right : ndarray
        """

    @abstractmethod
    def turned(self, states: Array) -> Array:
        """Return the largest angle by which it has turned, which is less than 45 deg [rad]."""

    def margins(self, states: Array) -> Array:
        """Return what is positive where the axle can be.

        Loops close, the dampers are as long as the file allows, and nothing has turned too far.

        Parameters
        ----------
        states : ndarray, shape (..., states)

        Returns
        -------
        ndarray, shape (..., margins)
            NaN where one before it is not positive.
        """
        turns = self.turned(states)
        level = turns < _MOST_TURN
        closing = np.full((*level.shape, len(self.equations.GUARDS)), np.nan)
        closing[level] = self.evaluate("margins", states[level])
        closes = (closing > 0.0).all(axis=-1)
        allowed = self.allowed_lengths()
        left = np.full((*level.shape, len(allowed)), np.nan)
        if allowed:
            signals = self.signals(states[closes])
            left[closes] = np.stack([one.left(signals) + _ROUNDING for one in allowed], axis=-1)
        return np.concatenate([closing, left, (_MOST_TURN - turns)[..., None]], axis=-1)

    def farthest(self, left: float, right: float) -> float:
        """Return how much of a way from design the axle can go, straight in the wheels' travels.

        Parameters
        ----------
        left, right : float
            Travels of the wheels at the end of the way [m].

        Returns
        -------
        float
            1 where it comes to the end, less where it does not.
        """
        with Validator("farthest") as given:
            left, right = given.number("left", left, "m"), given.number("right", right, "m")
        return float(self.parts_of_ways(np.array([left]), np.array([right]))[0])

    def parts_of_ways(self, lefts: Array, rights: Array) -> Array:
        """Return how much of each way from design the axle can go, see `farthest`.

        Parameters
        ----------
        lefts, rights : ndarray, shape (n,)
            Travels of the wheels at the ends of the ways [m].

        Returns
        -------
        ndarray, shape (n,)
        """
        longest = np.maximum(np.abs(lefts), np.abs(rights))
        # of a way without length either is none
        senses = np.stack([lefts, rights]) / np.where(longest > 0.0, longest, 1.0)

        def look(along: Array, which: NDArray[np.int64]) -> PlacesAlong:
            states = self.placed(*(senses[:, which, None] * along))
            states = self.moved(states, *senses[:, which, None])
            margins = self.margins(states)
            fine = np.asarray((margins > 0.0).all(axis=-1))
            stand = attitudes(self, states, None, fine)
            no_limits, even = np.zeros(fine.shape, dtype=int), np.ones(fine.shape)
            return PlacesAlong(fine, no_limits, along, even, margins, stand)

        found, limits = march(look, np.zeros(lefts.size), longest, _STEP)
        with np.errstate(invalid="ignore"):
            short = np.minimum(found / longest, np.nextafter(1.0, 0.0))
        return np.where(limits == GOAL, 1.0, short)

    def _refuse(self, left: float, right: float, part: float) -> None:
        """Refuse travels of which the axle can go a part."""
        ends = np.floor(1e5 * part * np.abs([left, right])) / 1e2 * np.sign([left, right])
        message = (
            f"the axle cannot be with its left wheel at {1e3 * left:+g} mm and its right one at "
            f"{1e3 * right:+g} mm from design: on this way it comes to {ends[0]:+.2f} mm and "
            f"{ends[1]:+.2f} mm, where {self.ENDS}. Choose less."
        )
        raise PositionError(message)
