"""Loops without a closed form: chains of hinges, and loops that hold each other.

None of them ships. Every kind of joint closes a loop in one of them, and every kind carries.
"""

from dataclasses import replace

import numpy as np
from kintrafo.generator.mechanisms.chains import AXES, PLACES

from mechanisms.every_closed_form import NORMAL, askew, ball, cross, declare, guide, heading, hinge

BODIES = ["ground", "one", "two", "three", "four", "five", "six"]


def in_a_ring(count):
    """Return hinges ``hinge_i`` between one body and the next, the last one at the ground again."""
    return tuple(
        hinge(f"hinge_{i}", BODIES[i], BODIES[(i + 1) % count], f"place_{i}", f"axis_{i}")
        for i in range(count)
    )


def ring(name, joints, places, axes, driven=None):
    """Return a closed chain with a spring to its second body; some joint drives: the first."""
    bodies = BODIES[1 : len(joints)]
    middles = {
        body: tuple((np.array(places[i]) + places[i + 1]) / 2) for i, body in enumerate(bodies)
    }
    # one of them has a mass, and its accelerations depend on those of all: a third of the time
    return declare(
        name,
        middles,
        joints,
        {
            **{f"place_{i}": place for i, place in enumerate(places)},
            "ground_top": (0.1, 0.1, 0.5),
            "two_seat": (-0.05, 0.2, 0.1),
        },
        {f"axis_{i}": axis for i, axis in enumerate(axes)},
        (driven or joints[0].name,),
        spring=("ground_top", "two_seat"),
        massive=("two",),
        allow_iteration=True,
    )


# -- one loop in space ----------------------------------------------------------------------------

_HINGES = in_a_ring(7)

CROSSED_RING = ring(
    "crossed_ring",
    (
        *_HINGES[:3],
        cross("cross_3", "three", "four", "place_3", "place_4", "axis_3"),
        hinge("hinge_4", "four", "five", "place_4", "axis_4"),
        hinge("hinge_5", "ground", "five", "place_5", "axis_5"),
    ),
    PLACES[:6],
    AXES[:6],
)
"""A cross closes the loop; a hinge is declared from the ground on."""

BALL_RING = ring(
    "ball_ring",
    (
        *_HINGES[:2],
        ball("ball_2", "two", "three", "place_2"),
        hinge("hinge_3", "three", "four", "place_3", "axis_3"),
        hinge("hinge_4", "four", "ground", "place_4", "axis_4"),
    ),
    PLACES[:5],
    AXES[:5],
)
"""A ball joint closes the loop."""


# -- chains that move although they should not ----------------------------------------------------


def bennett(length, twist, other, angle):
    """Return Bennett's chain of four hinges: one freedom, where Grübler counts -2.

    Parameters
    ----------
    length, twist
        Of the first link and the third, between its axes, m and rad.
    other
        Twist of the second link and the fourth; their length is that of the sine theorem.
    angle
        Between the first link and the fourth at the design position.
    """
    lengths = [length, length * np.sin(other) / np.sin(twist)] * 2
    twists = [twist, other] * 2
    at, axes = np.zeros(3), np.eye(3)  # Denavit and Hartenberg: x along the link, z along the axis
    places, along = [], []
    second = 2 * np.arctan(bennett_ratio(twist, other) / np.tan(angle / 2))
    turns = [angle, second, -angle, -second]
    for turn, link, lean in zip(turns, lengths, twists, strict=True):
        places.append(tuple(at.tolist()))
        along.append(tuple(axes[:, 2].tolist()))
        c, s = np.cos(turn), np.sin(turn)
        axes = axes @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        at = at + link * axes[:, 0]
        c, s = np.cos(lean), np.sin(lean)
        axes = axes @ np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    np.testing.assert_allclose(at, 0.0, atol=1e-15)
    np.testing.assert_allclose(axes, np.eye(3), atol=1e-15)
    return ring("bennett", in_a_ring(4), places, along)


