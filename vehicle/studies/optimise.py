"""Values of the input file that bring characteristics to targets, within limits."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import minimize

from ...core.errors import InputError
from ...core.named_types import Array
from ...core.validator import Validator
from .design_variables import DesignVariable, amounts
from .evaluation import Subject, check_subject
from .goals import Limit, TargetValue, check_data, limits_of, of_columns, targets_of
from .search import (
    ENOUGH,
    MOST_STEPS,
    NOTHING_TO_GAIN,
    TOO_MANY_STEPS,
    MetError,
    Search,
    in_words,
    least,
)
from .sweep_axes import sweep_axes_of

# Cost of a change over the whole range of a value, in deviations that matter: of equal solutions
# the one with the smallest changes is the best.
_RELUCTANCE = ENOUGH
_MET = f"found: all deviations are at most {100 * ENOUGH:g} % of `within`"
# Meanings of SLSQP's exit codes.
_GAVE_UP = {
    4: "the limits exclude each other",
    8: "no step from here improves it",
    9: TOO_MANY_STEPS,
}


@dataclass(frozen=True)
class Optimum:
    """The result of an optimisation.

    Attributes
    ----------
    suspension : Suspension, Axle, RigidAxle or Car
        The subject with the best values.
    start : Suspension, Axle, RigidAxle or Car
        The given subject.
    places : tuple of DesignVariable
        The values that may change.
    moved : dict of str to float
        The change of each value by its name, in the display unit.
    targets : tuple of TargetValue
        The targets, as in `goals`.
    limits : tuple of Limit
        The limits, as in `goals`.
    success : bool
        Whether the solver converged and all limits are kept; targets may be missed.
    message : str
        Broken limits, targets missed by more than ``within``, values at the ends of their ranges or
        without effect; or the note that the search ended at its targets.
    evaluations : int
        Number of evaluated suspensions.
    """

    suspension: Subject
    start: Subject
    places: tuple[DesignVariable, ...]
    moved: dict[str, float]
    targets: tuple[TargetValue, ...]
    limits: tuple[Limit, ...]
    success: bool
    message: str
    evaluations: int


def optimise(
    suspension: Subject,
    free: Mapping[str, float],
    targets: Mapping[str, Any],
    limits: Mapping[str, Any] | None = None,
    *,
    progress: Callable[[float], None] | None = None,
) -> Optimum:
    """Return the suspension whose values bring characteristics to their targets.

    The sum of the squared deviations, each relative to its ``within``, is minimised subject to the
    limits. Of several solutions of equal quality, the one with the smallest changes of values is
    returned.

    Parameters
    ----------
    suspension : Suspension, Axle, RigidAxle or Car
    free : mapping of str to float
        Values that may change, named as in `sensitivity`, and their largest changes to either side,
        in display units (mm, deg, N/m, ...). All other values are constant.
    targets : mapping
        By characteristic, a table or a list of tables: ``at_mm``, the positions [mm]; ``value``,
        the wanted value in the display unit, one for all positions or one for each; ``within``, the
        deviation that counts as one; ``over``, the motion, 'travel' by default. For a file with
        bushes also by the names of `kintrafo.compliance.linear`, with ``held``. Over 'load' also by
        the names of loads, with ``case`` and ``cases``, a load case and the file or dict that has
        it, by default the standard cases. A name without wheel is that of all wheels.
    limits : mapping, optional
        By characteristic, a table or a list of tables: ``at_mm``, ``over``, and the bounds
        ``least`` and ``most`` in the display unit.
    progress : callable, optional
        Called after every step of the solver with the remaining cost, as a fraction of that at the
        start.

    Returns
    -------
    Optimum

    Raises
    ------
    InputError
        If an argument cannot be used, or no free value has an effect on a target.
    PositionError
        If the given suspension does not reach a position.

    Notes
    -----
    The solver is SciPy's ``least_squares`` (trust region, reflected at the bounds), followed by
    SLSQP if limits are not kept. The search ends where all limits are kept and all deviations are
    at most a hundredth of ``within``. Derivatives are differences of neighbours, of a hardpoint
    0.5 mm to either side. A change of a value over its whole range costs a hundredth of ``within``.

    Examples
    --------
    >>> from kintrafo import Suspension, variation
    >>> car = Suspension.load("reference_car")
    >>> found = variation.optimise(
    ...     car,
    ...     free={"hardpoints.tie_rod_inner.z": 20.0},
    ...     targets={"bump_steer": {"at_mm": [0.0], "value": 0.0, "within": 0.001}},
    ... )
    >>> found.success, round(found.moved["hardpoints.tie_rod_inner.z"], 2)
    (True, -5.5)
    """
    with Validator("optimise") as given:
        check_subject(given, suspension)
        given.function("progress", progress)
        axes = sweep_axes_of(suspension)
        aims = targets_of(given, given.mapping("targets", targets, "names and targets"), axes)
        described = given.mapping("limits", {} if limits is None else limits, "names and limits")
        bounds = limits_of(given, described, axes)
        if not given.failed:
            check_data(given, suspension, [*aims, *bounds])
            aims, bounds = of_columns(suspension, aims), of_columns(suspension, bounds)
            by_pattern = given.mapping("free", free, "places and numbers")
            reach = amounts(given, suspension, by_pattern, "free")
            if not reach:
                given.fail("free: one value or more is needed.")
            if not aims:
                given.fail("targets: one or more are needed.")
    search = Search(suspension, reach, aims, bounds, progress, _RELUCTANCE, ENOUGH)
    idle = search.idle(np.zeros(len(reach)))
    if len(idle) == len(reach):
        problem = f"free: no value has an effect on a target: {', '.join(idle)}."
        raise InputError([problem], "optimise")
    try:
        return _optimum(search, *_solved(search), idle)
    except MetError as end:
        return _optimum(search, end.x, "", idle, met=True)


def _solved(search: Search) -> tuple[Array, str]:
    """Return values by SciPy's solvers, and a reason if they did not converge; see `MetError`."""
    start = np.zeros(len(search.places))
    found, gave_up = least(search)
    if not search.limits or (search.room(found) >= 0.0).all():
        return found, gave_up
    # from beyond the limits, and if that fails, from the values of the file
    tried = [_within_limits(search, found)]
    if tried[0][1]:
        tried.append(_within_limits(search, start))
    return min(
        tried, key=lambda t: (t[1] != "", (search.room(t[0]) < 0.0).any(), search.cost(t[0]))
    )


