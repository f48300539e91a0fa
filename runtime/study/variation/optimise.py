"""Values of the input file that bring characteristics to targets, within limits."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares, minimize

from ...core.arguments import Arguments
from ...core.errors import KintrafoError
from ...suspension.kinds import Suspension
from .curves import Together, changed, model_of
from .goals import Limit, Target, check_data, limits_of, targets_of
from .places import Place, amounts
from .sensitivity import step_of

Array = NDArray[np.float64]

# What a suspension that cannot be is worth, in deviations that matter.
_IMPOSSIBLE = 1e6
# What it costs to move a value over all of its range, in deviations that matter: of what does as
# well, that which moves least is taken.
_RELUCTANCE = 0.01
# Part of a limit by which it is kept for sure, whatever rounding does.
_MARGIN = 1e-9
# Steps of the solvers, and the part of the cost below which there is nothing to gain.
_MOST_STEPS = 100
_NOTHING_TO_GAIN = 1e-8
# Nearer to the end of its range than this part of it, a value is at the end.
_AT_THE_END = 1e-6


@dataclass(frozen=True)
class Optimum:
    """What came of an optimisation.

    Attributes
    ----------
    suspension : Suspension
        With the values that were found.
    start : Suspension
        The one that was given.
    places : tuple of Place
        The values that were free, as they were.
    moved : dict of str to float
        By how much each has moved, in the unit for people.
    targets : tuple of Target
    limits : tuple of Limit
    success : bool
        Whether the solver has come to its end and all limits are kept.
    message : str
        What there is to say about it: limits that are not kept, values at the ends of their ranges.
    evaluations : int
        How many suspensions were looked at.
    """

    suspension: Suspension
    start: Suspension
    places: tuple[Place, ...]
    moved: dict[str, float]
    targets: tuple[Target, ...]
    limits: tuple[Limit, ...]
    success: bool
    message: str
    evaluations: int


def optimise(
    suspension: Suspension,
    free: Mapping[str, float],
    targets: Mapping[str, Any],
    limits: Mapping[str, Any] | None = None,
    *,
    progress: Callable[[float], None] | None = None,
) -> Optimum:
    """Move values of the input file until characteristics come to their targets.

    The sum of the squared deviations becomes as small as it can, each in parts of what matters of
    it (``within``); limits are kept. Of several ways that do as well, values move least.

    Parameters
    ----------
    suspension : Suspension
    free : mapping of str to float
        How far values may move to either side, in the unit of the input file for people (mm, deg,
        N/m, ...), by their places as `sensitivity` takes them. Everything else stays.
    targets : mapping
        By characteristic: ``at_mm``, positions; ``value``, one for all or one for each; ``within``,
        a deviation that matters; ``over``, 'travel' or 'rack'. In mm and units for people.
    limits : mapping, optional
        By characteristic: ``at_mm``, ``least``, ``most``, ``over``.
    progress : callable, optional
        Called after every step of the solver with the cost that is left, as a part of that at the
        start.

    Returns
    -------
    Optimum

    Raises
    ------
    InputError
        If an argument cannot be used.
    PositionError
        If the suspension does not reach a position as it is.

    Notes
    -----
    Without limits by SciPy's ``least_squares`` (trust region, reflected at the bounds), with limits
    by SLSQP from there. Derivatives are differences of neighbours, of a hardpoint 0.5 mm to either
    side. Moving a value over all of its range counts as a hundredth of what matters.

    Examples
    --------
    >>> car = Suspension.load("reference_car")
    >>> found = optimise(
    ...     car,
    ...     free={"hardpoints.tie_rod_inner.z": 20.0},
    ...     targets={"bump_steer": {"at_mm": [0.0], "value": 0.0, "within": 0.001}},
    ... )
    >>> found.success, round(found.moved["hardpoints.tie_rod_inner.z"], 2)
    (True, -5.5)
    """
    with Arguments("optimise") as given:
        given.kind("suspension", suspension, Suspension, "a kintrafo.Suspension is needed")
        given.function("progress", progress)
        aims = targets_of(given, given.mapping("targets", targets, "names and targets"))
        bounds = limits_of(
            given, given.mapping("limits", {} if limits is None else limits, "names and limits")
        )
        if not given.refused:
            check_data(given, suspension, [*aims, *bounds])
            by_pattern = given.mapping("free", free, "places and numbers")
            reach = amounts(given, suspension, by_pattern, "range")
            if not reach:
                given.refuse("free: one value or more is needed.")
            if not aims:
                given.refuse("targets: one or more are needed.")
    search = _Search(suspension, reach, aims, bounds)
    search.look_at_the_start()
    found = _solved(search, progress)
    return search.optimum(np.clip(found.x, -1.0, 1.0), ended=found.success, said=found.message)


def _solved(search: "_Search", progress: Callable[[float], None] | None) -> Any:
    """Return what SciPy's solvers say."""
    size = len(search.places)
    begin = search.cost(np.zeros(size)) or 1.0

    def seen(intermediate_result: Any) -> None:
        if progress is not None:
            progress(search.cost(intermediate_result.x) / begin)

    found = least_squares(
        search.deviations,
        np.zeros(size),
        search.slopes,
        bounds=(-1.0, 1.0),
        xtol=_NOTHING_TO_GAIN,
        ftol=_NOTHING_TO_GAIN,
        gtol=_NOTHING_TO_GAIN,
        max_nfev=_MOST_STEPS,
        callback=seen,
    )
    if not search.limits or (search.room(found.x) >= 0.0).all():
        return found
    within_limits: Any = minimize
    return within_limits(
        search.cost,
        found.x,
        jac=search.gradient,
        bounds=[(-1.0, 1.0)] * size,
        constraints={"type": "ineq", "fun": search.room, "jac": search.room_slopes},
        method="SLSQP",
        options={"maxiter": _MOST_STEPS, "ftol": _NOTHING_TO_GAIN},
        callback=seen,
    )


