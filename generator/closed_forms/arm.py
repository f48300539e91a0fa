"""The kernel of the closed forms with a rod: an arm turns about a line until the rod fits.

Let n be the direction of the line, F the foot on it of the rod's joint D, rho = |FD|, E the other
end of the rod of length l, and w = E - F with parts w_n along n and w_p across it. The unit vector
t from F to D is perpendicular to n, and ``|D - E| = l`` becomes

    t . w_p = k,    k = (rho^2 + |w_p|^2 + w_n^2 - l^2) / (2 rho),

which is ``a cos + b sin = c`` without a reference for the angle. Its solutions:

    t = (k w_p + s sqrt(|w_p|^2 - k^2) n x w_p) / |w_p|^2,    s = +1 or -1.

Branch: s is the sign of (D - E) . (n x t) at the design position. Valid while ``|w_p|^2 > k^2``;
the edge is the dead point where rod, D and the line are in one plane. Singular: E on the line.
With D on the line, rho = 0, the arm has no direction and the rod holds nothing; rho is a constant,
and `prepare` refuses parameters for which it vanishes (t is not finite then).

The body axes are (n, t, n x t). In them D - E = (-w_n, rho - k, s sqrt(|w_p|^2 - k^2)), so the
turning rate follows from ``(D - E) . (v_D - v_E) = l l'`` with one division. The right side is zero
but for a telescope of known slide, which is a rod of known variable length (`leg`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..kinematics.extent import extent_squared, require
from ..program.floors import BRANCH, DIRECTION, LENGTH, ROOT
from ..program.functions import SignOf
from ..program.vectors import Vector
from .constraints import FixedDistance
from .lines import axes_about
from .solved_motion import ClosureCondition, TargetPoint, add_turn

if TYPE_CHECKING:
    from ..declare.geometry import Point
    from ..kinematics.extent import Spanning
    from ..kinematics.kinematics import Kinematics
    from ..kinematics.motion import PointMotion
    from ..program.vectors import Axes
    from .leg import Leg, RodLeg
    from .solved_motion import Unsolved


@dataclass(frozen=True)
class Arm:
    """The arm that turns about the line, at the design position (constants)."""

    local: Vector  # position of the point D relative to the base, in body axes
    design_axes: Axes  # line, direction to D across it, normal to both; in work axes
    base: Vector  # point of the line that is the origin of the arm, at the design position

    @classmethod
    def of(
        cls, kin: Kinematics, body: str, line: Vector, base: Point, end: Point, extent: sp.Expr
    ) -> Arm:
        """Return the arm of a body from a base on its line to its end D.

        `line` is the unit vector along the line at the design position, `extent` the square of the
        extent of the loop.
        """
        way = kin.program.vector(f"{body}_arm_design", kin.design(end) - kin.design(base))
        axes, local = axes_about(kin, f"{body}_arm", line, way)
        require(
            kin,
            f"{body}_arm_radius",
            local.y,
            LENGTH * sp.sqrt(extent),
            "m",
            f"at the design position, {end.name} is on the line about which {body} turns",
            f"move {end.name} away from that line",
        )
        return cls(local, axes, kin.design(base))

    @property
    def along(self) -> sp.Expr:
        """Distance of D from the base along the line [m]."""
        return self.local.x

    @property
    def radius(self) -> sp.Expr:
        """Distance of D from the line [m]."""
        return self.local.y


@dataclass(frozen=True)
class Reach:
    """Vector from the foot of the arm to the rod's anchor: w_n, w_p and n x w_p."""

    axial: sp.Expr
    across: Vector
    normal: Vector


@dataclass(frozen=True)
class ArmSolution:
    """The solution: body axes, D - E in them, the factor of the turning rate, and the rod."""

    axes: Axes
    rod_vector: Vector
    inverse_lever: sp.Expr
    rod: RodLeg