def bennett_ratio(twist, other):
    """Return the product of the tangents of half the angles at two neighbouring hinges."""
    return float(np.sin((other + twist) / 2) / np.sin((other - twist) / 2))


BENNETT = bennett(0.3, 0.6, 1.3, 1.0)


# -- loops that hold each other -------------------------------------------------------------------


def plate(name, last):
    """Return a plate in an oblique plane that a rod, a bar with a wheel and a slotted block hold.

    Parameters
    ----------
    last
        Name of the joint that is declared last, and so closes a loop.
    """
    joints = {
        joint.name: joint
        for joint in (
            hinge("crank_hinge", "ground", "crank", "crank_pivot", "normal"),
            hinge("bearing", "bar", "wheel", "wheel_com", "normal"),
            hinge("bar_pin", "crank", "bar", "bar_start", "normal"),
            hinge("plate_pin", "bar", "plate", "bar_end", "normal"),
            hinge("block_hinge", "ground", "block", "block_pivot", "normal"),
            guide("slot", "block", "plate", "slot_direction"),
            hinge("rod_hinge", "ground", "rod", "rod_start", "normal"),
            hinge("rod_pin", "rod", "plate", "rod_end", "normal"),
        )
    }
    joints[last] = joints.pop(last)
    model = declare(
        name,
        {"crank": askew(0.05, 0.02), "bar": askew(0.15, 0.15, 0.03), "block": askew(0.5, 0.02),
         "plate": askew(0.3, 0.3, 0.02), "rod": askew(0.35, 0.41),
         "wheel": askew(0.12, 0.16, 0.05)},
        tuple(joints.values()),
        {"crank_pivot": askew(0.0, 0.0), "bar_start": askew(0.1, 0.05), "bar_end": askew(0.2, 0.25),
         "block_pivot": askew(0.5, 0.0), "rod_start": askew(0.45, 0.5), "rod_end": askew(0.3, 0.38),
         "ground_top": askew(0.2, 0.6), "plate_seat": askew(0.25, 0.3)},
        {"normal": NORMAL, "slot_direction": heading(2.2)},
        ("crank_hinge", "bearing"),
        spring=("ground_top", "plate_seat"),
        wheel=("wheel", NORMAL),
    )  # fmt: skip
    return replace(model, allow_iteration=True)


PLATE_ON_A_SLOT = plate("plate_on_a_slot", "slot")
PLATE_ON_A_PIN = plate("plate_on_a_pin", "plate_pin")


def _rod(name, first, second, axis):
    """Return the joints of a rod: a cross and a ball joint."""
    return (
        cross(f"{name}_cross", first, name, f"{name}_start", f"{name}_end", axis),
        ball(f"{name}_ball", second, name, f"{name}_end"),
    )


ROCKERS = replace(
    declare(
        "rockers",
        {"crank": (0.05, 0.05, 0.0), "arm": (0.2, 0.1, 0.1), "hand": (0.35, 0.2, 0.15),
         "rocker": (0.5, -0.1, 0.0), "stay": (0.3, 0.35, 0.05), "link": (0.35, 0.0, 0.05),
         "tie": (0.45, 0.05, 0.1)},
        (
            hinge("crank_hinge", "ground", "crank", "crank_pivot", "axis_0"),
            hinge("arm_hinge", "crank", "arm", "arm_pivot", "axis_1"),
            hinge("hand_hinge", "arm", "hand", "hand_pivot", "axis_2"),
            hinge("rocker_hinge", "ground", "rocker", "rocker_pivot", "axis_3"),
            *_rod("stay", "ground", "hand", "axis_0"),
            *_rod("link", "rocker", "arm", "axis_1"),
            *_rod("tie", "rocker", "hand", "axis_2"),
        ),
        {"crank_pivot": (0.0, 0.0, 0.0), "arm_pivot": (0.1, 0.1, 0.0),
         "hand_pivot": (0.3, 0.1, 0.2), "rocker_pivot": (0.5, -0.2, -0.1),
         "stay_start": (0.25, 0.45, 0.0), "stay_end": (0.35, 0.25, 0.12),
         "link_start": (0.48, -0.08, 0.02), "link_end": (0.2, 0.08, 0.1),
         "tie_start": (0.52, -0.05, 0.05), "tie_end": (0.42, 0.2, 0.2),
         "ground_top": (0.3, 0.1, 0.6), "hand_seat": (0.38, 0.2, 0.2)},
        {"axis_0": AXES[0], "axis_1": AXES[4], "axis_2": AXES[5], "axis_3": AXES[3]},
        ("crank_hinge",),
        spring=("ground_top", "hand_seat"),
    ),
    allow_iteration=True,
)  # fmt: skip
"""Three rods close three loops of a chain of two bodies and a rocker; two join unknown bodies."""


