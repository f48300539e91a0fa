"""The push-rod suspension: the wheel of a double wishbone, and a spring that a rocker moves.

`test_mechanisms` compares its equations with maximal coordinates, like those of every model.
"""

import numpy as np
import pytest
from kintrafo import Axle, InputError, Model, Suspension, characteristics
from kintrafo.vehicle.models.points import hardpoints
from kintrafo.vehicle.models.positions import arm_angles, design_height
from kintrafo.vehicle.models.reach import at_rest
from scipy.optimize import brentq

CAR = Suspension.load("push_rod_car")
PULL = Suspension.load("pull_rod_car")
WISHBONES = Suspension.load("double_wishbone_car")
MODEL = Model(CAR)
TRAVELS = np.linspace(-0.07, 0.07, 15)


ROCKERS = pytest.mark.parametrize("car", [CAR, PULL], ids=["push", "pull"])


def points_at(travels, car=CAR):
    """Return the hardpoints at wheel travels."""
    model = Model(car)
    angles = arm_angles(model, design_height(model) + travels)
    return hardpoints(model, *at_rest(model, angles))


def turned(place, turn, car=CAR):
    """Return where a point of the rocker goes, by Rodrigues' formula."""
    design = car.hardpoints.at_design()
    axis = design["rocker_front"] - design["rocker_rear"]
    axis /= np.linalg.norm(axis)
    arm = place - design["rocker_rear"]
    across = np.cross(axis, arm)
    along = axis * (axis @ arm)
    arm = along + (arm - along) * np.cos(turn) + across * np.sin(turn)
    return design["rocker_rear"] + arm


@ROCKERS
def test_the_rocker_is_where_the_rod_holds_it(car):
    """Against a search for the angle at which the rod has its length."""
    design, found = car.hardpoints.at_design(), points_at(TRAVELS, car)
    outer, inner = car.hardpoints.ROD
    length = car.hardpoints.distance(outer, inner)
    for i in range(TRAVELS.size):
        foot = found[outer][i]

        def misfit(turn, foot=foot):
            return float(np.linalg.norm(turned(design[inner], turn, car) - foot) - length)

        turn = brentq(misfit, -0.9, 0.9, xtol=1e-14)
        for name in (inner, "spring_seat"):
            # an angle to 1e-14, and the rounding of a solution with a condition of ten
            expected = turned(design[name], turn, car)
            np.testing.assert_allclose(found[name][i], expected, atol=1e-12)


@ROCKERS
def test_the_wheel_is_guided_as_by_the_double_wishbone(car):
    one = characteristics.over(Model(car), "travel", TRAVELS)
    two = characteristics.over(Model(WISHBONES), "travel", TRAVELS)
    for name in ("camber", "toe", "caster", "roll_center_height_kinematic", "anti_dive", "trail"):
        np.testing.assert_allclose(one[name], two[name], rtol=1e-9, atol=1e-12)
    assert float(abs(one["motion_ratio"] - two["motion_ratio"]).max()) > 0.05


@ROCKERS
def test_motion_ratio_and_wheel_rate_are_derivatives(car):
    fine = np.linspace(-0.07, 0.07, 1401)  # differences of second order over 0.2 mm
    curves = characteristics.over(Model(car), "travel", fine)
    found = points_at(fine, car)
    length = np.linalg.norm(found["spring_top"] - found["spring_seat"], axis=1)
    np.testing.assert_allclose(curves["spring_length"], length, rtol=1e-12)
    ratio = -np.gradient(length, fine)
    inner = slice(1, -1)
    np.testing.assert_allclose(curves["motion_ratio"][inner], ratio[inner], atol=1e-6)
    free = car.spring.free_length(car.hardpoints.distance("spring_seat", "spring_top"))
    force = car.spring.rate_N_per_m * (free - length)
    rate = np.gradient(force * curves["motion_ratio"].values, fine)
    np.testing.assert_allclose(curves["wheel_rate"][inner], rate[inner], rtol=1e-4)


def test_what_the_equations_have_is_read_from_the_file():
    """Stops, curve, friction and lift-off come without other equations."""
    stopped = CAR.with_changes(
        {
            "bump_stop": {"clearance_mm": 10.0, "rate_N_per_m": 1e5},
            "damper.friction_N": 40.0,
            "tyre.lifts_off": True,
        }
    )
    model = Model(stopped)
    assert model.equations is MODEL.equations
    rates = [characteristics.over(m, "travel", [0.05])["wheel_rate"].item() for m in (MODEL, model)]
    assert rates[1] > rates[0] + 2e4
    assert set(CAR.parameters()) == set(MODEL.equations.PARAMETERS)


def test_what_cannot_be_is_refused(refused):
    for suspension, rod in ((CAR, "push_rod"), (PULL, "pull_rod")):
        at = suspension.hardpoints
        for place, value in (
            ("hardpoints.rocker_rear", at.rocker_front),
            (f"hardpoints.{rod}_inner", getattr(at, f"{rod}_outer")),
            (f"hardpoints.{rod}_inner", at.rocker_front),
            ("hardpoints.spring_seat", at.rocker_front),
            (f"bodies.{rod}.mass_kg", 1.0),
        ):
            with refused(InputError):
                suspension.with_changes({place: value})
    refused(InputError, lambda: Model(CAR, free_rack=True))


def test_an_axle_of_push_rods():
    bar = {
        "unit": "mm",
        "bush": [-250.0, -380.0, 260.0],
        "link_top": [-60.0, -400.0, 300.0],
        "link_foot": [-20.0, -345.0, 520.0],
        "link_on": "rocker",
        "rate_Nm_per_deg": 10.0,
    }
    axle = Axle.from_dict({"axle": "rear", "side": CAR, "anti_roll_bar": bar})
    found = characteristics.over(axle, "roll", np.deg2rad([-1.0, 0.0, 1.0]))
    assert float(found["bar_share"][1]) > 0.0
    np.testing.assert_allclose(found["roll_moment"][0], -found["roll_moment"][2], rtol=1e-9)
