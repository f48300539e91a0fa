"""How far the page's interpolated values are from those of the compiled model."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...core.named_types import Array
from ...core.vectors import cross
from ..models.model import Model
from .curves import CharacteristicCurve, curves
from .encode import rounded
from .grid import Grid
from .poses import Poses, poses


@dataclass(frozen=True)
class GridAccuracy:
    """Largest differences, measured between the grid's points, where they are largest.

    Attributes
    ----------
    points : float
        Of a position [m].
    spin_axis : float
        Angle between the wheel's axes [rad].
    curves : dict
        Of each characteristic by its key, in the unit of the reader, where it is plotted.
    places : int
        Number of places at which was compared.
    """

    points: float
    spin_axis: float
    curves: dict[str, float]
    places: int


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
    """Compare interpolated with compiled values.

    Parameters
    ----------
    model : Model
    grid : Grid
    sampled : Poses
        The samples on the grid.
    drawn : list of CharacteristicCurve
        The same of the characteristics.
    gaps : list of ndarray
        What is open of the stops, on the grid.
    ranges : dict
        Key of a curve to the values between which it is plotted, in SI units; what lies beyond,
        near a pole for example, is not shown and not compared.
    report : callable, optional
        Takes a word on what is being done.

    Returns
    -------
    GridAccuracy
        With the rounding of the encoding.
    """
    travel, rack = grid.travel.between, grid.rack.between
    report("accuracy of the interpolation")
    exact = poses(model, travel, rack)
    return GridAccuracy(
        points=max(
            _distance(grid, sampled.points[name], points) for name, points in exact.points.items()
        ),
        spin_axis=_angle(grid, sampled.spin_axis, exact.spin_axis),
        curves=_of_curves(grid, drawn, gaps, curves(model, travel, rack, report=report), ranges),
        places=travel.size * rack.size,
    )


def as_encoded(grid: Grid, samples: Array) -> Array:
    """Return samples on the grid with the rounding that the page sees."""
    return rounded(samples, samples[grid.travel.zero, grid.rack.zero])


def _distance(grid: Grid, samples: Array, exact: Array) -> float:
    near = grid.interpolate(as_encoded(grid, samples), grid.travel.between, grid.rack.between)
    return float(np.linalg.norm(near - exact, axis=-1).max())


def _angle(grid: Grid, samples: Array, exact: Array) -> float:
    near = grid.interpolate(as_encoded(grid, samples), grid.travel.between, grid.rack.between)
    near /= np.linalg.norm(near, axis=-1, keepdims=True)
    # from the sine: the cosine of a small angle has no digits left
    return float(np.arcsin(np.linalg.norm(cross(near, exact), axis=-1).max()))


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
            with np.errstate(divide="ignore"):  # an infinite value is outside of what is shown
                near = 1.0 / near
        low, high = ranges[curve.key]
        true = between[curve.key]
        shown = (true >= low) & (true <= high) & (near >= low) & (near <= high)
        difference = np.abs(near - true)[shown]
        errors[curve.key] = float(difference.max(initial=0.0)) * curve.factor
    return errors
