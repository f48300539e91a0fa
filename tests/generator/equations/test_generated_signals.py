"""The physical signals of the compiled models against what the oracles measure and apply."""

import numpy as np
import pytest
from cars.instants import MODELS, At, car_parameters, counted_by, random_instants
from kintrafo.generated import macpherson_general
from oracle import laws
from oracle.constraints import KNUCKLE, WHEEL, unit
from oracle.newton import Mechanism, observe

SEEDS = range(5)  # 0 is the reference car
POINTS = 4  # for each car

BEYOND_THE_PAPER = (
    "spring_length",
    "spring_velocity",
    "friction_force",
    "bump_stop_force",
    "rebound_stop_force",
)
"""Signals that only the general model has."""


def spring_velocity(car, pose, twist):
    """Return how fast the spring's seats part, m/s."""
    seat = car.point(pose, "spring_seat", KNUCKLE)
    arm = seat - pose.position[KNUCKLE - 1]
    velocity = twist[KNUCKLE - 1, :3] + np.cross(twist[KNUCKLE - 1, 3:], arm)
    return float(unit(seat - car.points["spring_top"]) @ velocity)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("model", MODELS.values(), ids=MODELS.keys())
def test_signals(model, seed):
    parameters = car_parameters(seed, model)
    constants = model.prepare(parameters)
    car = Mechanism(counted_by(model, parameters))
    given = car.parameters
    for instant in random_instants(np.random.default_rng(seed), car, POINTS):
        values = At(model, instant, constants)("signals")
        found = dict(zip(model.SIGNALS, values.tolist(), strict=True))
        solution = instant.solution(model, car)
        pose = instant.pose(car)
        seen = observe(car, pose)
        rise = solution.twist[WHEEL - 1, 2]
        slide_rate = solution.strut_slide_rate
        deflection = given["tyre_free_height"] + instant.road_height - seen.wheel_center[2]
        load = laws.tyre_load(given, deflection, instant.road_velocity - rise)
        expected = {
            "strut_length": seen.strut_length,
            "strut_velocity": -slide_rate,
            "spring_length": seen.spring_length,
            "spring_velocity": spring_velocity(car, pose, solution.twist),
            "spring_force": laws.spring_force(given, seen.spring_length),
            "damper_force": laws.damper_force(given, slide_rate),
            "friction_force": laws.friction_force(given, slide_rate),
            "bump_stop_force": laws.stop_force(given, "bump", seen.strut_length),
            "rebound_stop_force": laws.stop_force(given, "rebound", seen.strut_length),
            "wheel_velocity": rise,
            "wheel_acceleration": solution.acceleration[WHEEL - 1, 2],
            "camber": seen.camber,
            "toe": seen.toe,
            "steer": seen.steer,
            "tyre_force": load / np.hypot(*seen.spin_axis[:2]),
        }
        expected |= dict(
            zip([f"wheel_center_{axis}" for axis in "xyz"], seen.wheel_center, strict=True)
        )
        if model is not macpherson_general:
            for name in BEYOND_THE_PAPER:
                del expected[name]
        assert set(found) == set(expected)
        # Rigidities of up to 2e5 N/m magnify roundings of 1e-16 m; accelerations are those of the
        # dynamics, to 1e-10.
        assert found == pytest.approx(expected, rel=1e-10, abs=1e-9)
        for name in ("strut_length", "camber", "toe", "steer", "wheel_center_z"):
            # a few roundings of numbers of order one, ten times for angles
            assert found[name] == pytest.approx(expected[name], rel=0.0, abs=1e-14), name


@pytest.mark.parametrize("seed", SEEDS)
def test_tyre_force_is_in_the_wheel_plane(seed):
    """Q of the spin is zero: the force has no moment about the spin axis (Eq. 24)."""
    for model in MODELS.values():
        parameters = car_parameters(seed, model)
        constants = model.prepare(parameters)
        car = Mechanism(parameters)
        for instant in random_instants(np.random.default_rng(seed), car, POINTS):
            forces = At(model, instant, constants)("forces")
            assert forces[1] == 0.0
            assert abs(forces[0]) > 0.1  # N m: something acts
