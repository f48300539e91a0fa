"""A wheel carrier on two wishbones and a tie rod, by Newton's method on lengths alone.

A wishbone is two rods from its bearings to its ball joint, so that the carrier hangs on five rods:
five lengths, and the height of the wheel centre, are six equations for its six coordinates. Nothing
is eliminated, no angle of an arm occurs, and nothing is shared with the generator.

SI units, chassis axes (x forward, y left, z up).
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

Array = npt.NDArray[np.float64]

# Chassis side and carrier side of each rod.
RODS = (
    ("lower_arm_front", "lower_ball_joint"),
    ("lower_arm_rear", "lower_ball_joint"),
    ("upper_arm_front", "upper_ball_joint"),
    ("upper_arm_rear", "upper_ball_joint"),
    ("tie_rod_inner", "tie_rod_outer"),
)
# Newton's method goes to its goal by steps of at most this [m], so that it stays on its branch.
STEP = 0.02
STEPS = 40
ROUNDED = 1e-15


@dataclass(frozen=True)
class Pose:
    """Pose of a carrier: its wheel centre [m] and its rotation from design."""

    center: Array
    rotation: Array


class Carrier:
    """A wheel carrier on five rods.

    Parameters
    ----------
    points : dict of ndarray
        Hardpoints at design [m].
    rack_axis : ndarray
        Direction in which the rack moves the inner end of the tie rod.
    """

    def __init__(self, points, rack_axis):
        self.points = points
        self.rack_axis = rack_axis / np.linalg.norm(rack_axis)

    def at(self, travel, rack):
        """Return the pose with the wheel centre so far above design, followed from there."""
        parts = max(1, int(np.ceil(max(abs(travel), abs(rack)) / STEP)))
        pose = Pose(self.points["wheel_center"], np.eye(3))
        for part in range(1, parts + 1):
            pose = self._solved(pose, travel * part / parts, rack * part / parts)
        return pose

    def inner(self, rack):
        """Return the inner end of the tie rod [m]."""
        return self.points["tie_rod_inner"] + rack * self.rack_axis

    def point(self, pose, name):
        """Return a point of the carrier [m]."""
        return pose.center + pose.rotation @ (self.points[name] - self.points["wheel_center"])

    def on_arm(self, pose, arm, place):
        """Return where a point of the "lower" or "upper" arm is, given its place at design [m]."""
        names = (f"{arm}_arm_rear", f"{arm}_arm_front")
        rear, front = (self.points[name] for name in names)
        ball = f"{arm}_ball_joint"
        before = _frame(rear, front, self.points[ball])
        after = _frame(rear, front, self.point(pose, ball))
        return rear + after @ before.T @ (place - rear)

    def _solved(self, pose, travel, rack):
        height = self.points["wheel_center"][2] + travel
        fixed = self.points | {"tie_rod_inner": self.inner(rack)}
        for _ in range(STEPS):
            rows, errors = [np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0])], [pose.center[2] - height]
            for near, far in RODS:
                at = self.point(pose, far)
                rod = at - fixed[near]
                length = np.linalg.norm(rod)
                wanted = np.linalg.norm(self.points[far] - self.points[near])
                rows.append(np.concatenate([rod, np.cross(at - pose.center, rod)]) / length)
                errors.append(float(length - wanted))
            change = np.linalg.solve(np.array(rows), -np.array(errors))
            turn = Rotation.from_rotvec(change[3:]).as_matrix()
            pose = Pose(pose.center + change[:3], turn @ pose.rotation)
            if np.abs(change).max() < ROUNDED:
                break
        return pose


def _frame(origin, ahead, beside):
    """Return the matrix of axes along the first two points and, in their plane, to the third."""
    x = (ahead - origin) / np.linalg.norm(ahead - origin)
    z = np.cross(x, beside - origin)
    z /= np.linalg.norm(z)
    return np.column_stack([x, np.cross(z, x), z])
