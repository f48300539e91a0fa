"""Heights of geometries that no car has: met to rounding, on the design's branch, or refused.

The wheel of such a suspension turns back, or a loop comes to its dead point, within a fraction of a
degree. A height that is found is given to the oracle, which goes to that arm angle by Newton's
method on the joints, step by step from the design position.
"""

import numpy as np
import pytest
from kintrafo import Model, state_at_height, travel_range
from kintrafo.core.errors import InputError
from kintrafo.vehicle.models.reach import height_and_slope
from oracle import newton
from oracle.reference import reference_parameters

CAR = Model("reference_car").suspension
# A fold within one step of the table in which angles are looked up; the height that was asked for
# lies on the far side of it in the second one.
FOLDED = {
    "strut": ({"strut_top": [5.8, -709.0, 183.0]}, 0.2),
    "ball joint": (
        {"ball_joint": [-51.1100815144185, -529.3430369159549, 711.3640616626527]},
        0.32,
    ),
}


def model_with(points):
    changes = {f"hardpoints.{name}": place for name, place in points.items()}
    return Model(CAR.with_changes(changes | {"strut.length_max_mm": 5000.0}))


def hard_points(seed):
    """Move some points: anywhere near, next to another one, or next to the line of two others."""
    random = np.random.default_rng(seed)
    names = CAR.hardpoints.names()
    moved = {}
    for name in random.choice(names, random.integers(1, 4), replace=False):
        one, two = (np.array(getattr(CAR.hardpoints, n)) for n in random.choice(names, 2))
        start = np.array(getattr(CAR.hardpoints, name))
        place = (start, one, one + random.uniform(-1.0, 2.0) * (two - one))[random.integers(3)]
        moved[name] = (place + random.normal(size=3) * 10.0 ** random.uniform(-1.0, 2.0)).tolist()
    return moved


def hard_models(seeds):
    for seed in seeds:
        try:
            yield seed, model_with(hard_points(seed))
        except InputError:  # no suspension
            continue


@pytest.mark.parametrize("name", FOLDED)
def test_a_fold_within_a_step_ends_the_reach(name):
    points, wanted = FOLDED[name]
    model = model_with(points)
    reach = travel_range(model)
    angles = np.linspace(*reach.arm_angle, 2001)
    heights, slopes = height_and_slope(model, angles)
    assert (slopes < 0.0).all()
    assert (np.diff(heights) > 0.0).all()
    found = model.signal("wheel_center_z", state_at_height(model, wanted))
    assert found == pytest.approx(wanted, abs=1e-12)


def test_hard_positions_are_those_of_the_oracle():
    compared = 0
    for seed, model in hard_models(range(100, 112)):
        car = newton.Mechanism(reference_parameters() | model.parameters)
        reach = travel_range(model)
        for part in (0.2, 0.8):
            wanted = reach.height[0] + part * (reach.height[1] - reach.height[0])
            state = state_at_height(model, wanted)
            try:
                pose = newton.solve_pose(car, float(state[0]))
            except newton.AssemblyError:  # its steps are too long for this one
                continue
            # both are exact to some roundings times the slope and the condition of the loop
            assert newton.observe(car, pose).wheel_center[2] == pytest.approx(wanted, abs=1e-9), (
                seed
            )
            compared += 1
    assert compared > 8
