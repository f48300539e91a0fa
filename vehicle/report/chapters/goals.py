"""The chapter of targets and limits of characteristics."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ....core.quantities import display_of
from ....core.tabulated import Tabulated, significant
from ....core.validator import Validator
from ...analysis.compliance.flexibility import HELD
from ...assembly.assembly import Assembly
from ...assembly.of import given_assembly
from ...plots.by_axle import by_axle
from ...studies.evaluation import curves_over
from ...studies.goals import Goal, Verdict, judge, of_columns, words_of
from ...studies.sweep_axes import sweep_axis
from .chapter import Chapter, ChapterPicture
from .curves import pictures, positions_of, with_wanted

# With fewer positions curves have corners.
_SMOOTH = 21
_MEANING = (
    "A target is met if its deviation is at most its tolerance (within) at all of its positions. "
    "The column beyond has the further deviation of the worst position."
)


def goals_chapter(subject: Any, goals: Sequence[Goal]) -> Chapter:
    """Return the chapter of targets and limits that a suspension, an axle or a car meets.

    Parameters
    ----------
    subject : Suspension, Model, Axle, RigidAxle or Car
    goals : sequence of Goal
        Result of `kintrafo.variation.goals`; one or more.

    Returns
    -------
    Chapter

    Raises
    ------
    InputError, PositionError
        As from `kintrafo.variation.judge`.
    """
    with Validator("goals_chapter") as given:
        assembly = given_assembly(given, subject, cars=True)
        if isinstance(goals, list | tuple) and not goals:
            given.fail("goals is empty: one target or limit is needed.")
    verdicts = judge(assembly, goals)
    goals = of_columns(assembly, goals)
    missed = sum(not verdict.met for verdict in verdicts)
    words = f"{len(verdicts) - missed} of {len(verdicts)} are met, {missed} missed."
    axes = list(dict.fromkeys(goal.over for goal in goals))
    drawn = [picture for over in axes for picture in _drawn(assembly, goals, over)]
    table = _table(goals, verdicts)
    return Chapter("Targets and limits", (words, _MEANING), (table,), tuple(drawn))


def _drawn(assembly: Assembly, goals: Sequence[Goal], over: str) -> tuple[ChapterPicture, ...]:
    """Return pictures of the curves with goals over an axis."""
    own = [goal for goal in goals if goal.over == over]
    at = positions_of(assembly, over, own)
    if at.size < _SMOOTH:  # turns and rides have few usual ones
        at = np.unique(np.concatenate([at, np.linspace(at[0], at[-1], _SMOOTH)]))
    dataset = curves_over(assembly, over, at)
    dataset = by_axle(dataset) if assembly.axles else dataset
    kind = "Compliance" if over in HELD else "Curves"
    words = f"{kind} over {sweep_axis(over).words} with targets and limits"
    title = f"{words}\n{HELD[over]}" if over in HELD else words
    return pictures(dataset, with_wanted(dataset, (), own), title, words, goals=own)


def _table(goals: Sequence[Goal], verdicts: Sequence[Verdict]) -> Tabulated:
    """Return a table of the verdicts, with few columns for the width of a phone."""
    rows = []
    for goal, verdict in zip(goals, verdicts, strict=True):
        over, factor = sweep_axis(goal.over), display_of(goal.quantity.attributes()).factor
        words, at = words_of(verdict.kind, goal.name, goal.over), over.factor * verdict.at
        excess = "" if verdict.met else significant(factor * verdict.beyond)
        rows.append((words, "met" if verdict.met else "missed", excess, f"{at:g} {over.unit}"))
    columns = ("goal", "", "beyond", "worst at")
    return Tabulated("Which are met", columns, tuple(rows), frozenset({0, 1}))
