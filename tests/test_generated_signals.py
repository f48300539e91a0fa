"""The physical signals of the compiled models against what the oracles measure and apply."""

import numpy as np
import pytest
from cases import MODELS, At, car_parameters, counted_by, random_instants
from oracle.constraints import WHEEL
from oracle.newton import Mechanism, observe

SEEDS = range(5)  # 0 is the reference car
POINTS = 4  # for each car


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("model", MODELS.values(), ids=MODELS.keys())
def test_signals(model, seed: int) -> None:
    parameters = car_parameters(seed)
    constants = model.prepare(parameters)
    car = Mechanism(counted_by(model, parameters))
    for instant in random_instants(np.random.default_rng(seed), car, POINTS):
        values = At(model, instant, constants)("signals")
        found = dict(zip(model.SIGNALS, values.tolist(), strict=True))
        solution = instant.solution(model, car)
        seen = observe(car, instant.pose(car))
        spring = parameters["spring_rate"] * (seen.strut_slide - parameters["spring_free_slide"])
        deflection = parameters["tyre_free_height"] + instant.road_height - seen.wheel_center[2]
        expected = {
            "strut_length": seen.strut_length,
            "strut_velocity": -solution.strut_slide_rate,
            "spring_force": spring,
            "damper_force": parameters["damper_rate"] * solution.strut_slide_rate,
            "wheel_velocity": solution.twist[WHEEL - 1, 2],
            "wheel_acceleration": solution.acceleration[WHEEL - 1, 2],
            "camber": seen.camber,
            "toe": seen.toe,
            "steer": seen.steer,
            "tyre_force": parameters["tyre_rate"] * deflection / np.hypot(*seen.spin_axis[:2]),
        }
        expected |= dict(
            zip([f"wheel_center_{axis}" for axis in "xyz"], seen.wheel_center, strict=True)
        )
        assert set(found) == set(expected)
        # Rigidities of up to 2e5 N/m magnify roundings of 1e-16 m; accelerations are those of the
        # dynamics, to 1e-10.
        assert found == pytest.approx(expected, rel=1e-10, abs=1e-9)
        for name in ("strut_length", "camber", "toe", "steer", "wheel_center_z"):
            # a few roundings of numbers of order one, ten times for angles
            assert found[name] == pytest.approx(expected[name], rel=0.0, abs=1e-14), name


@pytest.mark.parametrize("seed", SEEDS)
def test_tyre_force_is_in_the_wheel_plane(seed: int) -> None:
    """Q of the spin is zero: the force has no moment about the spin axis (Eq. 24)."""
    parameters = car_parameters(seed)
    for model in MODELS.values():
        constants = model.prepare(parameters)
        car = Mechanism(parameters)
        for instant in random_instants(np.random.default_rng(seed), car, POINTS):
            forces = At(model, instant, constants)("forces")
            assert forces[1] == 0.0
            assert abs(forces[0]) > 1.0
