"""SciPy's methods with steps that end before a dead point, and at milestones."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from scipy.integrate import BDF, DOP853, LSODA, RK45, OdeSolver, Radau

from ..core.named_types import Array
from ..equations.errors import ModelError
from .dead_points import Approach, DeadPoint
from .trust import (
    LAPSE,
    LEFT,
    MOST_STUCK,
    NEAR,
    SHORTER,
    SMALLEST_OF_STEP,
    SMALLEST_OF_TIME,
    SMALLEST_PART,
)

_METHODS = {"RK45": RK45, "DOP853": DOP853, "Radau": Radau, "BDF": BDF, "LSODA": LSODA}
# An integration fails if this number of steps together covers less than this part of the whole
# time: 1e11 such steps would be needed. That happens close to a dead point, where the error of a
# step is a rounding error. Steps grow tenfold at most: a first step that is too short costs some
# tens.
_LOOKED_AT_EVERY, _NO_GAIN = 1000, 1e-8
_COUNTS = ("nfev", "njev", "nlu")


@dataclass(frozen=True)
class _Watch:
    """The limits of the steps of a method."""

    approach: Approach
    last_tried: Callable[[], float]
    milestones: Array
    failed: Callable[[Exception], None]


class TooManySteps(Exception):  # noqa: N818 (never leaves the solver)
    """More evaluations than are allowed."""


def watched(
    name: str,
    approach: Approach,
    last_tried: Callable[[], float],
    milestones: Array,
    failed: Callable[[Exception], None],
) -> type[OdeSolver]:
    """Return a method of SciPy whose steps are limited, and taken back, as those of SUNDIALS are.

    `last_tried` returns the time of the last evaluation of the right-hand side; `milestones` are
    times that no step passes over, in the order of the integration [s]. `failed` is called with the
    reason why no further step can be taken: `DeadPoint`, `ModelError` if a state is refused after a
    step of any length, or `TooManySteps`. The class is for ``solve_ivp``, which keeps its results
    until a step fails.
    """
    base: Any = _METHODS[name]
    watch = _Watch(approach, last_tried, milestones, failed)
    return type(f"Watched{name}", (_Steps, base), {"watch": watch})


class _Steps(OdeSolver):
    """Steps that are limited and taken back; the next base class takes them."""

    watch: _Watch
    _trusted: float  # longest next step [s]

    def __init__(self, fun: Any, t0: float, y0: Array, t_bound: float, **options: Any) -> None:
        self._given, self._end, self._options = fun, t_bound, options
        self._goals = [*self.watch.milestones.tolist(), t_bound]
        super().__init__(fun, t0, y0, t_bound, **options)
        self._whole, self._longest, self._stuck = abs(t_bound - t0), 0.0, 0
        self._taken, self._noted = 0, t0
        lapse = SMALLEST_OF_STEP * self._whole
        now, gained = self.watch.approach.look(self.t, self.y, lapse)
        if (beyond := self.watch.approach.crossed(now)) is not None:
            raise DeadPoint(beyond, self.t, self.y)
        self._limit(now, gained, lapse)

    def step(self) -> str | None:
        try:
            return self._trusted_step()
        except (DeadPoint, ModelError, TooManySteps) as error:
            self.watch.failed(error)
            self.status = "failed"
            return str(error)

    def _trusted_step(self) -> str | None:
        """Take a step, or a shorter one until it can be trusted."""
        while True:
            time, state = self.t, self.y
            try:
                message: str | None = self._limited()
            except ModelError:
                self._restart(time, state, abs(self.watch.last_tried() - time))
                continue
            if self.status == "failed":
                return message
            step = abs(self.t - time)
            if self._idle():
                self.status = "failed"
                return "its steps became too small, since the error stays too large"
            lapse = LAPSE * step
            now, gained = self.watch.approach.look(self.t, self.y, lapse)
            guard = self.watch.approach.doubt(now, gained, lapse, step)
            if guard is None:
                self._longest = max(self._longest, step)
                self._limit(now, gained, lapse)
                return message
            if SHORTER * step < self._smallest():
                raise DeadPoint(guard, time, state)
            self._restart(time, state, step)

    def _idle(self) -> bool:
        """Return whether many consecutive steps have covered almost no time."""
        self._taken += 1
        if self._taken % _LOOKED_AT_EVERY:
            return False
        gained, self._noted = abs(self.t - self._noted), self.t
        return gained < _NO_GAIN * self._whole

    def _limited(self) -> str | None:
        """Take a step that is no longer than the trusted length."""
        while len(self._goals) > 1 and self.direction * (self._goals[0] - self.t) <= 0.0:
            del self._goals[0]
        stop = self.t + self.direction * self._trusted
        inside = self.direction * (self._goals[0] - stop) > 0.0
        self._bound(stop if inside else self._goals[0])
        message: str | None = super().step()
        self._bound(self._end)
        if self.status == "finished" and self.direction * (self._end - self.t) > 0.0:
            self.status = "running"
        return message

    def _bound(self, time: float) -> None:
        self.t_bound = time
        if isinstance(self, LSODA):  # it has the time that it must not pass in its workspace
            held: Any = self
            held._lsoda_solver._integrator.rwork[0] = time  # noqa: SLF001 (no other way)

    def _restart(self, time: float, state: Array, step: float) -> None:
        """Start again with a shorter step; raise the present exception if it is too short."""
        step *= SHORTER
        if step < self._smallest():
            raise  # noqa: PLE0704 (called while an error is handled, or after the same check)
        counts = {name: getattr(self, name) for name in _COUNTS}
        options = self._options | {"first_step": step}
        super().__init__(self._given, time, state, self._end, **options)
        for name, count in counts.items():
            setattr(self, name, getattr(self, name) + count)
        if not self.n:  # without a state SciPy ignores the first step
            self._trusted = min(self._trusted, step)

    def _smallest(self) -> float:
        of_time = SMALLEST_OF_TIME * self._whole
        return min(of_time, SMALLEST_OF_STEP * self._longest) if self._longest else of_time

    def _limit(self, now: Array, gained: Array, lapse: float) -> None:
        self._trusted, guard, over = self.watch.approach.longest_step(now, gained, lapse)
        stuck = lapse < LAPSE * self._smallest() and self._trusted < NEAR * self._longest
        self._stuck = self._stuck + 1 if stuck else 0
        over = over or self._stuck >= MOST_STUCK or self._trusted < SMALLEST_PART * abs(self.t)
        if guard is not None and over:
            time = self.t + self.direction * LEFT * self._trusted
            raise DeadPoint(guard, time, self.y)
