"""The catalogue of characteristics: name, unit, definition, sign and formula of each."""

from ...assembly import wheel
from ...assembly.quantity import Quantity
from ...core.quantities import Display

_PERCENT = Display("%", 100.0)


_GROUND = ("tyre_radius",)
_STEERED = ("steered",)
_BRAKING = ("tyre_radius", "wheelbase", "center_of_gravity_height", "front_brake_share")

CORNER = (
    Quantity(
        "camber",
        "rad",
        "camber",
        "inclination of the wheel plane to the vehicle's vertical, atan2(-n_z, s n_y)",
        "positive with the top outboard",
        wheel.camber,
    ),
    Quantity(
        "toe",
        "rad",
        "toe angle",
        "direction of the wheel plane from the vehicle's x axis, atan2(n_x, s n_y)",
        "positive toe-in",
        wheel.toe,
    ),
    Quantity(
        "steer",
        "rad",
        "steer angle",
        "direction of the wheel plane from the vehicle's x axis, atan2(-s n_x, s n_y)",
        "positive to the left, on both sides",
        wheel.steer,
    ),
    Quantity(
        "camber_gradient",
        "rad/m",
        "camber gradient",
        "derivative of camber by wheel travel",
        "positive when camber grows in bump",
        wheel.camber_gradient,
    ),
    Quantity(
        "bump_steer",
        "rad/m",
        "bump steer",
        "derivative of toe by wheel travel",
        "positive toe-in in bump",
        wheel.bump_steer,
    ),
    Quantity(
        "caster",
        "rad",
        "caster angle",
        "inclination of the steering axis in side view, atan2(-k_x, k_z)",
        "positive with the top rearward",
        wheel.caster,
        _STEERED,
    ),
    Quantity(
        "caster_gradient",
        "rad/m",
        "caster gradient",
        "derivative of caster by wheel travel",
        "positive when caster grows in bump",
        wheel.caster_gradient,
        _STEERED,
    ),
    Quantity(
        "kingpin_inclination",
        "rad",
        "kingpin inclination",
        "inclination of the steering axis in front view, atan2(-s k_y, k_z)",
        "positive with the top inboard",
        wheel.kingpin_inclination,
        _STEERED,
    ),
    Quantity(
        "trail",
        "m",
        "mechanical trail",
        "from the contact to where the steering axis meets the ground, along the wheel",
        "positive with the axis ahead of the contact",
        wheel.trail,
        (*_STEERED, *_GROUND),
    ),
    Quantity(
        "steering_axis_offset",
        "m",
        "steering-axis offset at ground",
        "from the contact to where the steering axis meets the ground, across the wheel",
        "positive with the axis inboard of the contact",
        wheel.steering_axis_offset,
        (*_STEERED, *_GROUND),
    ),
    Quantity(
        "scrub_radius",
        "m",
        "scrub radius",
        "distance of the contact from where the steering axis meets the ground (ISO 8855)",
        "without sign; the signed lateral part is the steering-axis offset at ground",
        wheel.scrub_radius,
        (*_STEERED, *_GROUND),
    ),
    Quantity(
        "hub_trail",
        "m",
        "hub trail",
        "from the wheel centre to the steering axis at its height, along the wheel",
        "positive with the axis ahead of the wheel centre",
        wheel.hub_trail,
        _STEERED,
    ),
    Quantity(
        "spindle_offset",
        "m",
        "spindle offset",
        "from the wheel centre to the steering axis at its height, across the wheel",
        "positive with the axis inboard of the wheel centre",
        wheel.spindle_offset,
        _STEERED,
    ),
    Quantity(
        "half_track_change",
        "m",
        "half-track change",
        "lateral displacement of the contact from design",
        "positive outboard",
        wheel.half_track_change,
        _GROUND,
    ),
    Quantity(
        "wheelbase_change",
        "m",
        "wheelbase change",
        "longitudinal displacement of the wheel centre from design",
        "positive forward",
        wheel.wheelbase_change,
    ),
    Quantity(
        "arm_rotation",
        "rad",
        "arm rotation",
        "rotation of the arm, the lower of two (of five links: of a height sensor), from design",
        "positive with the wheel up",
        lambda corner: corner.arm_rotation,
    ),
)
"""Where the wheel is and how it stands: over wheel travel and over the rack."""

