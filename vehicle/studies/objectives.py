"""Objectives of a suspension, numbers to minimise or to maximise."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from ...core.named_types import Array
from ...core.quantities import distinct
from ...core.validator import Validator
from .evaluation import Subject
from .goals import Goal, TargetValue, extremes_of, of_columns, targets_of
from .sweep_axes import sweep_axes_of, sweep_axis

Kind = Literal["deviation", "greatest", "least"]

# Words for several positions, and for one.
_WORDS = {"deviation": "deviation of {} (rms)", "greatest": "greatest {}", "least": "least {}"}
_WORDS_OF_ONE = {"deviation": "deviation of {}", "greatest": "{}", "least": "{}"}


@dataclass(frozen=True)
class Objective:
    """A number of a suspension that is minimised or maximised."""

    name: str  # name of the variable in a dataset: ``toe_deviation``
    # 'deviation', the root mean square of deviations from a target, and 'greatest', the greatest
    # value at some positions, are minimised; 'least', the least value, is maximised
    kind: Kind
    goal: Goal  # the characteristic and its positions; a `TargetValue` for a deviation

    def of(self, values: Array) -> float:
        """Return the objective from values of the characteristic, SI units."""
        if isinstance(self.goal, TargetValue):
            return float(np.sqrt(np.mean((values - self.goal.value) ** 2)))
        return float(values.max() if self.kind == "greatest" else values.min())

    @property
    def sign(self) -> float:
        """Factor with which less is better."""
        return -1.0 if self.kind == "least" else 1.0

    def attributes(self) -> dict[str, Any]:
        """Return the attributes of the variable in a dataset."""
        quantity = sweep_axis(self.goal.over).known[self.goal.name]
        several = self.goal.at.size > 1
        words = (_WORDS if several else _WORDS_OF_ONE)[self.kind].format(quantity.long_name)
        own = {
            "long_name": f"{words}{self.goal.over_words}",
            "sign": "" if self.kind == "deviation" else quantity.sign,
            "wanted": "maximised" if self.kind == "least" else "minimised",
        }
        return quantity.attributes() | own


def objectives_of(
    given: Validator,
    suspension: Subject,
    targets: Mapping[str, Any],
    minimise: Mapping[str, Any],
    maximise: Mapping[str, Any],
) -> list[Objective]:
    """Return objectives: deviations from targets, greatest and least values."""
    axes = sweep_axes_of(suspension)
    goals: dict[Kind, Sequence[Goal]] = {
        "deviation": targets_of(given, targets, axes, weighed=False),
        "greatest": extremes_of(given, minimise, "minimise", axes),
        "least": extremes_of(given, maximise, "maximise", axes),
    }
    if not given.failed:
        goals = {kind: of_columns(suspension, several) for kind, several in goals.items()}
    found = [(kind, goal) for kind, several in goals.items() for goal in several]
    overs = [goal.over_words.replace(" the ", " ").replace(" ", "_") for _, goal in found]
    names = distinct([f"{g.name}{over}_{k}" for (k, g), over in zip(found, overs, strict=True)])
    return [Objective(name, kind, goal) for name, (kind, goal) in zip(names, found, strict=True)]