class _Search:
    """Targets and limits as functions of the free values, each from -1 to 1 over its range."""

    def __init__(
        self,
        suspension: Suspension,
        reach: Mapping[Place, float],
        targets: Sequence[Target],
        limits: Sequence[Limit],
    ) -> None:
        self.suspension = suspension
        self.places, self.reach = tuple(reach), np.array([*reach.values()])
        self.targets, self.limits = tuple(targets), tuple(limits)
        self._goals: tuple[Target | Limit, ...] = (*self.targets, *self.limits)
        self._look = Together([goal.curves for goal in self._goals])
        self._values: dict[bytes, list[Array] | None] = {}

    def look_at_the_start(self) -> None:
        """See that the suspension takes the positions as it is."""
        self._look.of(model_of(self.suspension))

    def at(self, x: Array) -> Suspension:
        """Return the suspension with some values."""
        changes: dict[str, float] = {}
        for place, by in zip(self.places, x * self.reach, strict=True):
            changes |= place.moved(float(by))
        return changed(self.suspension, changes)

    def values(self, x: Array) -> list[Array] | None:
        """Return the values of each target and each limit; None where there is no suspension."""
        key = x.tobytes()
        if key not in self._values:
            try:
                self._values[key] = [values[0] for values in self._look.of(model_of(self.at(x)))]
            except KintrafoError:
                self._values[key] = None
        return self._values[key]

    def derivatives(self, x: Array) -> list[Array]:
        """Return the derivatives of what `values` returns; (values, free) for each."""
        columns = [self._difference(x, which) for which in range(x.size)]
        return [np.stack(parts, axis=1) for parts in zip(*columns, strict=True)]

    def _difference(self, x: Array, which: int) -> list[Array]:
        """Return the derivatives by one value, one-sided beside what cannot be."""
        by = np.zeros(x.size)
        by[which] = step_of(self.places[which]) / self.reach[which]
        beside = [(at[which], self.values(at)) for at in (x - by, x, x + by)]
        possible = [(at, values) for at, values in beside if values is not None]
        if len(possible) < 2:
            return [np.zeros(goal.at.size) for goal in self._goals]
        (first, low), (last, high) = possible[0], possible[-1]
        return [np.nan_to_num((b - a) / (last - first)) for a, b in zip(low, high, strict=True)]

    # -- targets ----------------------------------------------------------------------------------

    def deviations(self, x: Array) -> Array:
        """Return the deviations from the targets, in parts of what matters, and what moves cost."""
        values = self.values(x)
        if values is None:
            return np.full(sum(t.at.size for t in self.targets) + x.size, _IMPOSSIBLE)
        pairs = zip(self.targets, values, strict=False)
        missed = [(value - target.value) / target.within for target, value in pairs]
        return np.concatenate([*missed, _RELUCTANCE * x])

    def slopes(self, x: Array) -> Array:
        """Return the derivatives of the deviations."""
        pairs = zip(self.targets, self.derivatives(x), strict=False)
        slopes = [slope / target.within for target, slope in pairs]
        return np.concatenate([*slopes, _RELUCTANCE * np.eye(x.size)])

    def cost(self, x: Array) -> float:
        """Return half of the sum of the squares."""
        missed = self.deviations(x)
        return 0.5 * float(missed @ missed)

    def gradient(self, x: Array) -> Array:
        """Return the derivative of the cost."""
        return self.deviations(x) @ self.slopes(x)

    # -- limits -----------------------------------------------------------------------------------

    def room(self, x: Array) -> Array:
        """Return how much room the limits leave, in parts of their size; negative beyond one."""
        values = self.values(x)
        if values is None:
            sides = (limit.at.size * len(_sides(limit)) for limit in self.limits)
            return np.full(sum(sides), -_IMPOSSIBLE)
        found = values[len(self.targets) :]
        rooms = [
            sign * (value - bound) / _size(limit)
            for limit, value in zip(self.limits, found, strict=True)
            for sign, bound in _sides(limit)
        ]
        return np.concatenate(rooms) - _MARGIN

    def room_slopes(self, x: Array) -> Array:
        """Return the derivatives of the room."""
        found = self.derivatives(x)[len(self.targets) :]
        slopes = [
            sign * slope / _size(limit)
            for limit, slope in zip(self.limits, found, strict=True)
            for sign, _ in _sides(limit)
        ]
        return np.concatenate(slopes)

    # -- result -----------------------------------------------------------------------------------

    def optimum(self, x: Array, *, ended: bool, said: str) -> Optimum:
        """Return what was found in words and numbers."""
        found = (self.values(x) or [])[len(self.targets) :]
        broken = [
            limit.name
            for limit, values in zip(self.limits, found, strict=True)
            if not limit.kept(values).all()
        ]
        at_end = [
            place.name
            for place, part in zip(self.places, x, strict=True)
            if abs(part) > 1.0 - _AT_THE_END
        ]
        words = [] if ended else [f"the solver gave up: {said}"]
        words += [f"not within its limits: {', '.join(broken)}"] if broken else []
        words += [f"at the end of its range: {', '.join(at_end)}"] if at_end else []
        moved = {
            place.name: float(by / place.to_si)
            for place, by in zip(self.places, x * self.reach, strict=True)
        }
        return Optimum(
            suspension=self.at(x),
            start=self.suspension,
            places=self.places,
            moved=moved,
            targets=self.targets,
            limits=self.limits,
            success=bool(ended and not broken),
            message="; ".join(words) or "found",
            evaluations=len(self._values),
        )


def _sides(limit: Limit) -> list[tuple[float, float]]:
    """Return the bounds that a limit has, with the sign of the room beside them."""
    return [(s, b) for s, b in ((1.0, limit.least), (-1.0, limit.most)) if np.isfinite(b)]


def _size(limit: Limit) -> float:
    """Return what a limit is measured by."""
    return max(abs(bound) for _, bound in _sides(limit)) or 1.0
