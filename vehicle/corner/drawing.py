"""The drawing of a suspension as data, independent of the kind.

Points are names of hardpoints. A *place* is one name; or three, for the point on the line through
the last two that is nearest to the first one.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, NamedTuple

Place = str | tuple[str, str, str]
Role = Literal["arm", "upper arm", "rocker", "strut", "rod", "push rod"]


class Axis(NamedTuple):
    """The axis of a spring or damper.

    Attributes
    ----------
    foot : str or tuple of str
        The place of its lower end.
    top : str
        The point at its upper end.
    part : float
        End of a damper's tube, and begin of a spring, as a part of the length at design from its
        foot.
    """

    foot: Place
    top: str
    part: float


@dataclass(frozen=True)
class Drawing:
    """The elements of a drawing.

    Attributes
    ----------
    links : mapping
        The two ends and the role of each link in front view.
    knuckle : tuple of str
        Points of the line that represents the knuckle in front view.
    legend : mapping
        The names of arms and strut on the page of the report, and of the ``knuckle`` if it has
        another one.
    damper, spring : Axis
    upright : tuple of places
        The ends of the knuckle in three dimensions, with the wheel between them.
    brackets : mapping
        The two ends of each bar between an arm and the spring.
    """

    links: Mapping[str, tuple[str, str, Role]]
    knuckle: tuple[str, ...]
    legend: Mapping[str, str]
    damper: Axis
    spring: Axis
    upright: tuple[Place, Place]
    brackets: Mapping[str, tuple[Place, Place]]
