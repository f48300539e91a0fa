"""Axes of other programs, by the directions in which they point."""

from typing import NamedTuple

import numpy as np

from ...core.errors import InputError
from ...core.named_types import Array
from ...core.validator import Validator

ISO, REARWARD = "forward left up", "rearward right up"

_DIRECTIONS = {
    "forward": (1.0, 0.0, 0.0),
    "rearward": (-1.0, 0.0, 0.0),
    "left": (0.0, 1.0, 0.0),
    "right": (0.0, -1.0, 0.0),
    "up": (0.0, 0.0, 1.0),
    "down": (0.0, 0.0, -1.0),
}

Point = tuple[float, float, float]


class Axes(NamedTuple):
    """The axes of a table of points."""

    words: str  # directions of x, y and z: `rearward right up`
    directions: Array  # these directions in axes of ISO 8855, in columns, (3, 3)

    def point(self, place: Point) -> Point:
        """Return a point in axes of ISO 8855: x forward, y left, z up."""
        # each sum has one product that is not zero, and the added zero avoids negative zeros
        x, y, z = (self.directions @ np.array(place) + 0.0).tolist()
        return x, y, z


def axes_of(words: str, *, left_handed: bool = False) -> Axes:
    """Return axes from the directions of x, y and z: forward, rearward, left, right, up or down.

    Raises `InputError` if they are not three axes. Left-handed axes, as in some games, are refused
    unless `left_handed`: they would make a mirror image of the car.

    Examples
    --------
    >>> axes_of("rearward right up").point((1.0, 2.0, 3.0))
    (-1.0, -2.0, 3.0)
    """
    with Validator("axes") as given:
        given.text("axes", words)
        given.flag("left_handed", left_handed)
    named = words.replace(",", " ").lower().split()
    unknown = [word for word in named if word not in _DIRECTIONS]
    if unknown or len(named) != 3:
        problem = (
            f"{words!r}: where x, y and z of the table point is needed, three of "
            f"{', '.join(_DIRECTIONS)}, such as {REARWARD!r}."
        )
        raise InputError([problem], "axes")
    directions = np.array([_DIRECTIONS[word] for word in named]).T
    volume = round(float(np.linalg.det(directions)))
    if volume == 0:
        problem = f"{words!r}: two of them are on one line. One of each pair is needed."
        raise InputError([problem], "axes")
    if (volume < 0) != left_handed:
        problem = f"{words!r} are {'left' if volume < 0 else 'right'}-handed axes. " + (
            "If those of the table are, give --left-handed (left_handed=True); otherwise reverse "
            "one of them."
            if volume < 0
            else "Leave --left-handed (left_handed=True) out, or reverse one of them."
        )
        raise InputError([problem], "axes")
    return Axes(" ".join(named), directions)
