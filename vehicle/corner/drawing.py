"""How a suspension is drawn, as data: what draws it knows no kind.

Everything is said by the names of hardpoints. A *place* is one of them; or three, for the point
nearest to the first on the line through the two others.
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
        So far from its foot, as a part of its length at design, ends the tube of a damper, and
        begins a spring.
    """

    foot: Place
    top: str
    part: float


@dataclass(frozen=True)
class Drawing:
    """What is drawn of a suspension.

    Attributes
    ----------
    links : mapping
        For each link that is seen from the front its two ends, and what it is.
    knuckle : tuple of str
        Points of the line that represents the knuckle there.
    legend : mapping
        What the arms and the strut are called on the page of the report, and the ``knuckle`` where
        that is not its name.
    damper, spring : Axis
    upright : tuple of places
        The ends of the knuckle in three dimensions, which holds the wheel between them.
    brackets : mapping
        For each bar by which an arm holds the spring, its two ends.
    """

    links: Mapping[str, tuple[str, str, Role]]
    knuckle: tuple[str, ...]
    legend: Mapping[str, str]
    damper: Axis
    spring: Axis
    upright: tuple[Place, Place]
    brackets: Mapping[str, tuple[Place, Place]]
