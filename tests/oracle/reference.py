"""The reference car: a front right MacPherson suspension, its parameters and expected values.

SI units; ISO 8855 chassis axes (x forward, y left, z up) with the origin on the ground below the
design position of the wheel centre, in the vehicle's centre plane. Every position is that at
design. The expected values were made by an implementation that shares no code with this project.

The parameters are one flat dict of floats. Three-vectors are spread over the suffixes ``_x``,
``_y``, ``_z``; inertias are the elements of the tensor about the centre of mass, in chassis axes at
design, over ``_inertia_xx``, ``_yy``, ``_zz``, ``_xy``, ``_xz``, ``_yz`` (kg m²; the elements off
the diagonal are those of the tensor, thus minus the products of inertia).
"""

import numpy as np
from scipy.interpolate import PchipInterpolator
from support.folders import DATA

Parameters = dict[str, float]

HARDPOINTS = {
    "arm_front": (0.17, -0.35, 0.205),
    "arm_rear": (-0.15, -0.35, 0.205),
    "ball_joint": (0.005, -0.71, 0.18),
    "strut_top": (-0.028, -0.585, 0.82),
    "tie_rod_outer": (-0.13, -0.69, 0.26),
    "tie_rod_inner": (-0.14, -0.31, 0.28),
    "wheel_center": (0.0, -0.76, 0.3),
}
"""Joint positions at design, m."""

GENERAL_BODIES = ("control_arm", "knuckle", "tie_rod", "rack", "upper_strut")
"""The bodies with a full inertia tensor; the wheel is a body of revolution."""

STAND_INS = {"strut_lower": "ball_joint", "spring_top": "strut_top", "spring_seat": "ball_joint"}
"""The points that the paper's suspension does not have, and those that take their place there."""

DAMPER_SEGMENTS = SPRING_SEGMENTS = 10
"""Segments of the damper's curve; those that are not used have no width."""

INERTIA_ELEMENTS = ("xx", "yy", "zz", "xy", "xz", "yz")

BETA1_DESIGN = 1.6401294604831052
"""Arm angle at design, rad."""

SPIN_RATE = 2.0 * np.pi * 14.8
"""Spin rate of the wheel relative to the knuckle at 14.8 rev/s, rad/s."""

EIGENVALUES_AT_REST = (-18.08249105 + 75.48161914j, -18.08249105 - 75.48161914j)
"""Eigenvalues (1/s) about rest at wheel height 0.3 m while the wheel spins at `SPIN_RATE`.

The other two, of the spin angle and the spin rate, are zero.
"""


def _table(name):
    """Return columns and rows of a table of expected values."""
    head, *rows = (DATA / f"reference_{name}.csv").read_text(encoding="utf-8").split()
    return (*head.split(","),), np.array([[float(x) for x in row.split(",")] for row in rows])


KINEMATICS_COLUMNS, KINEMATICS = _table("kinematics")
"""Rack held at zero, (8, 8): wheel centre z, x, y [m], design angle minus beta1 [rad], camber, toe
and steer [deg], strut length [m].
"""

DYNAMICS_COLUMNS, DYNAMICS = _table("dynamics")
"""From rest at wheel height 0.325 m, spin `SPIN_RATE`, rack held at zero, (9, 7): time [s], design
angle minus beta1 [rad], its rate, spin [rad], its rate, wheel centre z [m], its rate.

The states are good to about 1e-10, the last column (a central difference) to about 1e-8.
"""


def vector(parameters, name):
    """Return the three-vector `name` of a flat parameter dict, shape (3,)."""
    return np.array([parameters[f"{name}_{axis}"] for axis in "xyz"])


def set_vector(parameters, name, value):
    """Store the three-vector `value`, shape (3,), under `name` in a flat parameter dict."""
    for axis, element in zip("xyz", np.asarray(value, dtype=float), strict=True):
        parameters[f"{name}_{axis}"] = float(element)


