"""The margins, compared with the guarded geometry, measured on poses of the oracle."""

import numpy as np
import pytest
from cars.instants import MODELS, At, car_parameters, counted_by, random_instants
from kintrafo.generated import macpherson_general
from oracle.constraints import ARM, KNUCKLE, RACK, WHEEL, unit
from oracle.multipliers import reduced_equations
from oracle.newton import X_AXIS, Z_AXIS, Mechanism

SEEDS = range(4)  # 0 is the reference car
POINTS = 3  # for each car


def squared(v):
    return float(v @ v)


def measured(car, at):
    """Return all margins from where the points are, and from the mass matrix of the oracle."""
    pose = at.instant.pose(car)
    axis = pose.rotation[WHEEL - 1] @ car.spin_axis
    strut, rod = directions(car, pose)
    spring = car.point(pose, "spring_seat", KNUCKLE) - car.points["spring_top"]
    # The wheel's spin is eliminated first, then one coordinate after the other.
    mass = reduced_equations(car, pose, 0.0, 0.0).mass_matrix
    rest = mass[np.ix_([0, 2], [0, 2])] - np.outer(mass[[0, 2], 1], mass[1, [0, 2]]) / mass[1, 1]
    knuckle = knuckle_off_axis if at.model is macpherson_general else knuckle_on_axis
    return {
        **knuckle(car, pose),
        "upper_strut_cross_squared": squared(np.cross(X_AXIS, strut)),
        "tie_rod_cross_squared": squared(np.cross(Z_AXIS, rod)),
        "spring_length_squared": squared(spring),
        "cos_camber_squared": 1.0 - axis[2] ** 2,
        "pivot_beta1": rest[0, 0],
        "pivot_beta9": rest[1, 1] - rest[0, 1] ** 2 / rest[0, 0],
        "shaft_level_squared_C": squared(strut[:2]),
        "shaft_level_squared_E": squared(rod[:2]),
    }


def directions(car, pose):
    """Return the unit vectors of the strut, downwards, and of the tie rod, from the rack."""
    outer, inner = car.point(pose, "tie_rod_outer", KNUCKLE), car.point(pose, "tie_rod_inner", RACK)
    return unit(car.point(pose, "strut_lower", KNUCKLE) - car.points["strut_top"]), unit(
        outer - inner
    )


def steering(car, pose):
    """Return strut top to ball joint, ball joint to both ends of the rod, and the rod."""
    top, ball = car.points["strut_top"], car.point(pose, "ball_joint", ARM)
    outer, inner = car.point(pose, "tie_rod_outer", KNUCKLE), car.point(pose, "tie_rod_inner", RACK)
    return ball - top, outer - ball, inner - ball, outer - inner


def knuckle_on_axis(car, pose):
    """Return the margins of a knuckle that turns about a strut through its ball joint.

    Its closure is how far the rod reaches across the plane of strut and lever.
    """
    span, arm, reach, rod = steering(car, pose)
    strut = unit(span)
    normal = np.cross(strut, unit(arm - (arm @ strut) * strut))
    return {
        "length_squared_BC": squared(span),
        "knuckle_reach_squared": squared(np.cross(strut, reach)),
        "knuckle_closure": float(rod @ normal) ** 2,
    }


def knuckle_off_axis(car, pose):
    """Return the margins of a knuckle whose ball joint is beside the strut's axis.

    Its closure is how far the end of the rod is from the plane of its anchor, ball joint and top.
    """
    span, arm, reach, _ = steering(car, pose)
    strut, _ = directions(car, pose)
    normal = np.cross(span, reach)
    return {
        "length_squared_BC": float(span @ strut) ** 2,
        # how far the ball joint is along the strut: the length and a constant
        "length_BC": float(span @ strut),
        "knuckle_reach_squared": squared(normal),
        "knuckle_closure": float(arm @ unit(normal)) ** 2,
        "knuckle_plane_squared": squared(np.cross(span, arm)),
    }


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("model", MODELS.values(), ids=MODELS.keys())
def test_margins(model, seed):
    parameters = car_parameters(seed, model)
    constants = model.prepare(parameters)
    car = Mechanism(counted_by(model, parameters))
    for instant in random_instants(np.random.default_rng(seed), car, POINTS):
        at = At(model, instant, constants)
        names = [name for name, _ in model.GUARDS]
        found = dict(zip(names, at("margins").tolist(), strict=True))
        expected = measured(car, at)
        floors = {name: floor_of(at, name) for name in names}
        over = {name: found[name] + floors[name] for name in names}
        # some roundings of squares of lengths of about 1 m, and of up to 10 kg m²
        assert over == pytest.approx({n: expected[n] for n in names}, rel=1e-12, abs=1e-14)
        # far under what a car has
        relative = [name for name in names if name != "length_BC"]
        assert all(0.0 <= floors[name] < 2e-3 * expected[name] for name in relative)


def floor_of(at, name):
    """Return what a margin is measured from: a constant of the loop's extent, or a number."""
    shared = {"knuckle_plane_squared": "knuckle_reach_squared"}
    constants = dict(zip(at.model.CONSTANTS, at.constants, strict=True))
    if name.startswith("pivot"):
        return 0.0
    return float(constants.get(f"{shared.get(name, name)}_floor", 1e-10))
