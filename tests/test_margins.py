"""What the margins are: the geometry that each guard watches, measured on poses of the oracle."""

import numpy as np
import pytest
from cases import MODELS, At, car_parameters, counted_by, random_instants
from oracle.constraints import ARM, KNUCKLE, RACK, WHEEL, Array, unit
from oracle.multipliers import reduced_equations
from oracle.newton import X_AXIS, Z_AXIS, Mechanism

SEEDS = range(4)  # 0 is the reference car
POINTS = 3  # for each car


def squared(v: Array) -> float:
    return float(v @ v)


def measured(car: Mechanism, at: At) -> dict[str, float]:
    """Return all margins from where the points are, and from the mass matrix of the oracle."""
    pose = at.instant.pose(car)
    top, ball = car.points["strut_top"], car.point(pose, "ball_joint", ARM)
    outer, inner = car.point(pose, "tie_rod_outer", KNUCKLE), car.point(pose, "tie_rod_inner", RACK)
    strut, rod = unit(ball - top), unit(outer - inner)
    reach = inner - top
    arm = outer - ball
    normal = np.cross(strut, unit(arm - (arm @ strut) * strut))
    axis = pose.rotation[WHEEL - 1] @ car.spin_axis
    # The wheel's spin is eliminated first, then one coordinate after the other.
    mass = reduced_equations(car, pose, 0.0, 0.0).mass_matrix
    rest = mass[np.ix_([0, 2], [0, 2])] - np.outer(mass[[0, 2], 1], mass[1, [0, 2]]) / mass[1, 1]
    return {
        "length_squared_BC": squared(ball - top),
        "upper_strut_cross_squared": squared(np.cross(X_AXIS, strut)),
        "knuckle_reach_squared": squared(np.cross(strut, reach)),
        "knuckle_closure": float((outer - inner) @ normal) ** 2,
        "tie_rod_cross_squared": squared(np.cross(Z_AXIS, rod)),
        "cos_camber_squared": 1.0 - axis[2] ** 2,
        "pivot_beta1": rest[0, 0],
        "pivot_beta9": rest[1, 1] - rest[0, 1] ** 2 / rest[0, 0],
        "shaft_level_squared_C": squared(strut[:2]),
        "shaft_level_squared_E": squared(rod[:2]),
    }


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("model", MODELS.values(), ids=MODELS.keys())
def test_margins(model, seed: int) -> None:
    parameters = car_parameters(seed)
    constants = model.prepare(parameters)
    car = Mechanism(counted_by(model, parameters))
    for instant in random_instants(np.random.default_rng(seed), car, POINTS):
        at = At(model, instant, constants)
        names = [name for name, _ in model.GUARDS]
        found = dict(zip(names, at("margins").tolist(), strict=True))
        expected = measured(car, at)
        # some roundings of squares of lengths of about 1 m, and of up to 10 kg m²
        assert found == pytest.approx({n: expected[n] for n in names}, rel=1e-12, abs=1e-14)