def inertia(parameters, body):
    """Return a body's inertia tensor about its centre of mass, chassis axes at design [kg m²].

    It is one of `GENERAL_BODIES`, or ``wheel``.
    """
    if body == "wheel":
        axis = vector(parameters, "spin_axis")
        axis = axis / np.linalg.norm(axis)
        about_spin = parameters["wheel_inertia_spin"]
        across = parameters["wheel_inertia_diametral"]
        return across * np.eye(3) + (about_spin - across) * np.outer(axis, axis)
    xx, yy, zz, xy, xz, yz = (parameters[f"{body}_inertia_{e}"] for e in INERTIA_ELEMENTS)
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def set_inertia(parameters, body, tensor):
    """Store a symmetric inertia tensor, shape (3, 3) in kg m², in a flat parameter dict."""
    elements = np.asarray(tensor, dtype=float)
    for element in INERTIA_ELEMENTS:
        row, column = ("xyz".index(letter) for letter in element)
        parameters[f"{body}_inertia_{element}"] = float(elements[row, column])


def reference_parameters():
    """Return a fresh flat parameter dict of the reference car.

    Tie rod, rack and upper strut are massless; their centres of mass are then only reference
    points: the middle of the rod, `tie_rod_inner` and `strut_top`.
    """
    point = {name: np.array(value) for name, value in HARDPOINTS.items()}
    parameters = {}
    for name, value in point.items():
        set_vector(parameters, name, value)
    set_vector(parameters, "rack_axis", (0.0, 1.0, 0.0))
    set_vector(parameters, "spin_axis", (0.0, 1.0, 0.0))
    parameters |= {
        "strut_length_max": 0.85,
        "spring_rate": 25000.0,
        "damper_rate": 1500.0,
        "spring_free_slide": 0.05255401719941255,
        "tyre_rate": 200000.0,
        "tyre_free_height": 0.319,
        "gravity": 9.81,
    }

    strut = point["strut_top"] - point["ball_joint"]
    hinge_and_ball = point["arm_front"] + point["arm_rear"] + point["ball_joint"]
    bodies = {
        "control_arm": (5.0, hinge_and_ball / 3.0, (0.06, 0.04, 0.09)),
        "knuckle": (
            15.0,
            point["ball_joint"] + 0.12 * strut / np.linalg.norm(strut),
            (0.2, 0.18, 0.08),
        ),
        "tie_rod": (0.0, (point["tie_rod_outer"] + point["tie_rod_inner"]) / 2.0, (0.0,) * 3),
        "rack": (0.0, point["tie_rod_inner"], (0.0,) * 3),
        "upper_strut": (0.0, point["strut_top"], (0.0,) * 3),
    }
    for body, (mass, centre, moments) in bodies.items():
        parameters[f"{body}_mass"] = mass
        set_vector(parameters, f"{body}_com", centre)
        set_inertia(parameters, body, np.diag(moments))
    parameters |= {"wheel_mass": 22.0, "wheel_inertia_spin": 1.1, "wheel_inertia_diametral": 0.6}
    return parameters


def perturbed_parameters(rng, scale=0.02):
    """Return a general car near the reference: nothing aligned, symmetric or massless.

    Hardpoints and centres of mass are off by `scale` [m], a standard deviation; the directions of
    rack and spin axis by two and a half times this [rad], and their lengths are other than one.
    Every body has mass and a full, physically realisable inertia tensor.
    """
    parameters = reference_parameters()
    for name in HARDPOINTS:
        set_vector(parameters, name, vector(parameters, name) + scale * rng.standard_normal(3))
    for name in ("rack_axis", "spin_axis"):
        direction = vector(parameters, name) + 2.5 * scale * rng.standard_normal(3)
        set_vector(parameters, name, rng.uniform(0.5, 2.0) * direction)
    masses = {"control_arm": 5.0, "knuckle": 15.0, "tie_rod": 1.2, "rack": 3.0, "upper_strut": 2.0}
    for body, mass in masses.items():
        parameters[f"{body}_mass"] = mass * rng.uniform(0.7, 1.3)
        name = f"{body}_com"
        set_vector(parameters, name, vector(parameters, name) + scale * rng.standard_normal(3))
        # The tensor of four point masses is always realisable.
        arms = 0.1 * rng.standard_normal((4, 3))
        shares = 0.25 * parameters[f"{body}_mass"]
        set_inertia(
            parameters,
            body,
            shares * sum(float(arm @ arm) * np.eye(3) - np.outer(arm, arm) for arm in arms),
        )
    for name in ("spring_rate", "damper_rate", "tyre_rate", "wheel_mass", "wheel_inertia_spin"):
        parameters[name] *= rng.uniform(0.8, 1.2)
    # a wheel is no thinner than a disc
    spin = parameters["wheel_inertia_spin"]
    parameters["wheel_inertia_diametral"] = max(parameters["wheel_inertia_diametral"], 0.5 * spin)
    return parameters


