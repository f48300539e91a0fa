"""Closure equations of a tree of hinges and guides, and the iteration that solves them.

The bodies of a tree are carried by hinges and guides of unknown coordinates x, from bodies that are
placed. All is written in work axes. The coordinates displace a body from its design position
(`Frame`), composed from joint to joint along the tree, so that the geometry of the equations is
that of the design position: axes, points, lengths.

Every joint that closes a loop has the equations of its constraint, every rod that of its length
(`constraints`). The c of their factors is a length of the mechanism, which is the unit of slides,
too, so that neither equations nor unknowns have a unit. With the screw of a joint as a motion, the
rate of an equation is an element of the Jacobian J; with the motion of placed bodies it is the
right side of the equations for velocities (`coupled_loops`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..declare.joints import Prismatic, Revolute, Spherical, Universal
from ..program.functions import Frozen
from ..program.newton import IterationDerivation, IterationResult, Matrix
from ..program.vectors import IDENTITY, ZERO, Axes, Vector, from_axes
from .constraints import STILL, Coincident, Constraint, FixedDistance, Guided, Moving, Perpendicular

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from ..kinematics.hinge_angles import DrivenCoordinate
    from ..program.function import Estimate, IterationBlock
    from ..program.program import Program
    from .tree import CutJoint, Tree

Geometry = dict[str, Vector]
"""Inputs of the equations, by name: constants of the design position, poses of placed bodies.

