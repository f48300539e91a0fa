"""Distance along a telescope.

Equation: ``|P_end - P_anchor| = length``, explicit in the slide, ``slide = p - length``; Eqs. 6 to
8 of the paper. Branch: the positive length. Singular set: the two points coincide.

Its length follows, and its direction too, unless the axis misses the end: then the rod that holds
the body at the end determines it (`offset_turn`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import sympy as sp
from typing_extensions import override

from ..declare.joints import Cylindrical
from ..kinematics.extent import extent_squared, require
from ..kinematics.motion import OffLine, TelescopeEnds
from ..loops.forms import ClosedForm
from ..program.floors import BRANCH, LENGTH, ROOT
from .lines import line_of_ends, require_length

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Self

    from ..declare.geometry import Point
    from ..declare.joints import Joint
    from ..kinematics.kinematics import Kinematics
    from ..kinematics.step import Ends
    from ..loops.cut import CutLoop
    from ..loops.forms import Closing
    from ..loops.known import Coordinate, Known


@dataclass(frozen=True)
class Telescope(ClosedForm):
    """Two placed points are the ends of a telescope: its length follows."""

    ends: TelescopeEnds

    rank: ClassVar[int] = 1
    equations: ClassVar[tuple[int, ...]] = (1, 2)
    """Between two crosses its rotation remains, on which its length does not depend."""

    @classmethod
    def match(cls, known: Known, cut: CutLoop) -> Self | None:
        """Return the two links of one arc on a common axis, with both ends on placed bodies."""
        if len(cut.joints) != 1 or not isinstance(cut.joints[0], Cylindrical):
            return None
        joint, (anchor_link, end_link) = cut.joints[0], cut.bodies
        # the axis of the joint runs from the second body to the anchor, a point of the first
        along_axis = joint.axis.towards == cut.anchor
        placed = {cut.others[0], cut.others[-1]} <= known.placed
        if known.knows(joint, "slide") or not (along_axis and placed):
            return None
        if anchor_link != joint.first.name:
            return None
        anchor = cut.anchor, cut.others[0], anchor_link
        return cls(TelescopeEnds(joint, *anchor, cut.end, cut.others[-1], end_link))

    @property
    def about(self) -> str:
        return self.ends.end_link

    @property
    def title(self) -> str:
        return f"transformer: telescope {self.ends.joint.name}"

    @property
    def points(self) -> tuple[Point, ...]:
        """Both ends, and the point where the axis passes the far one."""
        return self.ends.anchor, self.ends.end, self.ends.axis_point

    def origin_on(self, ground: str) -> Point | None:
        """Return its anchor, if that is on the ground."""
        return self.ends.anchor if self.ends.anchor_body == ground else None

    def accept(self, known: Known) -> set[Coordinate]:
        """Record the length, and the direction unless its axis misses the end."""
        known.on_line.add(self.ends.end_link)
        joints = [] if self.ends.misses_end else self.aim(known)
        slide = known.add({(self.ends.joint.name, "slide")})
        return slide | known.add_all(joints)

    def aim(self, known: Known) -> list[Joint]:
        """Record that the direction is known; return the joints whose coordinates follow."""
        known.on_line.add(self.ends.anchor_link)
        universal = known.mechanism.universal_at(self.ends.anchor_link, self.ends.anchor)
        return [universal] if universal else []

    def lines(self) -> Iterator[Ends]:
        """Yield the link at the anchor, along the axis."""
        yield self.ends.anchor_link, self.ends.anchor, self.ends.axis_point

    @override
    def words(self, closing: Closing | None) -> tuple[str, str]:
        joint, end, anchor = self.ends.joint, self.ends.end, self.ends.anchor
        full = joint.length_at_zero_slide.name
        return (
            f"|{end.name} - {anchor.name}| = {full} - {joint.name}.slide",
            "explicit: the length is the root of a sum of squares",
        )

    def emit(self, kin: Kinematics) -> None:
        """Find length and direction between two known points."""
        ends = self.ends
        kin.spans[ends.joint.name] = ends
        if ends.misses_end:
            _solve_offset(kin, self)
            return
        name = ends.joint.name
        at = (ends.anchor_body, ends.anchor), (ends.end_body, ends.end)
        record = line_of_ends(kin, self, name, at, f"telescope {name}")
        kin.on_line[ends.anchor_link] = record
        kin.on_line[ends.end_link] = record
        kin.telescopes[name] = record
        kin.slides[name] = kin.program.define(
            f"slide_{name}", ends.joint.length_at_zero_slide.symbol - record.length
        )


def _solve_offset(kin: Kinematics, step: Telescope) -> None:
    r"""Length of a telescope whose axis misses the end at a constant distance.

    Let S = P_end - P_anchor, and d the distance of the end from the axis. The reach h, which is the
    part of S along the axis, follows from \|S\|^2 = h^2 + d^2, a quadratic in the slide:

        slide = p - (h + lead),    h = sqrt(\|S\|^2 - d^2),

    where `lead` is the distance beyond the end of the point that defines the telescope's length.
    Branch: h > 0. Singular set: \|S\| = d. The direction of the axis is known only when the body
    at the end has found its orientation, see `offset_turn`.
    """
    ends, program = step.ends, kin.program
    joint = ends.joint
    name, lower = joint.name, ends.axis_point
    anchor = kin.point_motion(ends.anchor_body, ends.anchor)
    end = kin.point_motion(ends.end_body, ends.end)
    axis = kin.unit(f"{name}_axis_design", kin.design(lower) - kin.design(ends.anchor))
    span_design = program.vector(
        f"{name}_span_design", kin.design(ends.end) - kin.design(ends.anchor)
    )
    along = program.define(f"{name}_reach_design", span_design.dot(axis))
    offset = program.vector(f"{name}_offset_design", span_design - axis * along)
    lead = program.define(f"{name}_lead", (kin.design(lower) - kin.design(ends.end)).dot(axis))
    relative = end.minus(anchor)
    span = program.vector(f"span_{name}", relative.position)
    span_squared = program.define(f"span_squared_{name}", span.dot(span))
    extent = extent_squared(kin, step)
    require_length(kin, name, (ends.anchor, lower), f"telescope {name}", extent)
    require(
        kin,
        f"{name}_reach_design",
        along,
        BRANCH * sp.sqrt(extent),
        "m",
        f"at the design position, {ends.end.name} is beside {ends.anchor.name}, seen along "
        f"telescope {name}",
        f"move {lower.name}",
    )
    squared = program.guarded(
        f"length_squared_{name}",
        span_squared - offset.dot(offset),
        f"{kin.loop_of(step)} cannot close: {ends.anchor.name} would be nearer to "
        f"{ends.end.name} than the axis of telescope {name}",
        "m^2",
        ROOT * extent,
    )
    reach = program.define(f"reach_{name}", sp.sqrt(squared))
    inverse = program.define(f"inverse_reach_{name}", 1 / reach)
    # the length is the reach and a constant, so that its guard needs no further step
    drawn = program.guarded(
        f"length_{name}",
        reach,
        f"{kin.loop_of(step)}: telescope {name} is drawn in until its ends {ends.anchor.name} "
        f"and {lower.name} meet, or pass each other",
        "m",
        LENGTH * sp.sqrt(extent) - lead,
    )
    kin.off_line[ends.end_link] = OffLine(
        ends,
        anchor,
        end,
        axis,
        offset,
        span,
        span_squared,
        drawn,
        inverse,
        program.define(f"length_{name}", drawn + lead),
        lead,
        relative,
        {
            k: program.define(f"d_length_{name}_{k}", span.dot(v) * inverse)
            for k, v in relative.motion.items()
        },
    )
    kin.slides[name] = program.define(
        f"slide_{name}", joint.length_at_zero_slide.symbol - kin.off_line[ends.end_link].length
    )
