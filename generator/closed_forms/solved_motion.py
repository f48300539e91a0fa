"""Velocities and biases of a body whose unknown parts are determined by constraints.

An *unsolved* body moves with others while its unknown rates are zero; a unit of each unknown adds a
screw. As many *conditions* relate the body to placed ones. The rates of their constraints with the
unknowns at rest, and the screws, make a system of linear equations for each coordinate; the second
derivatives without accelerations of the unknowns make that of the bias, with the same matrix. All
is in axes of the body, at its origin.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, ClassVar

import sympy as sp

from ..kinematics.motion import BodyMotion, PointMotion
from ..program.vectors import NO_TWIST, UNIT_X, ZERO, Axes, Twist, Vector, from_axes, to_axes
from .constraints import STILL, Moving

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from ..declare.geometry import Point
    from ..kinematics.kinematics import Kinematics
    from ..kinematics.motion import OffLine, OnLine
    from .constraints import Constraint
    from .leg import RodLeg

    Solve = Callable[[str, Sequence[sp.Expr]], Sequence[sp.Expr]]
    """Appends the unknowns that cancel the rates of residuals, with a name for the steps."""


# -- placed bodies --------------------------------------------------------------------------------


@dataclass(frozen=True)
class PlacedBody(ABC):
    """A placed body, in the axes of another one."""

    kin: Kinematics
    placed: BodyMotion  # body whose axes are used
    of: PointMotion | BodyMotion  # motion
    label: str = "target"  # begins the names of the steps, behind that of the body

    @property
    def coordinates(self) -> Iterable[str]:
        """The coordinates that move it."""
        return self.of.motion

    @abstractmethod
    def rates(self, k: str) -> Moving:
        """Return its motion per unit rate of a coordinate."""

    @abstractmethod
    def biases(self) -> Moving:
        """Return its rotation, and its accelerations without those of the coordinates."""

    def _seen(self, label: str, v: Vector) -> Vector:
        return projector(self.kin, self.placed)(f"{self.label}_{label}", v)


class TargetPoint(PlacedBody):
    """A point of known motion: its velocity and bias."""

    of: PointMotion

    def rates(self, k: str) -> Moving:
        return Moving(velocity=self._seen(k, self.of.motion.get(k, ZERO)))

    def biases(self) -> Moving:
        return Moving(acceleration=self._seen("bias", self.of.bias))


class TargetBody(PlacedBody):
    """A placed body: its rotation alone."""

    of: BodyMotion

    def rates(self, k: str) -> Moving:
        return Moving(omega=self._carried(k, self.of.motion.get(k, NO_TWIST)))

    def biases(self) -> Moving:
        """Return its angular velocity, and its angular bias acceleration."""
        omega = self._carried("now", self.kin.total(self.of))
        return Moving(omega=omega, alpha=self._carried("bias", self.of.bias()))

    def _carried(self, label: str, twist: Twist) -> Vector:
        return self._seen(label, from_axes(self.of.axes, twist.angular))


# -- unsolved bodies ------------------------------------------------------------------------------


class Unsolved(ABC):
    """A placed body whose motion has unknown parts.

    `carriers` are bodies and points that move it while the unknowns are at rest; `screws` the twist
    that a unit rate of each unknown adds.
    """

    unknown: ClassVar[str] = "turn"
    """Kind of its unknowns, for the names of steps."""

    def __init__(
        self,
        kin: Kinematics,
        placed: BodyMotion,
        carriers: Sequence[PlacedBody],
        screws: Sequence[Twist],
    ) -> None:
        self.kin, self.placed, self.carriers, self.screws = kin, placed, carriers, screws

    @abstractmethod
    def at_rest(self, k: str) -> Twist:
        """Return its twist per unit rate of a coordinate, with the unknowns at rest."""

    @abstractmethod
    def coasting(self) -> Twist:
        """Return its bias at the present rates, without accelerations of the unknowns."""

    def with_unknowns(self, twist: Twist, values: Sequence[sp.Expr]) -> Twist:
        """Return a twist (or bias) at rest plus that of the unknowns' rates (or accelerations)."""
        for screw, value in zip(self.screws, values, strict=True):
            twist += screw * value
        return twist

    def _named(self, label: str, v: Vector) -> Vector:
        return self.kin.program.vector(f"{self.placed.body}_{label}", v, "123")