# -- driven between two bodies that no other joint has placed -------------------------------------

FIVE_BAR = replace(
    declare(
        "five_bar",
        {
            "left": askew(0.01, 0.05, 0.02),
            "upper": askew(0.1, 0.2, -0.02),
            "lower": askew(0.25, 0.22, 0.01),
            "right": askew(0.36, 0.1),
        },
        (
            hinge("left_hinge", "ground", "left", "left_bearing", "normal"),
            hinge("elbow", "left", "upper", "left_pin", "normal", to="upper_pin"),
            # its second body is nearer to the ground of the tree: it counts the other way round
            hinge("knee", "lower", "upper", "upper_pin", "normal"),
            hinge("right_pin", "lower", "right", "lower_pin", "normal"),
            hinge("right_hinge", "right", "ground", "right_bearing", "normal"),
        ),
        {
            "left_bearing": askew(0.0, 0.0),
            "left_pin": askew(0.0, 0.12),
            "upper_pin": askew(0.18, 0.3),
            "lower_pin": askew(0.34, 0.18),
            "right_bearing": askew(0.4, 0.0),
            "ground_top": askew(0.2, 0.6, 0.1),
            "lower_seat": askew(0.25, 0.22),
        },
        {"normal": NORMAL},
        ("knee",),
        spring=("ground_top", "lower_seat"),
        prescribed={"elbow": "elbow"},
    ),
    allow_iteration=True,
)
"""A planar chain that is driven at two of its floating hinges."""

DRIVEN_GUIDE = ring(
    "driven_guide",
    (
        *_HINGES[:2],
        guide("guide_2", "two", "three", "axis_2"),
        *_HINGES[3:6],
        guide("guide_6", "six", "ground", "axis_6"),
    ),
    PLACES,
    AXES,
    driven="guide_2",
)
"""A guide within a ring in space drives it, with a force on it; another one closes the loop."""


# -- all axes through a point -------------------------------------------------------------------


def around_a_point(name, axes):
    """Return a ring of hinges whose axes meet in a point: five equations, two unknowns for four."""
    places = [tuple((0.2 * np.array(a) / np.linalg.norm(a)).tolist()) for a in axes]
    return ring(name, in_a_ring(len(axes)), places, axes)


BEND = 0.9


def hooke_axes(bend):
    """Return the axes of a Hooke joint between two shafts: input, both of the cross, output."""
    return [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (np.cos(bend), np.sin(bend), 0.0)]


HOOKE = around_a_point("hooke", hooke_axes(BEND))
"""A Hooke joint between two shafts, declared of hinges."""

SPHERICAL_AXES = [(1.0, 0.0, 0.0), (0.8, 0.6, 0.1), (0.1, 0.7, 1.0), (0.2, -0.5, 1.1)]
SPHERICAL = around_a_point("spherical", SPHERICAL_AXES)
"""A spherical four-bar linkage."""


# -- planar linkages, driven where no closed form begins -------------------------------------------


