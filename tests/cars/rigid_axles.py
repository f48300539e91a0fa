"""Rigid axles that tests share, and where a root finder puts their beams."""

import math

import numpy as np
import pytest
from kintrafo import RigidAxle, RigidAxleModel
from scipy.optimize import fsolve
from scipy.spatial.transform import Rotation

AXLE = RigidAxle.load("rigid_axle")
MODEL = RigidAxleModel(AXLE)
LEFT = np.array([0.0, 1.0, 0.0])
# lower links along x, upper ones that meet in a point ahead of the axle
TRIANGULATED = AXLE.with_changes(
    {
        "rods.upper_link": None,
        "rods.panhard_rod": None,
        "rods.left_link": {"chassis": [620.0, 500.0, 340.0], "axle": [20.0, 500.0, 310.0]},
        "rods.right_link": {"chassis": [620.0, -500.0, 340.0], "axle": [20.0, -500.0, 310.0]},
        "rods.left_upper": {"chassis": [420.0, 450.0, 500.0], "axle": [-20.0, 120.0, 530.0]},
        "rods.right_upper": {"chassis": [420.0, -450.0, 500.0], "axle": [-20.0, -120.0, 530.0]},
    }
)
LOPSIDED = AXLE.with_changes(
    {
        "rods.left_link.axle": [40.0, 560.0, 290.0],
        "rods.upper_link.chassis": [450.0, 200.0, 560.0],
        "rods.panhard_rod.axle": [-90.0, 380.0, 330.0],
        "left_hardpoints": {
            "damper_top": [110.0, 480.0, 780.0],
            "damper_seat": [95.0, 560.0, 300.0],
        },
        "wheel": {"camber_deg": -0.5, "toe_deg": 0.1},
    }
)
STOPPED = AXLE.with_changes(
    {
        "bump_stop": {"clearance_mm": 60.0, "rate_N_per_m": 6e4, "progression_N_per_mm3": 0.1},
        "rebound_stop": {"clearance_mm": 80.0, "rate_N_per_m": 1.2e5},
    }
)
# Four links and a Panhard rod.
FIVE = AXLE.with_changes(
    {
        "rods.upper_link": {"chassis": [500.0, 400.0, 480.0], "axle": [-20.0, 400.0, 525.0]},
        "rods.right_upper_link": {"chassis": [520.0, -380.0, 470.0],
                                  "axle": [-20.0, -410.0, 525.0]},
        "bushings": {"upper_link_axle": {"axial_N_per_mm": 1200.0}},
    }
)  # fmt: skip
AXLES = {"three links and a Panhard rod": AXLE, "triangulated": TRIANGULATED, "lopsided": LOPSIDED}
each_axle = pytest.mark.parametrize("axle", AXLES.values(), ids=AXLES)


class Found:
    """Poses of the beam by a root finder: six equations in its displacement and rotation."""

    def __init__(self, axle):
        self.axle, self.center, self.half = axle, axle.center, axle.half_track
        self.inner, self.outer = (
            np.array(ends) for ends in zip(*axle.ends().values(), strict=True)
        )
        self.lengths = np.linalg.norm(self.outer - self.inner, axis=1)

    def pose(self, heave, roll):
        """Return the middle of the axle and its turn, at one height and inclination."""

        def moved(x):
            return self.center + x[:3], Rotation.from_rotvec(x[3:])

        def misfit(x):
            middle, turn = moved(x)
            ends = middle + turn.apply(self.outer - self.center)
            off = np.linalg.norm(ends - self.inner, axis=1) - self.lengths
            return np.array([*off, x[2] - heave, turn.apply([0.0, 1.0, 0.0])[2] - math.sin(roll)])

        start = np.array([0.0, 0.0, heave, roll, 0.0, 0.0])
        x, _, _, words = fsolve(misfit, start, xtol=1e-14, full_output=True)
        # roundings of lengths below 1 m
        assert np.abs(misfit(x)).max() < 1e-13, words
        return moved(x)

    def place(self, point, heave, roll):
        """Return where a point of the beam is."""
        middle, turn = self.pose(heave, roll)
        return np.asarray(middle + turn.apply(point - self.center))

    def energy(self, heave, roll):
        """Return the energy of springs, bar and weight; no stops, no tyres."""
        axle, bodies = self.axle, self.axle.bodies
        weight = axle.gravity.acceleration_m_per_s2
        com = bodies.beam.centre_of_mass(axle.hardpoints)
        energy = weight * bodies.beam.mass_kg * self.place(com, heave, roll)[2]
        energy += 2.0 * weight * bodies.wheel.mass_kg * (self.center[2] + heave)
        for side in ("left", "right"):
            points = axle.points(side)
            rest = np.linalg.norm(points["spring_top"] - points["spring_seat"])
            free = axle.spring.free_length(float(rest))
            seat = self.place(points["spring_seat"], heave, roll)
            length = np.linalg.norm(points["spring_top"] - seat)
            energy += 0.5 * axle.spring.rate_N_per_m * (free - length) ** 2
        assert axle.anti_roll_bar is not None
        return float(energy + 0.5 * math.degrees(axle.anti_roll_bar.rate_Nm_per_deg) * roll**2)


def slopes(function, at, step=1e-3):
    """Return the derivatives by heave and roll, by differences of fourth order."""
    weights = {-2: 1.0, -1: -8.0, 1: 8.0, 2: -1.0}
    return np.stack(
        [
            sum(
                w * np.asarray(function(*(np.array(at) + k * step * way)))
                for k, w in weights.items()
            )
            / (12.0 * step)
            for way in np.eye(2)
        ],
        axis=-1,
    )
