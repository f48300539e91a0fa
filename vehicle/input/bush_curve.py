"""The force of a bush as a nonlinear curve over its displacement."""

from collections.abc import Mapping
from typing import Any, get_args

import numpy as np

from ...core.named_types import Array
from ...core.validator import Validator
from .curve import LEAST_GAP, Curve, Interpolation

_KEYS, _WAY = ("mm", "N"), "interpolation"
# Greatest displacement and force of a bush.
_MOST_MM, _MOST_N = 1e3, 1e9


def curve_of(given: Validator, title: str, described: Any, *, odd: bool) -> Curve | None:
    """Return the curve of ``{mm = [...], N = [...]}``; None if it is not valid.

    It rises, and continues with the slope of its last two points, so that it carries any force. An
    `odd` curve begins at zero and is the same to both sides, as normal to an axis.
    """
    if not isinstance(described, Mapping) or {*described} - {_WAY} != {*_KEYS}:
        given.fail(
            f"{title} must be a table of two lists, {{mm = [...], N = [...]}}, and if need be "
            f'{_WAY} = "linear".'
        )
        return None
    way = given.among(f"{title} {_WAY}", described.get(_WAY, "cubic"), get_args(Interpolation))
    places, forces = (
        given.array(f"{title} {key}", described[key], key, dimensions=[1]) for key in _KEYS
    )
    problem = _problem(places, forces, odd=odd)
    if problem:
        given.fail(f"{title}: {problem}")
        return None
    if odd:
        places, forces = (np.concatenate([-v[:0:-1], v]) for v in (places, forces))
    return Curve(1e-3 * places, forces, "linear" if way == "linear" else "cubic", as_secants=True)


def _problem(places: Array, forces: Array, *, odd: bool) -> str:
    """Return the problem of points that are not the curve of a bush."""
    if places.size != forces.size or places.size < 2:
        return f"mm has {places.size} values and N {forces.size}; give two or more of each."
    if not (np.abs(places) <= _MOST_MM).all() or not (np.abs(forces) <= _MOST_N).all():
        return f"values up to {_MOST_MM:g} mm and {_MOST_N:g} N are needed."
    for key, values in (("mm", places), ("N", forces)):
        fall = np.flatnonzero(np.diff(values) < LEAST_GAP)
        if fall.size:
            first, second = values[fall[0] : fall[0] + 2]
            return (
                f"{key}: {second:g} follows {first:g}; both lists must rise, by {LEAST_GAP:g} at "
                "least."
            )
    if not ((places == 0.0) & (forces == 0.0)).any():
        return "a point 0 mm, 0 N is needed: a bush is relaxed there."
    return _problem_of_sides(places, odd=odd)


def _problem_of_sides(places: Array, *, odd: bool) -> str:
    """Return the problem of a curve on the wrong sides of zero."""
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
