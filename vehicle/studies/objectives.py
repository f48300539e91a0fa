"""What of a suspension is to be as small, or as great, as can be: one number for each."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from ...core.named_types import Array
from ...core.quantities import distinct
from ...core.validator import Validator
from .goals import Goal, TargetValue, extremes_of, targets_of
from .sweep_axes import sweep_axis

Kind = Literal["deviation", "greatest", "least"]

# Of several positions, and of one.
_WORDS = {
    "deviation": "deviation of {} (rms)",
    "greatest": "greatest {}",
    "least": "least {}",
}
_WORDS_OF_ONE = {"deviation": "deviation of {}", "greatest": "{}", "least": "{}"}


@dataclass(frozen=True)
class Objective:
    """A number that judges a suspension.

    Attributes
    ----------
    name : str
        Of the variable in a dataset: ``toe_deviation``.
    kind : str
        'deviation', the root mean square of what a target is missed by, and 'greatest', the
        greatest value at some positions, are to be small; 'least', the least value, is to be great.
    goal : Goal
        The goal that it is about; of a deviation a `TargetValue`.
    """

    name: str
    kind: Kind
    goal: Goal

    def of(self, values: Array) -> float:
        """Return the number that some values of the characteristic make; SI units."""
        if isinstance(self.goal, TargetValue):
            return float(np.sqrt(np.mean((values - self.goal.value) ** 2)))
        return float(values.max() if self.kind == "greatest" else values.min())

    @property
    def sign(self) -> float:
        """What the number is multiplied with so that less is better."""
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
    targets: Mapping[str, Any],
    minimise: Mapping[str, Any],
    maximise: Mapping[str, Any],
    ways: Sequence[str],
) -> list[Objective]:
    """Read objectives: deviations from targets, greatest and least values."""
    goals: dict[Kind, Sequence[Goal]] = {
        "deviation": targets_of(given, targets, ways, weighed=False),
        "greatest": extremes_of(given, minimise, "minimise", ways),
        "least": extremes_of(given, maximise, "maximise", ways),
    }
    found = [(kind, goal) for kind, several in goals.items() for goal in several]
    names = distinct([_name(kind, goal) for kind, goal in found])
    return [Objective(name, kind, goal) for name, (kind, goal) in zip(names, found, strict=True)]


def _name(kind: Kind, goal: Goal) -> str:
    return f"{goal.name}{goal.over_words.replace(' the ', ' ').replace(' ', '_')}_{kind}"
