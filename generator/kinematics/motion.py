"""Motion of a body while a mechanism is being solved.

Positions are in the work axes, twists in body axes. *Motion* is velocity per unit rate of one
coordinate, so it is a column of a Jacobian; *bias* is the acceleration that remains when the
accelerations of the independent coordinates are zero.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from ..declare.geometry import Point
from ..program.vectors import IDENTITY, NO_TWIST, ZERO, Axes, Twist, Vector

if TYPE_CHECKING:
    from collections.abc import Callable

    import sympy as sp

    from ..declare.joints import Cylindrical


@dataclass
class BodyMotion:
    """A body whose pose is known."""

    body: str
    # origin of the body axes and their directions
    origin: Vector = ZERO
    axes: Axes = IDENTITY
    # same at the design position (constants)
    design_origin: Vector = ZERO
    design_axes: Axes = IDENTITY
    # body coordinates of points that are known by construction, with their exact zeros
    local: dict[Point, Vector] = field(default_factory=dict)
    # twist per unit rate of each coordinate that moves the body
    motion: dict[str, Twist] = field(default_factory=dict)
    # neighbour that shares the origin, with its own coordinates of that point: a point mass there
    # may be counted with either body
    carrier: tuple[str, Vector] | None = None
    # hinge whose axis is the first of the body axes, if one placed the body
    hinge: str | None = None
    bias: Callable[[], Twist] = lambda: NO_TWIST
    # twist at the true rates, of a body on a moving base; None: the sum of `motion`
    total: Callable[[], Twist] | None = None
    # motion of the origin, in work axes, where it is known as that of a point of the carrier
    at: PointMotion | None = None
    turn: Turn | None = None  # angle on the hinge that placed it, where it is known


@dataclass(frozen=True)
class Turn:
    """An angle about the first axis of a body, with the other axes at its zero, in work axes."""

    cosine: sp.Expr
    sine: sp.Expr
    axes: tuple[Vector, Vector]


@dataclass(frozen=True)
class PointMotion:
    """Position, velocity per unit rate, and bias acceleration of a point, in work axes."""

    position: Vector
    motion: dict[str, Vector]
    bias: Vector

    def minus(self, other: PointMotion) -> PointMotion:
        """Return the motion relative to another point."""
        names = list(dict.fromkeys([*self.motion, *other.motion]))
        return PointMotion(
            self.position - other.position,
            {k: self.motion.get(k, ZERO) - other.motion.get(k, ZERO) for k in names},
            self.bias - other.bias,
        )


@dataclass(frozen=True)
class OnLine:
    """A body (or a telescope of two) with a known line, free to turn about it."""

    # two points of the line, which runs from anchor to end
    anchor: Point
    end: Point
    anchor_motion: PointMotion
    end_motion: PointMotion
    anchor_body: str
    end_body: str
    direction: Vector  # unit vector along it
    # distance of the points
    length: sp.Expr
    inverse_length: sp.Expr
    relative: PointMotion  # motion of the end relative to the anchor
    length_motion: dict[str, sp.Expr]  # rate of the length per unit rate of each coordinate
    # from anchor to end, and the inverse of its square
    span: Vector
    inverse_squared: sp.Expr

    def reversed(self) -> OnLine:
        """Return the same line, from its end to its anchor."""
        return replace(
            self,
            anchor=self.end,
            end=self.anchor,
            anchor_motion=self.end_motion,
            end_motion=self.anchor_motion,
            anchor_body=self.end_body,
            end_body=self.anchor_body,
            direction=-self.direction,
            relative=self.anchor_motion.minus(self.end_motion),
            span=-self.span,
        )


@dataclass(frozen=True)
class RodEnds:
    """A rod of constant length from an anchor to a point of a body, which it keeps from turning."""

    body: str
    rod: str
    end: Point
    anchor: Point
    anchor_body: str


@dataclass(frozen=True)
class TelescopeEnds:
    """A telescope between two points of placed bodies: its axis passes through the first one."""

    joint: Cylindrical
    anchor: Point
    anchor_body: str
    anchor_link: str
    end: Point
    end_body: str
    end_link: str

    @property
    def axis_point(self) -> Point:
        """The point of the end's link that the axis passes through."""
        assert isinstance(self.joint.axis.through, Point)
        return self.joint.axis.through

    @property
    def misses_end(self) -> bool:
        """Whether the axis passes beside the end point."""
        return self.axis_point != self.end


@dataclass(frozen=True)
class Meeting:
    """The condition for which the coordinate of a hinge or guide was solved."""

    # placed body, and the one that the joint carries
    parent: str
    body: str
    # point of the body, and the point of a placed body that it meets, or that a rod connects it
    # with
    point: Point
    target: Point
    target_body: str
    rod: str | None = None  # that rod; None: the points meet


@dataclass(frozen=True)
class OffLine:
    """A link of a telescope whose axis misses the link's known point; its turn is not known yet."""

    ends: TelescopeEnds  # telescope with the names of its points and bodies
    anchor_motion: PointMotion
    end_motion: PointMotion
    # at the design position: unit vector of the axis from anchor to end, and the vector from the
    # axis to the end, across it (constants, work axes)
    axis: Vector
    offset: Vector
    # from anchor to end, and the square of that distance
    span: Vector
    span_squared: sp.Expr
    # part of the span along the axis
    reach: sp.Expr
    inverse_reach: sp.Expr
    length: sp.Expr  # length of the telescope: the reach and the constant `lead`
    lead: sp.Expr
    relative: PointMotion  # motion of the end relative to the anchor
    length_motion: dict[str, sp.Expr]  # rate of the length per unit rate of each coordinate
