"""The trailing arm: one hinge, by Rodrigues' rotation, and what it has not.

`test_mechanisms` compares its equations with maximal coordinates, like those of every model;
`test_compliance` and `test_deflection` its bushes.
"""

import numpy as np
import pytest
from kintrafo import (
    Axle,
    InputError,
    Model,
    PositionError,
    Suspension,
    characteristics,
    loads,
    state_at_height,
    travel_range,
)
from kintrafo.vehicle.analysis.compare import compare
from kintrafo.vehicle.analysis.sweep import positions
from kintrafo.vehicle.assembly.by_wheel import flat

CAR = Suspension.load("trailing_arm_car")
ACROSS = CAR.with_changes(
    {"hardpoints.arm_outer": [380.0, -620.0, 285.0], "wheel.camber_deg": 0.0, "wheel.toe_deg": 0.0}
)
CARS = {"askew": CAR, "left": CAR.mirrored(), "across": ACROSS}
TRAVELS = np.linspace(-0.1, 0.1, 9)
UP = np.array([0.0, 0.0, 1.0])
# Characteristics that need steering.
OF_STEERING = {
    "caster", "caster_gradient", "kingpin_inclination", "trail", "steering_axis_offset",
    "scrub_radius", "hub_trail", "spindle_offset", "steer_gradient", "steering_ratio", "ackermann",
    "ackermann_error", "turning_circle",
}  # fmt: skip


def turned(vector, axis, angle):
    """Rodrigues' formula."""
    along = axis * (axis @ vector)
    return along + np.cos(angle) * (vector - along) + np.sin(angle) * np.cross(axis, vector)


def hinge(car):
    """Return a point of the hinge and its direction."""
    inner, outer = (car.hardpoints.metres(f"arm_{end}") for end in ("inner", "outer"))
    return inner, (outer - inner) / np.linalg.norm(outer - inner)


def angle_for(car, travel):
    """Return the angle about the hinge that lifts the wheel centre, the smaller of two."""
    start, axis = hinge(car)
    arm = car.hardpoints.metres("wheel_center") - start
    along = axis * (axis @ arm)
    # z = a + b cos + c sin
    a, b, c = along[2], (arm - along)[2], np.cross(axis, arm)[2]
    middle, swing = np.arctan2(c, b), np.arccos((arm[2] + travel - a) / np.hypot(b, c))
    found = [(angle + np.pi) % (2.0 * np.pi) - np.pi for angle in (middle - swing, middle + swing)]
    return float(min(found, key=abs))


def spin_outboard(car):
    """Return the spin axis at design, by the definitions of camber and toe."""
    camber, toe = np.radians([car.wheel.camber_deg, car.wheel.toe_deg])
    axis = np.array([np.tan(toe), car.vehicle.sign, -np.tan(camber)])
    return np.asarray(axis / np.linalg.norm(axis))


def wheel_at(car, travel):
    """Return wheel centre, spin axis pointing outboard, and contact."""
    (start, axis), angle = hinge(car), angle_for(car, travel)
    center = start + turned(car.hardpoints.metres("wheel_center") - start, axis, angle)
    spin = turned(spin_outboard(car), axis, angle)
    upward = UP - (UP @ spin) * spin
    return center, spin, center - 0.3 * upward / np.linalg.norm(upward)


# -- where the wheel goes -----------------------------------------------------------------------


@pytest.mark.parametrize("name", CARS)
def test_wheel_swings_about_the_hinge(name):
    car = CARS[name]
    side, model = car.vehicle.sign, Model(car)
    found, path = characteristics.over(model, "travel", TRAVELS), positions(model, TRAVELS)
    _, _, at_design = wheel_at(car, 0.0)
    # roundings of lengths and angles below 1
    near = {"rtol": 0.0, "atol": 1e-13}
    for i, travel in enumerate(TRAVELS):
        center, spin, contact = wheel_at(car, travel)
        ours = [path[f"wheel_center_{axis}"].values[i] for axis in "xyz"]
        np.testing.assert_allclose(ours, center, **near)
        angles = {
            "camber": np.arctan2(-spin[2], side * spin[1]),
            "toe": np.arctan2(spin[0], side * spin[1]),
            "half_track_change": side * (contact - at_design)[1],
            "wheelbase_change": center[0] - car.hardpoints.metres("wheel_center")[0],
        }
        for quantity, expected in angles.items():
            np.testing.assert_allclose(found[quantity].values[i], expected, **near)


