"""A body that only rods hold, all together: a wheel carrier on several links. No closed form.

The equations, and the iteration that solves them from the design position on, are those of
`carrier_equations`. Here is what surrounds them, in straight-line code.

*Position.* What the iteration has found is corrected once more. That changes nothing but the last
digits, and carries all derivatives: by the implicit function theorem they are ``-J^-1 g_v``.

*Velocities and accelerations* fulfil ``J x = b``, b being what the starts of the rods do; they are
solved with what the iteration knows of J^-1 (`inverse`, where the guard is as well).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..kinematics.motion import Placed, PointMotion, from_axes
from ..loops.errors import NoClosedFormError
from ..program.function import LOST
from ..program.newton import Matrix, named
from ..program.vectors import ZERO, Twist, Vector
from .carrier_equations import Pose, RodEquation, block, rotation, split, turned
from .inverse import Inverse, guarded_factor
from .lines import once, place_rod, projector
from .rod import Rod

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..kinematics.kinematics import Kinematics
    from ..loops.actions import HeldByRod, SolveCarrier


def solve_carrier(kin: Kinematics, action: SolveCarrier) -> None:
    """Find the pose of a body that rods hold together, and its motion."""
    held = _Held.of(kin, action)
    _place(kin, held, _corrected(kin, held))
    for rod in held.rods:
        place_rod(kin, rod.entry, rod.anchor, rod.rod.length, rigid=rod.entry.guide is None)


@dataclass(frozen=True)
class _Held:
    """The body and what holds it.

    Attributes
    ----------
    base
        Motion of the known point; None if there is none.
    origin
        Origin of the body axes at design: the known point, or else the end of the first rod.
    size
        The length c of the equations: root mean square of the ways from there to the rods.
    rods
        In the order of the action.
    """

    action: SolveCarrier
    base: PointMotion | None
    origin: Vector
    size: sp.Expr
    rods: list[_RodAtBody]

    @classmethod
    def of(cls, kin: Kinematics, action: SolveCarrier) -> _Held:
        """Describe what an action is about."""
        program, body = kin.program, action.body
        if action.pin is None:
            base, origin = None, kin.design(action.rods[0].end)
            start = origin
        else:
            point, parent = action.pin
            base, origin = kin.point_motion(parent, point), kin.design(point)
            start = base.position
        ends = [
            program.vector(f"{body}_{entry.end.name}", kin.design(entry.end) - origin, "123")
            for entry in action.rods
        ]
        squares = sum((end.dot(end) for end in ends), sp.Integer(0))
        size = program.define(f"{body}_size", sp.sqrt(squares / len(ends)))
        rods = [
            _RodAtBody.of(kin, entry, end, start, size, pinned=base is not None)
            for entry, end in zip(action.rods, ends, strict=True)
        ]
        if all(program.constants.contains(c) for rod in rods for c in rod.equation.moving):
            message = (
                f"{body}, held by {action.rod_names}, cannot move: all that holds it stands still. "
                "Declare it as a part of the ground"
            )
            raise NoClosedFormError(message)
        return cls(action, base, origin, size, rods)

    def scaled(self, values: Sequence[sp.Expr]) -> list[sp.Expr]:
        """Return values of the rods, times the factors s of their equations."""
        return [v * rod.equation.scale for v, rod in zip(values, self.rods, strict=True)]


@dataclass(frozen=True)
class _RodAtBody:
    """A rod: its length, the motion of where it starts, and its equation."""

    entry: HeldByRod
    rod: Rod
    anchor: PointMotion
    equation: RodEquation

    @classmethod
    def of(
        cls,
        kin: Kinematics,
        entry: HeldByRod,
        end: Vector,
        start: Vector,
        size: sp.Expr,
        *,
        pinned: bool,
    ) -> _RodAtBody:
        """Describe a rod that ends at a point of the body; positions are from a start."""
        program, rod = kin.program, Rod.of(kin, entry)
        anchor = kin.point_motion(entry.anchor_body, entry.anchor)
        length = program.define(f"{entry.rod}_length_design", sp.sqrt(rod.design.dot(rod.design)))
        equation = RodEquation(
            program.vector(f"{entry.rod}_start", anchor.position - start),
            end,
            program.define(f"{entry.rod}_length_squared", rod.squared),
            program.define(f"{entry.rod}_scale", 1 / (length * size)),
            None if pinned else size,
        )
        return cls(entry, rod, anchor, equation)


@dataclass(frozen=True)
class _Solved:
    """The pose, the ways along the rods from their starts to their ends, J and its inverse."""

    pose: Pose
    gaps: list[Vector]
    rows: Matrix
    inverse: Inverse


# -- position -------------------------------------------------------------------------------------


def _found(kin: Kinematics, held: _Held) -> dict[str, sp.Expr]:
    """Append the call of the iteration, and return its results."""
    body, rods = held.action.body, {rod.entry.rod: rod.equation for rod in held.rods}
    iteration = block(kin.program, body, rods, held.size, kin.driven_coordinates())
    return kin.program.iterated(f"{body}_found", iteration)


def _corrected(kin: Kinematics, held: _Held) -> _Solved:
    """Correct what the iteration has found, and return the pose with its linear equations."""
    program, body, count = kin.program, held.action.body, len(held.rods)
    found = _found(kin, held)
    u, sigma = split(list(found.values())[:count])
    axes = rotation(program, f"{body}_found", u)
    start = Pose(axes, program.vector(f"{body}_found_shift", sigma * held.size))
    left = [
        program.define(f"{rod.entry.rod}_misfit", rod.equation.misfit(rod.equation.gap(start)))
        for rod in held.rods
    ]
    places = range(1, count + 1)
    adjugate = [[found[f"inverse_{i}{j}"] for j in places] for i in places]
    factor = guarded_factor(
        kin,
        body,
        found["determinant"],
        left,
        found[LOST],
        f"the loops of {body} through {held.action.rod_names} cannot close, or an iteration has "
        f"not found how in {{iterations}} steps on the way from the design position: the rods "
        f"cannot reach {body}, or they have no hold on it",
    )
    inverse = Inverse(adjugate, factor)
    step = [
        program.define(f"{body}_correction_{i}", value)
        for i, value in enumerate(inverse.step(left), 1)
    ]
    turn, way = split(step)
    names = (f"{body}_forward", f"{body}_side", f"{body}_top")
    moved = start.shift + from_axes(axes, way * held.size)
    pose = Pose(program.axes(names, turned(axes, turn)), program.vector(f"{body}_shift", moved))
    gaps = [
        program.vector(f"{rod.entry.rod}_gap", rod.equation.gap(pose), "123") for rod in held.rods
    ]
    rows = [rod.equation.row(gap) for rod, gap in zip(held.rods, gaps, strict=True)]
    return _Solved(pose, gaps, named(program, f"{body}_row", rows), inverse)


# -- motion ---------------------------------------------------------------------------------------


def _place(kin: Kinematics, held: _Held, solved: _Solved) -> None:
    """Record pose, velocities and bias."""
    action, program, pose = held.action, kin.program, solved.pose
    placed = Placed(
        action.body,
        origin=held.base.position
        if held.base
        else program.vector(f"{action.body}_origin", held.origin + pose.shift),
        axes=pose.axes,
        design_origin=held.origin,
        local={rod.entry.end: rod.equation.end for rod in held.rods},
    )
    if action.pin is not None:
        point, parent = action.pin
        placed.local[point] = ZERO
        placed.carrier = parent, kin.local(kin.placed[parent], point)
    _add_motion(kin, held, solved, placed)
    kin.placed[action.body] = placed


def _add_motion(kin: Kinematics, held: _Held, solved: _Solved, placed: Placed) -> None:
    """Add velocities and bias: every rod keeps its length, or has that of a known slide."""
    body, to_body = placed.body, projector(kin, placed)
    rates = [ZERO for _ in held.rods]  # of the ends of the rods, as seen from where they start

    def solve(name: str, slips: Sequence[sp.Expr]) -> list[sp.Expr]:
        return solved.inverse.solve(kin, name, solved.rows, held.scaled(slips))

    def twist_of(x: Sequence[sp.Expr], base: Vector) -> Twist:
        """Return a twist (or a bias) from the solution, and from the base where that is known."""
        turn, way = split(x)
        return Twist(turn, base if held.base else way * held.size)

    for k in _coordinates(held):
        base = to_body(f"velocity_{k}", held.base.motion.get(k, ZERO)) if held.base else ZERO
        starts = [
            to_body(f"{rod.entry.rod}_start_{k}", rod.anchor.motion.get(k, ZERO))
            for rod in held.rods
        ]
        growths = [rod.rod.stretch.get(k, sp.Integer(0)) for rod in held.rods]
        slips = [
            growth - gap.dot(base - start)
            for growth, gap, start in zip(growths, solved.gaps, starts, strict=True)
        ]
        twist = twist_of(solve(f"{body}_{k}", slips), base)
        placed.motion[k] = now = kin.define_twist(body, k, twist)
        for i, (rod, start) in enumerate(zip(held.rods, starts, strict=True)):
            rates[i] += (now.linear - start + now.angular.cross(rod.equation.end)) * kin.rate(k)

    def bias() -> Twist:
        omega = kin.total(placed).angular
        base = to_body("acceleration", held.base.bias) if held.base else ZERO
        slips = []
        for rod, gap, rate in zip(held.rods, solved.gaps, rates, strict=True):
            now = kin.program.vector(f"{rod.entry.rod}_rate", rate, "123")
            start = to_body(f"{rod.entry.rod}_start_bias", rod.anchor.bias)
            pull = base - start + omega.cross(omega.cross(rod.equation.end))
            slips.append(rod.rod.stretch_bias - gap.dot(pull) - now.dot(now))
        return kin.define_bias(body, twist_of(solve(f"{body}_bias", slips), base))

    placed.bias = once(bias)


def _coordinates(held: _Held) -> list[str]:
    """Return the coordinates that move the body."""
    motions = [held.base.motion] if held.base else []
    motions += [rod.anchor.motion for rod in held.rods]
    names = [*motions, *(rod.rod.stretch for rod in held.rods)]
    return list(dict.fromkeys(name for moved in names for name in moved))
