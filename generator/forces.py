"""Force elements and time-varying inputs that act on them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .geometry import Direction, Point


@dataclass(frozen=True, kw_only=True)
class Weight:
    """The weight of every body that carries mass, along the downward chassis axis.

    Parameters
    ----------
    gravity
        Name of the parameter [m/s^2].
    """

    gravity: str


@dataclass(frozen=True, kw_only=True)
class TelescopeSpring:
    """Spring, damper and actuator along a telescope (Eq. 23 of the paper).

    The force pushes the two ends apart:
    ``rate (slide - free_slide) + damper d(slide)/dt + actuator``.

    Parameters
    ----------
    name
        Begins the name of the length signal.
    joint
        Name of the cylindrical joint.
    rate, damper, free_slide
        Names of the parameters [N/m, N s/m, m].
    actuator
        Name of an input [N], or None.
    """

    name: str
    joint: str
    rate: str
    damper: str
    free_slide: str
    actuator: str | None = None


@dataclass(frozen=True, kw_only=True)
class LineSpring:
    """Spring and damper between a point of one body and a point of another.

    The force pushes the two points apart: ``rate (free_length - length) - damper d(length)/dt``.

    Parameters
    ----------
    name
        Begins the names of its signals.
    first, second
        Body and point at either end.
    rate, damper, free_length
        Names of the parameters [N/m, N s/m, m].
    """

    name: str
    first: tuple[str, Point]
    second: tuple[str, Point]
    rate: str
    damper: str
    free_length: str


@dataclass(frozen=True, kw_only=True)
class LinearTyre:
    """A radial tyre spring in the wheel plane (Eq. 24 of the paper).

    With ``a`` the spin axis and ``e_z`` up, the force on the wheel at its centre is
    ``rate (free_height + road - height) (e_z - a a_z) / (1 - a_z^2)``.

    Parameters
    ----------
    name
        Begins the names of its signals where there are several tyres.
    carrier
        Body that carries the wheel's bearing.
    center
        The wheel centre, where the force acts.
    spin
        Direction of the spin axis, fixed in the carrier.
    rate, free_height
        Names of the parameters [N/m, m].
    road
        Name of the input: height of the road under the tyre [m].
    """

    name: str
    carrier: str
    center: Point
    spin: Direction
    rate: str
    free_height: str
    road: str


@dataclass(frozen=True, kw_only=True)
class JointForce:
    """A force (or moment) along an independent joint coordinate, given as an input."""

    joint: str
    input: str


Force = Weight | TelescopeSpring | LineSpring | LinearTyre | JointForce
