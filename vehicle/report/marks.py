"""Targets and limits in the charts that move: what is marked in each, and what is in none."""

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
from .grid import Grid, GridAxis

# Positions that are nearer to the end of a chart are in it [m].
_ROUNDING = 1e-9
# Numbers come from display units, and go back to them: what is more is rounding.
_DIGITS = 12


@dataclass(frozen=True)
class Mark:
    """What is marked in a chart of one target, or of one bound of a limit.

    Attributes
    ----------
    kind : {'target', 'least', 'most'}
    at : ndarray, shape (n,)
        Positions [m].
    value : ndarray, shape (n,)
        In SI units.
    within : float
        Of a target: what matters to either side; else 0.
    """

    kind: Literal["target", "least", "most"]
    at: Array
    value: Array
    within: float = 0.0

    def described(self, curve: CharacteristicCurve) -> dict[str, Any]:
        """Return it for the page's script, in the units that are drawn."""
        along = sweep_axis(curve.over).factor
        return {
            "kind": self.kind,
            "at": [_written(along * at) for at in self.at],
            "value": [_written(curve.factor * value) for value in self.value],
            "within": _written(curve.factor * self.within),
        }


@dataclass(frozen=True)
class Marks:
    """Targets and limits on a page.

    Attributes
    ----------
    of : dict of str to list of Mark
        By the key of the curve in whose chart they are.
    beyond : dict of str to list of str
        What lies beyond the ends of a chart, in words, by the same key.
    elsewhere : list of str
        Those of which no chart has anything, in words.
    """

    of: dict[str, list[Mark]]
    beyond: dict[str, list[str]]
    elsewhere: list[str]

    def widened(self, key: str, shown: tuple[float, float]) -> tuple[float, float]:
        """Return between which values a curve is plotted, with what is marked."""
        marked = [m.value + sign * m.within for m in self.of.get(key, ()) for sign in (-1.0, 1.0)]
        every = np.concatenate([np.array(shown), *marked])
        return float(every.min()), float(every.max())

    def about(self, key: str) -> bool:
        """Return whether there is something to be said of a chart."""
        return key in self.of or key in self.beyond

    def kinds(self, key: str) -> list[str]:
        """Return of which sorts a chart has some: target, limit."""
        found = {"target" if m.kind == "target" else "limit" for m in self.of.get(key, ())}
        return sorted(found, reverse=True)


def marks(
    drawn: Sequence[CharacteristicCurve], grid: Grid, goals: Sequence[Goal], side: str
) -> Marks:
    """Return what of targets and limits is marked in the charts of a suspension.

    Parameters
    ----------
    drawn : sequence of CharacteristicCurve
        Those that have a chart.
    grid : Grid
        How far charts go.
    goals : sequence of TargetValue and Limit
        Of the suspension; or of the axle of which it is one side, of which those over parallel
        travel about what a wheel has by itself belong here.
    side : {'left', 'right'}
    """
    found = Marks({}, {}, [])
    keys = {(curve.name, curve.over): curve.key for curve in drawn}
    for goal in goals:
        key = keys.get(_place(goal, side))  # type: ignore[arg-type]
        if key is None:
            found.elsewhere.append(_words(goal))
            continue
        over = "rack" if goal.over == "rack" else "travel"
        inside = _inside(goal.at, grid.rack if over == "rack" else grid.travel)
        if inside.any():
            found.of.setdefault(key, []).extend(_marks(goal, inside))
        if not inside.all():
            at = ", ".join(f"{sweep_axis(goal.over).factor * at:g}" for at in goal.at[~inside])
            words = f"{_kind(goal)} at {at} {sweep_axis(goal.over).unit}".replace("-", "\u2212")
            found.beyond.setdefault(key, []).append(words)
    return found


def of_shown_side(axle: Axle, goals: Sequence[Goal], side: str) -> list[Goal]:
    """Return goals of an axle, those of the other wheel as of the one that its page shows.

    That is where both wheels have one curve in parallel travel, and nothing else is wanted of the
    one that is shown. What is wanted alike of both is there once.

    Parameters
    ----------
    axle : Axle
    goals : sequence of TargetValue and Limit
    side : {'left', 'right'}
        Which is shown.
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
    """Return which characteristics both wheels have alike in parallel travel."""
    curves = over(axle, "bump")
    both = {n: curves[n].values for n in KNOWN["travel"] if n in curves and WHEEL in curves[n].dims}
    return {
        name
        for name, (left, right) in both.items()
        if np.allclose(left, right, rtol=1e-9, atol=1e-12, equal_nan=True)
    }


def _place(goal: Goal, side: str) -> tuple[str, str]:
    """Return name and abscissa of the chart that a goal is about."""
    if goal.over == "bump" and goal.name.endswith(f"_{side}"):
        return goal.name.removesuffix(f"_{side}"), "travel"
    return goal.name, goal.over


def _inside(at: Array, axis: GridAxis) -> NDArray[np.bool_]:
    return (at >= axis.first - _ROUNDING) & (at <= axis.last + _ROUNDING)


def _marks(goal: Goal, inside: NDArray[np.bool_]) -> list[Mark]:
    at = goal.at[inside]
    if isinstance(goal, TargetValue):
        return [Mark("target", at, goal.value[inside], goal.within)]
    assert isinstance(goal, Limit)
    bounds: list[tuple[Literal["least", "most"], float]]
    bounds = [("least", goal.least), ("most", goal.most)]
    return [Mark(kind, at, np.full(at.size, b)) for kind, b in bounds if np.isfinite(b)]


def _kind(goal: Goal) -> str:
    return "target" if isinstance(goal, TargetValue) else "limit"


def _words(goal: Goal) -> str:
    return words_of(_kind(goal), goal.name, goal.over)


def _written(value: float) -> float:
    return float(f"{value:.{_DIGITS}g}") + 0.0
