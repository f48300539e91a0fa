"""Formulas of anti-dive, anti-lift and anti-squat.

They are the part of the load transfer by a longitudinal acceleration, m a h / L, that the path of a
wheel, or of a rigid axle, carries without the springs. A force F along the road at a point with
velocity (v_x, v_z) lifts the body by F v_x / v_z. The point is the contact, fixed to the carrier,
if the carrier reacts the torque; it is the wheel centre if a shaft leads the torque to the body.

Sources: W. F. Milliken and D. L. Milliken, Race Car Vehicle Dynamics, SAE, 1995, chapter 17; J. C.
Dixon, Suspension Geometry and Computation, Wiley, 2009 (pitch geometry).
"""

from collections.abc import Callable

from ....core.named_types import Array
from ..two_wheels import TwoWheels
from .corner import PITCH
from .measure import Measure


def braking(of: TwoWheels, side: str = "") -> Array:
    """Return anti-dive of a front axle, anti-lift of a rear axle, under braking [1].

    `side` is the wheel of an `AxleKinematics`.
    """
    front = of.vehicles[0].front_brake_share
    assert front is not None
    share = front if of.end == "front" else 1.0 - front
    return share * _path(of, side, of.axle.brakes.torque_on)


def driving(of: TwoWheels, side: str = "") -> Array:
    """Return anti-lift of a front axle, anti-squat of a rear axle, under drive [1]."""
    assert of.axle.drive is not None
    return of.axle.drive.share * _path(of, side, of.axle.drive.torque_on)


def at_both_ends(
    measure: Callable[..., Measure], brakes_at: str = "", drive_at: str = ""
) -> tuple[Measure, ...]:
    """Return the measures under braking and drive at both ends, by `of_wheel` or `of_axle`.

    Their definitions name the points of the forces under braking and drive, if these are given.
    """
    braked = (*PITCH, "front_brake_share")
    of_brakes = f"brake share b, wheelbase L, height h of the gravity centre; {brakes_at}"
    words = {
        "anti_dive": f"b (L / h) v_x / v_z under braking: {of_brakes}",
        "anti_lift_braked": f"-(1 - b) (L / h) v_x / v_z under braking: front brake share b; "
        f"{brakes_at}",
        "anti_lift_driven": f"d (L / h) v_x / v_z under drive: drive share d; {drive_at}",
        "anti_squat": f"-d (L / h) v_x / v_z under drive: drive share d; {drive_at}",
    }
    return tuple(
        measure(name, formula, needs, known_to, words[name] if at else "")
        for name, formula, needs, known_to, at in (
            ("anti_dive", braking, braked, _is_at("front"), brakes_at),
            ("anti_lift_driven", driving, PITCH, _is_at("front", driven=True), drive_at),
            ("anti_lift_braked", braking, braked, _is_at("rear"), brakes_at),
            ("anti_squat", driving, PITCH, _is_at("rear", driven=True), drive_at),
        )
    )


def _is_at(end: str, *, driven: bool = False) -> Callable[[TwoWheels], bool]:
    """Return the condition that an axle is at an end of the vehicle, and driven if `driven`."""
    return lambda of: of.end == end and (of.axle.drive is not None or not driven)


def _path(of: TwoWheels, side: str, torque_on: str) -> Array:
    """Return (L / h) v_x / v_z, positive if the axle's load falls as the force grows."""
    vehicle = of.vehicles[0]
    assert vehicle.wheelbase is not None
    assert vehicle.center_of_gravity_height is not None
    sense = 1.0 if of.end == "front" else -1.0
    ratio = vehicle.wheelbase / vehicle.center_of_gravity_height
    return sense * ratio * of.path_slope(torque_on, side)
