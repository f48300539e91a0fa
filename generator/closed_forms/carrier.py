"""A body that several rods hold together, such as a wheel carrier on five links. No closed form.

The equations, and the iteration that solves them from the design position on, are those of
`carrier_equations`. The straight-line code around them is here.

*Position.* The result of the iteration is corrected once more. That changes nothing but the last
digits, and carries all derivatives: by the implicit function theorem they are ``-J^-1 g_v``.

*Velocities and accelerations* fulfil ``J x = b``, where b is due to the motion of the anchors; they
are solved with the J^-1 of the iteration (`inverse`, which contains the guard, too).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

import sympy as sp

from ...equations.following import ITERATIONS
from ..declare.joints import Joint, Prismatic, Spherical
from ..kinematics.hinge_angles import driven_coordinates
from ..kinematics.motion import BodyMotion, PointMotion
from ..loops.errors import NoClosedFormError
from ..loops.forms import Attempt, Iteration
from ..program.newton import Matrix, named
from ..program.vectors import ZERO, Twist, Vector, from_axes
from .carrier_equations import Pose, RodEquation, block, rotation, screws, split, turned
from .guided_pair import GuidedPair
from .inverse import Inverse
from .lines import place_rod
from .rigid_rod import RigidRod
from .solved_motion import ClosureCondition, TargetPoint, Unsolved, add_motion
from .ups import StrutLeg, is_strut

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence
    from typing import Self

    from ..declare.bodies import Body
    from ..declare.geometry import Point
    from ..kinematics.kinematics import Kinematics
    from ..kinematics.step import Ends
    from ..loops.forms import Closing
    from ..loops.graph import Cycle
    from ..loops.known import Coordinate, Known
    from .leg import Leg, RodLeg

# A rod is one equation; the pose of a body about a known point has three unknowns, else six.
_RODS_ABOUT_A_POINT = 3
_RODS_WITHOUT_A_POINT = 6


@dataclass(frozen=True)
class CarrierOnRods(Iteration):
    """A body that several rods hold together: its pose follows by iteration."""

    body: str
    rods: tuple[Leg, ...]
    # ball joint at a placed body, and that body: then three rods hold the orientation. Without it
    # six rods hold position and orientation.
    pin: tuple[Point, str] | None = None

    rank: ClassVar[int] = 1

    @classmethod
    def attempt(
        cls, known: Known, driven: Collection[str], waiting: Sequence[Cycle]
    ) -> Attempt | None:
        """Return the first body that rods hold together, with the loops that they close."""
        for body in known.mechanism.bodies:
            step = cls._at(known, body)
            if step is None:
                continue
            links = {link for rod in step.rods for link in rod.links}
            inside = {step.body} | links | known.placed
            closed = [cycle for cycle in waiting if inside.issuperset(cycle.bodies)]
            if len(closed) == len(step.rods) - (step.pin is None):
                problem = (
                    f"{step.body} is held by {step.rod_names} together: {len(step.rods)} "
                    "equations remain in as many unknowns"
                )
                return Attempt(step, tuple(closed), problem)
        return None

    @classmethod
    def _at(cls, known: Known, body: Body) -> Self | None:
        """Return the step for a body that three rods and a point hold, or six rods."""
        if body.name in known.bodies:
            return None
        joints = known.mechanism.joints_of(body.name)
        rods = [rod for joint in joints if (rod := _rod(known, body, joint))]
        bases = [
            j for j in joints if isinstance(j, Spherical) and j.other(body.name) in known.placed
        ]
        if len(bases) == 1 and len(rods) == _RODS_ABOUT_A_POINT:
            (base,) = bases
            return cls(body.name, tuple(rods), (base.at, base.other(body.name)))
        if not bases and len(rods) == _RODS_WITHOUT_A_POINT:
            return cls(body.name, tuple(rods))
        return None

    @property
    def about(self) -> str:
        return self.body

    @property
    def title(self) -> str:
        return f"transformers with iteration: {self.body} held by {len(self.rods)} rods"

    @property
    def closing(self) -> Sequence[Closing]:
        return self.rods

    @property
    def rod_names(self) -> str:
        """The rods, for messages."""
        return ", ".join(rod.rod for rod in self.rods)

    def accept(self, known: Known) -> set[Coordinate]:
        """Record the body, and the rods: each on its line."""
        known.placed.add(self.body)
        known.on_line |= {rod.rod for rod in self.rods}
        links = [link for rod in self.rods for link in rod.links]
        held = [self.body, *links]
        joints = [joint for body in held for joint in known.mechanism.joints_of(body)]
        return known.add_all(filter(known.joins, joints))

    def lines(self) -> Iterator[Ends]:
        yield from ((rod.rod, rod.anchor, rod.end) for rod in self.rods)

    def words(self, closing: Closing | None) -> tuple[str, str]:
        assert closing is not None
        return closing.closure, (
            f"no closed form: {len(self.rods)} equations for the pose of {self.body}, by Newton's "
            f"method, at most {ITERATIONS} iterations"
        )

    def emit(self, kin: Kinematics) -> None:
        """Find the pose of the body, and its motion."""
        held = _BodyOnRods.of(kin, self)
        _place(kin, held, _corrected(kin, held))
        for rod in held.rods:
            place_rod(kin, rod.entry)


# -- structure ------------------------------------------------------------------------------------


def _rod(known: Known, body: Body, joint: Joint) -> Leg | None:
    """Return the rod that holds a body at a joint, if its other end is at a placed body."""
    end, rod = joint.center, joint.other(body.name)
    far, guide, other = None, None, _beyond(known, joint, rod)
    if isinstance(other, Prismatic) and known.unknowns_of(other) == 0:
        guide, far, rod = other, rod, other.other(rod)
        other = _beyond(known, guide, rod)
    anchor = other.center if other else None
    if other is None or end is None or anchor is None:
        return None
    if {rod, far} & known.bodies or other.other(rod) not in known.placed:
        return None
    if guide is None or far is None:
        return RigidRod(body.name, rod, end, anchor, other.other(rod))
    pair = GuidedPair(guide, rod, anchor, other.other(rod), far, end, body.name)
    return StrutLeg.of(pair) if is_strut(pair, other, joint) and guide.first.name == rod else None


def _beyond(known: Known, joint: Joint, link: str) -> Joint | None:
    """Return the other joint of a link; of several the one at a placed body."""
    others = [j for j in known.mechanism.joints_of(link) if j != joint]
    if len(others) > 1:  # other links may hang at it, such as a drop link
        others = [j for j in others if j.other(link) in known.placed]
    return others[0] if len(others) == 1 else None


# -- the body and its rods ------------------------------------------------------------------------


@dataclass(frozen=True)
class _BodyOnRods:
    """The body and its rods."""

    step: CarrierOnRods
    base: PointMotion | None  # motion of the known point; None if there is none
    # origin of the body axes at design: the known point, or else the end of the first rod
    origin: Vector
    # length c of the equations: root mean square distance of the rods' ends from there
    size: sp.Expr
    rods: list[_RodAtBody]  # in the order of the step

    @classmethod
    def of(cls, kin: Kinematics, step: CarrierOnRods) -> _BodyOnRods:
        """Return the body of a step and its rods."""
        program, body = kin.program, step.body
        if step.pin is None:
            base, origin = None, kin.design(step.rods[0].end)
            start = origin
        else:
            point, parent = step.pin
            base, origin = kin.point_motion(parent, point), kin.design(point)
            start = base.position
        ends = [
            program.vector(f"{body}_{entry.end.name}", kin.design(entry.end) - origin, "123")
            for entry in step.rods
        ]
        squares = sum((end.dot(end) for end in ends), sp.Integer(0))
        size = program.define(f"{body}_size", sp.sqrt(squares / len(ends)))
        rods = [
            _RodAtBody.of(kin, entry, end, start, size, pinned=base is not None)
            for entry, end in zip(step.rods, ends, strict=True)
        ]
        if all(program.constants.contains(c) for rod in rods for c in rod.equation.moving):
            message = (
                f"{body}, held by {step.rod_names}, cannot move: everything that holds it is "
                "at rest. Declare it as a part of the ground"
            )
            raise NoClosedFormError(message)
        return cls(step, base, origin, size, rods)


@dataclass(frozen=True)
class _RodAtBody:
    """A rod: its length, the motion of its anchor, and its equation."""

    entry: Leg
    rod: RodLeg
    anchor: PointMotion
    equation: RodEquation

    @classmethod
    def of(
        cls, kin: Kinematics, entry: Leg, end: Vector, start: Vector, size: sp.Expr, *, pinned: bool
    ) -> _RodAtBody:
        """Return a rod to an end at the body; positions are relative to `start`."""
        program, rod = kin.program, entry.rod_of(kin, entry)
        anchor = entry.anchor_motion(kin)
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
    """The pose, the vectors along the rods from their anchors to their ends, J and its inverse."""

    pose: Pose
    rod_vectors: list[Vector]
    rows: Matrix
    inverse: Inverse


# -- position -------------------------------------------------------------------------------------


def _corrected(kin: Kinematics, held: _BodyOnRods) -> _Solved:
    """Correct the result of the iteration; return the pose with its linear equations."""
    program, body = kin.program, held.step.body
    equations = {rod.entry.rod: rod.equation for rod in held.rods}
    iteration = block(program, body, equations, held.size, driven_coordinates(kin))
    found = program.iterated(f"{body}_found", iteration)
    u, sigma = split(list(found.values())[: len(held.rods)])
    axes = rotation(program, f"{body}_found", u)
    start = Pose(axes, program.vector(f"{body}_found_shift", sigma * held.size))
    left = [
        program.define(f"{rod}_residual", equation.length(equation.rod_vector(start)).residual())
        for rod, equation in equations.items()
    ]
    inverse = Inverse.found(
        kin,
        body,
        found,
        left,
        f"the loops of {body} through {held.step.rod_names} cannot close, or the iteration "
        f"from the design position did not converge within {{iterations}} steps: the rods cannot "
        f"reach {body}, or do not hold it",
    )
    step = [
        program.define(f"{body}_correction_{i}", value)
        for i, value in enumerate(inverse.step(left), 1)
    ]
    turn, way = split(step)
    names = (f"{body}_forward", f"{body}_side", f"{body}_top")
    moved = start.shift + from_axes(axes, way * held.size)
    pose = Pose(program.axes(names, turned(axes, turn)), program.vector(f"{body}_shift", moved))
    rod_vectors = [
        program.vector(f"{rod.entry.rod}_rod_vector", rod.equation.rod_vector(pose), "123")
        for rod in held.rods
    ]
    rows = [
        rod.equation.row(rod_vector) for rod, rod_vector in zip(held.rods, rod_vectors, strict=True)
    ]
    return _Solved(pose, rod_vectors, named(program, f"{body}_row", rows), inverse)


# -- motion ---------------------------------------------------------------------------------------


def _place(kin: Kinematics, held: _BodyOnRods, solved: _Solved) -> None:
    """Record pose, velocities and bias."""
    step, program, pose = held.step, kin.program, solved.pose
    placed = BodyMotion(
        step.body,
        origin=held.base.position
        if held.base
        else program.vector(f"{step.body}_origin", held.origin + pose.shift),
        axes=pose.axes,
        design_origin=held.origin,
        local={rod.entry.end: rod.equation.end for rod in held.rods},
    )
    if step.pin is not None:
        point, parent = step.pin
        placed.local[point] = ZERO
        placed.carrier = parent, kin.local(kin.placed[parent], point)
    _add_motion(kin, held, solved, placed)
    kin.placed[step.body] = placed


def _add_motion(kin: Kinematics, held: _BodyOnRods, solved: _Solved, placed: BodyMotion) -> None:
    """Add velocities and bias: every rod keeps its length, or has that of a known slide."""
    conditions = [
        ClosureCondition(
            replace(rod.equation.length(rod_vector), scale=sp.Integer(1)),
            TargetPoint(kin, placed, rod.anchor, f"{rod.entry.rod}_start"),
            rod.equation.end,
            rod.rod,
        )
        for rod, rod_vector in zip(held.rods, solved.rod_vectors, strict=True)
    ]

    def solve(name: str, residual_rates: Sequence[sp.Expr]) -> list[sp.Expr]:
        pairs = zip(residual_rates, held.rods, strict=True)
        b = [-rate * rod.equation.scale for rate, rod in pairs]
        return solved.inverse.solve(kin, name, solved.rows, b)

    base = [TargetPoint(kin, placed, held.base, "velocity")] if held.base else []
    unsolved = _OnRods(kin, placed, base, screws(None if held.base else held.size))
    add_motion(kin, unsolved, conditions, solve)


class _OnRods(Unsolved):
    """A body that turns about a known point, or moves freely."""

    carriers: Sequence[TargetPoint]

    def at_rest(self, k: str) -> Twist:
        """Return its twist as carried by the point."""
        return Twist(ZERO, sum((base.rates(k).velocity for base in self.carriers), ZERO))

    def coasting(self) -> Twist:
        """Return its bias as carried by the point."""
        return Twist(ZERO, sum((base.biases().acceleration for base in self.carriers), ZERO))