class TurnOnHinge(Unsolved):
    """A body on a hinge along the first of its axes, through its origin.

    `on` is the placed body at the other side of the hinge, and `point` the point of it that is the
    origin.
    """

    def __init__(self, kin: Kinematics, placed: BodyMotion, on: str, point: Point) -> None:
        self._origin = TargetPoint(kin, placed, kin.point_motion(on, point), "velocity")
        self._parent = TargetBody(kin, placed, kin.placed[on], "carried")
        super().__init__(kin, placed, (self._origin, self._parent), (Twist(UNIT_X, ZERO),))

    def at_rest(self, k: str) -> Twist:
        """Return its twist as carried by the axis."""
        return Twist(self._parent.rates(k).omega, self._origin.rates(k).velocity)

    def coasting(self) -> Twist:
        """Return its bias as carried by the axis."""
        parent, omega = self._parent.biases(), self.kin.total(self.placed).angular
        spin = UNIT_X * (omega.x - parent.omega.x)
        alpha = self._named("alpha_carried", parent.alpha + parent.omega.cross(spin))
        return Twist(alpha, self._origin.biases().acceleration)


class TurnOnLine(Unsolved):
    """A body that turns about the line of two points, along the first of its axes.

    In the body's axes, one point moves along that axis, and the other one is fixed, at a constant
    offset o from it. The span S = (h, o2, o3) and the relative velocity v of the points give

        omega = (0, -v3, v2) / h + omega1 (1, o2 / h, o3 / h),

    and their relative acceleration the second derivative of S, in the same components. `base` is
    the motion of its origin, which is one of the points, `inverse` 1 / h, and `sway` S / h, where
    there is an offset.
    """

    def __init__(
        self,
        kin: Kinematics,
        placed: BodyMotion,
        base: PointMotion,
        line: OnLine | OffLine,
        inverse: sp.Expr,
        sway: Vector = UNIT_X,
    ) -> None:
        self._base = TargetPoint(kin, placed, base, "velocity")
        self._swing = TargetPoint(kin, placed, line.relative, "swing")
        self._line, self._inverse, self._sway = line, inverse, sway
        super().__init__(kin, placed, (self._base, self._swing), (Twist(sway, ZERO),))

    def at_rest(self, k: str) -> Twist:
        """Return its twist as carried by the points."""
        swing = self._swing.rates(k).velocity
        across = Vector(ZERO.x, -swing.z * self._inverse, swing.y * self._inverse)
        return Twist(self._named(f"across_{k}", across), self._base.rates(k).velocity)

    def coasting(self) -> Twist:
        """Return its bias as carried by the points."""
        omega, sway = self.kin.total(self.placed).angular, self._sway
        swing, motion = self._swing.biases().acceleration, self._line.length_motion
        twice = 2 * sum((v * self.kin.coordinates.rate(k) for k, v in motion.items()), ZERO.x)
        spin = self.kin.program.define(f"{self.placed.body}_spin", omega.dot(sway))
        square = self.kin.program.define(f"{self.placed.body}_omega_squared", omega.dot(omega))
        across = Vector(
            ZERO.x,
            omega.z * spin - sway.z * square - (swing.z + twice * omega.y) * self._inverse,
            (swing.y - twice * omega.z) * self._inverse - omega.y * spin + sway.y * square,
        )
        return Twist(self._named("across_bias", across), self._base.biases().acceleration)


