"""Generations of candidates by the genetic algorithm NSGA-II of pymoo.

Source: K. Deb, A. Pratap, S. Agarwal and T. Meyarivan, A fast and elitist multiobjective genetic
algorithm: NSGA-II, IEEE Transactions on Evolutionary Computation 6 (2002), pp. 182-197.
"""

from collections.abc import Callable

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
