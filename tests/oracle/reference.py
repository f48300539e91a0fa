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
import numpy.typing as npt
from scipy.interpolate import PchipInterpolator, PPoly

Array = npt.NDArray[np.float64]
Parameters = dict[str, float]

HARDPOINTS: dict[str, tuple[float, float, float]] = {
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

KINEMATICS_COLUMNS = (
    "wheel_center_z",
    "wheel_center_x",
    "wheel_center_y",
    "arm_rise",
    "camber",
    "toe",
    "steer",
    "strut_length",
)
"""Columns of `KINEMATICS`: m, m, m, rad (design angle minus beta1), deg, deg, deg, m."""

KINEMATICS: Array = np.array(
    [
        [
            0.15,
            0.0003016080589612301,
            -0.7284837986628855,
            -0.4218062727652742,
            5.023901868006724,
            -0.6059903030309698,
            -0.6059903030309698,
            0.7902821707342356,
        ],
        [
            0.19999999999999998,
            7.60870693370672e-05,
            -0.745707338930284,
            -0.27624330840559014,
            3.0028368188777983,
            -0.5399074911391059,
            -0.5399074911391059,
            0.7453445865007637,
        ],
        [
            0.25,
            2.5269192644269967e-05,
            -0.7559702287841736,
            -0.13669655290634514,
            1.324568928220036,
            -0.3029037818988304,
            -0.3029037818988304,
            0.6996767901750316,
        ],
        [0.3, 0.0, -0.76, 0.0, 0.0, 0.0, 0.0, 0.6529272547535444],
        [
            0.325,
            -4.1701215854799203e-05,
            -0.7598017600855012,
            0.06812360100041595,
            -0.5139889032453783,
            0.15078062052170388,
            0.15078062052170388,
            0.6290417311047019,
        ],
        [
            0.35,
            -0.00012314499650414694,
            -0.7581586769371731,
            0.13653734059309838,
            -0.9139306489140895,
            0.2884880751609175,
            0.2884880751609175,
            0.6047579071960905,
        ],
        [
            0.4,
            -0.0004746465367320655,
            -0.7505323336897678,
            0.2756877312787418,
            -1.2963028906110856,
            0.48364283351560405,
            0.48364283351560405,
            0.554805935061221,
        ],
        [
            0.44999999999999996,
            -0.001227197897951911,
            -0.7369219997021669,
            0.4209776292739329,
            -0.913057931798724,
            0.4861020929546821,
            0.4861020929546821,
            0.5026419233371616,
        ],
    ]
)
"""Rack held at zero, shape (8, 8)."""

DYNAMICS_COLUMNS = (
    "time",
    "arm_rise",
    "arm_rise_rate",
    "spin",
    "spin_rate",
    "wheel_center_z",
    "wheel_center_z_rate",
)
"""Columns of `DYNAMICS`: s, rad (design angle minus beta1), rad/s, rad, rad/s, m, m/s."""

DYNAMICS: Array = np.array(
    [
        [0.0, 0.06812360100041616, 0.0, 0.0, 92.99114254625788, 0.32500000000000007, 0.0],
        [
            0.005,
            0.06335589960614099,
            -1.8263833996587127,
            0.46484923434791403,
            92.95055088571662,
            0.32325237348170627,
            -0.6695642085410026,
        ],
        [
            0.01,
            0.0507922637120403,
            -3.096911512712144,
            0.9295292055211714,
            92.92401598166485,
            0.31864494059620657,
            -1.1360667945809455,
        ],
        [
            0.02,
            0.014455194770255508,
            -3.764550232500322,
            1.8586794819280559,
            92.9148656938075,
            0.3053075542442027,
            -1.3822300896768063,
        ],
        [
            0.05,
            -0.026206952024318716,
            1.2866881971755075,
            4.6476169288405655,
            93.01556792837125,
            0.29038004668485984,
            0.47214680335940307,
        ],
        [
            0.1,
            0.005965984145963478,
            -0.8472188351509938,
            9.297800131821763,
            92.97422454193526,
            0.3021905295466222,
            -0.31107767367469963,
        ],
        [
            0.2,
            -0.001237052944665687,
            -0.08457800831761834,
            18.596771412128387,
            92.98947372679147,
            0.29954580334502406,
            -0.03105349458761886,
        ],
        [
            0.5,
            8.123434476889882e-06,
            -2.280840226227066e-05,
            46.494138769854416,
            92.9911420953012,
            0.3000029826194473,
            -8.374387311017593e-06,
        ],
        [
            1.0,
            9.692820151353675e-10,
            -5.87235715811421e-09,
            92.989709882391,
            92.9911425461418,
            0.3000000003558838,
            -2.156108488154392e-09,
        ],
    ]
)
"""From rest at wheel height 0.325 m, spin `SPIN_RATE`, rack held at zero; shape (9, 7).

The states are good to about 1e-10, the last column (a central difference) to about 1e-8.
"""


def vector(parameters: Parameters, name: str) -> Array:
    """Return the three-vector `name` of a flat parameter dict, shape (3,)."""
    return np.array([parameters[f"{name}_{axis}"] for axis in "xyz"])


def set_vector(parameters: Parameters, name: str, value: npt.ArrayLike) -> None:
    """Store the three-vector `value`, shape (3,), under `name` in a flat parameter dict."""
    for axis, element in zip("xyz", np.asarray(value, dtype=float), strict=True):
        parameters[f"{name}_{axis}"] = float(element)


def inertia(parameters: Parameters, body: str) -> Array:
    """Return a body's inertia tensor about its centre of mass, chassis axes at design.

    Parameters
    ----------
    parameters : dict of float
        Flat parameter dict.
    body : str
        One of `GENERAL_BODIES`, or ``wheel``.

    Returns
    -------
    ndarray, shape (3, 3)
        In kg m².
    """
    if body == "wheel":
        axis = vector(parameters, "spin_axis")
        axis = axis / np.linalg.norm(axis)
        about_spin = parameters["wheel_inertia_spin"]
        across = parameters["wheel_inertia_diametral"]
        return across * np.eye(3) + (about_spin - across) * np.outer(axis, axis)
    xx, yy, zz, xy, xz, yz = (parameters[f"{body}_inertia_{e}"] for e in INERTIA_ELEMENTS)
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def set_inertia(parameters: Parameters, body: str, tensor: npt.ArrayLike) -> None:
    """Store a symmetric inertia tensor, shape (3, 3) in kg m², in a flat parameter dict."""
    elements = np.asarray(tensor, dtype=float)
    for element in INERTIA_ELEMENTS:
        row, column = ("xyz".index(letter) for letter in element)
        parameters[f"{body}_inertia_{element}"] = float(elements[row, column])


def reference_parameters() -> Parameters:
    """Return a fresh flat parameter dict of the reference car.

    Tie rod, rack and upper strut are massless; their centres of mass are then only reference
    points: the middle of the rod, `tie_rod_inner` and `strut_top`.

    Returns
    -------
    dict of float
        SI units, see the module's docstring.
    """
    point = {name: np.array(value) for name, value in HARDPOINTS.items()}
    parameters: Parameters = {}
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
    bodies: dict[str, tuple[float, Array, tuple[float, float, float]]] = {
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


def perturbed_parameters(rng: np.random.Generator, scale: float = 0.02) -> Parameters:
    """Return a general car near the reference: nothing aligned, symmetric or massless.

    Parameters
    ----------
    rng : numpy.random.Generator
        Source of the random numbers.
    scale : float
        Standard deviation of the hardpoints and centres of mass, m; the directions of rack and
        spin axis get two and a half times this (rad) and a length other than one.

    Returns
    -------
    dict of float
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


def completed(parameters: Parameters) -> Parameters:
    """Return parameters with everything that a suspension can have, absent parts without effect.

    Parameters
    ----------
    parameters : dict of float
        Flat parameter dict; all that goes beyond the paper's suspension may be missing: the points
        of `STAND_INS`, ``spring_free_length``, ``spring_table_*``, ``damper_table_*``,
        ``strut_friction*``, ``bump_stop_*``, ``rebound_stop_*``, ``tyre_damper_rate`` and
        ``tyre_lifts_off``.

    Returns
    -------
    dict of float
        A new dict.
    """
    absent: Parameters = {
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


def set_damper_curve(parameters: Parameters, curve: PchipInterpolator) -> None:
    """Store a curve of force (N) over compression velocity (m/s), of up to ten segments.

    Parameters
    ----------
    parameters : dict of float
        Flat parameter dict, written to. With x the part of a segment that is passed, its force is
        that of its first knot plus x times linear, x² times quadratic and x³ times cubic.
    curve : PchipInterpolator
        Outside its knots it goes on as a straight line.
    """
    _set_curve(parameters, "damper_table", curve, curve.x)


def set_spring_curve(
    parameters: Parameters, curve: PPoly, longest: float, prefix: str = ""
) -> None:
    """Store a curve of force (N) over compression (m) from a length (m), of up to ten segments."""
    _set_curve(parameters, f"{prefix}spring_table", curve, longest - curve.x)


def _set_curve(parameters: Parameters, table: str, curve: PPoly, knots: Array) -> None:
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


def spring_parameters(rng: np.random.Generator, length: float, prefix: str = "") -> Parameters:
    """Return a random curve of a spring.

    Parameters
    ----------
    rng : numpy.random.Generator
        Source of the random numbers; it goes on as if none had been drawn.
    length : float
        A length in the middle of the curve, which reaches 60 mm to both sides, m.
    prefix : str
        Begins the names of the parameters.
    """
    (own,) = rng.spawn(1)
    at = np.sort(own.uniform(0.005, 0.115, SPRING_SEGMENTS - 1))
    forces = np.cumsum(own.uniform(50.0, 700.0, SPRING_SEGMENTS + 1)) - 1000.0
    parameters: Parameters = {}
    curve = PchipInterpolator(np.concatenate(([0.0], at, [0.12])), forces)
    set_spring_curve(parameters, curve, length + 0.06, prefix)
    return parameters


def general_parameters(rng: np.random.Generator, offset: float = 0.06) -> Parameters:
    """Return a general car with an offset strut, spring seats, damper curve, stops, friction.

    Its tyre damps and lifts off. Stops and knots are where motions over most of the travel, at up
    to some 3 m/s, go well past them.

    Parameters
    ----------
    rng : numpy.random.Generator
        Source of the random numbers.
    offset : float
        Distance of the ball joint from the strut's axis, m. The lower end of the strut is besides
        up to 0.15 m further up.

    Returns
    -------
    dict of float
        A complete flat parameter dict.
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


def further_parameters(rng: np.random.Generator, damper: str, length: float) -> Parameters:
    """Return what cars have beyond plain springs: friction, stops, damper curve, a lifting tyre.

    Parameters
    ----------
    rng : numpy.random.Generator
        Source of the random numbers.
    damper : str
        What the damper is called.
    length : float
        Its length at the design position, m.
    """
    parameters: Parameters = {
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


def offset_from_ball_joint(ball: Array, top: Array, offset: float, angle: float) -> Array:
    """Return how the foot of the ball joint on the strut's axis lies from the ball joint.

    Parameters
    ----------
    ball, top : ndarray, shape (3,)
        Ball joint, and the strut top through which the axis goes, m.
    offset : float
        Length of the result, m.
    angle : float
        Where around the line from ball joint to strut top, rad.

    Returns
    -------
    ndarray, shape (3,)
        In m; perpendicular to the axis.
    """
    span = top - ball
    distance = float(np.linalg.norm(span))
    n = span / distance
    first = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
    first /= np.linalg.norm(first)
    across = np.cos(angle) * first + np.sin(angle) * np.cross(n, first)
    # Thales: the foot is on the sphere over the line from ball joint to strut top.
    sine = offset / distance
    foot: Array = offset * (np.sqrt(1.0 - sine**2) * across + sine * n)
    return foot


def mirrored_parameters(parameters: Parameters) -> Parameters:
    """Return the mirror image in the x-z plane: the suspension of the vehicle's other side.

    Points and the rack axis are mirrored as vectors, the spin axis as the direction of a
    rotation (so that +y stays +y and rolling forward stays positive). With these, the mirror
    image has the same arm angle, spin angle and rack displacement as the original.

    Parameters
    ----------
    parameters : dict of float
        Flat parameter dict.

    Returns
    -------
    dict of float
        A new dict.
    """
    mirrored = dict(parameters)
    for name in parameters:
        flips = name.endswith(("_y", "_inertia_xy", "_inertia_yz"))
        if name.startswith("spin_axis"):
            flips = name.endswith(("_x", "_z"))
        if flips:
            mirrored[name] = -parameters[name]
    return mirrored