class SlideOnGuide(Unsolved):
    """A body that slides on a placed parent along constant directions, and turns with it.

    Its pose is recorded. `offset` is its displacement from the design position; `directions` are
    those of the slides that are unknown.
    """

    unknown = "speed"

    def __init__(
        self,
        kin: Kinematics,
        body: str,
        parent: BodyMotion,
        offset: Vector,
        directions: Iterable[Vector] = (),
    ) -> None:
        self._parent, self._offset = parent, offset
        at = parent.origin + from_axes(parent.axes, offset)
        placed = kin.placed[body] = BodyMotion(
            body,
            origin=kin.program.vector(f"{body}_origin", at),
            axes=parent.axes,
            design_origin=parent.design_origin,
            design_axes=parent.design_axes,
        )
        carriers = (TargetBody(kin, placed, parent),)
        super().__init__(kin, placed, carriers, [Twist(ZERO, d) for d in directions])

    def at_rest(self, k: str) -> Twist:
        """Return its twist as carried by the parent."""
        return self._carried(self._parent.motion.get(k, NO_TWIST))

    def coasting(self) -> Twist:
        """Return its bias as carried by the parent."""
        carried = self._carried(self.kin.total(self._parent))
        return self.carried_bias(self.kin.total(self.placed).linear - carried.linear)

    def carried_bias(self, sliding: Vector) -> Twist:
        """Return its bias as carried by the parent, for its velocity relative to that."""
        parent, omega = self._parent, self.kin.total(self._parent).angular
        linear = self.kin.point_bias(parent, self._offset) + omega.cross(sliding) * 2
        return Twist(parent.bias().angular, linear)

    def _carried(self, twist: Twist) -> Twist:
        return Twist(twist.angular, twist.linear + twist.angular.cross(self._offset))


# -- solving --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class ClosureCondition:
    """A condition that determines an unknown."""

    constraint: Constraint  # with the target as its first body, and the moving one as its second
    target: PlacedBody  # point or body that it relates the moving body to
    at: Vector = ZERO  # point of the moving body
    rod: RodLeg | None = None  # leg whose length a `FixedDistance` has, if that varies
    is_first: bool = False  # whether the moving body is the first one of the constraint

    @property
    def coordinates(self) -> Iterable[str]:
        """The coordinates that move the target, or change the length."""
        return [*self.target.coordinates, *(self.rod.stretch if self.rod else ())]

    def pivot(self, screw: Twist) -> sp.Expr:
        """Return the rate of the residual per unit rate of an unknown."""
        return self.constraint.rate(*self._ordered(STILL, Moving.of(screw)))

    def rate(self, k: str, rest: Twist) -> sp.Expr:
        """Return the rate of the residual per unit rate of a coordinate, with the unknowns at rest.

        Both bodies are described in axes that move with the target; `rest` is the twist of the
        body.
        """
        target = self.target.rates(k)
        velocity = rest.linear - target.velocity + rest.angular.cross(self.at)
        body = Moving(self.at, rest.angular, velocity)
        stretch = self.rod.stretch.get(k, sp.Integer(0)) if self.rod else sp.Integer(0)
        return self.constraint.rate(*self._ordered(Moving(omega=target.omega), body)) - stretch

    def acceleration(self, kin: Kinematics, now: Twist, rest: Twist) -> sp.Expr:
        """Return the second derivative of the residual without accelerations of the unknowns.

        `now` are the angular velocity of the body, and the velocity of its origin relative to the
        target; `rest` is its bias.
        """
        target, omega = self.target.biases(), now.angular
        name = f"{self.target.placed.body}_{self.target.label}"
        whirl = kin.program.vector(f"{name}_whirl", omega.cross(self.at), "123")
        velocity = kin.program.vector(f"{name}_slip", now.linear + whirl, "123")
        pull = rest.linear - target.acceleration + rest.angular.cross(self.at) + omega.cross(whirl)
        body = Moving(self.at, omega, velocity, rest.angular, pull)
        fixed = Moving(omega=target.omega, alpha=target.alpha)
        stretch = self.rod.stretch_bias if self.rod else sp.Integer(0)
        return self.constraint.acceleration(*self._ordered(fixed, body)) - stretch

    def _ordered(self, target: Moving, body: Moving) -> tuple[Moving, Moving]:
        return (body, target) if self.is_first else (target, body)


