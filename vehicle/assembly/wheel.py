"""Formulas of the characteristics of one wheel.

Each function takes a `Corner`, or a `RoadWheel` if that is sufficient, and returns an array over
its positions, SI units; a measure whose data are missing is not computed. Signs are those of
docs/suspension/characteristics.md. Unbounded quantities (the length of a swing arm about an instant
centre at infinity) are infinite.

Sources: definitions of ISO 8855:2011; roll centres, swing arms and anti-dive as in W. F. Milliken
and D. L. Milliken, Race Car Vehicle Dynamics, SAE, 1995, chapter 17; instant axes and the steering
axis as in W. Matschinsky, Road Vehicle Suspensions, Professional Engineering Publishing, 2000.
"""

import numpy as np

from ...core.named_types import Array
from ...core.vectors import cross, directions
from ..corner.corner import UP, CarrierMotion, Corner, RoadWheel, SteeringAxis

# -- angles of the wheel --------------------------------------------------------------------------


def camber(corner: RoadWheel) -> Array:
    """Return the camber [rad], positive with the top outboard."""
    return np.arctan2(*_camber_sides(corner, corner.axis))


def toe(corner: RoadWheel) -> Array:
    """Return the toe angle [rad], positive toe-in."""
    return np.arctan2(*_toe_sides(corner, corner.axis))


def steer(corner: RoadWheel) -> Array:
    """Return the steer angle [rad], positive to the left on both sides."""
    return -corner.vehicle.side * toe(corner)


def camber_gradient(corner: Corner) -> Array:
    """Return the derivative of camber with respect to wheel travel [rad/m]."""
    return camber_rate(corner, corner.travel)


def bump_steer(corner: Corner) -> Array:
    """Return the derivative of toe with respect to travel [rad/m], positive toe-in in bump."""
    return toe_rate(corner, corner.travel)


def steer_gradient(corner: Corner) -> Array:
    """Return the derivative of the steer angle with respect to rack travel [rad/m].

    The wheel centre keeps its height.
    """
    assert corner.steering is not None
    return -corner.vehicle.side * toe_rate(corner, corner.steering)


def camber_rate(corner: RoadWheel, motion: CarrierMotion) -> Array:
    """Return the rate of camber in a motion [rad per unit]."""
    turned = _turned_axis(corner, motion)
    return _angle_rate(_camber_sides(corner, corner.axis), _camber_sides(corner, turned))


def toe_rate(corner: RoadWheel, motion: CarrierMotion) -> Array:
    """Return the rate of toe in a motion [rad per unit]."""
    turned = _turned_axis(corner, motion)
    return _angle_rate(_toe_sides(corner, corner.axis), _toe_sides(corner, turned))


# -- steering axis --------------------------------------------------------------------------------


def caster(corner: Corner) -> Array:
    """Return the caster angle [rad], positive with the top rearward."""
    return np.arctan2(*_caster_sides(_steering_axis(corner)))


def caster_gradient(corner: Corner) -> Array:
    """Return the derivative of caster with respect to wheel travel [rad/m]."""
    axis, rate = _steering_axis(corner), _steered_about(corner).rate
    return _angle_rate(_caster_sides(axis), _caster_sides(rate))


def kingpin_inclination(corner: Corner) -> Array:
    """Return the kingpin inclination [rad], positive with the top inboard."""
    axis = _steering_axis(corner)
    return np.arctan2(-corner.vehicle.side * axis[..., 1], axis[..., 2])


def trail(corner: Corner) -> Array:
    """Return the mechanical trail [m], positive with the axis ahead of the contact."""
    return _offsets(corner, contact(corner))[0]


def steering_axis_offset(corner: Corner) -> Array:
    """Return the lateral offset of the axis at the ground [m], positive with the axis inboard."""
    return _offsets(corner, contact(corner))[1]


def scrub_radius(corner: Corner) -> Array:
    """Return the distance of axis and contact in the ground plane [m], without sign."""
    return np.hypot(*_offsets(corner, contact(corner)))


def hub_trail(corner: Corner) -> Array:
    """Return the trail at the height of the wheel centre [m], positive with the axis ahead."""
    return _offsets(corner, corner.center)[0]


def spindle_offset(corner: Corner) -> Array:
    """Return the lateral offset at the height of the wheel centre [m], positive axis inboard."""
    return _offsets(corner, corner.center)[1]


# -- path of the wheel ----------------------------------------------------------------------------


def contact(corner: RoadWheel) -> Array:
    """Return the contact point: the lowest point of the wheel as a thin disc [m]."""
    return lowest_point(corner.center, corner.axis, _radius(corner))


