"""Force elements and time-varying inputs that act on them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from .bodies import Body
from .declared import DeclarationError, Name, declared
from .geometry import Direction, Point
from .inputs import Input
from .joints import Cylindrical, Prismatic, Revolute
from .laws import Law, LinearSpring
from .parameters import DamperRate, Displacement, Gravity, Parameter, Share, SpringRate


@declared
@dataclass(frozen=True)
class Weight:
    """The weight of every body that carries mass, along the downward chassis axis."""

    gravity: Gravity = field(
        default_factory=lambda: Gravity("gravity", 9.81, "acceleration of gravity")
    )


@declared
@dataclass(frozen=True)
class AlongTelescope:
    """From one end of a telescope to the other.

    Parameters
    ----------
    joint
        The telescope.
    """

    joint: Cylindrical


@declared
@dataclass(frozen=True)
class AlongLine:
    """From a point of one body to a point of another.

    Parameters
    ----------
    first, second
        Body and point at either end.
    """

    first: tuple[Body, Point]
    second: tuple[Body, Point]

    def __post_init__(self) -> None:
        (one, _), (other, _) = self.first, self.second
        if one == other:
            problem = f"both ends are on {one.name!r}, so its length never changes; give two bodies"
            raise DeclarationError("AlongLine", [problem])

    @property
    def ends(self) -> tuple[tuple[str, Point], tuple[str, Point]]:
        """Name of the body and point at either end."""
        (one, start), (other, end) = self.first, self.second
        return (one.name, start), (other.name, end)


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
        The two hinges.
    """

    first: Revolute
    second: Revolute

    def __post_init__(self) -> None:
        if self.first == self.second:
            name = self.first.name
            problem = f"the angle of {name!r} less itself is always zero; give two hinges"
            raise DeclarationError("TwistOfHinges", [problem])


Path = AlongTelescope | AlongLine | TwistOfHinges


@declared
@dataclass(frozen=True)
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

    def __post_init__(self) -> None:
        sliding = [law for law in self.laws if isinstance(law, LinearSpring) and law.free_slide]
        problems = [f"law {law!r} is declared twice; once is enough" for law in _twice(self.laws)]
        if sliding and not isinstance(self.path, AlongTelescope):
            problems.append("a free_slide needs a telescope; give its spring a free_length")
        wanted = "an angle or a moment" if self.turns else "a length or a force"
        problems += [
            f"{number.name!r} is in {number.unit}; {type(self.path).__name__} needs what is about "
            f"{wanted}"
            for law in self.laws
            for number in vars(law).values()
            if isinstance(number, Parameter) and number.of_angle != self.turns
        ]
        if problems:
            raise DeclarationError(f"ForceElement {self.name!r}", problems)

    @property
    def turns(self) -> bool:
        """Whether it acts on an angle, by moments."""
        return isinstance(self.path, TwistOfHinges)

    def signal(self, law: Law) -> str:
        """Return what the signal of one of its laws is called, without the element's name."""
        return law.signal.replace("force", "moment") if self.turns else law.signal


def _twice(laws: tuple[Law, ...]) -> list[Law]:
    return [law for i, law in enumerate(laws) if law in laws[:i]]


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
        [N/m]; height of the wheel centre at which the tyre is free of force [m].
    road
        Height of the road under the tyre [m].
    damper, road_velocity
        [N s/m], and an input [m/s]; both or neither.
    lifts_off
        1 if the tyre can leave the road, 0 if not; None: it cannot.
    """

    name: Name
    carrier: Body
    center: Point
    spin: Direction
    rate: SpringRate
    free_height: Displacement
    road: Input
    damper: DamperRate | None = None
    road_velocity: Input | None = None
    lifts_off: Share | None = None

    turns_about: ClassVar[tuple[str, ...]] = ("spin",)

    def __post_init__(self) -> None:
        if (self.damper is None) != (self.road_velocity is None):
            problem = "give damper and road_velocity, or neither"
            raise DeclarationError(f"LinearTyre {self.name!r}", [problem])


@declared
@dataclass(frozen=True)
class JointForce:
    """A force (or moment) along an independent joint coordinate, given as an input."""

    joint: Revolute | Prismatic
    input: Input


Force = Weight | ForceElement | LinearTyre | JointForce
