"""A relay rod between a Pitman arm and an idler arm, by Newton's method on its pose alone.

The rod has six coordinates and six equations: its one end is where the Pitman arm puts it, three;
the other keeps its distances from two points on the axis of the idler arm; and the two axes of the
joint at the Pitman arm stay at right angles. The idler arm occurs nowhere, nothing is eliminated.

SI units, chassis axes (x forward, y left, z up).
"""

import numpy as np
from scipy.spatial.transform import Rotation

from oracle.links import ROUNDED, STEP, STEPS, Carrier, Pose

UP = np.array([0.0, 0.0, 1.0])


class Linkage:
    """Pitman arm, relay rod, idler arm.

    Parameters
    ----------
    points : dict of ndarray
        ``pivot``, ``ball``, ``idler_pivot``, ``idler_ball`` at design [m].
    axis, idler_axis : ndarray
        Of both arms.
    """

    def __init__(self, points, axis, idler_axis):
        self.points = points
        self.axis, self.idler_axis = (a / np.linalg.norm(a) for a in (axis, idler_axis))
        self.length = float(np.linalg.norm(np.cross(self.axis, points["ball"] - points["pivot"])))

    def arm(self, way):
        """Return the rotation of the Pitman arm whose ball has gone so far along its circle."""
        return Rotation.from_rotvec(way / self.length * self.axis).as_matrix()

    def at(self, way):
        """Return the pose of the relay rod about its end at the Pitman arm, from design on."""
        parts = max(1, int(np.ceil(abs(way) / STEP)))
        pose = Pose(self.points["ball"], np.eye(3))
        for part in range(1, parts + 1):
            pose = self._solved(pose, way * part / parts)
        return pose

    def carried(self, way, place):
        """Return where a point of the relay rod is, given its place at design [m]."""
        pose = self.at(way)
        return pose.center + pose.rotation @ (place - self.points["ball"])

    def _solved(self, pose, way):
        turned = self.arm(way)
        end = self.points["pivot"] + turned @ (self.points["ball"] - self.points["pivot"])
        rod = self.points["idler_ball"] - self.points["ball"]
        on_axis = [self.points["idler_pivot"] + 0.1 * k * self.idler_axis for k in (-1.0, 1.0)]
        first, second = turned @ UP, np.cross(rod, UP) / np.linalg.norm(np.cross(rod, UP))
        for _ in range(STEPS):
            rows, errors = [*np.eye(6)[:3]], [*(pose.center - end)]
            across = pose.rotation @ rod
            for fixed in on_axis:
                spoke = pose.center + across - fixed
                length = float(np.linalg.norm(spoke))
                rows.append(np.concatenate([spoke, np.cross(across, spoke)]) / length)
                errors.append(length - float(np.linalg.norm(self.points["idler_ball"] - fixed)))
            held = pose.rotation @ second
            rows.append(np.concatenate([np.zeros(3), np.cross(held, first)]))
            errors.append(float(held @ first))
            change = np.linalg.solve(np.array(rows), -np.array(errors))
            turn = Rotation.from_rotvec(change[3:]).as_matrix()
            pose = Pose(pose.center + change[:3], turn @ pose.rotation)
            if np.abs(change).max() < ROUNDED:
                break
        return pose


class OnRelayRod(Carrier):
    """A wheel carrier whose tie rod is joined to a relay rod.

    Parameters
    ----------
    points : dict of ndarray
        Hardpoints at design [m].
    linkage : Linkage
    """

    def __init__(self, points, linkage):
        super().__init__(points, UP)
        self.linkage = linkage

    def inner(self, rack):
        """Return the inner end of the tie rod [m]."""
        return self.linkage.carried(rack, self.points["tie_rod_inner"])


def linkage_of(arm):
    """Return the linkage of a file's section, without what it leaves out."""
    names = ("pivot", "ball", "idler_pivot", "idler_ball")
    points = {name: np.array(getattr(arm, f"{name}_mm")) / 1e3 for name in names}
    return Linkage(points, np.array(arm.axis), np.array(arm.idler_axis))
