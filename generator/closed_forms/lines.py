"""Lines between points of known motion, and bodies about them: helpers of the closed forms."""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

from ..kinematics.extent import extent_squared, require
from ..kinematics.motion import OnLine
from ..program.floors import DIRECTION, LENGTH
from ..program.vectors import ZERO, Vector

if TYPE_CHECKING:
    from ..declare.geometry import Point
    from ..kinematics.extent import Spanning
    from ..kinematics.kinematics import Kinematics
    from ..program.vectors import Axes
    from .leg import Leg

    Ends = tuple[tuple[str, Point], tuple[str, Point]]
    """Body and point at either end."""


def line_of_ends(kin: Kinematics, step: Spanning, name: str, ends: Ends, what: str) -> OnLine:
    """Append the line between two placed ends whose distance varies.

    The step closes its loop, and `name` ends the names of the steps. `ends` are body and point at
    either end, `what` the links between them, for the message that these coincide.
    """
    (_, first), (_, second) = ends
    span, extent = _span(kin, name, ends), extent_squared(kin, step)
    require_length(kin, name, (first, second), what, extent)
    squared = kin.program.guarded(
        f"length_squared_{name}",
        span.dot(span),
        f"{kin.loop_of(step)}: the ends {first.name} and {second.name} of {what} coincide",
        "m^2",
        DIRECTION * extent,
    )
    return _line(kin, name, ends, kin.program.define(f"length_{name}", sp.sqrt(squared)), squared)


def _line(
    kin: Kinematics,
    name: str,
    ends: Ends,
    length: sp.Expr,
    squared: sp.Expr | None = None,
    *,
    rigid: bool = False,
) -> OnLine:
    """Return the line between two points of placed bodies, whose distance may be constant.

    If the square of the length is given, the reciprocals come from that: a division that need not
    wait for the root.
    """
    program, ((anchor_body, anchor), (end_body, end)) = kin.program, ends
    if squared is None:
        inverse = program.define(f"inverse_length_{name}", 1 / length)
        inverse_squared = program.define(f"inverse_length_squared_{name}", inverse**2)
    else:
        inverse_squared = program.define(f"inverse_length_squared_{name}", 1 / squared)
        inverse = program.define(f"inverse_length_{name}", length * inverse_squared)
    motions = kin.point_motion(anchor_body, anchor), kin.point_motion(end_body, end)
    relative, span = motions[1].minus(motions[0]), _span(kin, name, ends)
    direction = program.vector(f"direction_{name}", span * inverse)
    motion = {
        k: program.define(f"d_length_{name}_{k}", direction.dot(v))
        for k, v in relative.motion.items()
        if not rigid
    }
    return OnLine(
        *(anchor, end, *motions, anchor_body, end_body, direction, length, inverse),
        *(relative, motion, span, inverse_squared),
    )


def _span(kin: Kinematics, name: str, ends: Ends) -> Vector:
    anchor, end = (kin.point_motion(*at).position for at in ends)
    return kin.program.vector(f"span_{name}", end - anchor)


def require_length(
    kin: Kinematics, name: str, ends: tuple[Point, Point], what: str, extent: sp.Expr
) -> None:
    """Have `prepare` check that two points are apart at the design position.

    `name` begins the names of the constants; `what` are the links between the points, for the
    message, `extent` the square of the extent of the loop.
    """
    first, second = ends
    span = kin.program.vector(f"{name}_span_design", kin.design(second) - kin.design(first))
    require(
        kin,
        f"{name}_length_design",
        sp.sqrt(span.dot(span)),
        LENGTH * sp.sqrt(extent),
        "m",
        f"at the design position, the ends {first.name} and {second.name} of {what} coincide",
        "move one of the two",
    )


def place_rod(kin: Kinematics, leg: Leg) -> None:
    """Record the line of a leg from its anchor to the body that it holds."""
    ends, length = ((leg.anchor_body, leg.anchor), (leg.body, leg.end)), kin.rod_lengths[leg.rod]
    kin.on_line[leg.rod] = _line(kin, leg.rod, ends, length, rigid=leg.rigid)


def axes_about(kin: Kinematics, name: str, line: Vector, way: Vector) -> tuple[Axes, Vector]:
    """Append axes along a line, along the part of a vector across it, and across both (constants).

    The axes are returned, and the components of the vector along the line, and across it.
    """
    program = kin.program
    along = program.define(f"{name}_along", way.dot(line))
    across = program.vector(f"{name}_across", way - line * along)
    radius = program.define(f"{name}_radius", sp.sqrt(across.dot(across)))
    t = program.vector(f"{name}_unit", across * (1 / radius))
    normal = program.vector(f"{name}_normal", line.cross(t))
    return (line, t, normal), Vector(along, radius, ZERO.z)