def fit_rod(
    kin: Kinematics, step: Spanning, leg: Leg, arm: Arm, line: Vector, reach: Reach
) -> ArmSolution:
    """Turn an arm about a line until a leg fits, in the loop that a step closes."""
    program, body, rho = kin.program, leg.body, arm.radius
    rod = leg.rod_of(kin, step)
    loop, extent = kin.loop_of(step), extent_squared(kin, step)
    _require_reach(kin, leg, arm, extent)
    branch = _branch(kin, leg, arm, rod, extent)
    squared = program.guarded(
        f"{body}_reach_squared",
        reach.across.dot(reach.across),
        f"{loop}: point {leg.anchor.name} lies on the line of {body}, whose rotation is "
        "undetermined",
        "m^2",
        DIRECTION * extent,
    )
    k = program.define(
        f"{body}_reach_needed",
        (squared + reach.axial**2 + (rho**2 - rod.squared)) * (1 / (2 * rho)),
    )
    room = program.guarded(
        f"{body}_closure",
        squared - k**2,
        f"{loop} cannot close: the {rod.name} cannot reach {body}, beyond its dead point",
        "m^2",
        ROOT * extent,
    )
    root = program.define(f"{body}_closure_root", sp.sqrt(room))
    inverse = program.define(f"{body}_reach_inverse", 1 / squared)
    signed = program.define(f"{body}_reach_inverse_signed", branch * inverse)
    cosine = program.define(f"{body}_turn_cosine", k * inverse)
    sine = program.define(f"{body}_turn_sine", root * signed)
    axes: Axes = (
        line,
        program.vector(f"{body}_arm", reach.across * cosine + reach.normal * sine),
        program.vector(f"{body}_normal", reach.normal * cosine - reach.across * sine),
    )
    height = program.define(f"{body}_rod_height", branch * root)
    rod_vector = program.vector(f"{body}_rod", Vector(-reach.axial, rho - k, height), "123")
    inverse_lever = program.define(f"{body}_inverse_lever", -branch / (rho * root))
    return ArmSolution(axes, rod_vector, inverse_lever, rod)


def add_turn_of_rod(
    kin: Kinematics, unsolved: Unsolved, fit: ArmSolution, arm: Arm, anchor: PointMotion
) -> None:
    """Record velocities and bias of a body that a rod from an anchor holds by an arm."""
    end, rod = arm.local, fit.rod
    length = FixedDistance(fit.rod_vector, end - fit.rod_vector, end, rod.squared)
    target = TargetPoint(kin, unsolved.placed, anchor)
    add_turn(kin, unsolved, ClosureCondition(length, target, end, rod), fit.inverse_lever)


def _require_reach(kin: Kinematics, leg: Leg, arm: Arm, extent: sp.Expr) -> None:
    """Have `prepare` check that the rod's anchor is beside the line."""
    program, body, anchor = kin.program, leg.body, leg.anchor
    line = arm.design_axes[0]
    way = program.vector(f"{body}_reach_design", kin.design(anchor) - arm.base)
    across = program.vector(
        f"{body}_reach_design_across",
        way - line * program.define(f"{body}_reach_design_along", way.dot(line)),
    )
    require(
        kin,
        f"{body}_reach_design",
        sp.sqrt(across.dot(across)),
        LENGTH * sp.sqrt(extent),
        "m",
        f"at the design position, {anchor.name} is on the line about which {body} turns, so that "
        f"{leg.rod} does not hold it",
        f"move {anchor.name} away from that line",
    )


def _branch(kin: Kinematics, leg: Leg, arm: Arm, rod: RodLeg, extent: sp.Expr) -> sp.Expr:
    """Return the sign of the side of the arm on which the rod is at the design position."""
    program, body = kin.program, leg.body
    height = program.define(f"{body}_rod_height_design", rod.design.dot(arm.design_axes[2]))
    require(
        kin,
        f"{body}_rod_height_design",
        height,
        BRANCH * sp.sqrt(extent),
        "m",
        f"at the design position the {rod.name} is at its dead point: it, {leg.end.name} and "
        f"the line about which {body} turns are in one plane",
        f"choose a design position where {leg.anchor.name} is beside that plane",
    )
    return program.define(f"{body}_branch", SignOf(height))
