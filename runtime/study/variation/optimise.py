"""Values of the input file that bring characteristics to targets, within limits."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares, minimize

from ...core.arguments import Arguments
from ...core.errors import InputError, KintrafoError
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
_MARGIN = 1e-7
# Steps of the solvers, and the part of the cost below which there is nothing to gain.
_MOST_STEPS = 100
_NOTHING_TO_GAIN = 1e-8
# Nearer to the end of its range than this part of it, a value is at the end.
_AT_THE_END = 1e-6
# A value that changes targets by less than this part of what matters, over its range, is idle.
_IDLE = 1e-6
# What SLSQP's exit codes mean here.
_GAVE_UP = {
    4: "the limits exclude each other",
    8: "no step from here makes it better",
    9: f"no end within {_MOST_STEPS} steps",
}


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
        Whether the solver has come to its end and all limits are kept. Targets may be missed, as
        little as it can be.
    message : str
        What there is to say about it: limits that are not kept, targets that are missed by more
        than what matters, values that are at the ends of their ranges or move nothing.
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
        a deviation that matters; ``over``, 'travel' or 'rack'. In mm and units for people. Or a
        list of several such.
    limits : mapping, optional
        By characteristic: ``at_mm``, ``least``, ``most``, ``over``, or a list of several such.
    progress : callable, optional
        Called after every step of the solver with the cost that is left, as a part of that at the
        start.

    Returns
    -------
    Optimum

    Raises
    ------
    InputError
        If an argument cannot be used, or no free value moves a target.
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
    search = _Search(suspension, reach, aims, bounds, progress)
    idle = search.idle(np.zeros(len(reach)))
    if len(idle) == len(reach):
        raise InputError([f"free: nothing of {', '.join(idle)} moves a target."], "optimise")
    return search.optimum(*_solved(search))


def _solved(search: "_Search") -> tuple[Array, str]:
    """Return the values that SciPy's solvers find, and why they gave up if they did."""
    start = np.zeros(len(search.places))
    found = least_squares(
        search.deviations,
        start,
        search.slopes,
        bounds=(-1.0, 1.0),
        xtol=_NOTHING_TO_GAIN,
        ftol=_NOTHING_TO_GAIN,
        gtol=_NOTHING_TO_GAIN,
        max_nfev=_MOST_STEPS,
    )
    if not search.limits or (search.room(found.x) >= 0.0).all():
        return found.x, "" if found.success else _GAVE_UP[9]
    # from beyond the limits, and where that leads nowhere, from where the file is
    tried = [_within_limits(search, found.x)]
    if tried[0][1]:
        tried.append(_within_limits(search, start))
    return min(
        tried, key=lambda t: (t[1] != "", (search.room(t[0]) < 0.0).any(), search.cost(t[0]))
    )


def _within_limits(search: "_Search", start: Array) -> tuple[Array, str]:
    slsqp: Any = minimize
    found = slsqp(
        search.cost,
        start,
        jac=search.gradient,
        bounds=[(-1.0, 1.0)] * start.size,
        constraints={"type": "ineq", "fun": search.room, "jac": search.room_slopes},
        method="SLSQP",
        options={"maxiter": _MOST_STEPS, "ftol": _NOTHING_TO_GAIN},
    )
    said = "" if found.success else _GAVE_UP.get(found.status, found.message)
    return np.clip(found.x, -1.0, 1.0), said


class _Search:
    """Targets and limits as functions of the free values, each from -1 to 1 over its range."""

    def __init__(
        self,
        suspension: Suspension,
        reach: Mapping[Place, float],
        targets: Sequence[Target],
        limits: Sequence[Limit],
        progress: Callable[[float], None] | None,
    ) -> None:
        self.suspension = suspension
        self.places, self.reach = tuple(reach), np.array([*reach.values()])
        self.targets, self.limits = tuple(targets), tuple(limits)
        self._goals: tuple[Target | Limit, ...] = (*self.targets, *self.limits)
        self._look = Together([goal.curves for goal in self._goals])
        self._values: dict[bytes, list[Array] | None] = {}
        self._progress = progress
        self._begin = self.cost(np.zeros(len(reach))) or 1.0

    def at(self, x: Array) -> Suspension:
        """Return the suspension with some values."""
        changes: dict[str, float] = {}
        for place, by in zip(self.places, x * self.reach, strict=True):
            changes |= place.moved(float(by))
        return changed(self.suspension, changes)

    def values(self, x: Array) -> list[Array] | None:
        """Return the values of each target and each limit; None where there are none."""
        key = x.tobytes()
        if key not in self._values:
            try:
                found = [values[0] for values in self._look.of(model_of(self.at(x)))]
            except KintrafoError:
                found = [np.array(np.nan)]
            finite = all(np.isfinite(values).all() for values in found)
            self._values[key] = found if finite else None
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
        return [(b - a) / (last - first) for a, b in zip(low, high, strict=True)]

    def idle(self, x: Array) -> list[str]:
        """Name the values that move no target, neither here nor from one end to the other."""
        return [
            place.name
            for which, place in enumerate(self.places)
            if not (self._matter(self._difference(x, which)) or self._matter(self._range(x, which)))
        ]

    def _range(self, x: Array, which: int) -> list[Array]:
        """Return by how much everything differs between the ends of the range of a value."""
        ends = np.array([x, x])
        ends[:, which] = -1.0, 1.0
        low, high = (self.values(end) for end in ends)
        if low is None or high is None:
            return [np.zeros(goal.at.size) for goal in self._goals]
        return [b - a for a, b in zip(low, high, strict=True)]

    def _matter(self, changes: Sequence[Array]) -> bool:
        """Tell whether changes of the targets are more than rounding."""
        pairs = zip(self.targets, changes, strict=False)
        return any((np.abs(change) > _IDLE * target.within).any() for target, change in pairs)

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
        """Return the derivatives of the deviations; every step of a solver asks for them once."""
        if self._progress is not None:
            self._progress(self.cost(x) / self._begin)
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

    def optimum(self, x: Array, gave_up: str) -> Optimum:
        """Return what was found in words and numbers."""
        values = self.values(x) or [np.full(goal.at.size, np.nan) for goal in self._goals]
        missed = [
            target.name
            for target, value in zip(self.targets, values, strict=False)
            if not (np.abs(value - target.value) <= target.within).all()
        ]
        broken = [
            limit.name
            for limit, value in zip(self.limits, values[len(self.targets) :], strict=True)
            if not limit.kept(value).all()
        ]
        at_end = [
            place.name
            for place, part in zip(self.places, x, strict=True)
            if abs(part) > 1.0 - _AT_THE_END
        ]
        facts = {
            "the solver gave up": [gave_up] if gave_up else [],
            "not within its limits": broken,
            "further off than what matters": missed,
            "at the end of its range": at_end,
            "moves no target": self.idle(x),
        }
        words = [
            f"{fact}: {', '.join(dict.fromkeys(names))}" for fact, names in facts.items() if names
        ]
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
            success=not (gave_up or broken),
            message="; ".join(words) or "found",
            evaluations=len(self._values),
        )


def _sides(limit: Limit) -> list[tuple[float, float]]:
    """Return the bounds that a limit has, with the sign of the room beside them."""
    return [(s, b) for s, b in ((1.0, limit.least), (-1.0, limit.most)) if np.isfinite(b)]


def _size(limit: Limit) -> float:
    """Return what a limit is measured by."""
    return max(abs(bound) for _, bound in _sides(limit)) or 1.0