def completed(parameters):
    """Return parameters with everything that a suspension can have, absent parts without effect.

    All that goes beyond the paper's suspension may be missing: the points of `STAND_INS`,
    ``spring_free_length``, ``spring_table_*``, ``damper_table_*``, ``strut_friction*``,
    ``bump_stop_*``, ``rebound_stop_*``, ``tyre_damper_rate`` and ``tyre_lifts_off``.
    """
    absent = {
        "strut_friction": 0.0,
        "strut_friction_speed": 0.01,
        "tyre_damper_rate": 0.0,
        "tyre_lifts_off": 0.0,
    }
    for table in ("damper_table", "spring_table"):
        absent |= {f"{table}_{what}": 0.0 for what in ("first_force", "first_slope", "last_slope")}
        absent |= {f"{table}_knot_{i}": 0.0 for i in range(DAMPER_SEGMENTS + 1)}
        for i in range(DAMPER_SEGMENTS):
            absent[f"{table}_inverse_width_{i}"] = 1.0
            absent |= {f"{table}_{p}_{i}": 0.0 for p in ("linear", "quadratic", "cubic")}
    for name, stand_in in STAND_INS.items():
        set_vector(absent, name, vector(parameters, stand_in))
    for side, length in (("bump", 0.0), ("rebound", parameters["strut_length_max"])):
        absent |= {f"{side}_stop_length": length}
        absent |= {f"{side}_stop_{name}": 0.0 for name in ("rate", "progression")}
    free_slide = parameters.get("spring_free_slide", 0.0)
    absent["spring_free_length"] = parameters["strut_length_max"] - free_slide
    return absent | parameters


def set_damper_curve(parameters, curve):
    """Store a curve of force (N) over compression velocity (m/s), of up to ten segments.

    With x the part of a segment that is passed, its force is that of its first knot plus x times
    linear, x² times quadratic and x³ times cubic. Outside its knots it goes on as a straight line.
    """
    _set_curve(parameters, "damper_table", curve, curve.x)


def set_spring_curve(parameters, curve, longest, prefix=""):
    """Store a curve of force (N) over compression (m) from a length (m), of up to ten segments."""
    _set_curve(parameters, f"{prefix}spring_table", curve, longest - curve.x)


def _set_curve(parameters, table, curve, knots):
    widths, slope = np.diff(curve.x), curve.derivative()
    first, last = curve.x[[0, -1]]
    parameters[f"{table}_first_force"] = float(curve(first))
    parameters[f"{table}_first_slope"] = float(slope(first))
    parameters[f"{table}_last_slope"] = float(slope(last))
    for i in range(DAMPER_SEGMENTS + 1):
        parameters[f"{table}_knot_{i}"] = float(knots[min(i, len(widths))])
    for i in range(DAMPER_SEGMENTS):
        width = widths[i] if i < len(widths) else 0.0
        parameters[f"{table}_inverse_width_{i}"] = float(1.0 / width) if width else 1.0
        for power, name in enumerate(("linear", "quadratic", "cubic"), 1):
            coefficient = curve.c[3 - power, i] * width**power if width else 0.0
            parameters[f"{table}_{name}_{i}"] = float(coefficient)


def spring_parameters(rng, length, prefix=""):
    """Return a random curve of a spring that reaches 60 mm to both sides of a length [m].

    `rng` goes on as if none had been drawn; `prefix` begins the names of the parameters.
    """
    (own,) = rng.spawn(1)
    at = np.sort(own.uniform(0.005, 0.115, SPRING_SEGMENTS - 1))
    forces = np.cumsum(own.uniform(50.0, 700.0, SPRING_SEGMENTS + 1)) - 1000.0
    parameters = {}
    curve = PchipInterpolator(np.concatenate(([0.0], at, [0.12])), forces)
    set_spring_curve(parameters, curve, length + 0.06, prefix)
    return parameters


