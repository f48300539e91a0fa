"""Loops of hinges and guides that close together, by iteration. No closed form.

The equations, and the iteration that solves them from the design position on, are those of
`closure_equations`. The straight-line code around them is here.

*Position.* The result of the iteration is corrected once more. That changes nothing but the last
digits, and carries all derivatives: by the implicit function theorem they are ``-J^-1 g_v``.

*Velocities.* With the unknowns at rest, the motion of the placed bodies changes the equations at
rates -b; ``J x = b`` gives the rates of the unknowns. *Accelerations* fulfil the same equations,
with the second derivatives that remain when the unknowns have no acceleration (`inverse`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations
from typing import TYPE_CHECKING, ClassVar

import sympy as sp

from ...equations.following import ITERATIONS
from ..declare.joints import Joint, Prismatic, Revolute, Spherical, Universal
from ..kinematics.hinge_angles import (
    HingeDesign,
    axis_at_design,
    driven_coordinates,
    positive_axis_at_design,
)
from ..kinematics.motion import BodyMotion
from ..loops.forms import Attempt, Iteration
from ..loops.known import coordinates_of
from ..loops.mobility import Mobility
from ..program.newton import Matrix, named
from ..program.vectors import IDENTITY, NO_TWIST, ZERO, Twist, Vector, from_axes, to_axes
from .closure_equations import Geometry, Position, Screw, bases, block, position
from .constraints import Moving
from .coupling import Coupling
from .inverse import Inverse
from .lines import place_rod
from .tree import CutJoint, JointOfTree, Tree

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator, Mapping, Sequence

    from ..declare.geometry import Direction
    from ..kinematics.kinematics import Kinematics
    from ..kinematics.step import Ends
    from ..loops.forms import Closing
    from ..loops.graph import Cycle
    from ..loops.known import Coordinate, Known

MOST_LOOPS = 4
"""Most loops that are solved together."""

MOST_UNKNOWNS = 8
"""Most unknowns of an iteration: the adjugate of its Jacobian is written out."""


@dataclass(frozen=True)
class CoupledLoops(Tree, Iteration):
    """Loops of hinges and guides that close together: their coordinates follow by iteration."""

    rank: ClassVar[int] = 2

    @classmethod
    def attempt(
        cls, known: Known, driven: Collection[str], waiting: Sequence[Cycle]
    ) -> Attempt | None:
        """Return the fewest loops that determine as many coordinates as they have unknown.

        These are the first ones without an obstacle, or else the first ones.
        """
        mobility = Mobility(known.topology, driven)
        found = []
        for count in range(1, min(len(waiting), MOST_LOOPS) + 1):
            for cycles in combinations(waiting, count):
                tree = Coupling(known, cycles).tree()
                if tree is None or len(tree.unknowns) > tree.equations:
                    continue
                problem = (
                    f"Closed at {tree.closing_names}, {count} loop(s) leave {tree.equations} "
                    f"equations for the {len(tree.unknowns)} unknown coordinates of "
                    f"{tree.joint_names}"
                )
                step = cls(**vars(tree))
                found.append(Attempt(step, cycles, problem, obstacle(step, mobility)))
                if not found[-1].obstacle:
                    return found[-1]
        return found[0] if found else None

    @property
    def about(self) -> str:
        return self.body

    @property
    def title(self) -> str:
        return f"transformers with iteration: {self.joint_names}"

    @property
    def closing(self) -> Sequence[Closing]:
        return *self.cuts, *self.rods

    def accept(self, known: Known) -> set[Coordinate]:
        """Record the bodies of the tree, and the rods: pinned in a plane, or each on its line."""
        known.placed.update(self.bodies)
        joints = [branch.joint for branch in self.tree] + [cut.joint for cut in self.cuts]
        for rod in self.rods:
            rod.settle(known)
            joints += known.mechanism.joints_of(rod.rod)
        return known.add_all(joints)

    def lines(self) -> Iterator[Ends]:
        yield from ((rod.rod, rod.anchor, rod.end) for rod in self.rods)

    def words(self, closing: Closing | None) -> tuple[str, str]:
        assert closing is not None
        return closing.closure, (
            f"no closed form: {self.equations} equations for the {len(self.unknowns)} coordinates "
            f"of {self.joint_names}, by Newton's method, at most {ITERATIONS} iterations"
        )

    def emit(self, kin: Kinematics) -> None:
        """Find the coordinates of hinges and guides that close the loops, and their rates."""
        solved = _corrected(kin, self, _geometry(kin, self))
        _place(kin, self, solved)
        _add_motion(kin, self, solved)
        for rod in self.rods:
            if not rod.pinned:
                place_rod(kin, rod)


def obstacle(step: CoupledLoops, mobility: Mobility) -> str:
    """Return the reason why an iteration would not help; empty: there is none."""
    unknowns, joints = len(step.unknowns), [branch.joint for branch in step.unknowns]
    if unknowns > MOST_UNKNOWNS:
        return f"{unknowns} unknowns are more than the {MOST_UNKNOWNS} of an iteration"
    if not mobility.is_known:
        return ""  # an undeclared parameter is refused later, by its name
    if not mobility.determines(coordinates_of(joints)):
        return (
            "with the default parameters they do not determine these at the design position: it is "
            "a dead point, or something else must be driven"
        )
    if not mobility.driven_move():
        return (
            "with the default parameters they cannot move from the design position as the "
            "independent and prescribed coordinates demand"
        )
    return ""


# -- geometry -------------------------------------------------------------------------------------


def _geometry(kin: Kinematics, step: CoupledLoops) -> Geometry:
    """Return the inputs of the equations."""
    geometry: Geometry = {}
    for body in bases(step):
        geometry |= _of_base(kin, body)
    for branch in step.tree:
        joint = branch.joint
        if branch.driven and isinstance(joint, Revolute):  # in the sense of its given angle
            axis = positive_axis_at_design(kin, joint)
        else:
            axis = _axis(kin, joint)
        geometry[f"{joint.name}_axis"] = axis * branch.sense
        if isinstance(joint, Revolute):
            geometry[f"{joint.name}_at"] = kin.design(joint.axis.through)
    for cut in step.cuts:
        geometry |= _of_cut(kin, cut)
    for held in step.rods:
        geometry[f"{held.rod}_anchor"] = kin.design(held.anchor)
        geometry[f"{held.rod}_end"] = kin.design(held.end)
    size = _size(kin, step.body, [v for n, v in geometry.items() if n.endswith(_PLACES)])
    geometry |= {"size": _scalar(size), "scale": _scalar(kin.program.define("scale", 1 / size))}
    for branch in step.tree:
        if branch.driven:
            given = _given(kin, branch.joint, size)
            geometry[f"{branch.joint.name}_given"] = _scalar(given)
    for held in step.rods:
        rod = held.rod_of(kin, held)
        scale = kin.program.define(f"{held.rod}_scale", 1 / (rod.length * size))
        squared = kin.program.define(f"{held.rod}_length_squared", rod.squared)
        geometry |= {f"{held.rod}_squared": _scalar(squared), f"{held.rod}_scale": _scalar(scale)}
    return geometry


# Ends of the names of positions.
_PLACES = ("_at", "_anchor", "_end")


def _scalar(value: sp.Expr) -> Vector:
    return Vector(value, ZERO.y, ZERO.z)


def _size(kin: Kinematics, name: str, places: Sequence[Vector]) -> sp.Expr:
    """Return the root mean square of the distances of some places from the first one."""
    squares = [(place - places[0]).dot(place - places[0]) for place in places[1:]]
    total = sum(squares, sp.Integer(0))
    if total == 0:  # all axes meet in a point: its equations have no length, and vanish
        return sp.Integer(1)
    return kin.program.define(f"{name}_size", sp.sqrt(total / len(squares)))


def _of_base(kin: Kinematics, body: str) -> Geometry:
    """Return the displacement of a placed body from its design position (`Frame`)."""
    placed = kin.placed[body]
    columns = (from_axes(placed.axes, to_axes(placed.design_axes, e)) for e in IDENTITY)
    x, y, z = kin.program.axes((f"{body}_x", f"{body}_y", f"{body}_z"), columns)
    return {
        f"{body}_x": x,
        f"{body}_y": y,
        f"{body}_z": z,
        f"{body}_origin": placed.origin,
        f"{body}_start": placed.design_origin,
    }


def _axis(kin: Kinematics, joint: Revolute | Prismatic) -> Vector:
    """Return the unit vector along a joint as declared, at design, in work axes."""
    if isinstance(joint, Revolute):
        return axis_at_design(kin, joint)
    return kin.unit(f"{joint.name}_axis_design", kin.to_work(joint.direction.components))


def _given(kin: Kinematics, joint: Revolute | Prismatic, size: sp.Expr) -> sp.Expr:
    """Return the displacement of a driven coordinate from design; a slide in units of c."""
    coordinate = kin.given(joint)
    if isinstance(joint, Prismatic):
        return kin.program.define(f"{joint.name}_given", coordinate / size)
    if joint.angle_to is None:
        return coordinate
    start = HingeDesign.of(kin, joint).angle(kin.program, joint.name)
    return kin.program.define(f"{joint.name}_given", coordinate - start)


def _place_of(kin: Kinematics, joint: Joint) -> Vector:
    """Return the position of a joint; of a guide, that of a point of its second body."""
    if isinstance(joint, Revolute):
        return kin.design(joint.axis.through)
    return kin.design(joint.center or joint.second.center)


def _of_cut(kin: Kinematics, cut: CutJoint) -> Geometry:
    """Return the position of a joint that closes a loop, directions along and across its axis."""
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
    """Return the same for a planar loop; both directions of a hinge are across it."""
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
        return list(zip(self.position.tree.tree, self.position.screws, strict=True))

    def filled(self, driven: Sequence[sp.Expr], unknown: Sequence[sp.Expr]) -> list[sp.Expr]:
        """Return values of all joints: given ones of driven joints, solved ones of the others."""
        rest = iter(unknown)
        tree = self.position.tree.tree
        return [x if b.driven else next(rest) for b, x in zip(tree, driven, strict=True)]

    def solve(self, kin: Kinematics, name: str, residual_rates: Sequence[sp.Expr]) -> list[sp.Expr]:
        """Append the rates, or accelerations, of the unknowns that cancel residual rates."""
        return self.inverse.solve(kin, name, self.rows, [-rate for rate in residual_rates])


def _corrected(kin: Kinematics, step: CoupledLoops, geometry: Geometry) -> _Solved:
    """Call the iteration, and correct its result."""
    program, name = kin.program, step.body
    results = program.iterated(
        f"{name}_loops", block(program, step, geometry, driven_coordinates(kin))
    )
    found = list(results.values())[: len(step.unknowns)]
    start = position(program, f"{name}_found_", step, geometry, found)
    left = [
        program.define(f"{name}_residual_{i}", equation.constraint.residual())
        for i, equation in enumerate(start.equations, 1)
    ]
    inverse = Inverse.found(
        kin,
        name,
        results,
        left,
        f"the loops through {', '.join(step.bodies)} cannot close, or the iteration from the "
        f"design position did not converge within {{iterations}} steps: {step.closing_names} "
        f"cannot meet with any coordinates of {step.joint_names}",
    )
    unknowns = [
        program.define(f"{branch.joint.name}_coordinate", x + dx)
        for branch, x, dx in zip(step.unknowns, found, inverse.step(left), strict=True)
    ]
    now = position(program, "", step, geometry, unknowns)
    rows = named(program, f"{name}_row", now.jacobian())
    return _Solved(geometry["size"].x, unknowns, now, rows, inverse)


# -- placing --------------------------------------------------------------------------------------


def _place(kin: Kinematics, step: CoupledLoops, solved: _Solved) -> None:
    """Record poses and slides."""
    for branch in step.tree:
        frame = solved.position.frames[branch.child]
        kin.placed[branch.child] = BodyMotion(
            branch.child, origin=frame.origin, axes=frame.axes, design_origin=frame.start
        )
    for branch, x in zip(step.unknowns, solved.unknowns, strict=True):
        if isinstance(branch.joint, Prismatic):
            kin.slides[branch.joint.name] = branch.sense * x * solved.size
    for cut in step.cuts:
        if isinstance(cut.joint, Prismatic):
            first, second = (solved.position.frames[body] for body in cut.joint.bodies)
            at = _place_of(kin, cut.joint)
            way = first.along(_axis(kin, cut.joint))
            kin.slides[cut.joint.name] = way.dot(second.at(at) - first.at(at))


# -- motion ---------------------------------------------------------------------------------------


def _add_motion(kin: Kinematics, step: CoupledLoops, solved: _Solved) -> None:
    """Record the motion of every body for every coordinate, and its bias."""
    program, name = kin.program, step.body
    placed = [kin.placed[body] for body in bases(step)]
    rates: list[sp.Expr] = [sp.Integer(0)] * len(step.tree)
    for k in _coordinates(kin, step, placed):
        given = {p.body: _in_motion(p, p.motion.get(k, NO_TWIST)) for p in placed}
        driven = [_driven_rate(kin, solved, branch, k) for branch in step.tree]
        carried = _velocities(kin, solved, f"{k}_carried", given, driven)
        residual_rates = [equation.rate(carried) for equation in solved.position.equations]
        x = solved.solve(kin, f"{name}_{k}", residual_rates)
        x = [program.define(f"{name}_{k}_{i}", value) for i, value in enumerate(x, 1)]
        x = solved.filled(driven, x)
        for body, moving in _velocities(kin, solved, k, given, x).items():
            if body in step.bodies:
                axes = kin.placed[body].axes
                twist = Twist(to_axes(axes, moving.omega), to_axes(axes, moving.velocity))
                kin.placed[body].motion[k] = kin.define_twist(body, k, twist)
        rates = [
            rate + value * kin.coordinates.rate(k) for rate, value in zip(rates, x, strict=True)
        ]
    biases: dict[str, Twist] = {}

    def bias_of(body: str) -> Callable[[], Twist]:
        def bias() -> Twist:
            if not biases:
                biases.update(_biases(kin, step, solved, rates))
            return biases[body]

        return bias

    for body in step.bodies:
        kin.placed[body].bias = bias_of(body)


def _biases(
    kin: Kinematics, step: CoupledLoops, solved: _Solved, rates: Sequence[sp.Expr]
) -> dict[str, Twist]:
    """Append the bias accelerations of all bodies of the tree."""
    program, name = kin.program, step.body
    rates = [program.define(f"{name}_rate_{i}", rate) for i, rate in enumerate(rates, 1)]
    given = {}
    for base in (kin.placed[body] for body in bases(step)):
        bias = base.bias()
        given[base.body] = replace(
            _in_motion(base, kin.total(base)),
            alpha=from_axes(base.axes, bias.angular),
            acceleration=from_axes(base.axes, bias.linear),
        )
    now = _velocities(kin, solved, "now", given, rates)
    driven = [_driven_acceleration(kin, solved, branch) for branch in step.tree]
    coasting = _accelerations(kin, solved, "coasting", now, rates, driven)
    residual_rates = [equation.acceleration(coasting) for equation in solved.position.equations]
    x = solved.filled(driven, solved.solve(kin, f"{name}_bias", residual_rates))
    moving = _accelerations(kin, solved, "bias", now, rates, x)
    found = {}
    for body in step.bodies:
        axes, end = kin.placed[body].axes, moving[body]
        accelerations = Twist(to_axes(axes, end.alpha), to_axes(axes, end.acceleration))
        found[body] = kin.define_bias(body, accelerations)
    return found


def _coordinates(kin: Kinematics, step: CoupledLoops, placed: Sequence[BodyMotion]) -> list[str]:
    """Return the coordinates that move the tree."""
    own = [kin.coordinates.of(branch.joint) for branch in step.tree if branch.driven]
    carrying = (k for base in placed for k in base.motion)
    return list(dict.fromkeys([*carrying, *(k for k in own if k in kin.coordinates.moving)]))


def _driven_rate(kin: Kinematics, solved: _Solved, branch: JointOfTree, k: str) -> sp.Expr:
    """Return the rate of a joint per unit rate of a coordinate, with the unknowns at rest."""
    if not branch.driven or kin.coordinates.of(branch.joint) != k:
        return sp.Integer(0)
    rate = kin.coordinates.ratio(branch.joint)
    return rate / solved.size if isinstance(branch.joint, Prismatic) else rate


def _driven_acceleration(kin: Kinematics, solved: _Solved, branch: JointOfTree) -> sp.Expr:
    """Return the given acceleration of a joint: that of an input."""
    if not branch.driven:
        return sp.Integer(0)
    given = kin.coordinates.given_acceleration(branch.joint)
    return given / solved.size if isinstance(branch.joint, Prismatic) else given


def _in_motion(placed: BodyMotion, twist: Twist) -> Moving:
    """Return the motion of a placed body in work axes."""
    omega, velocity = (from_axes(placed.axes, v) for v in (twist.angular, twist.linear))
    return Moving(placed.origin, omega, velocity)


def _velocities(
    kin: Kinematics,
    solved: _Solved,
    label: str,
    given: Mapping[str, Moving],
    rates: Sequence[sp.Expr],
) -> dict[str, Moving]:
    """Append the velocities of the tree, from those of placed bodies and the joints' rates."""
    found = dict(given)
    for (branch, screw), rate in zip(solved.joints, rates, strict=True):
        name, parent, turn, sliding = branch.child, found[branch.parent], *screw.at_rate(rate)
        omega = kin.program.vector(f"{name}_turning_{label}", parent.omega + turn)
        velocity = parent.velocity_of(screw.through) + sliding
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
    """Append the accelerations of the tree; velocities are given for all bodies."""
    found = dict(now)
    for (branch, screw), rate, change in zip(solved.joints, rates, accelerations, strict=True):
        name, parent, turn, sliding = branch.child, found[branch.parent], *screw.at_rate(rate)
        faster, further = screw.at_rate(change)
        alpha = parent.alpha + parent.omega.cross(turn) + faster
        pull = parent.acceleration_of(screw.through) + parent.omega.cross(sliding) * 2 + further
        found[name] = replace(
            now[name],
            alpha=kin.program.vector(f"{name}_alpha_{label}", alpha),
            acceleration=kin.program.vector(f"{name}_pull_{label}", pull),
        )
    return found
