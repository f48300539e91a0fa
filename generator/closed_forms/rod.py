"""What holds a body: a link of constant length, or a telescope of known slide.

A telescope in a plane whose slide x is known is a rod of known variable length. With d the
direction of the guide, n that of the hinges, d across n, and (h, c, e) the way from pin to pin at
the design position, along n, along d and along n x d,

    l^2 = (c + x)^2 + e^2 + h^2,    l l' = (c + x) x',    (l l')' = x'^2 + (c + x) x''.

These three are all that the closed forms of `arm` and `slide` read of it, at position, velocity and
acceleration level. Where the guide lies along the line of the pins, e = h = 0 and c is the length.
Valid while c + x has the sign that it has at the design position. That d is across n is one of the
`assumptions`; pins at different places along the hinges (h not zero) need a guide of their own
direction.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import sympy as sp

from ..kinematics.extent import extent_squared, require
from ..loops.actions import HeldByRod, Strut
from ..program.floors import BRANCH, LENGTH
from ..program.functions import SignOf
from ..program.vectors import ZERO, Vector

if TYPE_CHECKING:
    from ..declare.joints import Prismatic
    from ..kinematics.kinematics import Kinematics
    from ..kinematics.motion import Axes
    from ..loops.actions import PinnedTelescope, SolveHinge, SolveSlide, SolveTurn


@dataclass(frozen=True)
class Rod:
    """A rod between two points, from the anchor to the end.

    Attributes
    ----------
    name
        What it is and its name, for messages.
    design
        The way from the anchor to the end at the design position (work axes).
    length, squared
        Length and its square.
    stretch
        Length times its rate, per unit rate of each coordinate that changes it.
    stretch_bias
        What the second derivative of half the square is without accelerations of the independent
        coordinates.
    """

    name: str
    design: Vector
    length: sp.Expr
    squared: sp.Expr
    stretch: dict[str, sp.Expr] = field(default_factory=dict)
    stretch_bias: sp.Expr = sp.S.Zero

    @classmethod
    def of(cls, kin: Kinematics, action: SolveTurn | SolveHinge | SolveSlide | HeldByRod) -> Rod:
        """Return the rod of an action."""
        design = kin.design(action.end) - kin.design(action.anchor)
        design = kin.program.vector(f"{action.rod}_design", design)
        telescope, extent = getattr(action, "telescope", None), extent_squared(kin, action)
        if isinstance(action, HeldByRod) and action.guide is not None:
            sense = 1 if action.guide.direction.between == (action.anchor, action.end) else -1
            links = action.rod, action.far or ""
            rod = cls._strut(kin, links, action.guide, sense, design, extent)
        elif isinstance(telescope, Strut):
            links = telescope.near, telescope.far
            rod = cls._strut(kin, links, telescope.joint, telescope.sense, design, extent)
        elif telescope is None:
            length = kin.program.define(f"{action.rod}_length", sp.sqrt(design.dot(design)))
            cls._require_length(kin, action, length, extent)
            rod = cls(f"rod {action.rod}", design, length, length**2)
        else:
            rod = cls._telescopic(kin, telescope, design, extent)
        kin.rod_lengths[action.rod] = rod.length
        return rod

    @staticmethod
    def _require_length(
        kin: Kinematics,
        action: SolveTurn | SolveHinge | SolveSlide | HeldByRod,
        length: sp.Expr,
        extent: sp.Expr,
    ) -> None:
        first, second = action.anchor, action.end
        require(
            kin,
            f"{action.rod}_length",
            length,
            LENGTH * sp.sqrt(extent),
            "m",
            f"at the design position, the ends {first.name} and {second.name} of {action.rod} "
            "coincide",
            "move one of the two",
        )

    @classmethod
    def _strut(
        cls,
        kin: Kinematics,
        links: tuple[str, str],
        guide: Prismatic,
        sense: int,
        design: Vector,
        extent: sp.Expr,
    ) -> Rod:
        """Return a strut of known slide x along its line: l = l_0 + x, or l_0 - x."""
        program, (near, far) = kin.program, links
        start = program.define(f"{near}_length_start", sp.sqrt(design.dot(design)))
        coordinate = kin.coordinate_of(guide)
        length = program.guarded(
            f"{near}_length",
            start + sense * kin.coordinates[coordinate],
            f"the strut of {near} and {far} is drawn in until its ends meet",
            "m",
            LENGTH * sp.sqrt(extent),
        )
        stretch, bias = {}, sp.Integer(0)
        if coordinate in kin.moving:
            stretch[coordinate] = sense * length
            bias = kin.rate(coordinate) ** 2 + sense * length * kin.acceleration(coordinate)
        return cls(f"strut {near}", design, length, length**2, stretch, bias)

    @classmethod
    def _telescopic(
        cls, kin: Kinematics, telescope: PinnedTelescope, design: Vector, extent: sp.Expr
    ) -> Rod:
        """Return a telescope of known slide as a rod."""
        near = telescope.near
        guide = Guide.of(kin, telescope, extent)
        extension = guide.known_extension(kin, extent)
        beside = guide.start.x**2 + guide.start.z**2
        squared = kin.program.define(f"{near}_length_squared", extension**2 + beside)
        coordinate = kin.coordinate_of(telescope.joint)
        stretch, bias = {}, sp.Integer(0)
        if coordinate in kin.moving:
            stretch[coordinate] = telescope.sense * extension
            given = telescope.sense * kin.acceleration(coordinate)
            bias = kin.rate(coordinate) ** 2 + extension * given
        name = f"telescope of {telescope.links}"
        return cls(name, design, sp.sqrt(squared), squared, stretch, bias)


@dataclass(frozen=True)
class Guide:
    """The guide of a telescope in a plane, from the design position (constants).

    Attributes
    ----------
    axes
        Axes of both links: hinge n, guide d, and n x d; in work axes.
    start
        The way from pin to pin along these axes, (h, c, e).
    branch
        Sign of c.
    """

    telescope: PinnedTelescope
    axes: Axes
    start: Vector
    branch: sp.Expr

    @classmethod
    def of(cls, kin: Kinematics, telescope: PinnedTelescope, extent: sp.Expr) -> Guide:
        """Describe the guide of a telescope."""
        program, near = kin.program, telescope.near
        n = kin.unit(f"{near}_hinge_design", kin.to_work(telescope.near_hinge.axis.vector))
        span = kin.design(telescope.end) - kin.design(telescope.anchor)
        span = program.vector(f"{near}_span_design", span)
        if telescope.along_pins:
            branch = telescope.joint.direction.between == (telescope.anchor, telescope.end)
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
                f"{telescope.end.name} stand across the guide of {telescope.links}",
                "move one of the two along the guide",
            )
            sign = program.define(f"{near}_branch", SignOf(start.y))
        side = program.vector(f"{near}_side_design", n.cross(d))
        return cls(telescope, (n, d, side), start, sign)

    def known_extension(self, kin: Kinematics, extent: sp.Expr) -> sp.Expr:
        """Return c + x of a telescope of known slide x."""
        telescope = self.telescope
        slide = kin.coordinates[kin.coordinate_of(telescope.joint)]
        drawn = kin.program.guarded(
            f"{telescope.near}_extension",
            self.branch * (self.start.y + telescope.sense * slide),
            f"the telescope of {telescope.links} is drawn in until its pins "
            f"{telescope.anchor.name} and {telescope.end.name} meet, or pass each other",
            "m",
            LENGTH * sp.sqrt(extent),
        )
        return self.branch * drawn
