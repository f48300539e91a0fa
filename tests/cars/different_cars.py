"""Cars that differ, of which some fail, and results that must be the same bits."""

import numpy as np
from kintrafo import Model, Samples

SPAN = (0.0, 0.5)
TIMES = np.linspace(*SPAN, 41)

# Roads and a rack with jumps and kinks, and one that a function gives.
STEP = (np.array([0.0, 0.1, 0.1, 0.5]), np.array([0.0, 0.0, 0.02, 0.01]))
BUMP = (np.linspace(0.0, 0.5, 26), 0.01 * np.sin(np.linspace(0.0, 9.0, 26)) ** 2)
RACK = Samples(np.linspace(0.0, 0.5, 6), [0.0, 0.001, 0.01, 0.02, 0.015, 0.0], between="spline")


def some_cars(count, seed=0):
    """Return cars whose hardpoints, rates, masses and starts differ."""
    rng = np.random.default_rng(seed)
    reference = Model("reference_car").parameters
    names = ("ball_joint_y", "tie_rod_outer_z", "spring_rate", "damper_rate", "wheel_mass")
    found = {n: reference[n] * (1.0 + 0.01 * rng.standard_normal(count)) for n in names}
    return found | {"beta1_rate": 0.2 * rng.standard_normal(count)}


def of_all_kinds(car):
    """Return systems of which some fail, in every way in which they can."""
    cars = some_cars(60)
    rng = np.random.default_rng(7)
    cars["road_height"] = rng.choice(["step", "bump"], 60)
    cars["strut_force"] = np.zeros(60)
    cars["strut_force"][5] = -1e6  # the rod comes to its dead point
    cars["beta1_rate"][11] = 1e200  # overflows
    cars["rack_position"] = np.zeros(60)
    cars["rack_position"][17] = 2.0  # a loop is open from the beginning
    cars["damper_rate"][23] = 1e9  # so stiff that it takes too many steps
    for axis in "xyz":  # of no strut
        own = cars.setdefault(
            f"ball_joint_{axis}", np.full(60, car.parameters[f"ball_joint_{axis}"])
        )
        own[29] = car.parameters[f"strut_top_{axis}"]
    cars["spring_rate"][31] = -1.0  # out of its range
    options = {
        "inputs": {"road_height": {"step": STEP, "bump": BUMP}},
        "signals": ["camber", "tyre_force"],
        "reductions": {
            "tyre_force": ["max", "min", "mean", "rms", ("above", 3000.0), ("percentile", 90.0)],
            "wheel_center_z": [("psd", 16), ("percentile", 12.5)],
        },
        "t_eval": TIMES,
        "max_steps": 3000,
    }
    return cars, options


def same(one, other):
    """Demand the same bits in all results."""
    assert set(one.data_vars) == set(other.data_vars)
    for name, found in one.data_vars.items():
        expected = other[name].values
        if expected.dtype == object:
            assert found.values.tolist() == expected.tolist()
        else:
            assert found.values.tobytes() == expected.tobytes(), name