def test_reach_ends_where_the_wheel_turns_back(refused):
    """The highest wheel centre: amplitude of a + b cos + c sin."""
    start, axis = hinge(CAR)
    arm = CAR.hardpoints.metres("wheel_center") - start
    along = axis * (axis @ arm)
    highest = (start + along)[2] + np.hypot((arm - along)[2], np.cross(axis, arm)[2])
    # 1e-12 rad before it, of a parabola
    assert travel_range(Model(CAR)).height[1] == pytest.approx(highest, abs=1e-13)
    refused(PositionError, lambda: state_at_height(Model(CAR), highest + 0.001))


# -- not steered --------------------------------------------------------------------------------


def test_what_belongs_to_steering_is_not_there():
    model = Model(CAR)
    found = characteristics.over(model, "travel", TRAVELS)
    assert not OF_STEERING & set(found)
    assert "rack_position" not in found.coords
    assert "rack_position" not in positions(model, TRAVELS).coords
    assert all(np.isfinite(values).all() for values in found.values())
    words = f"{CAR.to_dict()} {model.equations.STATE} {model.equations.INPUTS} {model.parameters}"
    for word in ("rack", "tie_rod", "knuckle"):
        assert word not in words.replace("bracket", "").replace("half_track", ""), word


def test_free_rack_a_section_and_a_bush_of_it_are_refused(refused):
    refused(InputError, lambda: Model(CAR, free_rack=True))
    with pytest.raises(InputError, match="rack"):
        Suspension.from_dict(CAR.to_dict() | {"rack": {"axis": [0.0, 1.0, 0.0]}})
    refused(InputError, lambda: CAR.with_changes({"bushings": {"rack": {"axial_N_per_mm": 1e4}}}))


def test_comparison_shows_what_both_have():
    found = compare({"arm": Model(CAR), "links": Model("multi_link_car")}, TRAVELS)
    assert not OF_STEERING & set(found)
    assert np.isfinite(found["camber"].values).all()


# -- mechanisms that cannot move ----------------------------------------------------------------


@pytest.mark.parametrize(
    "changes",
    [
        {"wheel_center": [500.0, -620.0, 280.0]},
        {"wheel_center": [560.0, -805.0, 277.5]},
        {"arm_outer": [380.0, -250.0, 600.0]},
        {"wheel_center": [440.0, -435.0, 100.0]},
        {"spring_top": [110.0, -505.0, 235.0]},
    ],
)
def test_arms_that_cannot_move_are_refused(changes, refused):
    refused(
        InputError,
        lambda: CAR.with_changes({f"hardpoints.{name}": place for name, place in changes.items()}),
    )


# -- two of them --------------------------------------------------------------------------------

BAR = {
    "unit": "mm", "bush": [250.0, -400.0, 300.0], "link_top": [100.0, -560.0, 350.0],
    "link_foot": [100.0, -600.0, 260.0], "link_on": "trailing_arm", "rate_Nm_per_deg": 20.0,
}  # fmt: skip
REAR = {"axle": "rear", "side": CAR}


def test_axle_has_no_rack_between_its_sides(refused):
    axle = Axle.from_dict(REAR | {"anti_roll_bar": BAR})
    found = flat(characteristics.over(axle, "bump", TRAVELS))
    one = characteristics.over(Model(CAR), "travel", TRAVELS)
    np.testing.assert_allclose(found["camber_left"], one["camber"], rtol=0.0, atol=1e-13)
    assert "rack_position" not in found.coords
    refused(
        InputError,
        lambda: Axle.from_dict(
            REAR | {"steering": {"angle_deg": [-90.0, 90.0], "rack_mm": [-9.0, 9.0]}}
        ),
    )
    held = loads.static(axle, {"corner": {"contact_g": [0.0, 0.5, 1.0]}}, static_load=3400.0)
    assert "rack" not in held["part"].values
    assert "rack_force" not in held


# -- its page -----------------------------------------------------------------------------------


def test_commands_that_steer_refuse_it(kintrafo):
    for asked in (["characteristics", "--of", "caster"], ["simulate", "--rack-sine", "3"]):
        command, *options = asked
        code, out, err = kintrafo(command, "trailing_arm_car", *options)
        assert code != 0
        assert "not steered" in out + err
