"""Corners on test benches of the oracles: a strut, and wishbones as a carrier on five rods.

A place is a travel of the wheel and a displacement of the rack [m].
"""

import numpy as np
from kintrafo import Suspension

from oracle.constraints import KNUCKLE
from oracle.links import Carrier
from oracle.newton import Mechanism, observe, solve_pose_at_height
from oracle.relay_rod import OnRelayRod, linkage_of

UP = np.array([0.0, 0.0, 1.0])
# Of central differences over nine places.
WEIGHTS = np.array([3.0, -32.0, 168.0, -672.0, 0.0, 672.0, -168.0, 32.0, -3.0]) / 840.0
# Wishbones in no special position.
SKEWED = Suspension.load("double_wishbone_car").with_changes(
    {"hardpoints.lower_arm_front.z": 205.0, "hardpoints.upper_arm_rear.y": -445.0,
     "hardpoints.upper_ball_joint.x": -35.0, "hardpoints.tie_rod_inner.z": 270.0,
     "hardpoints.spring_seat.x": 25.0, "wheel.camber_deg": -1.5, "wheel.toe_deg": 0.3,
     "rack.axis": [0.05, 1.0, 0.02], "tyre.radius_mm": 310.0},
)  # fmt: skip


def difference(function, step=2e-3):
    """Differentiate by travel at zero; the error is of the order of the eighth power of 2 mm."""
    return sum(w * function(k * step) for k, w in enumerate(WEIGHTS, -4) if w) / step


def second_difference(function, step):
    """Differentiate twice, the differences of differences: of 17 places, each used once."""
    twice = enumerate(np.convolve(WEIGHTS, WEIGHTS), -8)
    return sum(w * function(k * step) for k, w in twice) / step**2


class Bench:
    """A corner whose quantities are measured independently, gradients by central differences."""

    def __init__(self, suspension):
        self.suspension = suspension
        names = self.suspension.hardpoints.names()
        self.points = {name: self.suspension.hardpoints.metres(name) for name in names}
        self.side = np.sign(self.points["wheel_center"][1])
        self.radius = suspension.tyre_radius()
        self._poses = {}

    def pose(self, place):
        """Solve for a position, once: many quantities are differentiated there."""
        if place not in self._poses:
            self._poses[place] = self.solved(*place)
        return self._poses[place]

    def solved(self, travel, rack):
        raise NotImplementedError

    def axis(self, place):
        """Return the spin axis, outboard."""
        raise NotImplementedError

    def rotation(self, place):
        """Return the rotation of the knuckle from design."""
        raise NotImplementedError

    def center(self, place):
        raise NotImplementedError

    def steering_axis(self, place):
        """Return its lower and its upper point."""
        raise NotImplementedError

    def guided(self, place):
        """Return two points of the knuckle, and which way they move."""
        raise NotImplementedError

    def spring(self, place):
        """Return the length of the spring."""
        raise NotImplementedError

    def contact(self, place):
        # down in the wheel's plane: minus the part of e_z across the axis
        axis = self.axis(place)
        down = np.cross(axis, np.cross(axis, UP))
        return self.center(place) + self.radius * down / np.linalg.norm(down)

    def camber(self, place):
        axis = self.axis(place)
        return np.arctan2(-axis[2], self.side * axis[1])

    def toe(self, place):
        axis = self.axis(place)
        return np.arctan2(axis[0], self.side * axis[1])

    def caster(self, place):
        low, high = self.steering_axis(place)
        return np.arctan2((low - high)[0], (high - low)[2])

    def by_travel(self, quantity, place):
        return difference(lambda h: quantity((place[0] + h, place[1])))

    def by_rack(self, quantity, place):
        return difference(lambda h: quantity((place[0], place[1] + h)))


class Strut(Bench):
    """Bodies in maximal coordinates, by Newton's method."""

    def __init__(self, suspension):
        super().__init__(suspension)
        self.mechanism = Mechanism(suspension.parameters())
        given = suspension.parameters()
        self.free = given["strut_length_max"] - given["spring_free_slide"]

    def solved(self, travel, rack):
        height = float(self.mechanism.points["wheel_center"][2]) + travel
        pose = solve_pose_at_height(self.mechanism, height, rack)
        return pose, observe(self.mechanism, pose)

    def axis(self, place):
        spin = self.pose(place)[1].spin_axis
        return spin * np.sign(spin[1]) * self.side

    def rotation(self, place):
        return self.pose(place)[0].rotation[KNUCKLE - 1]

    def center(self, place):
        return self.pose(place)[1].wheel_center

    def joint(self, name, place):
        return self.mechanism.point(self.pose(place)[0], name, KNUCKLE)

    def steering_axis(self, place):
        return self.joint("ball_joint", place), self.mechanism.points["strut_top"]

    def guided(self, place):
        """The ball joint moves across the arm's plane, and the strut along itself."""
        (ball, top), points = self.steering_axis(place), self.mechanism.points
        plane = np.cross(points["arm_front"] - ball, points["arm_rear"] - ball)
        return [(ball, plane), (top, top - ball)]

    def spring(self, place):
        return self.pose(place)[1].strut_length


class Wishbones(Bench):
    """A carrier on five rods."""

    def __init__(self, suspension):
        super().__init__(suspension)
        arm = self.suspension.pitman_arm
        self.carrier = (
            Carrier(self.points, np.array(self.suspension.rack.axis))
            if arm is None
            else OnRelayRod(self.points, linkage_of(arm))
        )
        wheel = self.suspension.wheel
        camber, toe = (np.radians(getattr(wheel, f"{a}_deg")) for a in ("camber", "toe"))
        # outboard, with the angles of docs/reference/conventions.md
        axis = np.array([np.tan(toe), self.side, -np.tan(camber)])
        self.design_axis = axis / np.linalg.norm(axis)
        self.free = suspension.parameters()["spring_free_length"]

    def solved(self, travel, rack):
        return self.carrier.at(travel, rack)

    def axis(self, place):
        return self.rotation(place) @ self.design_axis

    def rotation(self, place):
        return self.pose(place).rotation

    def center(self, place):
        return self.pose(place).center

    def joint(self, name, place):
        return self.carrier.point(self.pose(place), name)

    def steering_axis(self, place):
        return self.joint("lower_ball_joint", place), self.joint("upper_ball_joint", place)

    def guided(self, place):
        """Each ball joint moves across the plane of its arm."""
        ends = zip(("lower", "upper"), self.steering_axis(place), strict=True)
        bearings = (
            (ball, *(self.points[f"{arm}_arm_{end}"] - ball for end in ("front", "rear")))
            for arm, ball in ends
        )
        return [(ball, np.cross(front, rear)) for ball, front, rear in bearings]

    def seat(self, place):
        return self.carrier.on_arm(self.pose(place), "lower", self.points["spring_seat"])

    def spring(self, place):
        return float(np.linalg.norm(self.seat(place) - self.points["spring_top"]))
