"""Paths on a level road, and lanes between cones."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy.interpolate import CubicSpline, PPoly

from ....core.named_types import Array

# Points of a path between two lanes.
_TRANSITION = 25
# Greatest distance of points along a lane [m].
_CLOSE = 0.5


@dataclass(frozen=True)
class Path:
    """A smooth path through points."""

    points: Array  # in order, no two of them coincident, (n, 2) [m]

    @cached_property
    def _curve(self) -> CubicSpline:
        """The path as a function of the length of the chords between its points."""
        along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(self.points, axis=0).T))])
        return CubicSpline(along, self.points)

    @property
    def length(self) -> float:
        """The length of its chords [m]."""
        return float(self._curve.x[-1])

    @cached_property
    def _slope(self) -> PPoly:
        return self._curve.derivative()

    def at(self, along: float) -> tuple[float, float]:
        """Return a point of the path [m]; beyond its ends it is straight."""
        inside = min(max(along, 0.0), self.length)
        x, y = self._curve(inside)
        if inside != along:
            dx, dy = self.towards(inside)
            x, y = x + (along - inside) * dx, y + (along - inside) * dy
        return float(x), float(y)

    def towards(self, along: float) -> tuple[float, float]:
        """Return the direction of the path, a unit vector."""
        dx, dy = self._slope(min(max(along, 0.0), self.length))
        size = float(np.hypot(dx, dy))
        return float(dx) / size, float(dy) / size

    def nearest(self, x: float, y: float, near: float) -> float:
        """Return the position along the path nearest to a point, searched from another one [m]."""
        along = near
        for _ in range(4):
            px, py = self.at(along)
            dx, dy = self.towards(along)
            along += (x - px) * dx + (y - py) * dy
        return along

    def offsets(self, x: Array, y: Array) -> Array:
        """Return the distances of points from the path, positive to its left [m]."""
        found, along = np.empty(x.size), 0.0
        for i, (px, py) in enumerate(zip(x.tolist(), y.tolist(), strict=True)):
            along = self.nearest(px, py, along)
            cx, cy = self.at(along)
            dx, dy = self.towards(along)
            found[i] = dx * (py - cy) - dy * (px - cx)
        return found


@dataclass(frozen=True)
class Lane:
    """A straight lane between cones along the road's x axis."""

    start: float  # [m]
    end: float  # [m]
    # lateral positions of its edges, positive to the left [m]
    right: float
    left: float

    @property
    def length(self) -> float:
        """The length of the lane [m]."""
        return self.end - self.start

    @property
    def center(self) -> float:
        """Lateral position of its centre line [m]."""
        return 0.5 * (self.left + self.right)


def through(lanes: Sequence[Lane], *, before: float, after: float) -> Path:
    """Return the path along the centre lines of lanes, with smooth changes from one to the next.

    A change has the shape 10 s^3 - 15 s^4 + 6 s^5, without curvature at its ends. The path is
    straight over lengths before the first lane and after the last one [m].
    """
    rows: list[tuple[float, float]] = [(lanes[0].start - before, lanes[0].center)]

    def straight(start: float, end: float, y: float) -> None:
        count = int(np.ceil((end - start) / _CLOSE))
        rows.extend((float(x), y) for x in np.linspace(start, end, count + 1)[1:])

    straight(lanes[0].start - before, lanes[0].end, lanes[0].center)
    for one, other in pairwise(lanes):
        if other.start > one.end:
            s = np.linspace(0.0, 1.0, _TRANSITION + 1)[1:]
            blend = s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
            x = one.end + s * (other.start - one.end)
            y = one.center + blend * (other.center - one.center)
            rows.extend(zip(x.tolist(), y.tolist(), strict=True))
        straight(other.start, other.end, other.center)
    straight(lanes[-1].end, lanes[-1].end + after, lanes[-1].center)
    return Path(np.array(rows))
