"""The force of a bush over its displacement, where that is no straight line."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator
from scipy.optimize import brentq

from ..core.arguments import Arguments

Array = NDArray[np.float64]

_KEYS = ("mm", "N")
# No bush moves or carries more.
_MOST_MM, _MOST_N = 1e3, 1e9


class Curve:
    """A force that rises with the displacement.

    Between its points it is a monotone cubic (Fritsch and Carlson), outside them it goes on as the
    last two points rise.

    Parameters
    ----------
    displacement, force : ndarray, shape (n,)
        Both rising, zero at the same point [m], [N].
    """

    def __init__(self, displacement: Array, force: Array) -> None:
        self._ends = displacement[[0, -1]]
        slopes = PchipInterpolator(displacement, force).derivative()(displacement)
        secants = np.diff(force) / np.diff(displacement)
        # as the last points rise it goes on, so that it carries any force
        slopes[[0, -1]] = secants[[0, -1]]
        self._force = CubicHermiteSpline(displacement, force, slopes)
        self._slope = self._force.derivative()

    def force(self, displacement: Array) -> Array:
        """Return the force [N]."""
        inside = np.clip(displacement, *self._ends)
        found: Array = self._force(inside) + self._slope(inside) * (displacement - inside)
        return found

    def displacement(self, force: float) -> float:
        """Return the displacement at which a force is carried [m]."""

        def left(far: float) -> float:
            return float(self.force(np.array([far]))[0]) - force

        far = float(np.abs(self._ends).max())
        while not left(-far) <= 0.0 <= left(far):
            far *= 2.0
        return float(brentq(left, -far, far, xtol=1e-15))

    def rate(self, displacement: Array) -> Array:
        """Return its derivative [N/m]."""
        found: Array = self._slope(np.clip(displacement, *self._ends))
        return found


def curve_of(given: Arguments, title: str, described: Any, *, odd: bool) -> Curve | None:
    """Read a curve, ``{mm = [...], N = [...]}``; None where it cannot be one.

    Parameters
    ----------
    given : Arguments
        Gets what is wrong.
    title : str
    described : mapping
    odd : bool
        Whether it begins at zero and is the same to both sides: across an axis, none is told apart.
    """
    if not isinstance(described, Mapping) or set(described) != set(_KEYS):
        given.refuse(f"{title} must be a table of two lists, {{mm = [...], N = [...]}}.")
        return None
    places, forces = (
        given.array(f"{title} {key}", described[key], key, dimensions=[1]) for key in _KEYS
    )
    problem = _problem(places, forces, odd=odd)
    if problem:
        given.refuse(f"{title}: {problem}")
        return None
    if odd:
        places, forces = (np.concatenate([-v[:0:-1], v]) for v in (places, forces))
    return Curve(1e-3 * places, forces)


def _problem(places: Array, forces: Array, *, odd: bool) -> str:
    """Say why some points are no curve of a bush."""
    if places.size != forces.size or places.size < 2:
        return f"mm has {places.size} values and N {forces.size}; as many are needed, two or more."
    if not (np.abs(places) <= _MOST_MM).all() or not (np.abs(forces) <= _MOST_N).all():
        return f"values up to {_MOST_MM:g} mm and {_MOST_N:g} N are needed."
    for key, values in (("mm", places), ("N", forces)):
        fall = np.flatnonzero(np.diff(values) <= 0.0)
        if fall.size:
            first, second = values[fall[0] : fall[0] + 2]
            return f"{key}: {second:g} follows {first:g}; both lists must rise."
    if not ((places == 0.0) & (forces == 0.0)).any():
        return "a point 0 mm, 0 N is needed: a bush is relaxed there."
    return _problem_of_sides(places, odd=odd)


def _problem_of_sides(places: Array, *, odd: bool) -> str:
    """Say why a curve does not tell both sides."""
    if odd and places[0] < 0.0:
        return (
            f"mm begins with {places[0]:g}; a bush is the same to all sides of its axis: "
            "begin with 0 mm, 0 N."
        )
    if not odd and not places[0] < 0.0 < places[-1]:
        return (
            f"mm goes from {places[0]:g} to {places[-1]:g}; points on both sides of 0 mm are "
            "needed, as a bush is pushed either way along its axis."
        )
    return ""
