"""The chapter about targets and limits of characteristics."""

from collections.abc import Sequence

import numpy as np
from matplotlib import rc_context

from ...core.arguments import Arguments
from ...core.quantities import bracketed, display_of
from ...core.tabulated import Tabulated, significant
from ...plots import curves
from ...plots.figures import STYLE
from ...study import characteristics
from ...study.characteristics.datasets import KNOWN
from ...study.sweep import usual_rack, usual_travel
from ...study.variation.goals import Goal, Verdict, judge
from ...suspension.model import Model
from .chapter import Chapter, Picture

_MEANING = (
    "A target is met where it is off by no more than what matters of it, at all of its positions. "
    "Beyond is by how much more the worst position is off."
)


def goals_chapter(model: Model, goals: Sequence[Goal]) -> Chapter:
    """Return which targets and limits a suspension meets, with its curves.

    Parameters
    ----------
    model : Model
    goals : sequence of Goal
        From `kintrafo.variation.goals`; one or more.

    Returns
    -------
    Chapter

    Raises
    ------
    InputError, PositionError
        As of `kintrafo.variation.judge`.
    """
    with Arguments("goals_chapter") as given:
        given.kind("model", model, Model, Model.NEEDED)
        if isinstance(goals, list | tuple) and not goals:
            given.refuse("goals is empty: one target or limit is needed.")
    verdicts = judge(model.suspension, goals)
    met = sum(verdict.met for verdict in verdicts)
    words = (
        f"{met} of {len(verdicts)} are met.",
        _MEANING,
    )
    pictures = [picture for over in KNOWN for picture in _drawn(model, goals, over)]
    return Chapter("Targets and limits", words, (_table(verdicts),), tuple(pictures))


def _drawn(model: Model, goals: Sequence[Goal], over: str) -> list[Picture]:
    """Return the curves that goals are about, over travel or over the rack; none without goals."""
    own = [goal for goal in goals if goal.over == over]
    if not own:
        return []
    at = np.concatenate([goal.at for goal in own])
    if over == "travel":
        dataset = characteristics.travel(model, np.union1d(usual_travel(model), at))
    else:
        dataset = characteristics.steering(model, np.union1d(usual_rack(model), at))
    names = list(dict.fromkeys(goal.name for goal in own))
    with rc_context(STYLE):
        figure = curves.figure(dataset, names, alone=False, goals=goals)
        way = "wheel travel" if over == "travel" else "the rack"
        return [Picture.of(figure, f"Curves over {way} with targets and limits")]


def _table(verdicts: Sequence[Verdict]) -> Tabulated:
    rows = []
    for verdict in verdicts:
        quantity = KNOWN[verdict.over][verdict.name]
        factor = display_of(quantity.attributes()).factor
        over = "rack" if verdict.over == "rack" else "travel"
        rows.append(
            (
                bracketed(quantity.long_name, quantity.attributes()),
                verdict.kind,
                over,
                "met" if verdict.met else "missed",
                "" if verdict.met else significant(factor * verdict.beyond),
                f"{1e3 * verdict.at:g}",
            )
        )
    columns = ("characteristic", "goal", "over", "", "beyond", "worst at [mm]")
    return Tabulated("Which are met", columns, tuple(rows), frozenset({0, 1, 2, 3}))
