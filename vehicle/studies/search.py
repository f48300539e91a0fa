"""Deviations and limits as functions of values of the input file, for solvers."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from scipy.optimize import least_squares

from ...core.named_types import Array
from .candidates import IMPOSSIBLE, Candidates
from .design_variables import DesignVariable
from .evaluation import Subject
from .goals import Limit, TargetValue
from .sensitivity import step_of

MOST_STEPS, NOTHING_TO_GAIN = 100, 1e-8
"""Most steps of the solvers, and the relative change of the cost at which they stop."""

TOO_MANY_STEPS = f"no end within {MOST_STEPS} steps"

# Margin to a limit against rounding, as a part of it.
_MARGIN = 1e-7
# Deviations below this part of what matters end a search; a change of a value over its whole range
# counts as much.
ENOUGH = 0.01
# Steps from there to smaller changes; each costs one evaluation.
_LAST_STEPS = 3
# A value that changes all targets by less than this part of what matters, over its range, is idle.
_IDLE = 1e-6


class MetError(Exception):
    """Ends a solver where all targets are met and all limits kept."""

    def __init__(self, x: Array) -> None:
        super().__init__(x)
        self.x = x


class Search(Candidates):
    """Targets and limits as functions of the free values, each from -1 to 1 over its range.

    After every step of a solver `progress` is called with the remaining cost, as a part of that at
    the start. The reluctance is the cost of the largest change of a value, in deviations that
    matter. Deviations below the part `enough` of what matters end a solver, by `MetError`; by
    default none is small enough.
    """

    def __init__(
        self,
        suspension: Subject,
        reach: Mapping[DesignVariable, float],
        targets: Sequence[TargetValue],
        limits: Sequence[Limit],
        progress: Callable[[float], None] | None,
        reluctance: float,
        enough: float = -1.0,
    ) -> None:
        super().__init__(suspension, reach, targets, limits)
        self.targets = tuple(targets)
        self._progress, self._reluctance, self._enough = progress, reluctance, enough
        self._slopes: Array | None = None
        self._begin = self.cost(np.zeros(len(reach))) or 1.0

    def derivatives(self, x: Array) -> list[Array]:
        """Return the derivatives of `values`, each of shape (values, free values)."""
        self.look_at(at for which in range(x.size) for at in self._beside(x, which))
        columns = [self._difference(x, which) for which in range(x.size)]
        return [np.stack(parts, axis=1) for parts in zip(*columns, strict=True)]

    def _difference(self, x: Array, which: int) -> list[Array]:
        """Return the derivatives in one value, one-sided if one neighbour has no values."""
        beside = [(at[which], self.values(at)) for at in self._beside(x, which)]
        possible = [(at, values) for at, values in beside if values is not None]
        if len(possible) < 2:
            return [np.zeros(goal.at.size) for goal in self.goals]
        (first, low), (last, high) = possible[0], possible[-1]
        return [(b - a) / (last - first) for a, b in zip(low, high, strict=True)]

    def _beside(self, x: Array, which: int) -> tuple[Array, Array, Array]:
        """Return the free values with one of them less, equal and more by a step."""
        by = np.zeros(x.size)
        by[which] = step_of(self.places[which]) / self.reach[which]
        return x - by, x, x + by

    def idle(self, x: Array, of: Sequence[str] | None = None) -> list[str]:
        """Return the names of all or some values without effect on a target, near and far."""
        asked = [i for i, place in enumerate(self.places) if of is None or place.name in of]
        self.look_at(at for which in asked for at in self._beside(x, which))
        return [
            self.places[which].name
            for which in asked
            if not (self._matter(self._difference(x, which)) or self._matter(self._range(x, which)))
        ]

    def _range(self, x: Array, which: int) -> list[Array]:
        """Return the differences of `values` between the ends of the range of one value."""
        low, high = self.ends(x, which)
        if low is None or high is None:
            return [np.zeros(goal.at.size) for goal in self.goals]
        return [b - a for a, b in zip(low, high, strict=True)]

    def _matter(self, changes: Sequence[Array]) -> bool:
        """Return whether changes of the targets are more than rounding."""
        pairs = zip(self.targets, changes, strict=False)
        return any((np.abs(change) > _IDLE * target.within).any() for target, change in pairs)

    def deviations(self, x: Array) -> Array:
        """Return the deviations from targets, relative to `within`, and the costs of changes."""
        values = self.values(x)
        if values is None:
            return np.full(sum(t.at.size for t in self.targets) + x.size, IMPOSSIBLE)
        pairs = zip(self.targets, values, strict=False)
        missed = [(value - target.value) / target.within for target, value in pairs]
        return np.concatenate([*missed, self._reluctance * x])

    def slopes(self, x: Array) -> Array:
        """Return the derivatives of the deviations; called once in every step of a solver.

        A `MetError` is raised if all deviations are small enough, and all limits are kept.
        """
        if self._is_enough(x):
            raise MetError(self._shorter(x))
        if self._progress is not None:
            self._progress(self.cost(x) / self._begin)
        pairs = zip(self.targets, self.derivatives(x), strict=False)
        slopes = [slope / target.within for target, slope in pairs]
        self._slopes = np.concatenate([*slopes, self._reluctance * np.eye(x.size)])
        return self._slopes

    def _shorter(self, x: Array) -> Array:
        """Return values of equal quality that are moved less: a few steps along known slopes."""
        if self._slopes is None:
            return x
        moved, back = x, np.linalg.pinv(self._slopes)
        for _ in range(_LAST_STEPS):
            moved = np.clip(moved + -back @ self.deviations(moved), -1.0, 1.0)
            if self._is_enough(moved) and np.linalg.norm(moved) < np.linalg.norm(x):
                return moved
        return x

    def _is_enough(self, x: Array) -> bool:
        """Return whether all deviations are small enough, and all limits are kept."""
        missed = self.deviations(x)[: -x.size]
        return bool((np.abs(missed) <= self._enough).all() and (self.room(x) >= 0.0).all())

    def cost(self, x: Array) -> float:
        """Return half of the sum of squared deviations."""
        missed = self.deviations(x)
        return 0.5 * float(missed @ missed)

    def gradient(self, x: Array) -> Array:
        """Return the derivative of the cost."""
        return self.deviations(x) @ self.slopes(x)

    def room(self, x: Array, margin: float = _MARGIN) -> Array:
        return super().room(x, margin)

    def room_slopes(self, x: Array) -> Array:
        """Return the derivatives of the room."""
        slopes = [
            sign * slope / limit.size
            for limit, slope in self.of_limits(self.derivatives(x))
            for sign, _ in limit.sides
        ]
        return np.concatenate(slopes)


def least(search: Search) -> tuple[Array, str]:
    """Return the values of least deviations without limits, and a reason without convergence."""
    found = least_squares(
        search.deviations,
        np.zeros(len(search.places)),
        search.slopes,
        bounds=(-1.0, 1.0),
        xtol=NOTHING_TO_GAIN,
        ftol=NOTHING_TO_GAIN,
        gtol=NOTHING_TO_GAIN,
        max_nfev=MOST_STEPS,
    )
    return found.x, "" if found.success else TOO_MANY_STEPS


def in_words(facts: Mapping[str, Sequence[str]]) -> str:
    """Return facts with their names, without facts that have none."""
    lines = [f"{fact}: {', '.join(dict.fromkeys(names))}" for fact, names in facts.items() if names]
    return "; ".join(lines)
