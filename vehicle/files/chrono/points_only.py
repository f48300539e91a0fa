"""The hardpoints of a file of Project Chrono, with the other data of a packaged file."""

from collections.abc import Mapping

import tomlkit

from ...kinds import Suspension
from ..fitting import ground, move_along, packaged, put, to_side
from ..point_table import put_points
from .parts import Point, millimetres
from .suspension_file import RACK


def with_points(
    kind: str, points: Mapping[str, Point], alignment: Mapping[str, float], source: str
) -> tuple[Suspension, list[str]]:
    """Return the packaged suspension of a kind with other hardpoints, camber and toe.

    Points are those of the left side [m]; `alignment` has camber and toe [deg] by the keys of
    ``[wheel]``. The second result is the origin of all other data, one sentence each.
    """
    starter, text, old = packaged(kind)
    document = tomlkit.parse(text)
    left = to_side(document, old, "left")
    here: dict[str, Point] = {}
    for name, (x, y, z) in points.items():
        here[name] = (millimetres(x), millimetres(y), millimetres(z))
    moved = move_along(document, left, here)
    put_points(document, here, "mm")
    for key, angle in alignment.items():
        put(document, ("wheel", key), angle)
    new = Suspension.from_dict(document.unwrap(), source=source)
    lines = [
        f"spring, damper, masses, tyre and vehicle: as in the packaged {starter}",
        *(["damper: between the points of the spring"] if kind == "double_wishbone" else []),
        *([RACK] if "rack" in document else []),
        *moved,
    ]
    return new, [*lines, *ground(new)]
