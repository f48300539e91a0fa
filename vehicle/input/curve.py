"""A force from a table, with cubic or linear interpolation."""

from functools import cached_property
from itertools import pairwise
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator

from ...core.columns import number
from ...core.named_types import Array
from .section import Number

# The number of segments in the generated equations.
SEGMENTS = 10

LEAST_GAP = 1e-6
"""Least distance of points, in mm or m/s, which keeps seven digits of a length in metres."""

# Greatest force of a table, below which slopes are finite.
_MOST_N = 1e12

Interpolation = Literal["cubic", "linear"]

WAYS = (
    'between the points of a curve: "cubic", monotone and smooth (Fritsch and Carlson), or '
    '"linear", straight lines'
)
"""The description of `Interpolation` in the reference of files."""


def _numbers(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray) else value


Numbers = Annotated[tuple[Number, ...], BeforeValidator(_numbers)]


def point_problems(
    key: str, unit: str, places: tuple[float, ...], forces: tuple[float, ...]
) -> list[str]:
    """Return the problem of number, order or size of the points of a curve.

    `key` and `unit` are those of the places in the file; the forces are ``force_N``.
    """
    if len(places) != len(forces):
        problem = (
            f"{key} has {len(places)} values and force_N {len(forces)}; equal counts are "
            "needed. Give one force for each of the others."
        )
        return [problem]
    if not 2 <= len(places) <= SEGMENTS + 1:
        problem = (
            f"{key} has {len(places)} values; allowed are 2 to {SEGMENTS + 1}. Leave out points "
            "where the curve is nearly straight."
        )
        return [problem]
    for a, b in pairwise(places):
        if not b - a >= LEAST_GAP:
            problem = (
                f"{key}: {b} {unit} follows {a} {unit}; the values must rise, by {LEAST_GAP:g} "
                f"{unit} at least. Sort the points and keep one force for each."
            )
            return [problem]
    most = f"{_MOST_N:g} N"
    too_much = [force for force in forces if not abs(force) <= _MOST_N]
    return [
        f"force_N = {force} N is out of range: allowed is -{most} to {most}. Correct it."
        for force in too_much[:1]
    ]


class Curve:
    """A force over a displacement or a velocity, through two or more points whose places rise.

    Between its points it is a monotone cubic (Fritsch and Carlson), or linear; outside it is
    linear. If `as_secants` a cubic continues outside with the slope between its last two points, so
    that it carries any force; otherwise with the slope at its end.
    """

    def __init__(
        self, places: Array, forces: Array, interpolation: Interpolation, *, as_secants: bool
    ) -> None:
        self._places, self._forces = places, forces
        self._width, self._rise = np.diff(places), np.diff(forces)
        secants = self._rise / self._width
        self._is_straight = interpolation == "linear"
        if self._is_straight:
            self._slopes = np.append(secants, secants[-1])
            return
        from scipy.interpolate import PchipInterpolator  # noqa: PLC0415 (slow to import)

        self._slopes = PchipInterpolator(places, forces).derivative()(places)
        if as_secants:
            self._slopes[[0, -1]] = secants[[0, -1]]

    @cached_property
    def _force(self) -> Any:
        from scipy.interpolate import CubicHermiteSpline, PPoly  # noqa: PLC0415 (slow to import)

        if not self._is_straight:
            return CubicHermiteSpline(self._places, self._forces, self._slopes)
        none = np.zeros_like(self._rise)
        rows = np.stack([none, none, self._rise / self._width, self._forces[:-1]])
        return PPoly(rows, self._places)

    @cached_property
    def _slope(self) -> Any:
        return self._force.derivative()

    def force(self, place: Array) -> Array:
        """Return the force."""
        inside = np.clip(place, *self._places[[0, -1]])
        return self._force(inside) + self._slope(inside) * (place - inside)

    def rate(self, place: Array) -> Array:
        """Return the derivative of the force; at a corner that of the preceding line."""
        inside = np.clip(place, *self._places[[0, -1]])
        if self._is_straight:
            inside = np.nextafter(inside, -np.inf)
        return self._slope(inside)

    def place(self, force: float) -> float:
        """Return the place of a force, for a curve that rises everywhere."""
        from scipy.optimize import brentq  # noqa: PLC0415 (slow to import)

        def left(far: float) -> float:
            return float(self.force(np.array(far))) - force

        far = float(np.abs(self._places[[0, -1]]).max())
        while not left(-far) <= 0.0 <= left(far):
            far *= 2.0
        return float(brentq(left, -far, far, xtol=1e-15))

    def parameters(self, name: str, knots: Any = None) -> dict[str, Any]:
        """Return the coefficients by the names of a table in the equations.

        They are, for each segment, knot, inverse width and the three coefficients of a cubic
        polynomial of the passed part of the segment; unused segments have no force. The knots are
        those given, by default the places.
        """
        knots = self._places if knots is None else knots
        rise, none = self._rise, np.zeros_like(self._rise)
        first, last = self._width * self._slopes[:-1], self._width * self._slopes[1:]
        straight = self._is_straight
        table = {
            "knot": knots,
            "inverse_width": 1.0 / self._width,
            "linear": rise if straight else first,
            "quadratic": none if straight else 3.0 * rise - 2.0 * first - last,
            "cubic": none if straight else first + last - 2.0 * rise,
        }
        values = {
            "first_force": self._forces[0],
            "first_slope": self._slopes[0],
            "last_slope": self._slopes[-1],
        }
        values |= {f"{key}_{i}": x for key, row in table.items() for i, x in enumerate(row)}
        for i in range(rise.size, SEGMENTS):  # unused segments
            values |= dict.fromkeys((f"{key}_{i}" for key in table if key != "knot"), 0.0)
            values[f"knot_{i + 1}"] = knots[-1]
        return {f"{name}_{key}": number(x) for key, x in values.items()}


def no_curve(name: str) -> dict[str, float]:
    """Return the coefficients of a table without force, whose knots coincide."""
    points = np.array([0.0, 1.0])
    of_one = Curve(points, points, "linear", as_secants=True).parameters(name)
    return dict.fromkeys(of_one, 0.0)