TRAVEL = (
    Quantity(
        "spring_length",
        "m",
        "spring length",
        "distance of the spring's seats; of the strut's ends where no seats are given",
        "positive always; falls in bump",
        lambda corner: corner.spring.stroke.length,
    ),
    Quantity(
        "damper_length",
        "m",
        "damper length",
        "distance of the damper's ends: those of the strut, the spring, or its own",
        "positive always; falls in bump",
        lambda corner: corner.damper.length,
    ),
    Quantity(
        "motion_ratio",
        "1",
        "motion ratio",
        "compression of the spring per wheel travel; some programs print the inverse",
        "positive when the spring is compressed in bump",
        wheel.motion_ratio,
    ),
    Quantity(
        "damper_motion_ratio",
        "1",
        "damper motion ratio",
        "compression of the damper per wheel travel",
        "positive when the damper is compressed in bump",
        wheel.damper_motion_ratio,
    ),
    Quantity(
        "wheel_rate",
        "N/m",
        "wheel rate",
        "derivative of the force of spring and stops at the wheel by wheel travel, without tyre",
        "positive when the force grows in bump",
        wheel.wheel_rate,
    ),
    Quantity(
        "ride_rate",
        "N/m",
        "ride rate",
        "wheel rate and tyre rate in series",
        "positive when the force grows in bump",
        wheel.ride_rate,
        ("tyre_rate",),
    ),
    Quantity(
        "roll_center_height_kinematic",
        "m",
        "roll-centre height, kinematic",
        "where the normal to the contact's path meets the centre plane, y_C v_Cy / v_Cz",
        "positive above the contact",
        wheel.roll_center_height_kinematic,
        _GROUND,
    ),
    Quantity(
        "roll_center_height_geometric",
        "m",
        "roll-centre height, geometric",
        "where the line from the contact to the instant centre of the links meets the centre plane",
        "positive above the contact",
        wheel.roll_center_height_geometric,
        _GROUND,
    ),
    Quantity(
        "swing_arm_length_kinematic",
        "m",
        "front-view swing arm length, kinematic",
        "lateral distance of contact and instant centre of the wheel carrier, s v_Cz / w_x",
        "positive with the centre inboard",
        wheel.swing_arm_length_kinematic,
        _GROUND,
    ),
    Quantity(
        "swing_arm_length_geometric",
        "m",
        "front-view swing arm length, geometric",
        "lateral distance of contact and instant centre of the links",
        "positive with the centre inboard",
        wheel.swing_arm_length_geometric,
        _GROUND,
    ),
    Quantity(
        "side_view_swing_arm_angle",
        "rad",
        "side-view swing arm angle",
        "slope of the contact's path with the wheel locked to its carrier, atan(v_Cx / v_Cz)",
        "positive when the contact moves forward in bump",
        wheel.side_view_swing_arm_angle,
        _GROUND,
    ),
    Quantity(
        "side_view_hub_angle",
        "rad",
        "side-view hub angle",
        "slope of the wheel centre's path, atan(v_Wx / v_Wz)",
        "positive when the wheel centre moves forward in bump",
        wheel.side_view_hub_angle,
    ),
    Quantity(
        "anti_dive",
        "1",
        "anti-dive",
        "b (L / h) v_Cx / v_Cz: front brake share b, wheelbase L, height h of the gravity centre",
        "positive when braking lifts the front",
        wheel.anti_dive,
        (*_BRAKING, "front"),
        _PERCENT,
    ),
    Quantity(
        "anti_lift_braked",
        "1",
        "anti-lift under braking",
        "-(1 - b) (L / h) v_Cx / v_Cz: front brake share b, wheelbase L, height h of the gravity "
        "centre",
        "positive when braking holds the rear down",
        wheel.anti_lift_braked,
        (*_BRAKING, "rear"),
        _PERCENT,
    ),
)
"""What the motion over wheel travel decides."""

AT_STOPS = frozenset({"wheel_rate", "ride_rate"})
"""Names of those that jump where a stop begins to act."""

STEERING = (
    Quantity(
        "steer_gradient",
        "rad/m",
        "steer gradient",
        "derivative of the steer angle by rack travel, wheel centre held at its height",
        "positive when the rack's positive sense steers to the left",
        wheel.steer_gradient,
    ),
)
"""What the motion over the rack decides, for one wheel."""

_WITHOUT_TOE = "; steer angles without static toe, which is that with the rack in its middle"

AXLE = {
    quantity.name: quantity
    for quantity in (
        Quantity(
            "steer_left",
            "rad",
            "steer angle, left wheel",
            "steer angle of the left wheel",
            "positive to the left",
        ),
        Quantity(
            "steer_right",
            "rad",
            "steer angle, right wheel",
            "steer angle of the right wheel",
            "positive to the left",
        ),
        Quantity(
            "ackermann_error",
            "rad",
            "Ackermann error",
            "outer steer angle less that for rolling without slip, d_o - atan(L/(L/tan d_i + t)), "
            "t the distance of the wheel centres at design" + _WITHOUT_TOE,
            "positive towards parallel steering",
            needs=("wheelbase",),
        ),
        Quantity(
            "ackermann",
            "1",
            "Ackermann percentage",
            "difference of the steer angles over that for rolling without slip; not defined where "
            "the wheels are steered to different sides" + _WITHOUT_TOE,
            "0 % for parallel, 100 % for Ackermann steering; not defined straight ahead",
            needs=("wheelbase",),
            display=_PERCENT,
        ),
        Quantity(
            "turning_circle",
            "m",
            "turning circle",
            "diameter of the circle of the outer front wheel's centre, 2 L / sin d_o, without "
            "tyre width and body overhang" + _WITHOUT_TOE,
            "positive always; infinite straight ahead",
            needs=("wheelbase",),
            display=Display("m", 1.0),
        ),
        Quantity(
            "steering_ratio",
            "1",
            "steering ratio",
            "derivative of the steering wheel's angle by the mean steer angle of both wheels",
            "without sign",
            needs=("travel_per_turn",),
        ),
    )
}
"""What both wheels decide together."""
