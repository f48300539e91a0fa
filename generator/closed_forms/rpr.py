r"""A telescope in a plane between two placed pins: barrel and piston rod of a cylinder.

Two links on a common guide are pinned to bodies that are placed, at A and at D; the dyad of hinge,
guide and hinge. With S the part of D - A across the hinges, n the direction of the hinges, d that
of the guide, e the constant offset of D from the guide through A, u the extension along the guide,
and h the constant part of D - A along n,

    S = u d + e n x d,    d = (u S - e n x S) / |S|^2,    |S|^2 = u^2 + e^2.

Slide unknown: ``u = s sqrt(|S|^2 - e^2)``, s = +1 or -1, and the slide is u less its value at the
design position. Branch: s is the sign of u at the design position. Valid while ``|S| > |e|``; at
the edge the line of the pins is perpendicular to the guide. Slide known: u is known, and the loop
has closed before: the telescope then is a leg. That d is across n is one of the `assumptions`.

Both links have the body axes (n, d, n x d), in which D - A = (h, u, e). That D stays on the guide,
along n x d, gives the rate of the turn.

A telescope whose slide x is known is a rod of known variable length. With (h, c, e) the vector from
pin to pin at the design position, along n, along d and along n x d,

    l^2 = (c + x)^2 + e^2 + h^2,    l l' = (c + x) x',    (l l')' = x'^2 + (c + x) x''.

Where the guide lies along the line of the pins, e = h = 0 and c is the length. Valid while c + x
has the sign that it has at the design position. Pins at different places along the hinges (h not
zero) need a guide of their own direction.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import sympy as sp
from typing_extensions import override

from ..declare.joints import Revolute
from ..kinematics.extent import extent_squared, require
from ..loops.forms import ClosedForm, PlannedStep
from ..program.floors import BRANCH, DIRECTION, LENGTH, ROOT
from ..program.functions import Positive, SignOf
from ..program.vectors import UNIT_Y, UNIT_Z, ZERO, Axes, Vector, from_axes, to_axes
from .constraints import Guided
from .guided_pair import GuidedPair
from .leg import Leg, RodLeg
from .solved_motion import ClosureCondition, TargetPoint, TurnOnHinge, add_turn, place_at
from .turned_alike import place_turned_alike

if TYPE_CHECKING:
    from typing import Self

    from ..declare.geometry import Point
    from ..kinematics.extent import Spanning
    from ..kinematics.kinematics import Kinematics
    from ..kinematics.motion import PointMotion
    from ..loops.cut import CutLoop
    from ..loops.forms import Closing
    from ..loops.known import Coordinate, Known


@dataclass(frozen=True)
class _OnPins(PlannedStep):
    """A telescope in a plane between two placed pins."""

    telescope: GuidedPair

    @property
    def about(self) -> str:
        return self.telescope.near

    @property
    def points(self) -> tuple[Point, ...]:
        return self.telescope.points

    def accept(self, known: Known) -> set[Coordinate]:
        """Record the two links, and the joints at them."""
        telescope = self.telescope
        known.placed |= {telescope.near, telescope.far}
        ends = telescope.joints_at_ends(known.mechanism.joints)
        return known.add_all([telescope.joint, *ends])


@dataclass(frozen=True)
class RPR(_OnPins, ClosedForm):
    """Two placed pins are the ends of a telescope in a plane: slide and direction follow."""

    rank: ClassVar[int] = 2

    @classmethod
    def match(cls, known: Known, cut: CutLoop) -> Self | None:
        """Return the telescope of one arc of a loop, with both pins on placed bodies."""
        telescope = _pinned(known, cut)
        placed = {cut.others[0], cut.others[-1]} <= known.placed
        if telescope is None or not placed or known.unknowns_of(telescope.joint) == 0:
            return None
        return cls(telescope)

    @property
    def title(self) -> str:
        return f"transformer: telescope of {self.telescope.links}"

    @override
    def words(self, closing: Closing | None) -> tuple[str, str]:
        telescope = self.telescope
        return (
            f"{telescope.line} = length of {telescope.links} at {telescope.joint.name}.slide",
            "explicit: the way along the guide is the root of a difference of squares",
        )

    def emit(self, kin: Kinematics) -> None:
        """Find slide and direction of a telescope between two placed pins."""
        telescope = self.telescope
        program, near, joint = kin.program, telescope.near, telescope.joint
        pins = _Pins.of(kin, self, telescope)
        _, c, e = pins.guide.start
        extent = extent_squared(kin, self)
        squared = program.guarded(
            f"{near}_extension_squared",
            pins.across.dot(pins.across) - e**2,
            f"{kin.loop_of(self)} cannot close: the pins {telescope.anchor.name} and "
            f"{telescope.end.name} come nearer to each other than the guide of {telescope.links} "
            "allows",
            "m^2",
            # the square of the distance of the pins is more by e^2: their direction counts, too
            ROOT * extent + Positive(DIRECTION * extent - e**2),
        )
        extension = program.define(f"{near}_extension", pins.guide.branch * sp.sqrt(squared))
        slide = telescope.sense * (extension - c)
        kin.slides[joint.name] = program.define(f"slide_{joint.name}", slide)
        _place(kin, pins, extension)


@dataclass(frozen=True)
class PlaceTelescope(_OnPins):
    """Two placed pins are the ends of a telescope of known slide: its direction follows."""

    @property
    def title(self) -> str:
        return f"{self.telescope.links}: telescope"

    def emit(self, kin: Kinematics) -> None:
        """Find the direction of the telescope."""
        pins = _Pins.of(kin, self, self.telescope)
        _place(kin, pins, pins.guide.known_extension(kin, extent_squared(kin, self)))


@dataclass(frozen=True)
class PinnedTelescope(Leg):
    """A telescope in a plane whose slide is known, as a leg."""

    telescope: GuidedPair

    @classmethod
    def match(cls, known: Known, cut: CutLoop) -> Self | None:
        """Return the telescope of one arc of a loop."""
        pair = _pinned(known, cut)
        if pair is None or known.unknowns_of(pair.joint) > 0:
            return None
        return cls(pair.end_body, pair.near, pair.end, pair.anchor, pair.anchor_body, pair)

    @property
    def links(self) -> tuple[str, ...]:
        return self.telescope.near, self.telescope.far

    @property
    def placing(self) -> PlannedStep:
        return PlaceTelescope(self.telescope)

    @property
    def measure(self) -> str:
        return f"{self.telescope.links} at {self.telescope.joint.name}.slide"

    def stretched(self, kin: Kinematics, design: Vector, extent: sp.Expr) -> RodLeg:
        """Append its length, for the known slide."""
        telescope, near = self.telescope, self.rod
        guide = _Guide.of(kin, telescope, extent)
        extension = guide.known_extension(kin, extent)
        beside = guide.start.x**2 + guide.start.z**2
        squared = kin.program.define(f"{near}_length_squared", extension**2 + beside)
        rod = RodLeg(f"telescope of {telescope.links}", design, sp.sqrt(squared), squared)
        slope = telescope.sense * extension
        return rod.driven(kin.coordinates, telescope.joint, slope, sp.Integer(1))


# -- structure ------------------------------------------------------------------------------------


def _pinned(known: Known, cut: CutLoop) -> GuidedPair | None:
    """Return the planar telescope of one arc of a loop: a hinge at either end."""
    pair = GuidedPair.match(cut)
    if pair is None:
        return None
    hinges = pair.joints_at_ends(known.mechanism.joints)
    if not all(isinstance(hinge, Revolute) for hinge in hinges):
        return None
    return None if {pair.near, pair.far} & known.placed else pair


# -- algebra --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Guide:
    """The guide of a telescope in a plane, from the design position (constants)."""

    telescope: GuidedPair
    axes: Axes  # axes of both links: hinge n, guide d, and n x d; in work axes
    start: Vector  # vector from pin to pin along these axes, (h, c, e)
    branch: sp.Expr  # sign of c

    @classmethod
    def of(cls, kin: Kinematics, telescope: GuidedPair, extent: sp.Expr) -> _Guide:
        """Return the guide of a telescope."""
        program, near = kin.program, telescope.near
        hinge, _ = telescope.joints_at_ends(kin.mechanism.joints)
        assert isinstance(hinge, Revolute)
        n = kin.unit(f"{near}_hinge_design", kin.to_work(hinge.axis.vector))
        span = kin.design(telescope.end) - kin.design(telescope.anchor)
        span = program.vector(f"{near}_span_design", span)
        if telescope.along_ends:
            branch = telescope.forward
            sign = sp.Integer(1 if branch else -1)
            length = program.define(f"{near}_length_design", sp.sqrt(span.dot(span)))
            d = program.vector(f"{near}_guide_design", span * (sign / length))
            start = Vector(ZERO.x, sign * length, ZERO.z)
        else:
            d = kin.design_direction(telescope.joint.direction)
            side = program.vector(f"{near}_side_design", n.cross(d))
            along = (span.dot(axis) for axis in (n, d, side))
            start = program.vector(f"{near}_start", Vector(*along), "123")
            require(
                kin,
                f"{near}_along_design",
                start.y,
                BRANCH * sp.sqrt(extent),
                "m",
                f"at the design position, the pins {telescope.anchor.name} and "
                f"{telescope.end.name} are in a plane perpendicular to the guide of "
                f"{telescope.links}",
                "move one of the two along the guide",
            )
            sign = program.define(f"{near}_branch", SignOf(start.y))
        side = program.vector(f"{near}_side_design", n.cross(d))
        return cls(telescope, (n, d, side), start, sign)

    def known_extension(self, kin: Kinematics, extent: sp.Expr) -> sp.Expr:
        """Return c + x of a telescope of known slide x."""
        telescope = self.telescope
        slide = kin.given(telescope.joint)
        drawn = kin.program.guarded(
            f"{telescope.near}_extension",
            self.branch * (self.start.y + telescope.sense * slide),
            f"the telescope of {telescope.links} is drawn in until its pins "
            f"{telescope.anchor.name} and {telescope.end.name} meet, or pass each other",
            "m",
            LENGTH * sp.sqrt(extent),
        )
        return self.branch * drawn


@dataclass(frozen=True)
class _Pins:
    """The pins of a telescope and the vector between them."""

    telescope: GuidedPair
    guide: _Guide
    anchor: PointMotion
    end: PointMotion
    axis: Vector  # direction of the hinges, in work axes
    across: Vector  # from pin to pin, across the hinges

    @classmethod
    def of(cls, kin: Kinematics, step: Spanning, telescope: GuidedPair) -> _Pins:
        """Return the pins of a telescope, in the loop that a step closes."""
        program, near = kin.program, telescope.near
        guide = _Guide.of(kin, telescope, extent_squared(kin, step))
        parent = kin.placed[telescope.anchor_body]
        on_parent = to_axes(parent.design_axes, guide.axes[0])
        on_parent = program.vector(f"{near}_hinge_on_parent", on_parent, "123")
        axis = program.vector(f"{near}_hinge", from_axes(parent.axes, on_parent))
        anchor = kin.point_motion(telescope.anchor_body, telescope.anchor)
        end = kin.point_motion(telescope.end_body, telescope.end)
        span = end.position - anchor.position - axis * guide.start.x
        return cls(telescope, guide, anchor, end, axis, program.vector(f"{near}_span", span))


def _place(kin: Kinematics, pins: _Pins, extension: sp.Expr) -> None:
    """Place both links, for an extension along the guide."""
    telescope, start = pins.telescope, pins.guide.start
    near, arm = telescope.near, Vector(start.x, extension, start.z)
    axes = _axes(kin, pins, extension)
    at = telescope.anchor_body, telescope.anchor
    link = place_at(kin, near, at, axes, pins.guide.axes)
    guided, end = Guided(arm, arm, UNIT_Z, guide=UNIT_Y), TargetPoint(kin, link, pins.end)
    add_turn(kin, TurnOnHinge(kin, link, *at), ClosureCondition(guided, end, arm, is_first=True))
    place_turned_alike(kin, telescope.far, link, telescope.end_body, telescope.end)


def _axes(kin: Kinematics, pins: _Pins, extension: sp.Expr) -> Axes:
    """Return the axes of both links: hinge, guide, and across both."""
    program, near, offset = kin.program, pins.telescope.near, pins.guide.start.z
    if offset == 0:
        along = pins.across * program.define(f"{near}_extension_inverse", 1 / extension)
    else:
        inverse = program.define(f"{near}_span_inverse_squared", 1 / (extension**2 + offset**2))
        along = pins.across * extension - pins.axis.cross(pins.across) * offset
        along *= inverse
    d = program.vector(f"{near}_guide", along)
    return pins.axis, d, program.vector(f"{near}_side", pins.axis.cross(d))
