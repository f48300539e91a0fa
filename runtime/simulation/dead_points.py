"""Distance of a motion from dead points, and limits of steps there, for the methods of SciPy.

``native/margins.h`` explains it and does the same for SUNDIALS.
"""

from collections.abc import Mapping
from functools import cache
from types import ModuleType
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from ..core.named_types import Array
from ..equations.errors import ClosureError
from ..systems.system import System
from .trust import ACTS, NOTHING, PART, SINGULAR


@cache
def meanings(equations: ModuleType) -> NDArray[np.int32]:
    """Return bits with the effect of each guard on an integration.

    Bit 1: where the margin is not positive, the right-hand side or the signals refuse a state; in a
    prescribed motion the poses do, too. Bit 2: the right-hand side is singular where the margin is
    zero, and no step may pass over that: the guard determines a branch of poses, or it is the
    square of a divisor of a direction, such as the length of a spring. Such a square touches zero
    and rises again. Pivots of the mass matrix have the first bit only: where one vanishes the
    accelerations grow without bound, which the error control of every method detects.
    """
    return meanings_of(equations.equations.manifest)


def meanings_of(manifest: Mapping[str, Any]) -> NDArray[np.int32]:
    """Return the same for the equations of a manifest."""
    acting = {name: set(function["guards"]) for name, function in manifest["functions"].items()}
    places = acting["positions"] | acting["orientations"]
    found = np.zeros(len(manifest["guards"]), dtype=np.int32)
    rates, signals = acting["rhs"], acting.get("signals", set())
    if manifest["state"]:
        ends, singular = rates | signals, (places | acting["forces"]) & rates
    else:  # the motion is prescribed: its results are poses and signals
        ends, singular = places | signals, places
    for guard in ends:
        found[guard] |= ACTS
    for guard in singular:
        found[guard] |= SINGULAR
    return found


def refuse(model: System, guard: int, state: Array, inputs: Array) -> NoReturn:
    """Raise the error of a guard at whose dead point a motion ends."""
    name, meaning = model.equations.GUARDS[guard]
    margin = float(model.evaluate("margins", state, inputs)[guard])
    values = dict(zip(model.state_names, map(float, state), strict=True))
    values |= zip(model.input_names, map(float, inputs), strict=True)
    where = f"{model.equations.NAME}.rhs"
    units = model.equations.GUARD_UNITS
    described = {**model.equations.STATE, **model.equations.INPUTS}
    raise ClosureError(where, [meaning], {name: margin}, values, (), units, described)


class DeadPoint(Exception):  # noqa: N818 (it ends an integration, and is raised as another error)
    """The motion has reached a dead point of a guard at a time [s], after its last state."""

    def __init__(self, guard: int, time: float, state: Array) -> None:
        self.guard, self.time, self.state = guard, time, state
        super().__init__(guard, time, state)


class Approach:
    """The margins along a motion.

    `inputs_at` returns the array of inputs at a time; `direction` is that of time, plus or minus
    one.
    """

    def __init__(self, model: System, inputs_at: Any, direction: float) -> None:
        self._model, self._inputs_at, self._direction = model, inputs_at, direction
        meaning = meanings(model.equations)
        self._acts, self._singular = (meaning & ACTS) > 0, (meaning & SINGULAR) > 0
        self._greatest = model.usual_margins
        self._layout = model.layout

    def margins(self, time: float, state: Array) -> Array:
        """Return the margins of a state."""
        return self._model.evaluate("margins", state, self._inputs_at(time))

    def crossed(self, margins: Array) -> int | None:
        """Return a guard whose margin must be positive and is not; None if there is none."""
        return _first(self._acts & ~(margins > 0.0))

    def look(self, time: float, state: Array, lapse: float) -> tuple[Array, Array]:
        """Return the margins of a state, and their changes in a short time."""
        lapse *= self._direction
        moved = state.copy()
        now = self.margins(time, state)
        if self.crossed(now) is None:
            moved[: self._layout.positions] += lapse * self._rates(time, state)
        return now, self.margins(time + lapse, moved) - now

    def _rates(self, time: float, state: Array) -> Array:
        """Return the rates of the positions in a state that the model accepts."""
        positions = self._layout.positions
        if self._layout.rates_are_speeds:
            return state[positions : 2 * positions]
        return self._model.evaluate("rhs", state, self._inputs_at(time))[:positions]

    def doubt(self, now: Array, gained: Array, lapse: float, step: float) -> int | None:
        """Return a guard that makes a step untrustworthy; None if there is none."""
        crossed = self.crossed(now)
        if crossed is not None:
            return crossed
        return _first(self._singular & (2.0 * now * lapse < gained * step))

    def longest_step(
        self, now: Array, gained: Array, lapse: float
    ) -> tuple[float, int | None, bool]:
        """Return the length of the next step, the guard that limits it, and if the motion ends."""
        self._greatest = np.maximum(self._greatest, now)
        falling = self._singular & (gained < 0.0)
        if not falling.any():
            return np.inf, None, False
        over = falling & (now <= NOTHING * self._greatest)
        chosen = over if over.any() else falling
        steps = np.full(now.size, np.inf)
        steps[chosen] = -PART * now[chosen] * lapse / gained[chosen]
        nearest = int(np.argmin(steps))
        return float(steps[nearest]), nearest, bool(over.any())


def _first(found: NDArray[np.bool_]) -> int | None:
    places = np.flatnonzero(found)
    return int(places[0]) if places.size else None