def _within_limits(search: Search, start: Array) -> tuple[Array, str]:
    slsqp: Any = minimize
    found = slsqp(
        search.cost,
        start,
        jac=search.gradient,
        bounds=[(-1.0, 1.0)] * start.size,
        constraints={"type": "ineq", "fun": search.room, "jac": search.room_slopes},
        method="SLSQP",
        options={"maxiter": MOST_STEPS, "ftol": NOTHING_TO_GAIN},
    )
    said = "" if found.success else _GAVE_UP.get(found.status, found.message)
    return np.clip(found.x, -1.0, 1.0), said


def _optimum(
    search: Search, x: Array, gave_up: str, idle: list[str], *, met: bool = False
) -> Optimum:
    """Return the result with its message, from values without effect and the end of the search."""
    values = search.values(x)
    if values is None:
        values = [np.full(goal.at.size, np.nan) for goal in search.goals]
    missed = [
        target.name
        for target, value in zip(search.targets, values, strict=False)
        if not (np.abs(value - target.value) <= target.within).all()
    ]
    broken = [limit.name for limit, own in search.of_limits(values) if not limit.kept(own).all()]
    facts = {
        "the solver gave up": [gave_up] if gave_up else [],
        "not within its limits": broken,
        "targets missed by more than within": missed,
        "at the end of its range": search.at_the_end(x),
        "without effect on a target": search.idle(x, idle) if idle else [],
    }
    return Optimum(
        suspension=search.at(x),
        start=search.suspension,
        places=search.places,
        moved=search.moved(x),
        targets=search.targets,
        limits=search.limits,
        success=not (gave_up or broken),
        message=in_words(facts) or (_MET if met else "found"),
        evaluations=search.evaluations,
    )
