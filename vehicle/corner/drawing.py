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
    """The axis of a spring or damper."""

    foot: Place  # place of its lower end
    top: str  # point at its upper end
    # end of a damper's tube, and begin of a spring, as a part of the length at design from its foot
    part: float


@dataclass(frozen=True)
class Drawing:
    """The elements of a drawing."""

    links: Mapping[str, tuple[str, str, Role]]  # two ends and the role of each link in front view
    knuckle: tuple[str, ...]  # points of the line that represents the knuckle in front view
    # names of arms and strut on the page of the report, and of the `knuckle` if it has another one
    legend: Mapping[str, str]
    damper: Axis
    spring: Axis
    # ends of the knuckle in three dimensions, with the wheel between them
    upright: tuple[Place, Place]
    # two ends of each bar between an arm and the spring
    brackets: Mapping[str, tuple[Place, Place]]
