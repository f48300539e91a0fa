"""Axles with other values: their sections, changes of one side or both, files that they write."""

import tomllib

import pytest
from kintrafo import Axle, InputError, Suspension
from kintrafo.vehicle.input.toml_writer import toml_text

BAR = Axle.load("reference_axle").to_dict()["anti_roll_bar"]
LEFT_BAR = BAR | {name: [BAR[name][0], -BAR[name][1], BAR[name][2]] for name in
                  ("bush", "link_top", "link_foot")}  # fmt: skip
LEFT_CAR = Suspension.load("reference_car").mirrored()
AXLES = {
    "symmetric": Axle.load("reference_axle"),
    "by its left side": Axle.from_dict(
        {"axle": "front", "side": LEFT_CAR, "anti_roll_bar": LEFT_BAR | {"axis": [0.1, 1.0, 0.0]}}
    ),
    "rear": Axle.from_dict({"axle": "rear", "side": "trailing_arm_car"}),
    "steered by a curve": Axle.from_dict(
        {
            "axle": "front", "side": "reference_car", "drive": {"share": 0.6},
            "steering": {"angle_deg": [-180.0, 0.0, 180.0], "rack_mm": [-20.0, 0.0, 20.0]},
        }
    ),
}  # fmt: skip
CENTER = "hardpoints.wheel_center"


@pytest.mark.parametrize("name", AXLES)
def test_sections_and_file_give_the_same_axle(name):
    axle = AXLES[name]
    assert Axle.from_dict(axle.to_dict()) == axle
    assert Axle.from_dict(tomllib.loads(toml_text(axle))) == axle


@pytest.mark.parametrize("name", AXLES)
def test_sides_move_together_or_apart(name, refused):
    axle = AXLES[name]
    x = axle.right.hardpoints.wheel_center[0] + 3.0
    both = axle.with_changes({f"side.{CENTER}.x": x})
    assert both.symmetric
    assert [s.hardpoints.wheel_center[0] for s in both.sides.values()] == [x, x]
    apart = axle.with_changes({f"left.{CENTER}.x": x})
    assert not apart.symmetric
    assert apart.right == axle.right
    assert apart.left == both.left
    assert Axle.from_dict(apart.to_dict()) == apart
    for side, half in axle.halves.items():
        moved = apart.halves[side]
        for key in ("axis", "bush", "top", "foot"):
            assert getattr(moved, key) == pytest.approx(getattr(half, key), abs=1e-15), key
    # of one whose sides are apart each has its own name
    again = apart.with_changes({f"right.{CENTER}.x": x})
    assert again.right == both.right
    refused(InputError, lambda: apart.with_changes({f"side.{CENTER}.x": x}))


def test_a_bar_has_values_of_its_own():
    axle = AXLES["symmetric"]
    stiff = axle.with_changes({"anti_roll_bar.rate_Nm_per_deg": 55.0, "anti_roll_bar.bush.x": 90.0})
    assert (stiff.bar.rate_Nm_per_deg, stiff.bar.bush[0]) == (55.0, 90.0)
    assert stiff.sides == axle.sides
    assert axle.with_changes({"anti_roll_bar": None}).bar is None


@pytest.mark.parametrize(
    "changes",
    [
        {"anti_roll_bar.rate": 1.0},
        {"anti_rol_bar.rate_Nm_per_deg": 1.0},
        {"left.hardpoints.wheel_centre.x": 1.0},
        {f"side.{CENTER}.y": 700.0},
        {3: 1.0},
    ],
)
def test_what_cannot_be_is_refused(changes, refused):
    refused(InputError, lambda: AXLES["symmetric"].with_changes(changes))
