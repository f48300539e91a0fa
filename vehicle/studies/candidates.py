"""Suspensions with some free values, and their characteristics at the positions of goals."""

from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np

from ...core.errors import KintrafoError
from ...core.named_types import Array
from ..assembly.of import assembly_of
from .batch import curves_of_many, moved_by
from .curves import CurveBundle, changed
from .design_variables import DesignVariable
from .evaluation import Subject
from .goals import Goal, Limit

# A value this close to the end of its range, as a part of it, is at the end.
_AT_THE_END = 1e-6
IMPOSSIBLE = 1e6
"""Excess over limits, and deviation in those that matter, of a suspension without values."""


class Candidates:
    """Characteristics as functions of the free values, each from -1 to 1 over its range.

    The range is the largest change of each value to either side [SI].
    """

    def __init__(
        self,
        suspension: Subject,
        reach: Mapping[DesignVariable, float],
        goals: Sequence[Goal],
        limits: Sequence[Limit],
    ) -> None:
        self.suspension = suspension
        self.places, self.reach = tuple(reach), np.array([*reach.values()])
        self.limits, self.goals = tuple(limits), (*goals, *limits)
        self._look = CurveBundle([goal.curves for goal in self.goals])
        self._values: dict[bytes, list[Array] | None] = {}

    def at(self, x: Array) -> Subject:
        """Return the suspension with some values."""
        changes: dict[str, float] = {}
        for place, by in zip(self.places, x * self.reach, strict=True):
            changes |= place.moved(float(by))
        return changed(self.suspension, changes)

    def values(self, x: Array) -> list[Array] | None:
        """Return the values of the characteristic of each goal; None if one has no value."""
        key = x.tobytes()
        if key not in self._values:
            try:
                found = [values[0] for values in self._look.of(assembly_of(self.at(x)))]
            except KintrafoError:
                found = [np.array(np.nan)]
            finite = all(np.isfinite(values).all() for values in found)
            self._values[key] = found if finite else None
        return self._values[key]

    def look_at(self, several: Iterable[Array]) -> None:
        """Evaluate several suspensions together for later calls of `values`."""
        new = {x.tobytes(): x for x in several if x.tobytes() not in self._values}
        if not new:
            return
        moved = moved_by(self.places, np.array([*new.values()]) * self.reach)
        found, _ = curves_of_many(self.suspension, moved, [goal.curves for goal in self.goals])
        for row, key in enumerate(new):
            values = [curves[row, 0] for curves in found]
            finite = all(np.isfinite(one).all() for one in values)
            self._values[key] = values if finite else None

    def of_limits(self, values: Sequence[Array]) -> Iterator[tuple[Limit, Array]]:
        """Return each limit with its part of `values`."""
        return zip(self.limits, values[len(self.goals) - len(self.limits) :], strict=True)

    def room(self, x: Array, margin: float = 0.0) -> Array:
        """Return the distances to the limits less a margin, in parts of their size."""
        values = self.values(x)
        if values is None:
            sides = (limit.at.size * len(limit.sides) for limit in self.limits)
            return np.full(sum(sides), -IMPOSSIBLE)
        rooms = (limit.room(own) for limit, own in self.of_limits(values))
        return np.concatenate([[], *rooms]) - margin

    def ends(self, x: Array, which: int) -> tuple[list[Array] | None, list[Array] | None]:
        """Return `values` at both ends of the range of one free value."""
        ends = np.array([x, x])
        ends[:, which] = -1.0, 1.0
        low, high = (self.values(end) for end in ends)
        return low, high

    @property
    def evaluations(self) -> int:
        """Number of evaluated suspensions."""
        return len(self._values)

    @property
    def impossible(self) -> int:
        """Number of evaluated suspensions that cannot be built, or do not reach a position."""
        return sum(values is None for values in self._values.values())

    def at_the_end(self, x: Array) -> list[str]:
        """Return the names of values at an end of their range."""
        pairs = zip(self.places, x, strict=True)
        return [place.name for place, part in pairs if abs(part) > 1.0 - _AT_THE_END]

    def moved(self, x: Array) -> dict[str, float]:
        """Return the changes of values in display units, by name."""
        pairs = zip(self.places, x * self.reach, strict=True)
        return {place.name: float(by / place.to_si) for place, by in pairs}
