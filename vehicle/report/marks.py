"""Marks of targets and limits in the interactive charts, and the goals without a chart."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ...core.named_types import Array
from ..analysis.characteristics.datasets import KNOWN, over
from ..assembly.by_wheel import WHEEL
from ..models.axle import Axle
from ..models.sides import SIDES
from ..plots.goals import but_name
from ..studies.goals import Goal, Limit, TargetValue, words_of
from ..studies.sweep_axes import sweep_axis
from .curves import CharacteristicCurve
from .grid import Grid

# Positions this close to the end of a chart are in it [m].
_ROUNDING = 1e-9
# Digits of numbers after conversion from display units and back.
_DIGITS = 12


@dataclass(frozen=True)
class Mark:
    """The mark of a target, or of one bound of a limit."""

    kind: Literal["target", "least", "most"]
    at: Array  # positions, (n,) [m]
    value: Array  # in SI units, (n,)
    within: float = 0.0  # tolerance of a target; 0 for a limit

    def described(self, curve: CharacteristicCurve) -> dict[str, Any]:
        """Return the mark for the page's script, in display units."""

        def written(value: float) -> float:
            return float(f"{value:.{_DIGITS}g}") + 0.0

        along = sweep_axis(curve.over).factor
        return {
            "kind": self.kind,
            "at": [written(along * at) for at in self.at],
            "value": [written(curve.factor * value) for value in self.value],
            "within": written(curve.factor * self.within),
        }


@dataclass(frozen=True)
class Marks:
    """Targets and limits on a page."""

    of: dict[str, list[Mark]]  # by the key of the curve
    beyond: dict[str, list[str]]  # words on goals beyond the ends of a chart, by the same key
    elsewhere: list[str]  # words on goals without a chart

    def widened(self, key: str, shown: tuple[float, float]) -> tuple[float, float]:
        """Return the plotted range of a curve, extended to its marks."""
        marked = [m.value + sign * m.within for m in self.of.get(key, ()) for sign in (-1.0, 1.0)]
        every = np.concatenate([np.array(shown), *marked])
        return float(every.min()), float(every.max())

    def about(self, key: str) -> bool:
        """Return whether a chart has goals."""
        return key in self.of or key in self.beyond

    def kinds(self, key: str) -> list[str]:
        """Return the kinds of marks in a chart: target, limit."""
        found = {"target" if m.kind == "target" else "limit" for m in self.of.get(key, ())}
        return sorted(found, reverse=True)


def marks(
    drawn: Sequence[CharacteristicCurve], grid: Grid, goals: Sequence[Goal], side: str
) -> Marks:
    """Return the marks of targets and limits in the charts of a suspension on a side.

    Goals of its axle over parallel travel have charts, if they are of this wheel.
    """
    found = Marks({}, {}, [])
    keys: dict[tuple[str, str], str] = {(curve.name, curve.over): curve.key for curve in drawn}
    for goal in goals:
        place = goal.name, goal.over
        if goal.over == "bump" and goal.name.endswith(f"_{side}"):
            place = goal.name.removesuffix(f"_{side}"), "travel"
        key = keys.get(place)
        if key is None:
            found.elsewhere.append(words_of(goal.KIND, goal.name, goal.over))
            continue
        axis = grid.rack if goal.over == "rack" else grid.travel
        inside = (goal.at >= axis.first - _ROUNDING) & (goal.at <= axis.last + _ROUNDING)
        if inside.any():
            found.of.setdefault(key, []).extend(_marks(goal, inside))
        if not inside.all():
            at = ", ".join(f"{sweep_axis(goal.over).factor * at:g}" for at in goal.at[~inside])
            words = f"{goal.KIND} at {at} {sweep_axis(goal.over).unit}".replace("-", "\u2212")
            found.beyond.setdefault(key, []).append(words)
    return found


def of_shown_side(axle: Axle, goals: Sequence[Goal], side: str) -> list[Goal]:
    """Return goals of an axle with those of the other wheel as goals of the shown one.

    This is for characteristics with the same curve of both wheels in parallel travel, if the shown
    wheel has no other goal. Equal goals of both wheels become one.
    """
    other = next(name for name in SIDES if name != side)
    alike = _alike(axle) if axle.symmetric and goals else set()

    def wanted(stem: str, of: str) -> list[Any]:
        named = f"{stem}_{of}"
        return [but_name(g) for g in goals if (g.name, g.over) == (named, "bump")]

    found = []
    for goal in goals:
        stem = goal.name.removesuffix(f"_{other}")
        if goal.over == "bump" and stem in alike and stem != goal.name:
            own = wanted(stem, side)
            if own == wanted(stem, other):
                continue
            found.append(goal if own else replace(goal, name=f"{stem}_{side}"))
        else:
            found.append(goal)
    return found


def _alike(axle: Axle) -> set[str]:
    """Return the characteristics that are equal for both wheels in parallel travel."""
    curves = over(axle, "bump")
    both = {n: curves[n].values for n in KNOWN["travel"] if n in curves and WHEEL in curves[n].dims}
    return {
        name
        for name, (left, right) in both.items()
        if np.allclose(left, right, rtol=1e-9, atol=1e-12, equal_nan=True)
    }


def _marks(goal: Goal, inside: NDArray[np.bool_]) -> list[Mark]:
    at = goal.at[inside]
    if isinstance(goal, TargetValue):
        return [Mark("target", at, goal.value[inside], goal.within)]
    assert isinstance(goal, Limit)
    bounds: list[tuple[Literal["least", "most"], float]]
    bounds = [("least", goal.least), ("most", goal.most)]
    return [Mark(kind, at, np.full(at.size, b)) for kind, b in bounds if np.isfinite(b)]
