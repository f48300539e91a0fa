"""Hinges and guides that are nearly parallel, which is rarely intended.

A planar loop needs one coordinate less to close than a spatial one, but only with parallel hinges:
a hinge that is off by a tenth of a degree locks the mechanism.
"""

from __future__ import annotations

import math
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from ..declare.evaluation import AtDefaults
from ..declare.joints import Prismatic, Revolute

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..declare.mechanism import Mechanism
    from ..program.vectors import Vector

# Below the first, directions are equal but for rounding; above the second, not parallel [rad].
_EQUAL, _FAR = 1e-9, math.radians(1.0)


def tilted(mechanism: Mechanism) -> str:
    """Return a sentence on nearly parallel axes at the design position; empty: there are none."""
    angles = {pair: angle for pair, angle in _angles(mechanism) if _EQUAL < angle < _FAR}
    if not angles:
        return ""
    named = [name for pair in angles for name in pair]
    odd = max(dict.fromkeys(named), key=named.count)
    others = [name for pair in angles if odd in pair for name in pair if name != odd]
    degrees = math.degrees(max(angle for pair, angle in angles.items() if odd in pair))
    return (
        f"Joint {odd!r} is tilted by {degrees:.3g} degrees from {', '.join(others)}: if they are "
        "meant to be parallel, give them one Direction"
    )


def _angles(mechanism: Mechanism) -> Iterator[tuple[tuple[str, str], float]]:
    """Yield the angle between the lines of every two hinges, and of every two guides [rad]."""
    value = AtDefaults(mechanism)
    for kind in (Revolute, Prismatic):
        lines = {
            joint.name: np.array([value(c) for c in _line(joint)], dtype=float)
            for joint in mechanism.joints
            if isinstance(joint, kind)
        }
        for one, other in combinations(lines, 2):
            across = np.linalg.norm(np.cross(lines[one], lines[other]))
            yield (one, other), math.atan2(across, abs(lines[one] @ lines[other]))


def _line(joint: Revolute | Prismatic) -> Vector:
    return joint.axis.vector if isinstance(joint, Revolute) else joint.direction.components