def add_turn(
    kin: Kinematics,
    unsolved: Unsolved,
    condition: ClosureCondition,
    inverse_lever: sp.Expr | None = None,
) -> None:
    """Record velocities and bias of a body with one unknown and its condition.

    `inverse_lever` is ``-1 / condition.pivot``, if the solution of the position has a shorter
    expression for it.
    """
    if inverse_lever is None:
        lever = condition.pivot(unsolved.screws[0])
        inverse_lever = kin.program.define(f"{unsolved.placed.body}_inverse_lever", -1 / lever)

    def solve(name: str, residual_rates: Sequence[sp.Expr]) -> list[sp.Expr]:
        return [kin.program.define(name, residual_rates[0] * inverse_lever)]

    add_motion(kin, unsolved, [condition], solve)


def add_motion(
    kin: Kinematics, unsolved: Unsolved, conditions: Sequence[ClosureCondition], solve: Solve
) -> None:
    """Record velocities and bias of a body with as many conditions as unknowns.

    `solve` solves their linear equations.
    """
    placed = unsolved.placed
    relative = [ZERO for _ in conditions]  # velocity of the origin relative to each target
    names = [k for carrier in unsolved.carriers for k in carrier.coordinates]
    names += [k for condition in conditions for k in condition.coordinates]
    for k in dict.fromkeys(names):
        rest = unsolved.at_rest(k)
        found = solve(
            f"{placed.body}_{unsolved.unknown}_{k}", [c.rate(k, rest) for c in conditions]
        )
        twist = kin.define_twist(placed.body, k, unsolved.with_unknowns(rest, found))
        placed.motion[k] = twist
        rate = kin.coordinates.rate(k)
        relative = [
            seen + (twist.linear - condition.target.rates(k).velocity) * rate
            for seen, condition in zip(relative, conditions, strict=True)
        ]

    def bias() -> Twist:
        omega, rest = kin.total(placed).angular, unsolved.coasting()
        residual_rates = [
            condition.acceleration(kin, Twist(omega, velocity), rest)
            for condition, velocity in zip(conditions, relative, strict=True)
        ]
        found = solve(f"{placed.body}_{unsolved.unknown}_bias", residual_rates)
        return kin.define_bias(placed.body, unsolved.with_unknowns(rest, found))

    placed.bias = cache(bias)


# -- helpers --------------------------------------------------------------------------------------


def place_at(
    kin: Kinematics,
    body: str,
    at: tuple[str, Point],
    axes: Axes,
    design_axes: Axes,
    *,
    local: Mapping[Point, Vector] | None = None,
    hinge: str | None = None,
) -> BodyMotion:
    """Record the pose of a body whose origin is a point of a placed one, and return it.

    `axes` and `design_axes` are those of the body, now and at the design position; `local` and
    `hinge` are further points and the hinge, as in `BodyMotion`.
    """
    on, point = at
    origin = kin.point_motion(on, point)
    kin.placed[body] = BodyMotion(
        body,
        origin=origin.position,
        axes=axes,
        design_origin=kin.design(point),
        design_axes=design_axes,
        local={point: ZERO, **(local or {})},
        carrier=(on, kin.local(kin.placed[on], point)),
        hinge=hinge,
        at=origin,
    )
    return kin.placed[body]


def projector(kin: Kinematics, placed: BodyMotion) -> Callable[[str, Vector], Vector]:
    """Return a function that appends the body components of a work vector."""

    def to_body(label: str, v: Vector) -> Vector:
        return kin.program.vector(f"{placed.body}_{label}", to_axes(placed.axes, v), "123")

    return to_body
