"""A body on a hinge or a guide whose coordinate is known."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import sympy as sp

from ..declare.geometry import FORWARD, UP
from ..declare.joints import Joint, Prismatic, Revolute
from ..kinematics.hinge_angles import HingeDesign
from ..kinematics.motion import BodyMotion, Turn
from ..loops.errors import NoClosedFormError
from ..loops.forms import Follower
from ..program.vectors import (
    NO_TWIST,
    UNIT_X,
    UNIT_Z,
    ZERO,
    Axes,
    Twist,
    Vector,
    from_axes,
    to_axes,
)
from .solved_motion import SlideOnGuide

if TYPE_CHECKING:
    from typing import Self

    from ..declare.geometry import Point
    from ..kinematics.kinematics import Kinematics
    from ..loops.known import Known


@dataclass(frozen=True)
class PlaceByJoint(Follower):
    """A body on a placed one, by a joint of known coordinate."""

    joint: Revolute | Prismatic
    parent: str
    body: str

    rank: ClassVar[int] = 3

    @classmethod
    def follow(cls, known: Known, joint: Joint, parent: str, child: str) -> Self | None:
        """Return the step for a driven hinge or guide, unless another step waits for it."""
        if not isinstance(joint, Revolute | Prismatic) or joint.name in known.guided:
            return None
        if known.unknowns_of(joint) > 0:
            return None
        if child != joint.second.name:
            message = (
                f"joint {joint.name!r}: declare {parent!r} first and {child!r} second, "
                "since its coordinate drives the second body"
            )
            raise NoClosedFormError(message)
        return cls(joint, parent, child)

    @property
    def title(self) -> str:
        return f"{self.body}: {self.joint.kind} joint"

    def emit(self, kin: Kinematics) -> None:
        """Place the body from its parent."""
        if isinstance(self.joint, Revolute):
            _place_revolute(kin, self.joint, self.parent, self.body)
        else:
            _place_prismatic(kin, self.joint, self.parent, self.body)


@dataclass(frozen=True)
class _HingeFrame:
    """Axes and origin of a hinge: on the parent at angle zero, and on the child at design."""

    parent_axes: Axes
    origin: Vector
    design_origin: Vector
    design_axes: Axes
    local: dict[Point, Vector]


def _place_revolute(kin: Kinematics, joint: Revolute, parent_name: str, child: str) -> None:
    parent = kin.placed[parent_name]
    coordinate = kin.coordinates.of(joint)
    angle = kin.given(joint)
    frame = _revolute_frame(kin, joint, parent, child)
    cosine = kin.program.define(f"cos_{angle}", sp.cos(angle))
    sine = kin.program.define(f"sin_{angle}", sp.sin(angle))

    def turn(v: Vector) -> Vector:
        """Return child components of a vector in the parent's axes."""
        x, y, z = to_axes(frame.parent_axes, v)
        return Vector(x, cosine * y + sine * z, cosine * z - sine * y)

    x, y, z = (from_axes(parent.axes, axis) for axis in frame.parent_axes)
    axes = (x, y * cosine + z * sine, z * cosine - y * sine)
    placed = BodyMotion(
        child,
        origin=kin.program.vector(
            f"{child}_origin", parent.origin + from_axes(parent.axes, frame.origin)
        ),
        axes=kin.program.axes((f"{child}_axis", f"{child}_side", f"{child}_top"), axes),
        design_origin=frame.design_origin,
        design_axes=frame.design_axes,
        local=frame.local,
        carrier=(parent_name, frame.origin),
        hinge=joint.name,
        turn=Turn(cosine, sine, (y, z)),
    )
    for k, twist in parent.motion.items():
        velocity = twist.linear + twist.angular.cross(frame.origin)
        placed.motion[k] = kin.define_twist(child, k, Twist(turn(twist.angular), turn(velocity)))
    if kin.coordinates.moves(joint):  # an angle that a closed form reads moves the parent, too
        carried = placed.motion.get(coordinate, NO_TWIST)
        own = UNIT_X * kin.coordinates.ratio(joint)
        placed.motion[coordinate] = carried + Twist(own, ZERO)

    def bias() -> Twist:
        if coordinate in kin.coordinates.rotors and kin.coordinates.rate_scale_of(parent) != 1:
            message = f"the bias of rotor {child!r} is not available at a unit rate"
            raise ValueError(message)
        carried = parent.bias()
        omega = turn(kin.total(parent).angular)
        spin = UNIT_X * kin.coordinates.speed(joint)
        angular = (
            turn(carried.angular)
            + omega.cross(spin)
            + UNIT_X * kin.coordinates.given_acceleration(joint)
        )
        linear = turn(kin.point_bias(parent, frame.origin))
        return kin.define_bias(child, Twist(angular, linear))

    placed.bias = bias
    kin.placed[child] = placed


