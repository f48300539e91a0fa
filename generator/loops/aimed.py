"""Guides directed at a joint by their default numbers alone, as struts are often declared.

A strut of a guide between two ball joints closes in closed form if its guide is along the line of
the two for any hardpoints. Three numbers fulfil that for the default hardpoints alone.
"""

from __future__ import annotations

import math
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from ..declare.evaluation import AtDefaults
from ..declare.joints import Prismatic

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..declare.geometry import Point
    from ..declare.mechanism import Mechanism

# A strut that misses a joint by intent does so by more [rad].
_NEAR = math.radians(1.0)


def aimed(mechanism: Mechanism) -> str:
    """Return a sentence on a guide that points at a joint at design; empty: there is none."""
    value = AtDefaults(mechanism)
    for joint in mechanism.joints:
        if not isinstance(joint, Prismatic) or joint.direction.between is not None:
            continue
        along = np.array([value(c) for c in joint.direction.components])
        for first, second in product(*(_centers(mechanism, joint, b) for b in joint.bodies)):
            way = np.array([value(c) for c in second.position - first.position])
            across = float(np.linalg.norm(np.cross(along, way)))
            if math.atan2(across, abs(along @ way)) < _NEAR:
                return (
                    f"Guide {joint.name!r} is along {first.name} and {second.name} by its numbers "
                    f"alone: give it Direction({joint.direction.name!r}, between=({first.name}, "
                    f"{second.name})), and a universal joint at its end the same shaft"
                )
    return ""


def _centers(mechanism: Mechanism, guide: Prismatic, body: str) -> Iterator[Point]:
    """Yield the centres of the other joints of a body."""
    for joint in mechanism.joints:
        if joint != guide and body in joint.bodies and joint.center is not None:
            yield joint.center
