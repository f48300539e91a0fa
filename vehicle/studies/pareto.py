"""The Pareto front of several objectives by values of the input file."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from ...core.errors import InputError
from ...core.named_types import Array
from ...core.validator import Validator
from .candidates import IMPOSSIBLE, Candidates
from .curves import changed, refuse_bushes
from .design_variables import DesignVariable, amounts
from .evaluation import Subject, check_subject
from .front import check_installed, compromise, evolve, spread, unbeaten
from .goals import Limit, check_data, limits_of, of_columns
from .objectives import Objective, objectives_of
from .search import in_words
from .sweep_axes import sweep_axes_of

MEMBER = "member"
"""Dimension of a front."""

# Members of a generation, and of a front; NSGA-II cannot pair fewer.
_LEAST_MEMBERS, _MOST_MEMBERS = 4, 10_000
# They take some minutes.
_MOST_CARS = 100_000
# With more objectives nearly all cars are on the front, which then has no meaning.
_MOST_OBJECTIVES = 6
# Changes below this part of a number are rounding.
_ROUNDING = 1e-9


@dataclass(frozen=True)
class Front:
    """A Pareto front of suspensions.

    Attributes
    ----------
    dataset : xarray.Dataset
        Over ``member``, numbered from 1: each objective by its name, and each free value by its
        name in the file, in SI units. Members are sorted by the first objective.
    start : Suspension, Axle, RigidAxle or Car
        The given subject.
    before : dict of str to float
        Its objectives, by name, SI units.
    keeps_limits : bool
        Whether it keeps the limits.
    places : tuple of DesignVariable
        The values that may change.
    objectives : tuple of Objective
        The objectives, in the order of `before`.
    limits : tuple of Limit
        The limits, as in `goals`.
    moved : tuple of dict of str to float
        The changes of the values of each member by their names, in display units.
    compromise : int
        The member whose objectives are nearest to the best of each, relative to their ranges over
        the front; 0 for an empty front.
    success : bool
        Whether the front has a member: a suspension that keeps all limits.
    message : str
        Remarks.
    evaluations : int
        Number of evaluated suspensions.
    """

    dataset: xr.Dataset
    start: Subject
    before: dict[str, float]
    keeps_limits: bool
    places: tuple[DesignVariable, ...]
    objectives: tuple[Objective, ...]
    limits: tuple[Limit, ...]
    moved: tuple[dict[str, float], ...]
    compromise: int
    success: bool
    message: str
    evaluations: int

    def suspension(self, member: int) -> Subject:
        """Return the suspension of a member.

        Parameters
        ----------
        member : int
            Number of the member, from 1.

        Returns
        -------
        Suspension

        Raises
        ------
        InputError
            If there is no such member.
        """
        with Validator("pareto") as given:
            if not self.moved:
                given.fail("member: the front has none.")
            else:
                member = given.whole("member", member, most=len(self.moved))
        moved = self.moved[member - 1]
        changes: dict[str, float] = {}
        for place in self.places:
            changes |= place.moved(moved[place.name] * place.to_si)
        return changed(self.start, changes)


def pareto(
    suspension: Subject,
    free: Mapping[str, float],
    targets: Mapping[str, Any] | None = None,
    *,
    minimise: Mapping[str, Any] | None = None,
    maximise: Mapping[str, Any] | None = None,
    limits: Mapping[str, Any] | None = None,
    population: int = 48,
    generations: int = 40,
    seed: int = 1,
    progress: Callable[[float], None] | None = None,
) -> Front:
    """Return the Pareto front of several objectives over some values of the input file.

    Contradictory objectives have no single best suspension. The Pareto front consists of those
    suspensions for which no other one is better in an objective without being worse in another; an
    engineer chooses from them.

    Parameters
    ----------
    suspension : Suspension, Axle, RigidAxle or Car
    free : mapping of str to float
        Values that may change, and their largest changes to either side, as in `optimise`.
    targets : mapping, optional
        As in `optimise`, without ``within``. The root mean square of the deviations from each is an
        objective.
    minimise, maximise : mapping, optional
        By characteristic, a table or a list of tables: ``at_mm``, the positions [mm], and ``over``,
        the motion. The greatest value at these positions is minimised, or the least value
        maximised.
    limits : mapping, optional
        Bounds of characteristics that every suspension keeps.
    population : int, optional
        Number of suspensions in a generation, and largest number of members of the front; four or
        more.
    generations : int, optional
        Number of generations, including the first one.
    seed : int, optional
        Seed of the generator of random numbers: the same front for the same seed.
    progress : callable, optional
        Called with the completed fraction, up to 1.

    Returns
    -------
    Front

    Raises
    ------
    InputError
        If an argument cannot be used, or no free value has an effect on an objective.
    PositionError
        If the given suspension does not reach a position.
    MissingPackageError
        If pymoo is not installed.

    Notes
    -----
    The solver is the genetic algorithm NSGA-II of pymoo. The first generation is the given
    suspension, and a Latin hypercube over the ranges. Suspensions that cannot be built, or do not
    reach a position, are far beyond all limits. The front is that of all evaluated suspensions,
    reduced to the size of a generation if it has more.

    Examples
    --------
    >>> from kintrafo import Suspension, variation
    >>> car = Suspension.load("reference_car")
    >>> found = variation.pareto(
    ...     car,
    ...     free={"hardpoints.tie_rod_inner.z": 20.0},
    ...     targets={"bump_steer": {"value": 0.0}},
    ...     maximise={"toe": {"at_mm": [30.0]}},
    ...     population=8,
    ...     generations=2,
    ... )
    >>> [found.success, *found.before]
    [True, 'bump_steer_deviation', 'toe_least']
    """
    with Validator("pareto") as given:
        check_subject(given, suspension)
        given.function("progress", progress)
        population = given.whole("population", population, least=_LEAST_MEMBERS, most=_MOST_MEMBERS)
        generations = given.whole("generations", generations)
        seed = given.whole("seed", seed, least=0, most=2**32 - 1)
        axes = sweep_axes_of(suspension)
        objectives = objectives_of(
            given,
            suspension,
            _described(given, "targets", targets),
            _described(given, "minimise", minimise),
            _described(given, "maximise", maximise),
        )
        bounds = limits_of(given, _described(given, "limits", limits), axes)
        if not given.failed:
            bounds = of_columns(suspension, bounds)
            _refuse_counts(given, len(objectives), population, generations)
            goals = [*(o.goal for o in objectives), *bounds]
            check_data(given, suspension, goals)
            by_pattern = given.mapping("free", free, "places and numbers")
            reach = amounts(given, suspension, by_pattern, "free")
            refuse_bushes(given, reach, [goal.over for goal in goals])
            if not reach:
                given.fail("free: one value or more is needed.")
    check_installed()
    judge = _Judge(suspension, reach, objectives, bounds, population * generations, progress)
    idle = judge.idle()
    if len(idle) == len(reach):
        problem = f"free: no value has an effect on an objective: {', '.join(idle)}."
        raise InputError([problem], "pareto")
    evolve(judge, _first(population, len(reach), seed), judge.counts, generations, seed)
    return _front(judge, idle, population)


def _described(given: Validator, name: str, value: Any) -> Mapping[Any, Any]:
    return given.mapping(name, {} if value is None else value, "names of characteristics")


def _refuse_counts(given: Validator, objectives: int, population: int, generations: int) -> None:
    if not 2 <= objectives <= _MOST_OBJECTIVES:
        given.fail(
            f"targets, minimise, maximise: they make {objectives} objectives, and 2 to "
            f"{_MOST_OBJECTIVES} are needed. For one there is `kintrafo optimise`; conditions "
            "that must be kept belong to limits."
        )
    if population * generations > _MOST_CARS:
        given.fail(
            f"population = {population}, generations = {generations}: they make "
            f"{population * generations} suspensions, and at most {_MOST_CARS} are allowed."
        )


def _first(population: int, values: int, seed: int) -> Array:
    """Return the first generation: the given suspension, and a Latin hypercube over the ranges."""
    from scipy.stats import qmc  # noqa: PLC0415 (slow to import)

    drawn = qmc.LatinHypercube(values, rng=np.random.default_rng(seed)).random(population)
    first: Array = 2.0 * drawn - 1.0
    first[0] = 0.0
    return first


class _Judge(Candidates):
    """Candidates with objectives and limits, of which a number is expected, and all evaluated."""

    def __init__(
        self,
        suspension: Subject,
        reach: Mapping[DesignVariable, float],
        objectives: list[Objective],
        limits: list[Limit],
        expected: int,
        progress: Callable[[float], None] | None,
    ) -> None:
        super().__init__(suspension, reach, [one.goal for one in objectives], limits)
        self.objectives = tuple(objectives)
        self.seen: list[tuple[Array, Array, Array]] = []
        self._expected, self._progress = expected, progress
        # one more limit, which only impossible suspensions exceed
        self.counts = len(objectives), 1 + sum(limit.at.size * len(limit.sides) for limit in limits)

    def __call__(self, generation: Array) -> tuple[Array, Array]:
        """Return the costs of each candidate, and its excess over the limits."""
        found = []
        self.look_at(generation)
        for x in generation:
            found.append((x, *self.one(x)))
            self.seen.append(found[-1])
            if self._progress is not None:
                self._progress(len(self.seen) / self._expected)
        _, costs, excess = zip(*found, strict=True)
        return np.array(costs), np.array(excess)

    def one(self, x: Array) -> tuple[Array, Array]:
        """Return the costs of a candidate, and its excess over the limits."""
        values = self.values(x)
        if values is None:
            objectives, sides = self.counts
            return np.zeros(objectives), np.full(sides, IMPOSSIBLE)
        pairs = zip(self.objectives, values, strict=False)
        costs = np.array([objective.sign * objective.of(found) for objective, found in pairs])
        return costs, -np.concatenate([np.zeros(1), self.room(x)])

    def idle(self) -> list[str]:
        """Return the names of values without effect from one end of their ranges to the other."""
        here = np.zeros(len(self.places))
        return [
            place.name
            for which, place in enumerate(self.places)
            if _alike([*self.ends(here, which), self.values(here)])
        ]

    def broken(self, x: Array) -> list[str]:
        """Return the names of limits that a candidate exceeds."""
        values = self.values(x)
        pairs = () if values is None else self.of_limits(values)
        return [limit.name for limit, found in pairs if not limit.kept(found).all()]


def _alike(several: list[list[Array] | None]) -> bool:
    """Return whether values of several cars differ by rounding at most; False without values."""
    first, *others = several
    if first is None or any(other is None for other in others):
        return False
    return all(
        np.allclose(a, b, rtol=_ROUNDING, atol=_ROUNDING)
        for other in others
        for a, b in zip(first, other or (), strict=True)
    )


def _front(judge: _Judge, idle: list[str], most: int) -> Front:
    """Return the front of all evaluated candidates."""
    x, costs, excess = (np.array(rows) for rows in zip(*judge.seen, strict=True))
    within = np.flatnonzero((excess <= 0.0).all(axis=1))
    members = within[unbeaten(costs[within])]
    members = members[spread(costs[members], most)] if members.size else members
    signs = np.array([objective.sign for objective in judge.objectives])
    before, _ = judge.one(np.zeros(x.shape[1]))
    nearest = x[int(np.maximum(excess, 0.0).sum(axis=1).argmin())]
    message = _message(judge, x[members], nearest, idle)
    return Front(
        dataset=_dataset(judge, x[members], costs[members] * signs, message),
        start=judge.suspension,
        before=dict(
            zip([o.name for o in judge.objectives], (before * signs).tolist(), strict=True)
        ),
        keeps_limits=not judge.broken(np.zeros(x.shape[1])),
        places=judge.places,
        objectives=judge.objectives,
        limits=judge.limits,
        moved=tuple(judge.moved(member) for member in x[members]),
        compromise=compromise(costs[members]) + 1 if members.size else 0,
        success=bool(members.size),
        message=message,
        evaluations=judge.evaluations,
    )


def _message(judge: _Judge, members: Array, nearest: Array, idle: list[str]) -> str:
    ends = [set(judge.at_the_end(member)) for member in members]
    always = set.intersection(*ends) if ends else set()
    broken = [] if len(members) else judge.broken(nearest)
    lost = [f"{judge.impossible} suspensions"] if judge.impossible else []
    facts = {
        "no suspension keeps all limits, the nearest one not those of": broken,
        "could not be built, or did not reach a position": lost,
        "at the end of its range all along the front": sorted(always),
        "without effect on an objective": idle,
    }
    return "; ".join(part for part in (_size(len(members)), in_words(facts)) if part)


def _size(members: int) -> str:
    if members == 1:
        return "one suspension is the best in every objective"
    return f"{members} suspensions are on the front" if members else ""


def _dataset(judge: _Judge, x: Array, numbers: Array, message: str) -> xr.Dataset:
    data: dict[Any, Any] = {
        objective.name: xr.Variable(MEMBER, numbers[:, which], objective.attributes())
        for which, objective in enumerate(judge.objectives)
    }
    for which, place in enumerate(judge.places):
        values = place.value * place.to_si + x[:, which] * judge.reach[which]
        data[place.name] = xr.Variable(MEMBER, values, place.attributes())
    members = xr.Variable(MEMBER, np.arange(1, len(x) + 1), {"long_name": "member of the front"})
    return xr.Dataset(data, {MEMBER: members}, {"title": "Pareto front", "message": message})
