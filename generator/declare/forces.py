"""Force elements and time-varying inputs that act on them."""

from __future__ import annotations

from dataclasses import dataclass

from .declared import Amount, DeclarationError, Name, Share, declared
from .geometry import Direction, Point
from .laws import Law


@declared
@dataclass(frozen=True, kw_only=True)
class Weight:
    """The weight of every body that carries mass, along the downward chassis axis.

    Parameters
    ----------
    gravity
        Name of the parameter [m/s^2].
    """

    gravity: Amount


@declared
@dataclass(frozen=True)
class AlongTelescope:
    """From one end of a telescope to the other.

    Parameters
    ----------
    joint
        Name of the cylindrical joint.
    """

    joint: Name


@declared
@dataclass(frozen=True)
class AlongLine:
    """From a point of one body to a point of another.

    Parameters
    ----------
    first, second
        Body and point at either end.
    """

    first: tuple[Name, Point]
    second: tuple[Name, Point]

    def __post_init__(self) -> None:
        if self.first[0] == self.second[0]:
            problem = (
                f"both ends are on {self.first[0]!r}, so its length never changes; name two bodies"
            )
            raise DeclarationError("AlongLine", [problem])


@declared
@dataclass(frozen=True)
class TwistOfHinges:
    """The angle of one hinge less that of another: what twists a bar between them.

    What elsewhere is a length is an angle here [rad], and what is a force is a moment [N m]: it
    acts with its sign on the second hinge and against it on the first, so that its power is that
    of the moment at the rate of the twist.

    Parameters
    ----------
    first, second
        Names of the two revolute joints.
    """

    first: Name
    second: Name

    def __post_init__(self) -> None:
        if self.first == self.second:
            problem = f"the angle of {self.first!r} less itself is always zero; name two hinges"
            raise DeclarationError("TwistOfHinges", [problem])


Path = AlongTelescope | AlongLine | TwistOfHinges


@declared
@dataclass(frozen=True, kw_only=True)
class ForceElement:
    """Springs, dampers and stops that act along one path between two bodies (Eq. 23).

    Parameters
    ----------
    name
        Begins the names of its signals: ``<name>_length``, ``<name>_velocity``; of a twist,
        ``<name>_angle`` and ``<name>_angular_velocity``.
    path
        What it acts along.
    laws
        What it does; the forces add up.
    """

    name: Name
    path: Path
    laws: tuple[Law, ...]

    @property
    def turns(self) -> bool:
        """Whether it acts on an angle, by moments."""
        return isinstance(self.path, TwistOfHinges)

    def signal(self, law: Law) -> str:
        """Return what the signal of one of its laws is called, without the element's name."""
        return law.signal.replace("force", "moment") if self.turns else law.signal


@declared
@dataclass(frozen=True, kw_only=True)
class LinearTyre:
    """A radial tyre spring in the wheel plane (Eq. 24 of the paper).

    With ``a`` the spin axis and ``e_z`` up, the force on the wheel at its centre is
    ``load (e_z - a a_z) / (1 - a_z^2)``, with ``load = rate x``, x = free_height + road - height.

    With a damper the load is ``rate x + damper x'``. A tyre that lifts off neither pulls nor damps
    in the air: its load is zero where x or the load itself would be negative; one that does not
    holds on to the road, as in the paper.

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
    damper
        Name of the parameter [N s/m]; the road then needs an input that is its derivative [m/s].
    lifts_off
        Name of the parameter: 1 if the tyre can leave the road, 0 if not; None: it cannot.
    """

    name: Name
    carrier: Name
    center: Point
    spin: Direction
    rate: Amount
    free_height: Name
    road: Name
    damper: Amount | None = None
    lifts_off: Share | None = None


@declared
@dataclass(frozen=True, kw_only=True)
class JointForce:
    """A force (or moment) along an independent joint coordinate, given as an input."""

    joint: Name
    input: Name


Force = Weight | ForceElement | LinearTyre | JointForce