def planar(name, hinges, driven, seat):
    """Return a linkage of pins in an oblique plane.

    Parameters
    ----------
    hinges
        Of each: its name, the two bodies, and where it is in the plane, m.
    driven
        The independent ones.
    seat
        A body, and where a spring from the ground ends on it.
    """
    places = {}
    for _, first, second, at in hinges:
        for body in (first, second):
            places.setdefault(body, []).append(at)
    body, end = seat
    return declare(
        name,
        {b: askew(*np.mean(p, axis=0), 0.01) for b, p in places.items() if b != "ground"},
        tuple(hinge(n, one, two, f"{n}_at", "normal") for n, one, two, _ in hinges),
        {
            **{f"{n}_at": askew(*at) for n, *_, at in hinges},
            "ground_top": askew(0.2, 0.7, 0.05),
            f"{body}_seat": askew(*end),
        },
        {"normal": NORMAL},
        driven,
        spring=("ground_top", f"{body}_seat"),
        massive=(body,),
        allow_iteration=True,
    )


FOUR_BAR_AT_ITS_KNEE = planar(
    "knee_bar",
    [
        ("crank_hinge", "ground", "crank", (0.0, 0.0)),
        ("knee", "crank", "coupler", (0.0, 0.12)),
        ("knuckle", "coupler", "rocker", (0.3, 0.25)),
        ("rocker_hinge", "rocker", "ground", (0.35, 0.0)),
    ],
    ("knee",),
    ("coupler", (0.15, 0.3)),
)
"""A four-bar linkage that is driven at the pin between crank and coupler."""
KNEE = replace(
    FOUR_BAR_AT_ITS_KNEE, allow_iteration=False, massive=FOUR_BAR_AT_ITS_KNEE.mechanism.bodies[1:]
)
"""The same without iteration, and with all its masses."""

STEPHENSON_PINS = [
    ("crank_hinge", "ground", "crank", (0.0, 0.0)),
    ("crank_pin", "crank", "coupler", (0.02, 0.15)),
    ("rocker_pin", "coupler", "rocker", (0.3, 0.25)),
    ("rocker_hinge", "ground", "rocker", (0.32, 0.0)),
    ("link_pin", "coupler", "link", (0.12, 0.35)),
    ("arm_pin", "link", "arm", (0.4, 0.45)),
    ("arm_hinge", "ground", "arm", (0.55, 0.2)),
]
"""Name, the two bodies, and where it is in the plane, of the hinges of `STEPHENSON`."""
STEPHENSON = planar("stephenson", STEPHENSON_PINS, ("arm_hinge",), ("coupler", (0.15, 0.25)))
"""A six-bar linkage that is driven from its far side: the coupler is held by three."""

IN_A_ROW = planar(
    "in_a_row",
    [
        *STEPHENSON_PINS,
        ("next_crank_hinge", "ground", "next_crank", (-0.5, 0.0)),
        ("next_crank_pin", "next_crank", "next_coupler", (-0.48, 0.15)),
        ("next_rocker_pin", "next_coupler", "next_rocker", (-0.2, 0.25)),
        ("next_rocker_hinge", "ground", "next_rocker", (-0.18, 0.0)),
        ("next_link_pin", "next_coupler", "next_link", (-0.38, 0.35)),
        ("last_pin", "next_link", "crank", (-0.08, 0.12)),
    ],
    ("arm_hinge",),
    ("coupler", (0.15, 0.25)),
)
"""Two of them: what the first one finds drives the second one."""

_LEGS = (((0.0, 0.0), (0.02, 0.14), (0.15, 0.2)), ((0.5, 0.0), (0.4, 0.1), (0.27, 0.19)))
_LEGS = (*_LEGS, ((0.25, 0.5), (0.3, 0.38), (0.2, 0.29)))
THREE_RRR = planar(
    "three_rrr",
    [
        pin
        for i, (at, elbow, end) in enumerate(_LEGS)
        for pin in (
            (f"crank_{i}_hinge", "ground", f"crank{i}", at),
            (f"elbow_{i}", f"crank{i}", f"rod{i}", elbow),
            (f"end_{i}", f"rod{i}", "plate", end),
        )
    ],
    ("crank_0_hinge", "crank_1_hinge", "crank_2_hinge"),
    ("plate", (0.2, 0.25)),
)
"""A plate on three legs, each with a driven hinge on the ground."""
