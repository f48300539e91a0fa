"""A force and a moment on a part, and the forces that need no input."""

from dataclasses import dataclass

import numpy as np

from ...core.named_types import Array
from ..corner.structure import LineForce
from .part_poses import PartPoses

RACK = "rack"


@dataclass(frozen=True)
class Load:
    """A force and a moment on a part."""

    # loaded part, and the point: a hardpoint, `contact`, or `mass` for its centre of mass
    part: str
    point: str
    by: str  # source: another part, or `spring`, `damper`, `road`, `gravity`
    # chassis axes, the moment about the point, (..., 3) [N], [N m], [m]
    force: Array
    moment: Array
    at: Array


def known(poses: PartPoses) -> list[Load]:
    """Return the forces that need no input: weights, spring, damper and stops."""
    structure, still = poses.structure, np.zeros(3)
    weights, forces = poses.weights(), poses.forces_along_lines()
    loads = [
        Load(part, "mass", "gravity", weights[part], still, poses.centers[part])
        for part in (*structure.parts, RACK)
        if part in weights and weights[part].any()
    ]
    for line in structure.lines:
        loads += along_line(poses, line, forces[line.name])
    return loads


def along_line(poses: PartPoses, line: LineForce, force: Array) -> list[Load]:
    """Return the loads of a force along a line on both of its parts, positive when it pushes."""
    points = poses.points
    push = force[..., None] * line.direction(points)
    ends = ((line.first, line.at[0], -push), (line.second, line.at[1], push))
    return [
        Load(part, point, line.name, end, np.zeros(3), points[point]) for part, point, end in ends
    ]
