"""Studies of axles: values of one side and its image, of either side, of the anti-roll bar."""

import numpy as np
import pytest
from kintrafo import Axle, InputError, RigidAxle, Suspension, characteristics, load, variation
from kintrafo.vehicle.analysis.scenario import Scenario
from kintrafo.vehicle.assembly.by_wheel import flat

AXLE = Axle.load("reference_axle")
CAR = Suspension.load("reference_car")
AT = np.array([-0.03, 0.0, 0.04])
ROD = "hardpoints.tie_rod_outer.z"
RATE = "anti_roll_bar.rate_Nm_per_deg"
# Differences of four neighbours, over the largest value of a curve: their rounding.
CLOSE = 1e-7


def test_both_sides_move_as_one_of_them_does():
    names = ["bump_steer", "camber"]
    wanted = variation.sensitivity(CAR, [ROD], names=names, positions=AT)
    columns = [f"{name}_{side}" for name in names for side in ("left", "right")]
    found = variation.sensitivity(AXLE, [ROD], names=columns, positions=AT)
    assert found["place"].values.tolist() == [f"side.{ROD}"]
    for name in names:
        scale = CLOSE * abs(wanted[name]).max().item()
        for side in ("left", "right"):
            np.testing.assert_allclose(found[f"{name}_{side}"], wanted[name], rtol=0.0, atol=scale)


def test_a_side_alone_moves_its_own_wheel():
    columns = ["toe_left", "toe_right"]
    both = variation.sensitivity(AXLE, [f"side.{ROD}"], names=columns, positions=AT)
    found = variation.sensitivity(AXLE, [f"left.{ROD}"], names=columns, positions=AT)
    np.testing.assert_allclose(found["toe_left"], both["toe_left"], rtol=1e-6)
    assert not found["toe_right"].any()


def test_a_bar_has_a_share_of_the_roll_stiffness():
    """It is in proportion to its rate, so that the derivative is the share over the rate."""
    found = variation.sensitivity(
        AXLE, [RATE], over="roll", names=["roll_stiffness", "camber_left"], positions=[0.0]
    )
    share = characteristics.over(AXLE, "roll", [0.0])["roll_stiffness_bar"].item()
    assert found["roll_stiffness"].item() == pytest.approx(share / AXLE.bar.rate(), rel=1e-8)
    assert found["camber_left"].item() == 0.0


def test_sections_stand_for_one_side_and_its_image():
    """Each side apart is asked for by its name."""
    found = variation.sensitivity(AXLE, ["*.wheel_center"], names=["camber_left"], positions=[0.0])
    places = found["place"].values.tolist()
    assert places == [f"side.hardpoints.wheel_center.{axis}" for axis in "xyz"]
    apart = AXLE.with_changes({"left.hardpoints.wheel_center.x": 1.0})
    found = variation.sensitivity(
        apart, ["*.wheel_center.z"], names=["camber_left"], positions=[0.0]
    )
    assert found["place"].values.tolist() == [
        f"{side}.hardpoints.wheel_center.z" for side in ("left", "right")
    ]


def test_many_axles_are_those_of_one_by_one():
    rates = [30.0, 45.0]
    found = variation.cars(
        AXLE, {f"right.{ROD}": [238.0, 243.0], RATE: rates}, over="roll", positions=[0.0, 0.02]
    )
    for i, rate in enumerate(rates):
        one = AXLE.with_changes({f"right.{ROD}": [238.0, 243.0][i], RATE: rate})
        expected = flat(characteristics.over(one, "roll", [0.0, 0.02]))
        for name in ("toe_right", "roll_stiffness", "bar_torque"):
            np.testing.assert_allclose(found[name][i], expected[name], rtol=1e-12, atol=1e-15)


def test_tolerances_of_both_sides_are_independent():
    """So the toe of both wheels varies alike, and with no common part."""
    found = variation.tolerance(
        AXLE, {f"left.{ROD}": 1.0, f"right.{ROD}": 1.0}, count=60, positions=[0.0],
        names=["toe_left", "toe_right"], seed=3,
    )  # fmt: skip
    spans = [np.ptp(found[f"toe_{side}"].values) for side in ("left", "right")]
    assert min(spans) > 0.0
    assert spans[0] == pytest.approx(spans[1], rel=0.5)


def test_a_bar_is_found_that_has_a_roll_stiffness():
    stiffness = characteristics.over(AXLE.with_changes({RATE: 25.0}), "roll", [0.0])
    wanted = stiffness["roll_stiffness"].item() * np.pi / 180.0
    target = {"over": "roll", "at_deg": 0.0, "value": wanted, "within": 1e-4 * wanted}
    found = variation.optimise(AXLE, {RATE: 15.0}, {"roll_stiffness": target})
    assert isinstance(found.suspension, Axle)
    assert found.suspension.bar.rate_Nm_per_deg == pytest.approx(25.0, rel=1e-3)


STEERED = {
    "reference_axle": "side.hardpoints.tie_rod_inner.x",
    "steered_rigid_axle": "hardpoints.track_rod.x",
}


@pytest.mark.parametrize("name", STEERED)
@pytest.mark.parametrize(("over", "end"), [("steer", 1.5), ("rack", 0.02)])
def test_a_steered_axle_is_studied_over_its_steering(name, over, end):
    axle, place, along = load(name), STEERED[name], np.array([-end, 0.5 * end, end])
    how = {"names": ["ackermann_error"], "over": over, "positions": along}
    found = variation.sensitivity(axle, [place], **how)
    point, _, axis = place.rpartition(".")
    kept = axle.to_dict()
    for part in point.split("."):
        kept = kept[part]
    ends = []
    for by in (-0.1, 0.1):
        there = [x + by * (axis == n) for n, x in zip("xyz", kept, strict=True)]
        moved = axle.with_changes({point: there})
        ends.append(characteristics.over(moved, over, along)["ackermann_error"].values)
    by_differences = (ends[1] - ends[0]) / 0.2e-3
    np.testing.assert_allclose(found["ackermann_error"].values[0], by_differences, rtol=1e-4)


def test_an_axle_without_the_ratio_of_its_steering_is_studied_over_the_rack(refused):
    axle = load("bmw_e90_rear_axle")
    place = "side.hardpoints.wheel_center.z"
    how = {"names": ["camber_left"], "positions": [0.0]}
    assert variation.sensitivity(axle, [place], over="rack", **how)["rack_position"].size == 1
    refused(InputError, lambda: variation.sensitivity(axle, [place], over="steer", **how))


def test_a_grid_of_axles_goes_over_a_road():
    from kintrafo import roads

    road = roads.step(0.01, at=0.02, end=0.1)
    scenario = Scenario(duration=0.1, output_step=0.05, inputs={"left_road_height": road})
    found = variation.sweep(AXLE, {RATE: [20.0, 60.0]}, scenario, signals=["right_strut_length"])
    moved = found["right_strut_length"].values
    # a stiffer bar takes the other wheel along the farther
    assert np.abs(np.diff(moved[:, -1])).item() > 1e-5


WRONG = [
    {"places": ["left.hardpoint"]},
    {"places": ["anti_roll_bar.rate"]},
    {"over": "travel"},
    {"names": ["tow"]},
]


@pytest.mark.parametrize("given", WRONG)
def test_what_an_axle_does_not_have_is_refused(given, refused):
    refused(InputError, lambda: variation.sensitivity(AXLE, **({"positions": [0.0]} | given)))


def test_the_file_of_a_rigid_axle_has_no_sides(refused):
    refused(
        InputError, lambda: variation.sensitivity(RigidAxle.load("rigid_axle"), ["side.hardpoints"])
    )
