"""The grid on which a model is sampled, and the interpolation between its points.

The page interpolates in the browser; `Grid.interpolate` and `Grid.interpolate_apart` have the same
arithmetic, with which the error is measured against the compiled model when the page is written.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.named_types import Array

# Points of the cubic in each direction.
ORDER = 4
# Place of the largest error between the first two of four points, in steps.
_WORST = 0.5 * (3.0 - 5.0**0.5)


@dataclass(frozen=True)
class GridAxis:
    """Equally spaced values of one coordinate."""

    # first value and distance of two neighbours, in the coordinate's SI unit
    first: float
    step: float
    count: int  # number of values, at least four

    @classmethod
    def around_zero(cls, low: float, high: float, step: float) -> "GridAxis":
        """Return the multiples of a step between two limits on either side of zero.

        A step with fewer than four values becomes smaller.
        """
        step = min(step, (high - low) / ORDER)
        # with limits that are multiples to rounding
        below, above = int(-low / step + 1e-9), int(high / step + 1e-9)
        return cls(-below * step, step, below + above + 1)

    @property
    def values(self) -> Array:
        """The values in ascending order, shape (count,)."""
        return self.first + self.step * np.arange(self.count, dtype=np.float64)

    @property
    def last(self) -> float:
        """The greatest value."""
        return self.first + self.step * (self.count - 1)

    @property
    def between(self) -> Array:
        """A coordinate in each interval, where the error of interpolation is largest.

        The error of a cubic is proportional to s (s - 1) (s - 2) (s - 3): largest in the middle of
        inner intervals, and nearer to the end of the first and the last one.
        """
        parts = np.full(self.count - 1, 0.5)
        parts[0], parts[-1] = _WORST, 1.0 - _WORST
        return self.values[:-1] + parts * self.step

    @property
    def zero(self) -> int:
        """Index of the value zero."""
        return round(-self.first / self.step)

    def places(self, where: ArrayLike) -> Array:
        """Return coordinates in steps from the first value."""
        return (np.asarray(where, dtype=np.float64) - self.first) / self.step

    def weights(self, where: ArrayLike) -> tuple[NDArray[np.int64], Array]:
        """Return the index of the first of four neighbours, (n,), and their weights, (n, 4).

        The weights are Lagrange's cubic polynomials at coordinates within the axis, (n,).
        """
        place = self.places(where)
        first = np.clip(np.floor(place).astype(np.int64) - 1, 0, self.count - ORDER)
        s = place - first
        weights = np.stack(
            [
                (s - 1.0) * (s - 2.0) * (s - 3.0) / -6.0,
                s * (s - 2.0) * (s - 3.0) / 2.0,
                s * (s - 1.0) * (s - 3.0) / -2.0,
                s * (s - 1.0) * (s - 2.0) / 6.0,
            ],
            axis=-1,
        )
        return first, weights

    def interpolate(self, samples: Array, where: ArrayLike) -> Array:
        """Return samples of shape (count, ...) interpolated at coordinates (n,), (n, ...)."""
        first, weights = self.weights(where)
        near = samples[first[:, None] + np.arange(ORDER)]
        return np.einsum("nk,nk...->n...", weights, near)


@dataclass(frozen=True)
class Grid:
    """A grid over wheel travel and rack displacement."""

    travel: GridAxis  # height of the wheel centre above its design height [m], positive in bump
    rack: GridAxis  # displacement of the rack along its axis [m]

    @property
    def shape(self) -> tuple[int, int]:
        """Number of travels and of rack displacements."""
        return self.travel.count, self.rack.count

    def interpolate(self, samples: Array, travel: ArrayLike, rack: ArrayLike) -> Array:
        """Return samples (travels, racks, ...) at all combinations of coordinates, (n, m, ...)."""
        along = self.travel.interpolate(samples, travel)
        return np.moveaxis(self.rack.interpolate(np.moveaxis(along, 1, 0), rack), 0, 1)

    def interpolate_apart(
        self, samples: Array, gaps: Sequence[Array], travel: ArrayLike, rack: ArrayLike
    ) -> Array:
        """Return samples with jumps at closing gaps, interpolated on each side of a jump, (n, m).

        The gaps are smooth, positive on one side of a jump, and zero or negative on the other. Only
        points of the grid on the same side are used, with extrapolation up to the jump; a part of
        the grid without points is interpolated across its border.
        """
        result = self.interpolate(samples, travel, rack)
        if not gaps:
            return result
        closed = np.stack([gap <= 0.0 for gap in gaps], axis=-1)
        here = np.stack([self.interpolate(gap, travel, rack) <= 0.0 for gap in gaps], axis=-1)
        lines, columns = self.travel.weights(travel)[0], self.rack.weights(rack)[0]
        places = self.travel.places(travel), self.rack.places(rack)
        for i, j in np.ndindex(result.shape):
            near = closed[lines[i] : lines[i] + ORDER, columns[j] : columns[j] + ORDER]
            same = (closed == here[i, j]).all(axis=-1)
            if (near != here[i, j]).any() and same.any():
                result[i, j] = _one_sided(samples, same, float(places[0][i]), float(places[1][j]))
        return result


def _one_sided(samples: Array, same: NDArray[np.bool_], line: float, column: float) -> float:
    """Return the value at a place, in steps of the grid, interpolated from marked points."""
    columns = _run(np.logical_or.reduce(same, axis=0), column)
    values = []
    for index in columns:
        lines = _run(same[:, index], line)
        weights = _lagrange(line - lines.start, len(lines))
        values.append(weights @ samples[lines.start : lines.stop, index])
    return float(_lagrange(column - columns.start, len(columns)) @ np.array(values))


def _run(marked: NDArray[np.bool_], place: float) -> range:
    """Return up to four adjacent marked points that are nearest to a place."""
    known = np.flatnonzero(marked)
    low = high = int(known[np.argmin(np.abs(known - place))])
    while low > 0 and marked[low - 1]:
        low -= 1
    while high + 1 < marked.size and marked[high + 1]:
        high += 1
    first = min(max(int(np.floor(place)) - 1, low), max(high + 1 - ORDER, low))
    return range(first, min(first + ORDER, high + 1))


def _lagrange(s: float, count: int) -> Array:
    """Return Lagrange's weights at a place, in steps from the first of some neighbours."""
    others = [[other for other in range(count) if other != k] for k in range(count)]
    return np.array([np.prod([(s - o) / (k - o) for o in row]) for k, row in enumerate(others)])
