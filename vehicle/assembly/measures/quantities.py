"""What each characteristic is called, its unit, its definition and its sign: said once for all.

Where an assembly has another definition of the same quantity, its list of measures says it.
"""

from math import pi

from ....core.quantities import Display
from ..quantity import Quantity

_PERCENT = Display("%", 100.0)
_PER_DEGREE = Display("N m/deg", pi / 180.0)
_ANGLES = Display("deg/deg", 1.0)
_NEWTON_METRES = Display("N m", 1.0)
_METRES = Display("m", 1.0)

_WITHOUT_TOE = "; steer angles without static toe, which is that with the rack in its middle"

_ALL = (
    Quantity(
        "camber",
        "rad",
        "camber",
        "inclination of the wheel plane to the vehicle's vertical, atan2(-n_z, s n_y)",
        "positive with the top outboard",
    ),
    Quantity(
        "toe",
        "rad",
        "toe angle",
        "direction of the wheel plane from the vehicle's x axis, atan2(n_x, s n_y)",
        "positive toe-in",
    ),
    Quantity(
        "steer",
        "rad",
        "steer angle",
        "direction of the wheel plane from the vehicle's x axis, atan2(-s n_x, s n_y)",
        "positive to the left, on both sides",
    ),
    Quantity(
        "camber_gradient",
        "rad/m",
        "camber gradient",
        "derivative of camber with respect to wheel travel",
        "positive when camber grows in bump",
    ),
    Quantity(
        "bump_steer",
        "rad/m",
        "bump steer",
        "derivative of toe with respect to wheel travel",
        "positive toe-in in bump",
    ),
    Quantity(
        "caster",
        "rad",
        "caster angle",
        "inclination of the steering axis in side view, atan2(-k_x, k_z)",
        "positive with the top rearward",
    ),
    Quantity(
        "caster_gradient",
        "rad/m",
        "caster gradient",
        "derivative of caster with respect to wheel travel",
        "positive when caster grows in bump",
    ),
    Quantity(
        "kingpin_inclination",
        "rad",
        "kingpin inclination",
        "inclination of the steering axis in front view, atan2(-s k_y, k_z)",
        "positive with the top inboard",
    ),
    Quantity(
        "trail",
        "m",
        "mechanical trail",
        "from the contact to where the steering axis meets the ground, along the wheel",
        "positive with the axis ahead of the contact",
    ),
    Quantity(
        "steering_axis_offset",
        "m",
        "steering-axis offset at ground",
        "from the contact to where the steering axis meets the ground, across the wheel",
        "positive with the axis inboard of the contact",
    ),
    Quantity(
        "scrub_radius",
        "m",
        "scrub radius",
        "distance of the contact from where the steering axis meets the ground (ISO 8855)",
        "without sign; the signed lateral part is the steering-axis offset at ground",
    ),
    Quantity(
        "hub_trail",
        "m",
        "hub trail",
        "from the wheel centre to the steering axis at its height, along the wheel",
        "positive with the axis ahead of the wheel centre",
    ),
    Quantity(
        "spindle_offset",
        "m",
        "spindle offset",
        "from the wheel centre to the steering axis at its height, across the wheel",
        "positive with the axis inboard of the wheel centre",
    ),
    Quantity(
        "half_track_change",
        "m",
        "half-track change",
        "lateral displacement of the contact from design",
        "positive outboard",
    ),
    Quantity(
        "wheelbase_change",
        "m",
        "wheelbase change",
        "longitudinal displacement of the wheel centre from design",
        "positive forward",
    ),
    Quantity(
        "arm_rotation",
        "rad",
        "arm rotation",
        "rotation of the arm, the lower of two (of five links: of a height sensor), from design",
        "positive with the wheel up",
    ),
    Quantity(
        "spring_length",
        "m",
        "spring length",
        "distance of the spring's seats; of the strut's ends where no seats are given",
        "positive always; falls in bump",
    ),
    Quantity(
        "damper_length",
        "m",
        "damper length",
        "distance of the damper's ends: those of the strut, the spring, or its own",
        "positive always; falls in bump",
    ),
    Quantity(
        "motion_ratio",
        "1",
        "motion ratio",
        "compression of the spring per wheel travel; some programs print the inverse",
        "positive when the spring is compressed in bump",
    ),
    Quantity(
        "damper_motion_ratio",
        "1",
        "damper motion ratio",
        "compression of the damper per wheel travel",
        "positive when the damper is compressed in bump",
    ),
    Quantity(
        "wheel_rate",
        "N/m",
        "wheel rate",
        "derivative of the force of spring and stops at the wheel with respect to wheel travel, "
        "without tyre",
        "positive when the force grows in bump",
    ),
    Quantity(
        "ride_rate",
        "N/m",
        "ride rate",
        "wheel rate and tyre rate in series",
        "positive when the force grows in bump",
    ),
    Quantity(
        "roll_center_height_kinematic",
        "m",
        "roll-centre height, kinematic",
        "where the normal to the contact's path meets the centre plane, y_C v_Cy / v_Cz",
        "positive above the contact",
    ),
    Quantity(
        "roll_center_height_geometric",
        "m",
        "roll-centre height, geometric",
        "where the line from the contact to the instant centre of the links meets the centre plane",
        "positive above the contact",
    ),
    Quantity(
        "swing_arm_length_kinematic",
        "m",
        "front-view swing arm length, kinematic",
        "lateral distance of contact and instant centre of the wheel carrier, s v_Cz / w_x",
        "positive with the centre inboard",
    ),
    Quantity(
        "swing_arm_length_geometric",
        "m",
        "front-view swing arm length, geometric",
        "lateral distance of contact and instant centre of the links",
        "positive with the centre inboard",
    ),
    Quantity(
        "side_view_swing_arm_angle",
        "rad",
        "side-view swing arm angle",
        "slope of the contact's path with the wheel locked to its carrier, atan(v_Cx / v_Cz)",
        "positive when the contact moves forward in bump",
    ),
    Quantity(
        "side_view_hub_angle",
        "rad",
        "side-view hub angle",
        "slope of the wheel centre's path, atan(v_Wx / v_Wz)",
        "positive when the wheel centre moves forward in bump",
    ),
    Quantity(
        "anti_dive",
        "1",
        "anti-dive",
        "b (L / h) v_Cx / v_Cz: front brake share b, wheelbase L, height h of the gravity centre",
        "positive when braking lifts the front",
        display=_PERCENT,
    ),
    Quantity(
        "anti_lift_braked",
        "1",
        "anti-lift under braking",
        "-(1 - b) (L / h) v_Cx / v_Cz: front brake share b, wheelbase L, height h of the "
        "gravity centre",
        "positive when braking holds the rear down",
        display=_PERCENT,
    ),
    Quantity(
        "steer_gradient",
        "rad/m",
        "steer gradient",
        "derivative of the steer angle by rack travel, wheel centre held at its height",
        "positive when the rack's positive sense steers to the left",
    ),
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
        "outer steer angle less that for rolling without slip, d_o - atan(L/(L/tan d_i + t)), t"
        " the distance of the wheel centres at design" + _WITHOUT_TOE,
        "positive towards parallel steering",
    ),
    Quantity(
        "ackermann",
        "1",
        "Ackermann percentage",
        "difference of the steer angles over that for rolling without slip; not defined where "
        "the wheels are steered to different sides" + _WITHOUT_TOE,
        "0 % for parallel, 100 % for Ackermann steering; not defined straight ahead",
        display=_PERCENT,
    ),
    Quantity(
        "turning_circle",
        "m",
        "turning circle",
        "diameter of the circle of the outer front wheel's centre, 2 L / sin d_o, without tyre "
        "width and body overhang" + _WITHOUT_TOE,
        "positive always; infinite straight ahead",
        display=_METRES,
    ),
    Quantity(
        "steering_ratio",
        "1",
        "steering ratio",
        "derivative of the steering wheel's angle with respect to the mean steer angle of both "
        "wheels",
        "without sign",
    ),
    Quantity(
        "track",
        "m",
        "track",
        "lateral distance of the contacts",
        "positive always",
    ),
    Quantity(
        "track_change",
        "m",
        "track change",
        "how much farther apart the contacts are than at design",
        "positive with a wider track",
    ),
    Quantity(
        "inclination",
        "rad",
        "inclination angle",
        "camber to the line through the contacts instead of the body",
        "positive with the top outboard",
    ),
    Quantity(
        "roll_center_height",
        "m",
        "roll-centre height",
        "where the normals to the paths of both contacts meet, above the line through them",
        "positive above the contacts",
    ),
    Quantity(
        "roll_center_lateral",
        "m",
        "roll-centre offset",
        "the same point, from the middle between the contacts along the line through them",
        "positive to the left",
    ),
    Quantity(
        "jacking",
        "1",
        "jacking coefficient",
        "lift of the body by a lateral force at the contact, over the force, s v_Cy / v_Cz",
        "positive when an inboard force lifts the body",
    ),
    Quantity(
        "roll_steer",
        "1",
        "roll steer",
        "derivative of the steer angle with respect to the roll angle, in which each wheel travels "
        "by -y per radian",
        "positive when a roll with the right side down steers to the left",
        display=_ANGLES,
    ),
    Quantity(
        "roll_camber",
        "1",
        "roll camber",
        "derivative of camber, to the body, with respect to the roll angle, in which each wheel "
        "travels by -y per radian",
        "positive when a roll with the right side down adds camber",
        display=_ANGLES,
    ),
    Quantity(
        "wheel_force",
        "N",
        "wheel force",
        "vertical force at the wheel that spring, stops and bar take; no unsprung weight",
        "positive when the road pushes up",
    ),
    Quantity(
        "roll_moment",
        "N m",
        "roll moment",
        "moment of the wheel forces about the vehicle's centre line at the ground",
        "positive when it turns the right side up",
        display=_NEWTON_METRES,
    ),
    Quantity(
        "roll_moment_gradient",
        "N m/rad",
        "roll-moment gradient",
        "derivative of the roll moment with respect to the roll angle, the wheel centres moving "
        "oppositely; "
        "forces and levers change",
        "positive when it resists roll; with the change of levers",
        display=_PER_DEGREE,
    ),
    Quantity(
        "roll_stiffness",
        "N m/rad",
        "roll stiffness",
        "y' K y, with the stiffness K of both wheels and constant levers y of the contacts; no "
        "tyres",
        "positive when it resists roll; at constant levers",
        display=_PER_DEGREE,
    ),
    Quantity(
        "roll_stiffness_springs",
        "N m/rad",
        "roll stiffness of the springs",
        "the part of springs and stops",
        "positive when it resists roll",
        display=_PER_DEGREE,
    ),
    Quantity(
        "roll_stiffness_bar",
        "N m/rad",
        "roll stiffness of the anti-roll bar",
        "the part of the anti-roll bar",
        "positive when it resists roll",
        display=_PER_DEGREE,
    ),
    Quantity(
        "bar_share",
        "1",
        "share of the anti-roll bar",
        "its part of the roll stiffness",
        "0 % without a bar",
        display=_PERCENT,
    ),
    Quantity(
        "roll_stiffness_with_tyres",
        "N m/rad",
        "roll stiffness with tyres",
        "roll stiffness in series with the vertical stiffness of the tyres",
        "positive when it resists roll",
        display=_PER_DEGREE,
    ),
    Quantity(
        "bar_twist",
        "rad",
        "twist of the anti-roll bar",
        "angle of the left half less that of the right",
        "positive when the left half is turned farther about its axis to the left",
    ),
    Quantity(
        "bar_torque",
        "N m",
        "torque of the anti-roll bar",
        "its rate times the twist from where it is free",
        "as the twist",
        display=_NEWTON_METRES,
    ),
    Quantity(
        "link_force",
        "N",
        "force of the drop link",
        "tension of the drop link",
        "positive when it pulls its ends together",
    ),
    Quantity(
        "anti_lift_driven",
        "1",
        "anti-lift under drive",
        "d (L / h) v_x / v_z under drive: drive share d; wheel centre with the final drive on "
        "the body, contact with a motor on the carrier",
        "positive when driving holds the front down",
        display=_PERCENT,
    ),
    Quantity(
        "anti_squat",
        "1",
        "anti-squat",
        "-d (L / h) v_x / v_z under drive: drive share d; wheel centre with the final drive on "
        "the body, contact with a motor on the carrier",
        "positive when driving lifts the rear",
        display=_PERCENT,
    ),
    Quantity(
        "axle_steer",
        "rad",
        "steer angle of the axle",
        "turn of the line through the wheels about the vehicle's vertical",
        "positive to the left",
    ),
    Quantity(
        "heave_steer",
        "rad/m",
        "heave steer",
        "derivative of the axle's steer angle with respect to the travel of both wheels",
        "positive when the axle steers to the left in bump",
    ),
    Quantity(
        "axle_lateral",
        "m",
        "lateral displacement of the axle",
        "of the middle between the wheel centres, from design",
        "positive to the left",
    ),
    Quantity(
        "axle_longitudinal",
        "m",
        "longitudinal displacement of the axle",
        "of the middle between the wheel centres, from design",
        "positive forward",
    ),
    Quantity(
        "pinion_angle",
        "rad",
        "pinion angle",
        "turn of the axle about the line through its wheels, from design",
        "positive with the nose of the final drive up",
    ),
    Quantity(
        "roll_motion_ratio",
        "1",
        "motion ratio in roll",
        "compression of the spring per travel of its wheel, the other one moving oppositely",
        "positive when the spring is compressed with its wheel up",
    ),
    Quantity(
        "damper_roll_motion_ratio",
        "1",
        "damper motion ratio in roll",
        "compression of the damper per travel of its wheel, the other one moving oppositely",
        "positive when the damper is compressed with its wheel up",
    ),
    Quantity(
        "wheel_rate_alone",
        "N/m",
        "wheel rate, one wheel",
        "derivative of the wheel force with respect to the travel of this wheel, the other one at "
        "rest",
        "positive when the force grows in bump",
    ),
)

QUANTITIES = {quantity.name: quantity for quantity in _ALL}
"""By name."""
