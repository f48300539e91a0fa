"""Wheels that a rod joins, as on a locomotive."""

from mechanisms.every_closed_form import NORMAL, askew, declare, guide, hinge


def locomotive(name="locomotive", bearings=(0.0, 0.9, 1.7)):
    """Return a frame that swings, with wheels on it whose pins a rod joins."""
    level = [0.0, 0.25, -0.1, 0.0]  # the bearings are not on a line
    places = {f"bearing_{i}": askew(x, level[i]) for i, x in enumerate(bearings)}
    pins = {f"pin_{i}": askew(x + 0.1, level[i] + 0.28, 0.03 * i) for i, x in enumerate(bearings)}
    count = range(len(bearings))
    return declare(
        name,
        {
            "frame": askew(0.5, -0.3, 0.1),
            **{f"wheel{i}": askew(bearings[i] + 0.03, level[i] + 0.02, 0.01) for i in count},
            "rod": askew(0.8, 0.4, 0.05),
        },
        (
            hinge("swing", "ground", "frame", "frame_bearing", "swing_line"),
            *(hinge(f"axle_{i}", "frame", f"wheel{i}", f"bearing_{i}", "normal") for i in count),
            *(hinge(f"crank_{i}", f"wheel{i}", "rod", f"pin_{i}", "normal") for i in count),
        ),
        {
            **places,
            **pins,
            "frame_bearing": (0.0, 0.1, 0.4),
            "ground_seat": (0.5, 0.3, 0.9),
            "rod_seat": askew(1.2, 0.5, 0.02),
        },
        {"normal": NORMAL, "swing_line": (0.3, 1.0, -0.2)},
        ("swing", "axle_0"),
        spring=("ground_seat", "rod_seat"),
    )


PINS = ((0.1, 0.2), (0.05, 0.1), (0.0, 0.25))
"""Of links on a crank whose bearing is at the origin."""


def double_crank(name, pins=PINS, *, lean=0.0, way=0.4, driven=("swing", "crank_bearing")):
    """Return a frame that swings, with a crank and a rocker on it that several links join.

    Parameters
    ----------
    pins
        Of the links on the crank, in the plane.
    lean, way
        Of the links, across and along the line of the bearings, which are 0.4 m apart.
    """
    count = range(len(pins))
    return declare(
        name,
        {
            "frame": askew(0.2, -0.3, 0.1),
            "crank": askew(0.05, 0.1, 0.01),
            "rocker": askew(0.45, 0.1, 0.02),
            **{f"link{i}": askew(0.3, 0.2 + 0.01 * i, 0.01) for i in count},
        },
        (
            hinge("swing", "ground", "frame", "frame_bearing", "swing_line"),
            hinge("crank_bearing", "frame", "crank", "a", "normal"),
            hinge("rocker_bearing", "frame", "rocker", "d", "normal"),
            *(hinge(f"near_{i}", "crank", f"link{i}", f"b_{i}", "normal") for i in count),
            *(hinge(f"far_{i}", f"link{i}", "rocker", f"c_{i}", "normal") for i in count),
        ),
        {
            "a": askew(0.0, 0.0),
            "d": askew(0.4, 0.0, 0.02),
            **{f"b_{i}": askew(x, y, 0.03 * i) for i, (x, y) in enumerate(pins)},
            **{f"c_{i}": askew(x + way, y + lean, 0.01) for i, (x, y) in enumerate(pins)},
            "frame_bearing": (0.0, 0.1, 0.4),
            "ground_seat": (0.5, 0.3, 0.9),
            "rocker_seat": askew(0.5, 0.3, 0.02),
        },
        {"normal": NORMAL, "swing_line": (0.3, 1.0, -0.2)},
        driven,
        spring=("ground_seat", "rocker_seat"),
    )


def table_on_links(name):
    """Return a table on a guide, and a saddle on one across it that pulls the table by links."""
    count = range(len(PINS))
    along, across = (
        tuple(b - a for a, b in zip(askew(0.0, 0.0), askew(*way), strict=True))
        for way in ((1.0, 0.3), (0.6, 1.0))
    )
    return declare(
        name,
        {
            "saddle": askew(0.2, -0.3, 0.1),
            "table": askew(0.45, 0.1, 0.02),
            **{f"link{i}": askew(0.3, 0.2 + 0.01 * i, 0.01) for i in count},
        },
        (
            guide("bed", "ground", "saddle", "along"),
            guide("cross_slide", "ground", "table", "across"),
            *(hinge(f"near_{i}", "saddle", f"link{i}", f"b_{i}", "normal") for i in count),
            *(hinge(f"far_{i}", f"link{i}", "table", f"c_{i}", "normal") for i in count),
        ),
        {
            **{f"b_{i}": askew(x, y, 0.03 * i) for i, (x, y) in enumerate(PINS)},
            **{f"c_{i}": askew(x + 0.4, y + 0.1, 0.01) for i, (x, y) in enumerate(PINS)},
            "ground_seat": (0.5, 0.3, 0.9),
            "table_seat": askew(0.5, 0.3, 0.02),
        },
        {"normal": NORMAL, "along": along, "across": across},
        ("bed",),
        spring=("ground_seat", "table_seat"),
    )