A scalar is the first component.
"""


# -- motion ---------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Frame:
    """The displacement of a body from its design position, in work axes."""

    axes: Axes = IDENTITY  # work axes as turned with the body
    # point of the body, now and at the design position
    origin: Vector = ZERO
    start: Vector = ZERO

    def at(self, point: Vector) -> Vector:
        """Return the position of a point of the body, given at the design position."""
        return self.origin + from_axes(self.axes, point - self.start)

    def along(self, direction: Vector) -> Vector:
        """Return the present direction of a direction of the body."""
        return from_axes(self.axes, direction)


@dataclass(frozen=True)
class Screw:
    """Motion of all bodies that a joint carries, per unit rate of its coordinate."""

    axis: Vector
    through: Vector
    slides: bool
    size: sp.Expr

    def at_rate(self, rate: sp.Expr) -> tuple[Vector, Vector]:
        """Return angular velocity and velocity of the carried bodies, at its origin."""
        if self.slides:
            return ZERO, self.axis * (self.size * rate)
        return self.axis * rate, ZERO

    def moving(self) -> Moving:
        """Return the motion for a unit rate."""
        return Moving(self.through, *self.at_rate(sp.Integer(1)))


@dataclass(frozen=True)
class Closure:
    """A constraint between two bodies."""

    first: str
    second: str
    constraint: Constraint

    def rate(self, motions: Mapping[str, Moving]) -> sp.Expr:
        """Return the rate of its residual with the motions of all bodies."""
        return self.constraint.rate(motions[self.first], motions[self.second])

    def acceleration(self, motions: Mapping[str, Moving]) -> sp.Expr:
        """Return the second derivative of the residual, where residual and rate are zero."""
        return self.constraint.acceleration(motions[self.first], motions[self.second])


# -- a position -----------------------------------------------------------------------------------


@dataclass(frozen=True)
class Position:
    """Position of the tree for some values of the unknowns."""

    tree: Tree
    frames: dict[str, Frame]  # of every body of the tree, and of the placed ones that it touches
    screws: list[Screw]  # of every joint of the tree, in its order
    equations: list[Closure]  # in the order of the cuts and rods

    def jacobian(self) -> Matrix:
        """Return the derivatives of the residuals with respect to the unknowns."""
        return self._columns(driven=False)

    def by_driven(self) -> Matrix:
        """Return the derivatives of the residuals with respect to the driven coordinates."""
        return self._columns(driven=True)

    def _columns(self, *, driven: bool) -> Matrix:
        places = [p for p, branch in enumerate(self.tree.tree) if branch.driven == driven]
        return [[self._element(equation, p) for p in places] for equation in self.equations]

    def _element(self, equation: Closure, place: int) -> sp.Expr:
        """Return an element of J: zero where both bodies are carried alike, or neither is."""
        one, two = (place in self.carriers(b) for b in (equation.first, equation.second))
        if one == two:
            return sp.Integer(0)
        screw = self.screws[place].moving()
        motions = (screw, STILL) if one else (STILL, screw)
        return equation.constraint.rate(*motions)

    def carriers(self, body: str) -> list[int]:
        """Return the indices of the joints that carry a body, from the body inward."""
        children = self.tree.bodies
        found = []
        while body in children:
            found.append(children.index(body))
            body = self.tree.tree[found[-1]].parent
        return found


def position(
    program: Program, label: str, tree: Tree, geometry: Geometry, unknowns: Sequence[sp.Expr]
) -> Position:
    """Append the position for values of the unknowns; the label begins the names of steps."""
    size, rest = geometry["size"].x, iter(unknowns)
    frames = {
        body: Frame(
            (geometry[f"{body}_x"], geometry[f"{body}_y"], geometry[f"{body}_z"]),
            geometry[f"{body}_origin"],
            geometry[f"{body}_start"],
        )
        for body in bases(tree)
    }
    screws = []
    for branch in tree.tree:
        x = geometry[f"{branch.joint.name}_given"].x if branch.driven else next(rest)
        name, parent = f"{label}{branch.child}", frames[branch.parent]
        local = geometry[f"{branch.joint.name}_axis"]
        axis = program.vector(f"{name}_axis", parent.along(local))
        if isinstance(branch.joint, Prismatic):
            origin = program.vector(f"{name}_origin", parent.origin + axis * (x * size))
            frames[branch.child] = Frame(parent.axes, origin, parent.start)
        else:
            start = geometry[f"{branch.joint.name}_at"]
            origin = program.vector(f"{name}_origin", parent.at(start))
            axes = _turned(program, name, parent.axes, axis, local, x)
            frames[branch.child] = Frame(axes, origin, start)
        screws.append(Screw(axis, origin, isinstance(branch.joint, Prismatic), size))
    equations = []
    for cut in tree.cuts:
        plane = frames[tree.base_of(cut.joint.first.name)]
        equations += _at_cut(program, label, cut, geometry, frames, plane)
    for held in tree.rods:
        one, two = frames[held.anchor_body], frames[held.body]
        p1 = program.vector(f"{label}{held.rod}_anchor", one.at(geometry[f"{held.rod}_anchor"]))
        p2 = program.vector(f"{label}{held.rod}_end", two.at(geometry[f"{held.rod}_end"]))
        rod_vector = program.vector(f"{label}{held.rod}_rod_vector", p2 - p1)
        squared, scale = geometry[f"{held.rod}_squared"].x, geometry[f"{held.rod}_scale"].x
        length = FixedDistance(rod_vector, p1, p2, squared, scale)
        equations.append(Closure(held.anchor_body, held.body, length))
    return Position(tree, frames, screws, equations)


def bases(tree: Tree) -> list[str]:
    """Return the placed bodies that a tree, or a joint or rod that closes it, starts from."""
    touched = [branch.parent for branch in tree.tree]
    touched += [body for cut in tree.cuts for body in cut.joint.bodies]
    touched += [body for held in tree.rods for body in (held.anchor_body, held.body)]
    return [body for body in dict.fromkeys(touched) if body not in tree.bodies]


def _turned(
    program: Program, name: str, axes: Axes, axis: Vector, local: Vector, angle: sp.Expr
) -> Axes:
    """Append axes after a turn about an axis, whose components along them are `local`."""
    cosine = program.define(f"{name}_cos", sp.cos(angle))
    sine = program.define(f"{name}_sin", sp.sin(angle))
    kept = program.vector(f"{name}_kept", axis * (1 - cosine))
    columns = (
        r * cosine + axis.cross(r) * sine + kept * share
        for r, share in zip(axes, local, strict=True)
    )
    return program.axes((f"{name}_x", f"{name}_y", f"{name}_z"), columns)


def _at_cut(
    program: Program,
    label: str,
    cut: CutJoint,
    geometry: Geometry,
    frames: Mapping[str, Frame],
    plane: Frame,
) -> list[Closure]:
    """Return the equations of a joint that closes a loop; the plane is that of a placed body."""
    name, bodies = cut.joint.name, cut.joint.bodies
    scale, at = geometry["scale"].x, geometry[f"{name}_at"]
    one, two = (frames[body] for body in bodies)
    p1 = program.vector(f"{label}{name}_p1", one.at(at))
    p2 = program.vector(f"{label}{name}_p2", two.at(at))

    def carried(frame: Frame, what: str, number: int) -> Vector:
        direction = frame.along(geometry[f"{name}_{what}"])
        return program.vector(f"{label}{name}_{what}_{number}", direction)

    square = _SQUARE_IN_PLANE if cut.planar else _SQUARE
    found: list[Constraint] = [
        Perpendicular(carried(one, a, 1), carried(two, b, 2)) for a, b in square[cut.joint.kind]
    ]
    if isinstance(cut.joint, Prismatic):
        across = ("side",) if cut.planar else ("side", "top")
        ways = (carried(one, what, 1) for what in across)
        found += [Guided(p1, p2, way, scale) for way in ways]
    else:
        ways = (carried(plane, what, 0) for what in ("side", "top"))
        found += [Coincident(p1, p2, way, scale) for way in (ways if cut.planar else IDENTITY)]
    return [Closure(*bodies, constraint) for constraint in found]


# Directions of the two bodies that stay perpendicular, by their names in the geometry.
_ACROSS = [("axis", "side"), ("axis", "top")]
_SQUARE = {
    Revolute.kind: _ACROSS,
    Prismatic.kind: [*_ACROSS, ("side", "top")],
    Universal.kind: [("axis", "side")],
    Spherical.kind: [],
}
_SQUARE_IN_PLANE = {Revolute.kind: [], Prismatic.kind: [("axis", "side")]}


# -- the iteration --------------------------------------------------------------------------------


def block(
    program: Program, tree: Tree, geometry: Geometry, driven: Iterable[DrivenCoordinate]
) -> IterationBlock:
    """Return the iteration that finds the unknowns (`IterationDerivation`).

    `program` is that of the caller; `tree` and `geometry` are the loops and the inputs of their
    equations, `driven` the coordinates along which the solution is followed.
    """
    name = f"loops_through_{tree.body}"
    if name in program.constants.blocks:
        return program.constants.blocks[name]
    size = geometry["size"].x
    along = ((d.symbol, d.start, d.unit(size), d.turns) for d in driven)
    derivation = IterationDerivation(program, along)

    def derive(own: Program, estimate: Estimate) -> IterationResult:
        own.section("bodies placed before, at this stage")
        components = [c for vector in geometry.values() for c in vector]
        staged = iter(derivation.repeated(components))
        here = {n: Vector(next(staged), next(staged), next(staged)) for n in geometry}
        given = {}
        for branch in (b for b in tree.tree if b.driven):
            name = f"{branch.joint.name}_given"
            given[name] = here[name].x
            here[name] = Vector(own.define(f"{name}_here", Frozen(given[name])), ZERO.y, ZERO.z)
        own.section("position of this iteration")
        x = [
            own.define(f"{branch.joint.name}_estimate", base + step)
            for branch, base, step in zip(tree.unknowns, estimate.base, estimate.step, strict=True)
        ]
        now = position(own, "", tree, here, x)
        own.section("residuals of the equations")
        left = [
            own.define(f"residual_{i}", equation.constraint.residual())
            for i, equation in enumerate(now.equations, 1)
        ]
        apart = [
            value**2 if isinstance(branch.joint, Prismatic) else 2 - 2 * sp.cos(value)
            for branch, value in zip(tree.unknowns, x, strict=True)
        ]
        return IterationResult(
            x, left, now.jacobian(), sp.Add(*apart), list(given.values()), now.by_driven()
        )

    found = derivation.block(
        name,
        f"the coordinates of {tree.joint_names}, with which {tree.closing_names} close",
        [f"{branch.joint.name}_coordinate" for branch in tree.unknowns],
        tree.equations,
        derive,
    )
    program.constants.blocks[name] = found
    return found
