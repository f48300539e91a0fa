"""Loops of hinges and guides that close together, by iteration. No closed form.

The equations, and the iteration that solves them from the design position on, are those of
`closure_equations`. Here is what surrounds them, in straight-line code.

*Position.* What the iteration has found is corrected once more. That changes nothing but the last
digits, and carries all derivatives: by the implicit function theorem they are ``-J^-1 g_v``.

*Velocities.* With the unknowns at rest, what the placed bodies do changes the equations at rates
-b; ``J x = b`` gives the rates of the unknowns. *Accelerations* fulfil the same equations, with the
second derivatives that remain when the unknowns have no acceleration (`inverse`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import sympy as sp

from ..declare.joints import Joint, Prismatic, Revolute, Spherical, Universal
from ..kinematics.hinge_angles import HingeDesign, axis_at_design, positive_axis_at_design
from ..kinematics.motion import Placed, from_axes, to_axes
from ..program.function import LOST
from ..program.newton import Matrix, named
from ..program.vectors import NO_TWIST, UNIT_X, UNIT_Y, UNIT_Z, ZERO, Twist, Vector
from .closure_equations import Geometry, Moving, Position, Screw, bases, block, position
from .inverse import Inverse, guarded_factor
from .lines import place_rod
from .rod import Rod

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from ..declare.geometry import Direction
    from ..kinematics.kinematics import Kinematics
    from ..loops.actions import CutJoint, JointOfTree, SolveTogether


def solve_together(kin: Kinematics, action: SolveTogether) -> None:
    """Find the coordinates of hinges and guides that close loops together, and their rates."""
    solved = _corrected(kin, action, _geometry(kin, action))
    _place(kin, action, solved)
    _add_motion(kin, action, solved)
    for held in action.rods:
        if not kin.plan.is_pinned(held.rod):
            anchor = kin.point_motion(held.anchor_body, held.anchor)
            place_rod(kin, held, anchor, kin.rod_lengths[held.rod])


# -- geometry -------------------------------------------------------------------------------------


def _geometry(kin: Kinematics, action: SolveTogether) -> Geometry:
    """Return all that the equations read."""
    geometry: Geometry = {}
    for body in bases(action):
        geometry |= _of_base(kin, body)
    for branch in action.tree:
        joint = branch.joint
        axis = _driven_axis(kin, joint) if branch.driven else _axis(kin, joint)
        geometry[f"{joint.name}_axis"] = axis * branch.sense
        if isinstance(joint, Revolute):
            geometry[f"{joint.name}_at"] = kin.design(joint.axis.through)
    for cut in action.cuts:
        geometry |= _of_cut(kin, cut)
    for held in action.rods:
        geometry[f"{held.rod}_anchor"] = kin.design(held.anchor)
        geometry[f"{held.rod}_end"] = kin.design(held.end)
    size = _size(kin, action.body, [v for n, v in geometry.items() if n.endswith(_PLACES)])
    geometry |= {"size": _scalar(size), "scale": _scalar(kin.program.define("scale", 1 / size))}
    for branch in action.tree:
        if branch.driven:
            given = _given(kin, branch.joint, size)
            geometry[f"{branch.joint.name}_given"] = _scalar(given)
    for held in action.rods:
        rod = Rod.of(kin, held)
        scale = kin.program.define(f"{held.rod}_scale", 1 / (rod.length * size))
        squared = kin.program.define(f"{held.rod}_length_squared", rod.squared)
        geometry |= {f"{held.rod}_squared": _scalar(squared), f"{held.rod}_scale": _scalar(scale)}
    return geometry


# Names of what is a place, by their ends.
_PLACES = ("_at", "_anchor", "_end")


def _scalar(value: sp.Expr) -> Vector:
    return Vector(value, ZERO.y, ZERO.z)


def _size(kin: Kinematics, name: str, places: Sequence[Vector]) -> sp.Expr:
    """Return the root mean square of the distances of some places from the first one."""
    squares = [(place - places[0]).dot(place - places[0]) for place in places[1:]]
    total = sum(squares, sp.Integer(0))
    if total == 0:  # all axes meet in a point, and its equations have neither length nor content
        return sp.Integer(1)
    return kin.program.define(f"{name}_size", sp.sqrt(total / len(squares)))


def _of_base(kin: Kinematics, body: str) -> Geometry:
    """Return the displacement of a placed body from its design position (`Frame`)."""
    placed = kin.placed[body]
    columns = (from_axes(placed.axes, to_axes(placed.design_axes, e)) for e in _UNITS)
    x, y, z = kin.program.axes((f"{body}_x", f"{body}_y", f"{body}_z"), columns)
    return {
        f"{body}_x": x,
        f"{body}_y": y,
        f"{body}_z": z,
        f"{body}_origin": placed.origin,
        f"{body}_start": placed.design_origin,
    }


_UNITS = (UNIT_X, UNIT_Y, UNIT_Z)


def _axis(kin: Kinematics, joint: Revolute | Prismatic) -> Vector:
    """Return the unit vector along which a coordinate counts, at design, in work axes."""
    if isinstance(joint, Revolute):
        return axis_at_design(kin, joint)
    return kin.unit(f"{joint.name}_axis_design", kin.to_work(joint.direction.components))


def _driven_axis(kin: Kinematics, joint: Revolute | Prismatic) -> Vector:
    """Return the same of a driven joint, in the sense in which its coordinate is positive."""
    if isinstance(joint, Revolute):
        return positive_axis_at_design(kin, joint)
    return _axis(kin, joint)


def _given(kin: Kinematics, joint: Revolute | Prismatic, size: sp.Expr) -> sp.Expr:
    """Return how far a driven coordinate is from its design position; a slide in units of c."""
    coordinate = kin.coordinates[kin.coordinate_of(joint)]
    if isinstance(joint, Prismatic):
        return kin.program.define(f"{joint.name}_given", coordinate / size)
    if joint.angle_to is None:
        return coordinate
    start = HingeDesign.of(kin, joint).angle(kin.program, joint.name)
    return kin.program.define(f"{joint.name}_given", coordinate - start)


def _place_of(kin: Kinematics, joint: Joint) -> Vector:
    """Return where a joint is; of a guide, which is nowhere, a point of its second body."""
    if isinstance(joint, Revolute):
        return kin.design(joint.axis.through)
    return kin.design(joint.center or kin.mechanism.body(joint.second).center)


def _of_cut(kin: Kinematics, cut: CutJoint) -> Geometry:
    """Return where a joint is that closes a loop, and directions along its axis and across it."""
    if cut.normal is not None:
        return _of_plane(kin, cut.joint, cut.normal)
    joint, name = cut.joint, cut.joint.name
    at = {f"{name}_at": _place_of(kin, joint)}
    if isinstance(joint, Spherical):
        return at
    if isinstance(joint, Universal):
        first, shaft = kin.design_direction(joint.first_axis), kin.to_work(joint.shaft.vector)
        second = kin.unit(f"{name}_second_design", first.cross(shaft))
        return at | {f"{name}_axis": first, f"{name}_side": second}
    assert isinstance(joint, Revolute | Prismatic)
    axis = _axis(kin, joint)
    side, top = kin.across(name, axis)
    return at | {f"{name}_axis": axis, f"{name}_side": side, f"{name}_top": top}


def _of_plane(kin: Kinematics, joint: Joint, normal: Direction) -> Geometry:
    """Return the same of a loop in a plane; both directions of a hinge are across it."""
    name, at = joint.name, {f"{joint.name}_at": _place_of(kin, joint)}
    n = kin.unit(f"{name}_normal_design", kin.to_work(normal.components))
    if isinstance(joint, Prismatic):
        axis = _axis(kin, joint)
        side = kin.program.vector(f"{name}_side_design", n.cross(axis))
        return at | {f"{name}_axis": axis, f"{name}_side": side}
    side, top = kin.across(name, n)
    return at | {f"{name}_side": side, f"{name}_top": top}


# -- position -------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Solved:
    """The position that closes the loops, the values of the unknowns, J and its inverse."""

    size: sp.Expr
    unknowns: list[sp.Expr]
    position: Position
    rows: Matrix
    inverse: Inverse

    @property
    def joints(self) -> list[tuple[JointOfTree, Screw]]:
        """The joints of the tree with their screws."""
        return list(zip(self.position.action.tree, self.position.screws, strict=True))

    def filled(self, driven: Sequence[sp.Expr], unknown: Sequence[sp.Expr]) -> list[sp.Expr]:
        """Return what is given of driven joints and what is found of the others, in one list."""
        rest = iter(unknown)
        tree = self.position.action.tree
        return [x if b.driven else next(rest) for b, x in zip(tree, driven, strict=True)]

    def solve(self, kin: Kinematics, name: str, slips: Sequence[sp.Expr]) -> list[sp.Expr]:
        """Append the rates, or accelerations, of the unknowns that make up for some slips."""
        return self.inverse.solve(kin, name, self.rows, [-slip for slip in slips])


def _corrected(kin: Kinematics, action: SolveTogether, geometry: Geometry) -> _Solved:
    """Call the iteration, and correct what it has found."""
    program, name = kin.program, action.body
    results = program.iterated(
        f"{name}_loops", block(program, action, geometry, kin.driven_coordinates())
    )
    count = len(action.unknowns)
    found = list(results.values())[:count]
    start = position(program, f"{name}_found_", action, geometry, found)
    left = [
        program.define(f"{name}_misfit_{i}", equation.misfit())
        for i, equation in enumerate(start.equations, 1)
    ]
    matrix = [
        [results[f"inverse_{i}{j}"] for j in range(1, len(left) + 1)] for i in range(1, count + 1)
    ]
    factor = guarded_factor(
        kin,
        name,
        results["determinant"],
        left,
        results[LOST],
        f"the loops through {', '.join(action.bodies)} cannot close, or an iteration has not found "
        f"how in {{iterations}} steps on the way from the design position: {action.closing_names} "
        f"cannot meet with any coordinates of {action.joint_names}",
    )
    inverse = Inverse(matrix, factor)
    unknowns = [
        program.define(f"{branch.joint.name}_coordinate", x + dx)
        for branch, x, dx in zip(action.unknowns, found, inverse.step(left), strict=True)
    ]
    now = position(program, "", action, geometry, unknowns)
    rows = named(program, f"{name}_row", now.jacobian())
    return _Solved(geometry["size"].x, unknowns, now, rows, inverse)


# -- placing --------------------------------------------------------------------------------------


def _place(kin: Kinematics, action: SolveTogether, solved: _Solved) -> None:
    """Record poses and slides."""
    for branch in action.tree:
        frame = solved.position.frames[branch.child]
        kin.placed[branch.child] = Placed(
            branch.child, origin=frame.origin, axes=frame.axes, design_origin=frame.start
        )
    for branch, x in zip(action.unknowns, solved.unknowns, strict=True):
        if isinstance(branch.joint, Prismatic):
            kin.slides[branch.joint.name] = branch.sense * x * solved.size
    for cut in action.cuts:
        if isinstance(cut.joint, Prismatic):
            first, second = (solved.position.frames[body] for body in cut.joint.bodies)
            at = _place_of(kin, cut.joint)
            way = first.along(_axis(kin, cut.joint))
            kin.slides[cut.joint.name] = way.dot(second.at(at) - first.at(at))


# -- motion ---------------------------------------------------------------------------------------


def _add_motion(kin: Kinematics, action: SolveTogether, solved: _Solved) -> None:
    """Record the motion of every body for every coordinate, and its bias."""
    program, name = kin.program, action.body
    placed = [kin.placed[body] for body in bases(action)]
    rates: list[sp.Expr] = [sp.Integer(0)] * len(action.tree)
    for k in _coordinates(kin, action, placed):
        given = {p.body: _in_motion(p, p.motion.get(k, NO_TWIST)) for p in placed}
        driven = [_driven_rate(kin, solved, branch, k) for branch in action.tree]
        carried = _velocities(kin, solved, f"{k}_carried", given, driven)
        slips = [e.rate(carried[e.first], carried[e.second]) for e in solved.position.equations]
        x = solved.solve(kin, f"{name}_{k}", slips)
        x = [program.define(f"{name}_{k}_{i}", value) for i, value in enumerate(x, 1)]
        x = solved.filled(driven, x)
        for body, moving in _velocities(kin, solved, k, given, x).items():
            if body in action.bodies:
                child = kin.placed[body]
                child.motion[k] = kin.define_twist(body, k, _twist(child, moving))
        rates = [rate + value * kin.rate(k) for rate, value in zip(rates, x, strict=True)]
    biases: dict[str, Twist] = {}

    def bias_of(body: str) -> Callable[[], Twist]:
        def bias() -> Twist:
            if not biases:
                biases.update(_biases(kin, action, solved, rates))
            return biases[body]

        return bias

    for body in action.bodies:
        kin.placed[body].bias = bias_of(body)


def _biases(
    kin: Kinematics, action: SolveTogether, solved: _Solved, rates: Sequence[sp.Expr]
) -> dict[str, Twist]:
    """Append the bias accelerations of all bodies of the tree."""
    program, name = kin.program, action.body
    rates = [program.define(f"{name}_rate_{i}", rate) for i, rate in enumerate(rates, 1)]
    given = {}
    for base in (kin.placed[body] for body in bases(action)):
        bias = base.bias()
        given[base.body] = replace(
            _in_motion(base, kin.total(base)),
            alpha=from_axes(base.axes, bias.angular),
            acceleration=from_axes(base.axes, bias.linear),
        )
    now = _velocities(kin, solved, "now", given, rates)
    driven = [_driven_acceleration(kin, solved, branch) for branch in action.tree]
    coasting = _accelerations(kin, solved, "coasting", now, rates, driven)
    equations = solved.position.equations
    slips = [e.acceleration(coasting[e.first], coasting[e.second]) for e in equations]
    x = solved.filled(driven, solved.solve(kin, f"{name}_bias", slips))
    moving = _accelerations(kin, solved, "bias", now, rates, x)
    found = {}
    for body in action.bodies:
        axes, end = kin.placed[body].axes, moving[body]
        accelerations = Twist(to_axes(axes, end.alpha), to_axes(axes, end.acceleration))
        found[body] = kin.define_bias(body, accelerations)
    return found


def _coordinates(kin: Kinematics, action: SolveTogether, placed: Sequence[Placed]) -> list[str]:
    """Return the coordinates that move the tree."""
    own = [kin.coordinate_of(branch.joint) for branch in action.tree if branch.driven]
    carrying = (k for base in placed for k in base.motion)
    return list(dict.fromkeys([*carrying, *(k for k in own if k in kin.moving)]))


def _driven_rate(kin: Kinematics, solved: _Solved, branch: JointOfTree, k: str) -> sp.Expr:
    """Return the rate of a joint per unit rate of a coordinate, with the unknowns at rest."""
    if not branch.driven or kin.coordinate_of(branch.joint) != k:
        return sp.Integer(0)
    return 1 / solved.size if isinstance(branch.joint, Prismatic) else sp.Integer(1)


def _driven_acceleration(kin: Kinematics, solved: _Solved, branch: JointOfTree) -> sp.Expr:
    """Return the acceleration of a joint that an input gives."""
    if not branch.driven:
        return sp.Integer(0)
    given = kin.acceleration(kin.coordinate_of(branch.joint))
    return given / solved.size if isinstance(branch.joint, Prismatic) else given


def _in_motion(placed: Placed, twist: Twist) -> Moving:
    """Return the motion of a placed body in work axes."""
    omega, velocity = (from_axes(placed.axes, v) for v in (twist.angular, twist.linear))
    return Moving(placed.origin, omega, velocity)


def _twist(placed: Placed, moving: Moving) -> Twist:
    """Return a motion in body axes."""
    return Twist(to_axes(placed.axes, moving.omega), to_axes(placed.axes, moving.velocity))


def _velocities(
    kin: Kinematics,
    solved: _Solved,
    label: str,
    given: Mapping[str, Moving],
    rates: Sequence[sp.Expr],
) -> dict[str, Moving]:
    """Append the velocities of the tree from those of placed bodies and the rates of unknowns."""
    found = dict(given)
    for (branch, screw), rate in zip(solved.joints, rates, strict=True):
        name, parent, turn, slip = branch.child, found[branch.parent], *screw.at_rate(rate)
        omega = kin.program.vector(f"{name}_turning_{label}", parent.omega + turn)
        velocity = parent.velocity_of(screw.through) + slip
        velocity = kin.program.vector(f"{name}_moving_{label}", velocity)
        found[name] = Moving(screw.through, omega, velocity)
    return found


def _accelerations(
    kin: Kinematics,
    solved: _Solved,
    label: str,
    now: Mapping[str, Moving],
    rates: Sequence[sp.Expr],
    accelerations: Sequence[sp.Expr],
) -> dict[str, Moving]:
    """Append the same for accelerations; velocities are given for all bodies."""
    found = dict(now)
    for (branch, screw), rate, change in zip(solved.joints, rates, accelerations, strict=True):
        name, parent, turn, slip = branch.child, found[branch.parent], *screw.at_rate(rate)
        faster, further = screw.at_rate(change)
        alpha = parent.alpha + parent.omega.cross(turn) + faster
        pull = parent.acceleration_of(screw.through) + parent.omega.cross(slip) * 2 + further
        found[name] = replace(
            now[name],
            alpha=kin.program.vector(f"{name}_alpha_{label}", alpha),
            acceleration=kin.program.vector(f"{name}_pull_{label}", pull),
        )
    return found
