"""The grid on which a model is sampled, and the interpolation between its points.

The page interpolates in the browser; `Grid.interpolate` and `Grid.interpolate_apart` do the same
arithmetic here, so that its error can be measured against the compiled model before the page is
written.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.named_types import Array

# Points of the cubic through which each direction is interpolated.
ORDER = 4
# Between the first two of its four points, a cubic's error is largest here, in steps.
_WORST = 0.5 * (3.0 - 5.0**0.5)


@dataclass(frozen=True)
class GridAxis:
    """Equally spaced values of one coordinate.

    Attributes
    ----------
    first, step : float
        First value and distance of two neighbours, in the coordinate's SI unit.
    count : int
        Number of values, at least four.
    """

    first: float
    step: float
    count: int

    @classmethod
    def around_zero(cls, low: float, high: float, step: float) -> "GridAxis":
        """Return the multiples of a step from a lower to an upper limit, zero among them.

        Parameters
        ----------
        low, high : float
            Limits, on either side of zero.
        step : float
            Wanted distance; it becomes smaller where fewer than four values would be left.

        Returns
        -------
        GridAxis
        """
        step = min(step, (high - low) / ORDER)
        # a limit that is a multiple but for rounding counts as one
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
        """One coordinate between each two neighbours, where interpolation is worst.

        The error of a cubic goes with s (s - 1) (s - 2) (s - 3): half way within the axis, nearer
        to the end in the first and in the last interval.
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
        """Return which values interpolate, and with which weights.

        Parameters
        ----------
        where : array_like, shape (n,)
            Coordinates within the axis.

        Returns
        -------
        first : ndarray of int, shape (n,)
            Index of the first of four neighbours.
        weights : ndarray, shape (n, 4)
            Lagrange's cubic polynomials at these coordinates.
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
        """Interpolate samples over this axis alone.

        Parameters
        ----------
        samples : ndarray, shape (count, ...)
        where : array_like, shape (n,)

        Returns
        -------
        ndarray, shape (n, ...)
        """
        first, weights = self.weights(where)
        near = samples[first[:, None] + np.arange(ORDER)]
        result: Array = np.einsum("nk,nk...->n...", weights, near)
        return result


@dataclass(frozen=True)
class Grid:
    """Wheel travel by rack displacement.

    Attributes
    ----------
    travel : GridAxis
        Height of the wheel centre above its design height [m], positive in bump.
    rack : GridAxis
        Displacement of the rack along its axis [m].
    """

    travel: GridAxis
    rack: GridAxis

    @property
    def shape(self) -> tuple[int, int]:
        """Number of travels and of rack displacements."""
        return self.travel.count, self.rack.count

    def interpolate(self, samples: Array, travel: ArrayLike, rack: ArrayLike) -> Array:
        """Interpolate samples at every combination of travels and rack displacements.

        Parameters
        ----------
        samples : ndarray, shape (travels, racks, ...)
            Values on the grid.
        travel : array_like, shape (n,)
        rack : array_like, shape (m,)
            Coordinates within the grid [m].

        Returns
        -------
        ndarray, shape (n, m, ...)
        """
        along = self.travel.interpolate(samples, travel)
        across = self.rack.interpolate(np.moveaxis(along, 1, 0), rack)
        return np.moveaxis(across, 0, 1)

    def interpolate_apart(
        self, samples: Array, gaps: Sequence[Array], travel: ArrayLike, rack: ArrayLike
    ) -> Array:
        """Interpolate samples that jump where a gap closes, from their own side of the jump alone.

        The gaps themselves are smooth. Their signs show on which side a place is; of the grid's
        points only those on the same side take part, and the cubic reaches out from them up to the
        jump.

        Parameters
        ----------
        samples : ndarray, shape (travels, racks)
            Values on the grid.
        gaps : sequence of ndarray, shape (travels, racks)
            Positive on one side of a jump, zero or negative on the other.
        travel : array_like, shape (n,)
        rack : array_like, shape (m,)
            Coordinates within the grid [m].

        Returns
        -------
        ndarray, shape (n, m)
            A part of the grid without a point of its own is interpolated across its border.
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
    """Interpolate at a place, in steps of the grid, from the marked points alone."""
    columns = _run(np.logical_or.reduce(same, axis=0), column)
    values = []
    for index in columns:
        lines = _run(same[:, index], line)
        weights = _lagrange(line - lines.start, len(lines))
        values.append(weights @ samples[lines.start : lines.stop, index])
    return float(_lagrange(column - columns.start, len(columns)) @ np.array(values))


def _run(marked: NDArray[np.bool_], place: float) -> range:
    """Return up to four neighbours, all of them marked, as near to a place as there are."""
    known = np.flatnonzero(marked)
    low = high = int(known[np.argmin(np.abs(known - place))])
    while low > 0 and marked[low - 1]:
        low -= 1
    while high + 1 < marked.size and marked[high + 1]:
        high += 1
    first = min(max(int(np.floor(place)) - 1, low), max(high + 1 - ORDER, low))
    return range(first, min(first + ORDER, high + 1))


def _lagrange(s: float, count: int) -> Array:
    """Return Lagrange's weights at a place, counted in steps from the first of some neighbours."""
    others = [[other for other in range(count) if other != k] for k in range(count)]
    return np.array([np.prod([(s - o) / (k - o) for o in row]) for k, row in enumerate(others)])
