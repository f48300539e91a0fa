"""Distance along a telescope."""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

from ..kinematics.extent import extent_squared, require
from ..kinematics.motion import OffLine
from ..program.floors import BRANCH, LENGTH, ROOT
from .lines import line_of_ends, require_length

if TYPE_CHECKING:
    from ..kinematics.kinematics import Kinematics
    from ..loops.actions import SolveTelescope


def solve_telescope(kin: Kinematics, action: SolveTelescope) -> None:
    """Length and direction of a telescope between two known points (Eqs. 6 to 8).

    Equation: ``|P_end - P_anchor| = length``, explicit in the slide, ``slide = p - length``.
    Branch: the positive length. Singular set: the two points coincide. Where the axis misses the
    end, `_solve_offset` takes over.
    """
    if action.misses_end:
        _solve_offset(kin, action)
        return
    name = action.joint.name
    record = line_of_ends(kin, action, f"telescope {name}")
    kin.on_line[action.anchor_link] = record
    kin.on_line[action.end_link] = record
    kin.telescopes[name] = record
    kin.slides[name] = kin.program.define(
        f"slide_{name}", sp.Symbol(action.joint.length_at_zero_slide) - record.length
    )


def _solve_offset(kin: Kinematics, action: SolveTelescope) -> None:
    r"""Length of a telescope whose axis misses the end at a constant distance.

    Let S = P_end - P_anchor, and d the distance of the end from the axis. The reach h, which is the
    part of S along the axis, follows from \|S\|^2 = h^2 + d^2, a quadratic in the slide:

        slide = p - (h + lead),    h = sqrt(\|S\|^2 - d^2),

    where `lead` is how far the point that gives the telescope its length lies beyond the end.
    Branch: h > 0. Singular set: \|S\| = d. The direction of the axis is known only when the body
    at the end has found its orientation, see `offset_turn`.
    """
    joint, program = action.joint, kin.program
    name, lower = joint.name, action.axis_point
    anchor = kin.point_motion(action.anchor_body, action.anchor)
    end = kin.point_motion(action.end_body, action.end)
    axis = kin.unit(f"{name}_axis_design", kin.design(lower) - kin.design(action.anchor))
    span_design = program.vector(
        f"{name}_span_design", kin.design(action.end) - kin.design(action.anchor)
    )
    along = program.define(f"{name}_reach_design", span_design.dot(axis))
    offset = program.vector(f"{name}_offset_design", span_design - axis * along)
    lead = program.define(f"{name}_lead", (kin.design(lower) - kin.design(action.end)).dot(axis))
    relative = end.minus(anchor)
    span = program.vector(f"span_{name}", relative.position)
    span_squared = program.define(f"span_squared_{name}", span.dot(span))
    extent = extent_squared(kin, action)
    require_length(kin, name, (action.anchor, lower), f"telescope {name}", extent)
    require(
        kin,
        f"{name}_reach_design",
        along,
        BRANCH * sp.sqrt(extent),
        "m",
        f"at the design position, {action.end.name} is beside {action.anchor.name}, seen along "
        f"telescope {name}",
        f"move {lower.name}",
    )
    squared = program.guarded(
        f"length_squared_{name}",
        span_squared - offset.dot(offset),
        f"{kin.loop_of(action)} cannot close: {action.anchor.name} would be nearer to "
        f"{action.end.name} than the axis of telescope {name}",
        "m^2",
        ROOT * extent,
    )
    reach = program.define(f"reach_{name}", sp.sqrt(squared))
    inverse = program.define(f"inverse_reach_{name}", 1 / reach)
    # the length is the reach and a constant, so that nothing has to be added for its guard
    drawn = program.guarded(
        f"length_{name}",
        reach,
        f"{kin.loop_of(action)}: telescope {name} is drawn in until its ends {action.anchor.name} "
        f"and {lower.name} meet, or pass each other",
        "m",
        LENGTH * sp.sqrt(extent) - lead,
    )
    kin.off_line[action.end_link] = OffLine(
        action,
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
        f"slide_{name}",
        sp.Symbol(joint.length_at_zero_slide) - kin.off_line[action.end_link].length,
    )
