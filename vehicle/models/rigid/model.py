"""The equations of motion of a rigid axle, and the positions that it takes."""

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....core.arguments import Arguments, shown
from ....core.errors import InputError
from ....core.named_types import ArrayLike
from ....generated import rigid_axle as equations
from ....systems.allowed import LengthLimit
from ....systems.system import System
from ...corner.corner import Array
from ...corner.wheel_loads import with_wheel_loads
from ..attitudes import attitudes
from ..reach import PositionError
from ..sides import SIDES
from ..swing import GOAL, Seen, march
from .axle import RigidAxle

HEAVE, ROLL = "heave", "roll"
"""The coordinates: height of the middle between the wheels above design [m], inclination [rad]."""

# An axle that is inclined as far stands on its end [rad].
_MOST_ROLL = np.pi / 4.0
# Lengths at design are read from the same numbers [m].
_ROUNDING = 1e-12
# A way is looked at in steps of this travel at most [m].
_STEP = 0.02
_OVERHELD = (
    "[rods] {rods}: an axle on five rods heaves and rolls only as its bushes deflect, and here "
    "rods are rigid. `kintrafo compliance`, with and without --nonlinear, computes its motion on "
    "bushes. For all other analyses leave out one of the rods."
)


class RigidAxleModel(System):
    """The compiled equations of a rigid axle: beam, wheels, springs, dampers, stops and tyres.

    Parameters
    ----------
    axle : RigidAxle, str or Path
        The data, or the name of a packaged data set or path of a TOML file.
    guided : bool, optional
        Of an axle on five rods those of four of them, from which an equilibrium on bushes begins;
        without it such an axle is refused, as it has no motion with rigid rods.
    wheel_loads : bool, optional
        Whether what acts on the wheels are inputs, as in `Model`, after ``right_`` and ``left_``.
        These equations are derived and compiled when they are first needed.

    Attributes
    ----------
    axle : RigidAxle
    parameters, constants, design_state
        As of `System`. The states are ``heave`` [m] and ``roll`` [rad], positive with the left
        wheel up, and the angles of the wheels; signals and inputs of a side begin with ``right_``
        or ``left_``.

    Examples
    --------
    >>> model = RigidAxleModel("rigid_axle")
    >>> model.state_names[:2]
    ('heave', 'roll')
    """

    NEEDED = 'a kintrafo.RigidAxleModel, such as RigidAxleModel("rigid_axle"), is needed'

    def __init__(
        self, axle: RigidAxle | str | Path, *, guided: bool = False, wheel_loads: bool = False
    ) -> None:
        with Arguments("RigidAxleModel") as given:
            guided = given.flag("guided", guided)
            wheel_loads = given.flag("wheel_loads", wheel_loads)
        self.axle, self.wheel_loads = _axle_of(axle), wheel_loads
        if self.axle.overheld and not guided:
            raise InputError([_OVERHELD.format(rods=", ".join(self.axle.rods))], "RigidAxleModel")
        parameters = self.axle.parameters()
        if wheel_loads:
            parameters |= self.axle.wheel_load_parameters()
        super().__init__(with_wheel_loads(equations) if wheel_loads else equations, parameters)

    def __reduce__(self) -> tuple[Any, ...]:
        made = partial(RigidAxleModel, guided=self.axle.overheld, wheel_loads=self.wheel_loads)
        return made, (self.axle,)

    def __repr__(self) -> str:
        return f"<RigidAxleModel of a {self.axle.heading()}>"

    def allowed_lengths(self) -> tuple[LengthLimit, ...]:
        """Return the lengths of the dampers that the file allows."""
        return tuple(
            one._replace(part=f"{side} {one.part}")
            for side in SIDES
            for one in self.axle.damper.allowed_lengths(f"{side}_damper_length")
        )

    # -- positions ------------------------------------------------------------------------------

    def states_at(self, left: ArrayLike, right: ArrayLike) -> Array:
        """Return the states at rest with the wheel centres at some travels.

        Parameters
        ----------
        left, right : array_like
            Heights of the wheel centres above design [m].

        Returns
        -------
        ndarray, shape (..., 8)

        Raises
        ------
        PositionError
            If the axle cannot be there; the message states how far it goes on this way.
        """
        with Arguments("states_at") as given:
            lefts = given.array("left", left, "m", dimensions=[0, 1])
            rights = given.array("right", right, "m", dimensions=[0, 1])
            if lefts.ndim and rights.ndim and lefts.shape != rights.shape:
                given.refuse(
                    f"left has {lefts.size} travels and right {rights.size}: as many are needed."
                )
        lefts, rights = np.broadcast_arrays(lefts, rights)
        parts = self.parts_of_ways(lefts.ravel(), rights.ravel())
        missed = parts < 1.0
        if missed.any():
            # the one that somebody asked for is at the end of a range
            far = np.where(missed, np.maximum(np.abs(lefts), np.abs(rights)).ravel(), -1.0)
            worst = int(far.argmax())
            where = float(lefts.ravel()[worst]), float(rights.ravel()[worst])
            _refuse(*where, float(parts[worst]))
        return self.placed(lefts, rights)

    def placed(self, left: Array, right: Array) -> Array:
        """Return the states at rest with the wheels at some travels, whether it gets there or not.

        Parameters
        ----------
        left, right : ndarray, shape (...)
            Heights of the wheel centres above design [m].

        Returns
        -------
        ndarray, shape (..., 8)
            NaN where no beam is as long as the wheels would be apart.
        """
        states = np.broadcast_to(self.design_state, (*left.shape, self.design_state.size)).copy()
        states[..., self.state_names.index(HEAVE)] = 0.5 * (left + right)
        with np.errstate(invalid="ignore"):
            rolls = np.arcsin(0.5 * (left - right) / self.axle.half_track)
        states[..., self.state_names.index(ROLL)] = rolls
        return states

    def _move(self, states: Array, left: Array, right: Array) -> None:
        """Give states the rates at which the wheels travel so fast [m/s]."""
        with np.errstate(all="ignore"):  # of an axle that is inclined too far
            leaning = np.cos(states[..., self.state_names.index(ROLL)])
            rolling = 0.5 * (left - right) / self.axle.half_track / leaning
        states[..., self.state_names.index(f"{HEAVE}_rate")] = 0.5 * (left + right)
        states[..., self.state_names.index(f"{ROLL}_rate")] = rolling

    def margins(self, states: Array) -> Array:
        """Return what is positive where the axle can be.

        The rods reach, the dampers are as long as the file allows, and the axle is not inclined
        too far.

        Parameters
        ----------
        states : ndarray, shape (..., 8)

        Returns
        -------
        ndarray, shape (..., margins)
            NaN where one before it is not positive.
        """
        rolls = np.abs(states[..., self.state_names.index(ROLL)])
        level = rolls < _MOST_ROLL
        closing = np.full((*level.shape, len(self.equations.GUARDS)), np.nan)
        closing[level] = self.evaluate("margins", states[level])
        closes = (closing > 0.0).all(axis=-1)
        allowed = self.allowed_lengths()
        left = np.full((*level.shape, len(allowed)), np.nan)
        if allowed:
            signals = self.signals(states[closes])
            left[closes] = np.stack([one.left(signals) + _ROUNDING for one in allowed], axis=-1)
        return np.concatenate([closing, left, (_MOST_ROLL - rolls)[..., None]], axis=-1)

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
        with Arguments("farthest") as given:
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

        def look(along: Array, which: NDArray[np.int64]) -> Seen:
            states = self.placed(*(senses[:, which, None] * along))
            self._move(states, *senses[:, which, None])
            margins = self.margins(states)
            fine = np.asarray((margins > 0.0).all(axis=-1))
            stand = attitudes(self, states, None, fine)
            no_limits, even = np.zeros(fine.shape, dtype=int), np.ones(fine.shape)
            return Seen(fine, no_limits, along, even, margins, stand)

        found, limits = march(look, np.zeros(lefts.size), longest, _STEP)
        with np.errstate(invalid="ignore"):
            short = np.minimum(found / longest, np.nextafter(1.0, 0.0))
        return np.where(limits == GOAL, 1.0, short)


def _refuse(left: float, right: float, part: float) -> None:
    """Refuse travels of which the axle can go a part."""
    ends = np.floor(1e5 * part * np.abs([left, right])) / 1e2 * np.sign([left, right])
    message = (
        f"the axle cannot be with its left wheel at {1e3 * left:+g} mm and its right one at "
        f"{1e3 * right:+g} mm from design: on this way it comes to {ends[0]:+.2f} mm and "
        f"{ends[1]:+.2f} mm, where a rod reaches no farther, a damper is at the end of its "
        "length, or the axle is inclined by 45 deg. Choose less."
    )
    raise PositionError(message)


def _axle_of(given: Any) -> RigidAxle:
    if isinstance(given, str | Path):
        return RigidAxle.load(given)
    if isinstance(given, RigidAxle):
        return given
    problem = f"a RigidAxle, a name or a path is needed, not {shown(given)}."
    raise InputError([problem], "RigidAxleModel")
