"""Differences of the page's interpolated values from those of the compiled model."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...core.named_types import Array
from ...core.vectors import cross, directions
from ..models.model import Model
from .curves import CharacteristicCurve, curves
from .encode import rounded
from .grid import Grid
from .poses import Poses, poses


@dataclass(frozen=True)
class GridAccuracy:
    """Largest differences, between the points of the grid, where they are largest."""

    points: float  # distance of positions [m]
    spin_axis: float  # angle between the wheel's axes [rad]
    # of each characteristic by its key, in the display unit, within the plotted range
    curves: dict[str, float]
    places: int  # number of compared positions


def measure(
    model: Model,
    grid: Grid,
    sampled: Poses,
    drawn: list[CharacteristicCurve],
    gaps: list[Array],
    ranges: dict[str, tuple[float, float]],
    *,
    report: Callable[[str], None] = lambda _: None,
) -> GridAccuracy:
    """Return the differences of interpolated from compiled values, with those of the encoding.

    Poses, curves and open gaps of stops are on the grid. Values beyond the plotted range of a
    curve, SI units, as near a pole, are not compared.
    """
    travel, rack = grid.travel.between, grid.rack.between
    report("accuracy of the interpolation")
    exact = poses(model, travel, rack)

    def interpolated(samples: Array) -> Array:
        return grid.interpolate(as_encoded(grid, samples), travel, rack)

    axis = directions(interpolated(sampled.spin_axis))
    # from the sine, since the cosine of a small angle has no digits left
    return GridAccuracy(
        points=max(
            float(np.linalg.norm(interpolated(sampled.points[name]) - points, axis=-1).max())
            for name, points in exact.points.items()
        ),
        spin_axis=float(np.arcsin(np.linalg.norm(cross(axis, exact.spin_axis), axis=-1).max())),
        curves=_of_curves(grid, drawn, gaps, curves(model, travel, rack, report=report), ranges),
        places=travel.size * rack.size,
    )


def as_encoded(grid: Grid, samples: Array) -> Array:
    """Return samples on the grid with the rounding of the encoding."""
    return rounded(samples, samples[grid.travel.zero, grid.rack.zero])


def _of_curves(
    grid: Grid,
    drawn: list[CharacteristicCurve],
    gaps: list[Array],
    exact: list[CharacteristicCurve],
    ranges: dict[str, tuple[float, float]],
) -> dict[str, float]:
    between = {curve.key: curve.values for curve in exact}
    seen = [as_encoded(grid, gap) for gap in gaps]
    errors = {}
    for curve in drawn:
        near = grid.interpolate_apart(
            as_encoded(grid, curve.smooth),
            seen if curve.jumps else (),
            grid.travel.between,
            grid.rack.between,
        )
        if curve.reciprocal:
            with np.errstate(divide="ignore"):  # an infinite value is outside the range
                near = 1.0 / near
        low, high = ranges[curve.key]
        true = between[curve.key]
        shown = (true >= low) & (true <= high) & (near >= low) & (near <= high)
        errors[curve.key] = float(np.abs(near - true)[shown].max(initial=0.0)) * curve.factor
    return errors
