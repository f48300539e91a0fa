"""Steering shafts in a plane: column, shaft of two links between two crosses, and pinion."""

from math import atan2, cos, sin

import numpy as np

from mechanisms.every_closed_form import cross, declare, guide, hinge


def column(name, first, second, phase, *, along=None, beside=0.0, swinging=False, links=""):
    """Return a column whose shaft lies along x, with both bearings in the plane y = 0.

    Parameters
    ----------
    first, second
        Angles of the axes of column and pinion to the shaft, down from it.
    phase
        By how much the second fork of the shaft is ahead of the first one, about x.
    along
        Direction of the guide; None: from cross to cross.
    beside
        How far the bearing of the pinion is from its cross, across its axis.
    swinging
        Whether the column's bearing is on a bracket that turns about y, so that the shaft slides.
    links
        What is between the bearings instead: a ``rigid`` shaft, one with a cross that is ``turned``
        round, or ``one`` cross alone.
    """
    across = np.array([0.0, 1.0, 0.0])
    start = atan2(sin(phase), cos(second) * cos(phase))
    ends = "upper_center", "lower_center"
    axis = {e: np.array([cos(a), 0.0, -sin(a)]) for e, a in (("column", first), ("pinion", second))}
    base = "bracket" if swinging else "ground"
    swing = (hinge("swing", "ground", "bracket", "bracket_bearing", "plane"),) if swinging else ()
    at = "pinion_bearing" if beside else "lower_center"
    upper = cross("upper_cross", "column", "upper", *ends, "plane")
    spline = guide("spline", "upper", "lower", ends if along is None else "way")
    between = {
        "": (upper, spline, cross("lower_cross", "pinion", "lower", *ends[::-1], "lower_fork")),
        "turned": (upper, spline, cross("lower_cross", "lower", "pinion", *ends[::-1], "plane")),
        "rigid": (
            cross("upper_cross", "column", "shaft", *ends, "plane"),
            cross("lower_cross", "pinion", "shaft", *ends[::-1], "lower_fork"),
        ),
        "one": (cross("upper_cross", "column", "pinion", *ends, "plane"),),
    }[links]
    if links == "one":
        at = "upper_center"
    moving = dict.fromkeys(body for joint in between for body in (joint.first, joint.second))
    names = ["bracket", *moving] if swinging else [*moving]
    return declare(
        name,
        {body: (0.1 * i, 0.02 * i, 0.01) for i, body in enumerate(names)},
        (
            *swing,
            hinge("steer", base, "column", "upper_center", "column_line"),
            *between,
            hinge("rolling", "ground", "pinion", at, "pinion_line"),
        ),
        {
            "bracket_bearing": (-0.2, 0.0, 0.3),
            "upper_center": (0.0, 0.0, 0.0),
            "lower_center": (0.4, 0.0, 0.0),
            "pinion_bearing": (0.4, beside, 0.0),
            "ground_seat": (0.0, 0.3, 0.0),
            "column_seat": (-0.1, 0.0, 0.1),
        },
        {
            "plane": tuple(across),
            "column_line": tuple(axis["column"]),
            "pinion_line": tuple(axis["pinion"]),
            "lower_fork": tuple(
                cos(start) * across + sin(start) * np.cross(axis["pinion"], across)
            ),
            "way": along or (1.0, 0.0, 0.0),
        },
        ("swing", "steer") if swinging else ("steer",),
        spring=("ground_seat", "column_seat"),
    )


CENTERS = {"first_center": (0.3, 0.1, 0.5), "second_center": (0.6, 0.2, 0.3)}
BEARINGS = {"swing_bearing": (0.0, 0.1, 0.4), "shake_bearing": (0.4, -0.2, 0.1)}
SEATS = {"ground_seat": (0.3, 0.3, 0.4), "last_seat": (0.8, 0.1, 0.2)}
LINES = {
    "swing_line": (0.2, 1.0, -0.3),
    "shake_line": (0.4, -0.3, 0.9),
    "column_line": (0.9, 0.1, -0.2),
    "middle_line": (0.9, 0.3, -0.6),
    "last_line": (0.7, 0.4, -0.1),
    "fork_1": (0.1, 0.2, 1.0),
    "fork_2": (0.3, 1.0, 0.2),
}


def crosses_in_a_row():
    """Return three shafts with two crosses between them, on a bracket and a lever that move.

    A last shaft has a bearing in a body that turns independently about the centre of its cross.
    """
    return declare(
        "crosses_in_a_row",
        {
            "bracket": (0.1, 0.0, 0.6),
            "column": (0.2, 0.02, 0.5),
            "middle": (0.45, 0.15, 0.4),
            "lever": (0.5, 0.25, 0.3),
            "last": (0.7, 0.2, 0.25),
        },
        (
            hinge("swing", "ground", "bracket", "swing_bearing", "swing_line"),
            hinge("steer", "bracket", "column", "first_center", "column_line"),
            cross("cross_1", "column", "middle", "first_center", "second_center", "fork_1"),
            hinge(
                "bearing", "bracket", "middle", "second_center", ("first_center", "second_center")
            ),
            hinge("shake", "bracket", "lever", "second_center", "shake_line"),
            cross("cross_2", "last", "middle", "second_center", "first_center", "fork_2"),
            hinge("rolling", "last", "lever", "second_center", "last_line"),
        ),
        {**CENTERS, "swing_bearing": BEARINGS["swing_bearing"], **SEATS},
        {name: way for name, way in LINES.items() if name != "middle_line"},
        ("swing", "steer", "shake"),
        spring=("ground_seat", "last_seat"),
        crosses=True,
    )