def contact_rate(corner: Corner) -> Array:
    """Return the derivative of the contact's position with respect to travel, (..., 3) [1]."""
    motion = corner.travel
    return lowest_point_rate(motion.velocity, corner.axis, motion.turning, _radius(corner))


def half_track_change(corner: RoadWheel) -> Array:
    """Return the displacement of the contact from design [m], positive outboard."""
    design = lowest_point(corner.design_center, corner.design_axis, _radius(corner))
    return corner.vehicle.side * (contact(corner)[..., 1] - design[..., 1])


def wheelbase_change(corner: RoadWheel) -> Array:
    """Return the displacement of the wheel centre from design [m], positive forward."""
    return corner.center[..., 0] - corner.design_center[..., 0]


def roll_center_height_kinematic(corner: Corner) -> Array:
    """Return the height above the contact at which the contact's normal meets y = 0 [m].

    The normal is that of the path of the contact point, fixed to the wheel carrier, in front view.
    """
    velocity = contact_velocity(corner)
    return _quotient(contact(corner)[..., 1] * velocity[..., 1], velocity[..., 2])


def swing_arm_length_kinematic(corner: Corner) -> Array:
    """Return the lateral distance of contact and instant centre in front view [m]."""
    velocity, turning = contact_velocity(corner), corner.travel.turning
    return _quotient(corner.vehicle.side * velocity[..., 2], turning[..., 0])


def roll_center_height_geometric(corner: Corner) -> Array:
    """Return the height above the contact of the line to the links' instant centre at y = 0 [m]."""
    y, z, scale = _instant_center(corner)
    at = contact(corner)
    return _quotient(-at[..., 1] * (z - at[..., 2] * scale), y - at[..., 1] * scale)


def swing_arm_length_geometric(corner: Corner) -> Array:
    """Return the lateral distance of contact and the links' instant centre in front view [m]."""
    y, _, scale = _instant_center(corner)
    return _quotient(corner.vehicle.side * (contact(corner)[..., 1] * scale - y), scale)


def side_view_swing_arm_angle(corner: Corner) -> Array:
    """Return the angle of the contact's path from the vertical, wheel locked [rad]."""
    velocity = contact_velocity(corner)
    return np.arctan2(velocity[..., 0], velocity[..., 2])


def side_view_hub_angle(corner: Corner) -> Array:
    """Return the angle of the wheel centre's path from the vertical [rad]."""
    return np.arctan2(corner.travel.velocity[..., 0], corner.travel.velocity[..., 2])


def anti_dive(corner: Corner) -> Array:
    """Return the part of the braking pitch that the front suspension reacts [1]."""
    share = corner.vehicle.front_brake_share
    assert share is not None
    return share * _braking(corner)


def anti_lift_braked(corner: Corner) -> Array:
    """Return the part of the braking pitch that the rear suspension reacts [1]."""
    share = corner.vehicle.front_brake_share
    assert share is not None
    return (share - 1.0) * _braking(corner)


def _braking(corner: Corner) -> Array:
    """Return (L / h) v_Cx / v_Cz."""
    wheelbase, height = corner.vehicle.wheelbase, corner.vehicle.center_of_gravity_height
    assert wheelbase is not None
    assert height is not None
    velocity = contact_velocity(corner)
    return _quotient(wheelbase / height * velocity[..., 0], velocity[..., 2])


# -- springs --------------------------------------------------------------------------------------


def motion_ratio(corner: Corner) -> Array:
    """Return the compression of the spring per wheel travel [1]."""
    return -corner.spring.stroke.slope


def damper_motion_ratio(corner: Corner) -> Array:
    """Return the compression of the damper per wheel travel [1]."""
    return -corner.damper.slope


def wheel_force(corner: Corner) -> Array:
    """Return the vertical force of spring and stops at the wheel, by virtual work [N]."""
    force = np.zeros_like(corner.arm_rotation)
    for spring in (corner.spring, *corner.stops):
        force = force - spring.force * spring.stroke.slope
    return force


def wheel_rate(corner: Corner) -> Array:
    """Return the derivative of `wheel_force` with respect to wheel travel [N/m].

    A spring of force F has the force F MR at the wheel, with the motion ratio MR; both change.
    """
    rate = np.zeros_like(corner.arm_rotation)
    for spring in (corner.spring, *corner.stops):
        stroke = spring.stroke
        rate = rate - spring.force_slope * stroke.slope - spring.force * stroke.curvature
    return rate


