"""Loops that turn about a point: a universal joint, and hinges whose axes meet in its centre.

By declaration, or with the default parameters; that other parameters fulfil it too is one of the
`assumptions`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..declare.joints import Revolute, Universal
from ..program.floors import ROUNDING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..declare.evaluation import AtDefaults
    from ..declare.geometry import Line, Point
    from ..declare.joints import Joint


def common_center(joints: Sequence[Joint], at_defaults: AtDefaults) -> Point | None:
    """Return the centre of a loop of one universal joint and hinges through its centre."""
    crosses = [joint for joint in joints if isinstance(joint, Universal)]
    hinges = [joint for joint in joints if isinstance(joint, Revolute)]
    if len(crosses) != 1 or len(hinges) + 1 < len(joints):
        return None
    center = crosses[0].at
    return center if all(_through(j.axis, center, at_defaults) for j in hinges) else None


def _through(axis: Line, point: Point, at_defaults: AtDefaults) -> bool:
    if axis.contains(point):
        return True
    way = np.array([at_defaults(x) for x in point.position - axis.through.position])
    along = np.array([at_defaults(x) for x in axis.vector])
    scale = np.linalg.norm(along) * (np.linalg.norm(way) + np.linalg.norm(along))
    return bool(np.linalg.norm(np.cross(along, way)) <= float(ROUNDING) * scale)