def general_parameters(rng, offset=0.06):
    """Return a general car with an offset strut, spring seats, damper curve, stops, friction.

    Its tyre damps and lifts off. Stops and knots are where motions over most of the travel, at up
    to some 3 m/s, go well past them. The ball joint is `offset` [m] from the strut's axis, and the
    lower end of the strut up to 0.15 m further up.
    """
    parameters = perturbed_parameters(rng)
    ball, top = vector(parameters, "ball_joint"), vector(parameters, "strut_top")
    lower = ball + offset_from_ball_joint(ball, top, offset, rng.uniform(0.0, 2.0 * np.pi))
    axis = (top - lower) / np.linalg.norm(top - lower)
    lower = lower + rng.uniform(0.0, 0.15) * axis
    seat = lower + 0.3 * (top - lower) + 0.03 * rng.standard_normal(3)
    upper_seat = top + 0.03 * rng.standard_normal(3)
    for name, place in (("strut_lower", lower), ("spring_seat", seat), ("spring_top", upper_seat)):
        set_vector(parameters, name, place)
    length = float(np.linalg.norm(top - lower))
    seats = float(np.linalg.norm(upper_seat - seat))
    parameters["spring_free_length"] = seats + rng.uniform(0.08, 0.16)
    parameters |= spring_parameters(rng, seats)
    return completed(parameters | further_parameters(rng, "strut", length))


def further_parameters(rng, damper, length):
    """Return what cars have beyond plain springs: friction, stops, damper curve, a lifting tyre.

    `damper` is what the damper is called, and `length` [m] its length at the design position.
    """
    parameters = {
        f"{damper}_friction": rng.uniform(30.0, 90.0),
        f"{damper}_friction_speed": rng.uniform(0.02, 0.08),
        "tyre_damper_rate": rng.uniform(1000.0, 3000.0),
        "tyre_lifts_off": 1.0,
    }
    for side, sense in (("bump", -1.0), ("rebound", 1.0)):
        parameters |= {
            f"{side}_stop_length": length + sense * rng.uniform(0.01, 0.05),
            f"{side}_stop_rate": rng.uniform(2e4, 5e4),
            f"{side}_stop_progression": rng.uniform(1e7, 4e7),
        }
    knots = np.sort(rng.uniform(-2.0, 2.0, DAMPER_SEGMENTS + 1)) + np.linspace(-0.5, 0.5, 11)
    rises = rng.uniform(50.0, 400.0, DAMPER_SEGMENTS + 1)
    rises[DAMPER_SEGMENTS // 2] = -30.0  # not at the ends, where the slopes would be zero
    forces = np.cumsum(rises) - 1000.0
    set_damper_curve(parameters, PchipInterpolator(knots, forces))
    return parameters


def offset_from_ball_joint(ball, top, offset, angle):
    """Return how the foot of the ball joint on the strut's axis lies from the ball joint [m].

    It is `offset` long, perpendicular to the axis through `top`, and at `angle` [rad] around the
    line from ball joint to strut top.
    """
    span = top - ball
    distance = float(np.linalg.norm(span))
    n = span / distance
    first = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
    first /= np.linalg.norm(first)
    across = np.cos(angle) * first + np.sin(angle) * np.cross(n, first)
    # Thales: the foot is on the sphere over the line from ball joint to strut top.
    sine = offset / distance
    return offset * (np.sqrt(1.0 - sine**2) * across + sine * n)


def mirrored_parameters(parameters):
    """Return the mirror image in the x-z plane: the suspension of the vehicle's other side.

    Points and the rack axis are mirrored as vectors, the spin axis as the direction of a
    rotation (so that +y stays +y and rolling forward stays positive). With these, the mirror
    image has the same arm angle, spin angle and rack displacement as the original.
    """
    mirrored = dict(parameters)
    for name in parameters:
        flips = name.endswith(("_y", "_inertia_xy", "_inertia_yz"))
        if name.startswith("spin_axis"):
            flips = name.endswith(("_x", "_z"))
        if flips:
            mirrored[name] = -parameters[name]
    return mirrored