def _revolute_frame(
    kin: Kinematics, joint: Revolute, parent: BodyMotion, child: str
) -> _HingeFrame:
    """Return the axes of a hinge on both of its bodies."""
    through = kin.design(joint.axis.through)
    if joint == kin.work_hinge:
        assert joint.angle_to is not None
        point = kin.design(joint.angle_to)
        axis, z_parent = UNIT_X, UNIT_Z
        origin = Vector(point.x, through.y, through.z)
        arm = kin.program.vector(f"{child}_arm", point - origin)
        radius = kin.program.define(f"{child}_radius", sp.sqrt(arm.y**2 + arm.z**2))
        z_child = kin.program.vector(f"{child}_top_design", arm * (1 / radius))
        local = {joint.angle_to: Vector(ZERO.x, ZERO.y, radius)}
    elif joint.angle_to is not None:
        design = HingeDesign.of(kin, joint)
        axis, z_parent, z_child = design.axis, design.zero, design.mark
        origin = kin.program.vector(f"{child}_foot", through + axis * design.along)
        local = {joint.angle_to: Vector(ZERO.x, ZERO.y, design.radius)}
    else:
        axis = kin.unit(f"{child}_axis_design", kin.to_work(joint.axis.vector))
        z_parent = _beside(kin, joint, child, axis)
        origin, z_child = through, z_parent
        local = {joint.axis.through: ZERO}
    design_axes = (axis, kin.program.vector(f"{child}_side_design", z_child.cross(axis)), z_child)
    start = (axis, kin.program.vector(f"{child}_side_zero", z_parent.cross(axis)), z_parent)
    parent_axes = kin.program.axes(
        (f"{child}_axis_on_parent", f"{child}_side_on_parent", f"{child}_top_on_parent"),
        (to_axes(parent.design_axes, v) for v in start),
        "123",
    )
    on_parent = kin.program.vector(
        f"{child}_origin_on_parent",
        to_axes(parent.design_axes, origin - parent.design_origin),
        "123",
    )
    return _HingeFrame(parent_axes, on_parent, origin, design_axes, local)


def _beside(kin: Kinematics, joint: Revolute, child: str, axis: Vector) -> Vector:
    """Return a unit vector across a hinge whose angle counts from the design position.

    It is along an axis of the ground where that makes the shortest equations; the default
    parameters show that it is far enough from the hinge. Otherwise it has no singular direction of
    the hinge.
    """
    n = [kin.at_defaults(component) for component in joint.axis.vector]
    size = math.hypot(*n)
    if all(component.is_number for component in joint.axis.vector):
        reference = FORWARD if abs(n[0]) <= abs(n[2]) else UP
    elif abs(n[2]) < size / 2:
        reference = UP
    else:
        return kin.across(child, axis)[1]
    v = kin.design_direction(reference)
    return kin.unit(f"{child}_top_design", v - axis * v.dot(axis))


def _place_prismatic(kin: Kinematics, joint: Prismatic, parent_name: str, child: str) -> None:
    parent = kin.placed[parent_name]
    coordinate = kin.coordinates.of(joint)
    slide = kin.given(joint)
    direction = kin.local_direction(parent, joint.direction)
    on_guide = SlideOnGuide(kin, child, parent, direction * slide)
    placed = on_guide.placed
    for k in parent.motion:
        placed.motion[k] = kin.define_twist(child, k, on_guide.at_rest(k))
    if kin.coordinates.moves(joint):  # that of a strut turns its first link, too
        carried = placed.motion.get(coordinate, NO_TWIST)
        own = direction * kin.coordinates.ratio(joint)
        placed.motion[coordinate] = carried + Twist(ZERO, own)

    def bias() -> Twist:
        carried = on_guide.carried_bias(direction * kin.coordinates.speed(joint))
        own = direction * kin.coordinates.given_acceleration(joint)
        return kin.define_bias(child, carried + Twist(ZERO, own))

    placed.bias = bias
