"""Wheels that a rod joins, as on a locomotive."""

from __future__ import annotations

from typing import TYPE_CHECKING

from own_mechanisms import NORMAL, askew, declare, hinge

if TYPE_CHECKING:
    from kintrafo.generator import Formulation


def locomotive(
    name: str = "locomotive", bearings: tuple[float, ...] = (0.0, 0.9, 1.7)
) -> Formulation:
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
