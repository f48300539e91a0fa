"""The Pareto front of candidates with several costs: its search, and its representatives.

Generations of candidates are those of the genetic algorithm NSGA-II of pymoo.

Source: K. Deb, A. Pratap, S. Agarwal and T. Meyarivan, A fast and elitist multiobjective genetic
algorithm: NSGA-II, IEEE Transactions on Evolutionary Computation 6 (2002), pp. 182-197.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ...core.named_types import Array
from ...core.optional import require

_PURPOSE, _EXTRA = "A Pareto front", "pareto"


def check_installed() -> None:
    """Raise an error with the remedy if pymoo is not installed."""
    require("pymoo.algorithms.moo.nsga2", purpose=_PURPOSE, extra=_EXTRA)


def evolve(
    judge: Callable[[Array], tuple[Array, Array]],
    first: Array,
    counts: tuple[int, int],
    generations: int,
    seed: int,
) -> None:
    """Call a function for the candidates of some generations, from (population, values).

    Each value is from -1 to 1. The function returns the costs of candidates, (n, values), and their
    excess over each limit, positive beyond it; `counts` are the numbers of costs and limits.
    """
    nsga2, problems, static, evaluators = (
        require(f"pymoo.{module}", purpose=_PURPOSE, extra=_EXTRA)
        for module in ("algorithms.moo.nsga2", "core.problem", "problems.static", "core.evaluator")
    )
    objectives, limits = counts
    problem = problems.Problem(
        n_var=first.shape[1], n_obj=objectives, n_ieq_constr=limits, xl=-1.0, xu=1.0
    )
    algorithm = nsga2.NSGA2(pop_size=len(first), sampling=first)
    algorithm.setup(problem, termination=("n_gen", generations), seed=seed, verbose=False)
    # candidates are evaluated here, outside pymoo, so that an interruption ends the search at once
    while algorithm.has_next():
        candidates = algorithm.ask()
        if candidates is None:
            return  # pymoo finds no new candidate
        costs, excess = judge(candidates.get("X"))
        evaluators.Evaluator().eval(static.StaticProblem(problem, F=costs, G=excess), candidates)
        algorithm.tell(infills=candidates)


Indices = NDArray[np.intp]


def unbeaten(costs: Array) -> Indices:
    """Return the rows that no other one dominates by being lower in a cost and higher in none.

    Indices are sorted by the first cost, with only the first of equal rows.

    Examples
    --------
    >>> unbeaten(np.array([[3.0, 1.0], [1.0, 2.0], [3.0, 2.0], [1.0, 2.0]])).tolist()
    [1, 0]
    """
    rows, left = np.unique(costs, axis=0, return_index=True)
    found = []
    while left.size:
        # no remaining row is lower in all costs, since rows are sorted
        found.append(left[0])
        better_somewhere = (rows < rows[0]).any(axis=1)
        rows, left = rows[better_somewhere], left[better_somewhere]
    return np.array(found, dtype=np.intp)


def spread(costs: Array, count: int) -> Indices:
    """Return rows that represent a front: the best in each cost, then the farthest from these.

    Indices are ascending, a number of them at most.

    Examples
    --------
    >>> spread(np.array([[0.0, 4.0], [0.1, 3.9], [2.0, 2.0], [4.0, 0.0]]), 3).tolist()
    [0, 2, 3]
    """
    if len(costs) <= count:
        return np.arange(len(costs))
    parts = in_parts(costs)
    chosen = [*dict.fromkeys(map(int, parts.argmin(axis=0)))][:count]
    distances = np.min([np.linalg.norm(parts - parts[i], axis=1) for i in chosen], axis=0)
    while len(chosen) < count:
        chosen.append(int(distances.argmax()))
        distances = np.minimum(distances, np.linalg.norm(parts - parts[chosen[-1]], axis=1))
    return np.array(sorted(chosen))


def compromise(costs: Array) -> int:
    """Return the row nearest to the best of all costs, each relative to its range.

    Examples
    --------
    >>> compromise(np.array([[0.0, 4.0], [1.0, 1.0], [9.0, 0.0]]))
    1
    """
    return int(np.linalg.norm(in_parts(costs), axis=1).argmin())


def in_parts(costs: Array) -> Array:
    """Return costs scaled from 0, the best of a front, to 1, the worst."""
    extent = np.ptp(costs, axis=0)
    return (costs - costs.min(axis=0)) / np.where(extent > 0.0, extent, 1.0)