def ride_rate(corner: Corner) -> Array:
    """Return the rate of wheel and tyre in series [N/m]."""
    tyre = corner.vehicle.tyre_rate
    assert tyre is not None
    wheel = wheel_rate(corner)
    return _quotient(wheel * tyre, wheel + tyre)


# -- shared by the formulas -----------------------------------------------------------------------


def _quotient(numerator: Array, denominator: Array) -> Array:
    """Return a quotient, infinite for a zero denominator, without a warning."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return numerator / denominator


def _camber_sides(corner: RoadWheel, axis: Array) -> tuple[Array, Array]:
    return -axis[..., 2], corner.vehicle.side * axis[..., 1]


def _toe_sides(corner: RoadWheel, axis: Array) -> tuple[Array, Array]:
    return axis[..., 0], corner.vehicle.side * axis[..., 1]


def _caster_sides(axis: Array) -> tuple[Array, Array]:
    return -axis[..., 0], axis[..., 2]


def _angle_rate(sides: tuple[Array, Array], rates: tuple[Array, Array]) -> Array:
    """Return the rate of ``arctan2(*sides)``; the sides are linear in a vector of known rate."""
    (p, q), (p_rate, q_rate) = sides, rates
    return (q * p_rate - p * q_rate) / (p**2 + q**2)


def _turned_axis(corner: RoadWheel, motion: CarrierMotion) -> Array:
    return cross(motion.turning, corner.axis)


def lowest_point(center: Array, axis: Array, radius: float) -> Array:
    """Return the lowest point of a thin disc about an axis [m]."""
    return center - np.asarray(radius)[..., None] * upward_across(axis)


def upward_across(axis: Array) -> Array:
    """Return the steepest upward unit vector perpendicular to an axis, in the plane of a wheel."""
    across = axis[..., 2:]
    return (UP - axis * across) / np.sqrt(1.0 - across**2)


def lowest_point_rate(velocity: Array, axis: Array, turning: Array, radius: float) -> Array:
    """Return the velocity of the lowest point of a thin disc, which is not fixed to it.

    `velocity` is that of its centre, `axis` its axis, `turning` its angular velocity, (..., 3)
    each.
    """
    turned, up = cross(turning, axis), upward_across(axis)
    across, rate = axis[..., 2:], turned[..., 2:]
    square = 1.0 - across**2
    change = up * across * rate / square - (turned * across + axis * rate) / np.sqrt(square)
    return velocity - np.asarray(radius)[..., None] * change


def contact_velocity(corner: Corner) -> Array:
    """Return the velocity of the contact point, fixed to the carrier, per wheel travel."""
    motion = corner.travel
    return motion.velocity + cross(motion.turning, contact(corner) - corner.center)


def _steered_about(corner: Corner) -> SteeringAxis:
    assert corner.steering_axis is not None  # measures that need it are left out without a rack
    return corner.steering_axis


def _steering_axis(corner: Corner) -> Array:
    axis = _steered_about(corner)
    return axis.upper - axis.lower


def _offsets(corner: Corner, point: Array) -> tuple[Array, Array]:
    """Return the offsets of the steering axis at the height of a point, ahead and inboard."""
    axis, lower = _steering_axis(corner), _steered_about(corner).lower
    rise = (point - lower)[..., 2:] / axis[..., 2:]
    away = lower + rise * axis - point
    heading = _heading(corner)
    left = cross(UP, heading)
    ahead = np.einsum("...i,...i->...", away, heading)
    return ahead, -corner.vehicle.side * np.einsum("...i,...i->...", away, left)


def _heading(corner: Corner) -> Array:
    """Return the horizontal unit vector of the wheel's forward direction."""
    return directions(cross(corner.vehicle.side * corner.axis, UP))


def _instant_center(corner: Corner) -> tuple[Array, Array, Array]:
    """Return the intersection of the links' planes in the transverse plane of the wheel centre.

    It has homogeneous coordinates: the centre is at (y, z) / scale, at infinity if scale is zero.
    """
    (first_y, first_z, first), (second_y, second_z, second) = (
        _trace(plane.point, plane.normal, corner.center[..., 0]) for plane in corner.links
    )
    y = first * second_z - second * first_z
    z = first_y * second - second_y * first
    return y, z, first_y * second_z - second_y * first_z


def _trace(point: Array, normal: Array, x: Array) -> tuple[Array, Array, Array]:
    """Return a, b, c of the line a y + b z = c in which a plane intersects that of given x."""
    level = np.einsum("...i,...i->...", normal, point) - normal[..., 0] * x
    return normal[..., 1], normal[..., 2], level


def _radius(corner: RoadWheel) -> float:
    assert corner.vehicle.tyre_radius is not None
    return corner.vehicle.tyre_radius
