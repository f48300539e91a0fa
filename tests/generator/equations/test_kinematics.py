"""Closed-form poses: against the reference car, against Newton, and in the paper's coordinates."""

from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest
from cars.instants import MODELS, At, Instant, car_parameters
from kintrafo.generated import macpherson, macpherson_general
from oracle.constraints import KNUCKLE, RACK, WHEEL, Pose
from oracle.newton import Mechanism, solve_pose_at_height
from oracle.reference import BETA1_DESIGN, KINEMATICS, KINEMATICS_COLUMNS

# 0 is the reference car; of the others, those that reach the ends of the travel below
SEEDS = {
    "macpherson": range(5),
    "macpherson_free_rack": range(5),
    "macpherson_general": (0, 1, 2, 4, 6),
}
SPIN = 2.5


@dataclass(frozen=True)
class Placed(At):
    """A model at an instant, and the pose that Newton found for it."""

    car: Mechanism
    pose: Pose


@cache
def poses(car_of, seed):
    """Return poses over a travel of 0.15 m up and down, and 60 mm of the rack to both sides."""
    car = Mechanism(car_parameters(seed, car_of))
    middle = car.points["wheel_center"][2]
    finest = seed == 0
    found = []
    for rack in np.linspace(-0.06, 0.06, 7 if finest else 3):
        start = None
        for height in middle + np.linspace(-0.15, 0.15, 13 if finest else 5):
            # Newton finds the angle of the arm by height; this angle is then exact by definition.
            start = solve_pose_at_height(car, height, rack, SPIN, start)
            instant = Instant(car.beta1(start), SPIN, rack)
            found.append((instant, instant.pose(car, start)))
    return car, found


@pytest.fixture(
    scope="module",
    params=[(name, seed) for name in MODELS for seed in SEEDS[name]],
    ids=lambda value: f"{value[0]}-car{value[1]}",
)
def travel(request):
    name, seed = request.param
    model = MODELS[name]
    # the two models of the paper's suspension have the same poses
    car, found = poses(model if model is macpherson_general else macpherson, seed)
    constants = model.prepare(car_parameters(seed, model))
    return [Placed(model, instant, constants, car, pose) for instant, pose in found]


@pytest.mark.parametrize("row", KINEMATICS, ids=lambda row: f"{row[0]:.3f}m")
def test_reference_car(row):
    """Heights, branch and signs of all angles, as tabulated with 16 digits."""
    expected = dict(zip(KINEMATICS_COLUMNS, row, strict=True))
    arm = BETA1_DESIGN - expected.pop("arm_rise")
    found = dict(zip(macpherson.SIGNALS, macpherson.signals([arm, 0.0, 0.0, 0.0]), strict=True))
    for name in ("camber", "toe", "steer"):
        found[name] = np.rad2deg(found[name])
    # The arm angle of a row is rounded by 2e-16 rad; near full rebound the camber falls by 0.6 rad
    # per rad, and degrees multiply by 57. The table comes from an iteration that stops at
    # round-off, so a few tens of 1e-15 remain (6e-14 degrees at worst); three times that is let by.
    assert {name: found[name] for name in expected} == pytest.approx(expected, rel=0.0, abs=2e-13)


def test_positions_and_orientations_are_newtons(travel):
    """Both sides carry a few roundings of numbers of order one; Newton's conditioning adds ten."""
    for place in travel:
        assert np.abs(place("positions") - place.pose.position).max() < 1e-12
        assert np.abs(place("orientations") - place.pose.rotation).max() < 1e-12


def rotation_x(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def rotation_z(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def elevation_and_azimuth(direction):
    """Angles of R = Rz(azimuth) Rx(elevation) whose y axis is along a vector."""
    n = direction / np.linalg.norm(direction)
    return float(np.arcsin(n[2])), float(np.arctan2(-n[0], n[1]))


def coordinates_of(car, pose):
    """Measure the relative coordinates on a pose, by the paper's definitions and no equation."""
    top = car.points["strut_top"]
    lower = car.point(pose, "strut_lower", KNUCKLE)
    strut = lower - top
    beta3, beta4 = elevation_and_azimuth(strut)
    frame = rotation_z(beta4) @ rotation_x(beta3)
    # H is on the strut, as is its lower end: from both, G is as far across the strut.
    across = frame.T @ (pose.position[WHEEL - 1] - lower)
    rod = car.point(pose, "tie_rod_outer", KNUCKLE) - car.point(pose, "tie_rod_inner", RACK)
    beta11, beta12 = elevation_and_azimuth(rod)
    slide = car.parameters["strut_length_max"] - float(np.linalg.norm(strut))
    return {
        "beta1": car.beta1(pose),
        "beta2": slide,
        "beta3": beta3,
        "beta4": beta4,
        "beta5": car.spin(pose),
        "beta6": slide,
        "beta7": beta3,
        "beta8": beta4,
        "beta9": car.rack(pose),
        "beta10": float(np.arctan2(-across[0], across[2])),
        "beta11": beta11,
        "beta12": beta12,
    }


def test_relative_coordinates_are_the_papers(travel):
    for place in travel:
        beta = place("relative_coordinates")
        found = dict(zip(place.model.RELATIVE_COORDINATES, beta, strict=True))
        expected = coordinates_of(place.car, place.pose)
        # The strut is within 20 degrees of vertical: its azimuth is three times worse conditioned
        # than its direction, which Newton gives to 1e-15.
        assert found == pytest.approx({name: expected[name] for name in found}, rel=0.0, abs=1e-13)
