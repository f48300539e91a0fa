"""The trailing arm: one hinge, by Rodrigues' rotation and the balance of one body, by hand.

`test_mechanisms` compares its equations with maximal coordinates, like those of every model;
`test_compliance` and `test_deflection` its bushes.
"""

from typing import Any

import numpy as np
import pytest
from kintrafo import (
    Axle,
    AxleModel,
    InputError,
    Model,
    PositionError,
    Suspension,
    arm_angles,
    characteristics,
    equilibrium,
    loads,
    state_at_height,
    travel_range,
)
from kintrafo.vehicle.analysis.compare import compare
from kintrafo.vehicle.analysis.sweep import positions
from kintrafo.vehicle.assembly.by_wheel import flat
from kintrafo.vehicle.assembly.usual import usual_rack
from kintrafo.vehicle.models.positions import design_height
from kintrafo.vehicle.studies import sensitivity

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


def turned(vector: np.ndarray, axis: np.ndarray, angle: float) -> np.ndarray:
    """Rodrigues' formula."""
    along = axis * (axis @ vector)
    return along + np.cos(angle) * (vector - along) + np.sin(angle) * np.cross(axis, vector)


def hinge(car: Suspension) -> tuple[np.ndarray, np.ndarray]:
    """Return a point of the hinge and its direction."""
    inner, outer = (car.hardpoints.metres(f"arm_{end}") for end in ("inner", "outer"))
    return inner, (outer - inner) / np.linalg.norm(outer - inner)


def angle_for(car: Suspension, travel: float) -> float:
    """Return the angle about the hinge that lifts the wheel centre, the smaller of two."""
    start, axis = hinge(car)
    arm = car.hardpoints.metres("wheel_center") - start
    along = axis * (axis @ arm)
    # z = a + b cos + c sin
    a, b, c = along[2], (arm - along)[2], np.cross(axis, arm)[2]
    middle, swing = np.arctan2(c, b), np.arccos((arm[2] + travel - a) / np.hypot(b, c))
    found = [(angle + np.pi) % (2.0 * np.pi) - np.pi for angle in (middle - swing, middle + swing)]
    return float(min(found, key=abs))


def spin_outboard(car: Suspension) -> np.ndarray:
    """Return the spin axis at design, by the definitions of camber and toe."""
    camber, toe = np.radians([car.wheel.camber_deg, car.wheel.toe_deg])
    axis = np.array([np.tan(toe), car.vehicle.sign, -np.tan(camber)])
    return np.asarray(axis / np.linalg.norm(axis))


def wheel_at(car: Suspension, travel: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return wheel centre, spin axis pointing outboard, and contact."""
    (start, axis), angle = hinge(car), angle_for(car, travel)
    center = start + turned(car.hardpoints.metres("wheel_center") - start, axis, angle)
    spin = turned(spin_outboard(car), axis, angle)
    upward = UP - (UP @ spin) * spin
    return center, spin, center - 0.3 * upward / np.linalg.norm(upward)


# -- where the wheel goes -----------------------------------------------------------------------


@pytest.mark.parametrize("name", CARS)
def test_wheel_swings_about_the_hinge(name: str) -> None:
    car = CARS[name]
    side, model = car.vehicle.sign, Model(car)
    found, path = characteristics.over(model, "travel", TRAVELS), positions(model, TRAVELS)
    _, _, at_design = wheel_at(car, 0.0)
    # roundings of lengths and angles below 1
    near: dict[str, float] = {"rtol": 0.0, "atol": 1e-13}
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


@pytest.mark.parametrize("name", CARS)
def test_instant_centres_are_where_the_hinge_passes(name: str) -> None:
    """Seen from the front, the hinge pierces the plane across through the contact; so from aside.

    In the plane the part of the turning along it does nothing, which leaves a turn about a point.
    """
    car = CARS[name]
    start, axis = hinge(car)
    found = characteristics.over(Model(car), "travel", TRAVELS)
    given = car.vehicle
    lever = 2600.0 / 550.0 * 0.3  # as the file has them
    for i, travel in enumerate(TRAVELS):
        _, _, contact = wheel_at(car, travel)
        aside = start + axis * (contact - start)[1] / axis[1] - contact
        slope = aside[2] / -aside[0]  # the path is at right angles to the arm to the centre
        np.testing.assert_allclose(
            found["side_view_swing_arm_angle"][i], np.arctan(slope), rtol=1e-11
        )
        np.testing.assert_allclose(found["anti_lift_braked"][i], lever * -slope, rtol=1e-11)
        if name == "across":
            # parallel to the plane: the wheel moves straight, seen from the front
            assert np.isinf(found["swing_arm_length_kinematic"][i])
            assert abs(found["roll_center_height_kinematic"][i]) < 1e-13
            continue
        front = start + axis * (contact - start)[0] / axis[0] - contact
        np.testing.assert_allclose(
            found["swing_arm_length_kinematic"][i], -given.sign * front[1], rtol=1e-11
        )
        height = front[2] * contact[1] / -front[1]
        np.testing.assert_allclose(
            found["roll_center_height_kinematic"][i], height, rtol=1e-11, atol=1e-13
        )


def test_reach_ends_where_the_wheel_turns_back() -> None:
    """The highest wheel centre: amplitude of a + b cos + c sin."""
    start, axis = hinge(CAR)
    arm = CAR.hardpoints.metres("wheel_center") - start
    along = axis * (axis @ arm)
    highest = (start + along)[2] + np.hypot((arm - along)[2], np.cross(axis, arm)[2])
    # 1e-12 rad before it, of a parabola
    assert travel_range(Model(CAR)).height[1] == pytest.approx(highest, abs=1e-13)
    with pytest.raises(PositionError, match="out of reach") as refused:
        state_at_height(Model(CAR), highest + 0.001)
    assert "rack" not in str(refused.value)


def test_angle_of_the_arm_falls_as_the_wheel_rises() -> None:
    for car in CARS.values():
        model = Model(car)
        angles = arm_angles(model, design_height(model) + TRAVELS)
        assert (np.diff(angles) < 0.0).all()
        expected = [abs(angle_for(car, travel)) for travel in TRAVELS]
        np.testing.assert_allclose(np.abs(angles - model.design_state[0]), expected, atol=1e-13)


# -- what it carries ----------------------------------------------------------------------------


@pytest.mark.parametrize("name", CARS)
def test_bearings_balance_the_arm(name: str) -> None:
    """Spring by the moment about the hinge, then force and moment of both bearings together."""
    car = CARS[name]
    case: dict[str, Any] = {"corner": {"contact_N": [700.0, 900.0, 0.0], "travel_mm": 20.0}}
    found = loads.static(Model(car), case)
    start, axis = hinge(car)
    angle = angle_for(car, 0.02)
    center, spin, contact = wheel_at(car, 0.02)

    def carried(place: np.ndarray) -> np.ndarray:
        return np.asarray(start + turned(place - start, axis, angle))

    forward = np.cross(car.vehicle.sign * spin, UP)
    forward /= np.linalg.norm(forward)
    part = car.bodies.rigid()["trailing_arm"]
    weights = -9.81 * UP * part.mass_kg, -9.81 * UP * car.bodies.wheel.mass_kg
    road = 700.0 * forward + 900.0 * np.cross(UP, forward)
    seat, top = carried(car.hardpoints.metres("spring_seat")), car.hardpoints.metres("spring_top")
    along = (seat - top) / np.linalg.norm(seat - top)
    length = np.linalg.norm(car.hardpoints.metres("spring_seat") - top) - np.linalg.norm(seat - top)
    assert car.spring.force_at_design_N is not None
    spring = (car.spring.force_at_design_N + car.spring.rate_N_per_m * length) * along
    known = [
        (road, contact),
        (weights[0], carried(part.centre_of_mass(car.hardpoints))),
        (weights[1], center),
        (spring, seat),
    ]
    # the wheel is held there: the road pushes as it needs
    missing = sum(axis @ np.cross(at - start, force) for force, at in known)
    known.append((-missing / (axis @ np.cross(contact - start, UP)) * UP, contact))
    total = sum(force for force, _ in known)
    moment = sum(np.cross(at - start, force) for force, at in known)
    one = found.isel(load=((found["part"] == "trailing_arm") & (found["by"] == "chassis")).values)
    force, at = one["force"].values[0], one["at"].values[0]
    assert force.shape == (2, 3)
    # of some 10 kN, with the spring's force to a rounding of its length
    np.testing.assert_allclose(force.sum(0), -total, rtol=0.0, atol=1e-7)
    np.testing.assert_allclose(np.cross(at - start, force).sum(0), -moment, rtol=0.0, atol=1e-7)
    np.testing.assert_allclose(*(force @ axis), rtol=0.0, atol=1e-7)


def test_rests_where_its_moments_balance() -> None:
    """Vertical load at rest from weights and spring about the hinge."""
    model = Model(CAR)
    rest = equilibrium(model)
    start, axis = hinge(CAR)
    travel = float(model.signal("wheel_center_z", rest)) - design_height(model)
    center, spin, _ = wheel_at(CAR, travel)
    upward = UP - (UP @ spin) * spin
    tyre = float(model.signal("tyre_force", rest)) * upward / np.linalg.norm(upward)
    part = CAR.bodies.rigid()["trailing_arm"]
    seat, top = CAR.hardpoints.metres("spring_seat"), CAR.hardpoints.metres("spring_top")
    spring = float(model.signal("spring_force", rest)) * (seat - top) / np.linalg.norm(seat - top)
    assert abs(travel) < 1e-8
    forces = [
        (tyre, center),
        (-9.81 * part.mass_kg * UP, part.centre_of_mass(CAR.hardpoints)),
        (-9.81 * CAR.bodies.wheel.mass_kg * UP, center),
        (spring, seat),
    ]
    moments = [axis @ np.cross(at - start, force) for force, at in forces]
    # the travel of some nanometres turns nothing that matters: 1e-8 of the moments
    assert abs(sum(moments)) < 1e-6 * max(map(abs, moments))


# -- not steered --------------------------------------------------------------------------------


def test_what_belongs_to_steering_is_not_there() -> None:
    model = Model(CAR)
    found = characteristics.over(model, "travel", TRAVELS)
    assert not OF_STEERING & set(found)
    assert "rack_position" not in found.coords
    assert "rack_position" not in positions(model, TRAVELS).coords
    assert all(np.isfinite(values).all() for values in found.values())
    words = f"{CAR.to_dict()} {model.equations.STATE} {model.equations.INPUTS} {model.parameters}"
    for word in ("rack", "tie_rod", "knuckle"):
        assert word not in words.replace("bracket", "").replace("half_track", ""), word


@pytest.mark.parametrize(
    "ask",
    [
        lambda model: characteristics.over(model, "rack"),
        lambda model: characteristics.over(model, "rack", [0.0]),
        lambda model: characteristics.over(model, "travel", TRAVELS, rack_position=0.005),
        lambda model: positions(model, [0.0], [0.0, 0.01]),
        usual_rack,
        lambda model: equilibrium(model, rack_position=-0.001),
        lambda model: travel_range(model, 0.01),
        lambda _: sensitivity(CAR, ["hardpoints.arm_inner.z"], over="rack"),
        lambda model: compare({"one": model, "other": Model("multi_link_car")}, over="rack"),
        lambda model: loads.static(model, {"a": {"contact_N": [0, 0, 3e3], "rack_mm": 5.0}}),
    ],
)
def test_what_moves_a_rack_is_refused(ask: Any) -> None:
    with pytest.raises(InputError, match="not steered"):
        ask(Model(CAR))


@pytest.mark.parametrize("name", sorted(OF_STEERING & {"caster", "scrub_radius", "steering_ratio"}))
def test_characteristics_of_steering_are_refused_by_name(name: str) -> None:
    with pytest.raises(InputError, match=f"{name}: this suspension is not steered"):
        sensitivity(CAR, ["hardpoints.arm_inner.z"], names=[name])


def test_free_rack_a_section_and_a_bush_of_it_are_refused() -> None:
    with pytest.raises(InputError, match="is not steered"):
        Model(CAR, free_rack=True)
    with pytest.raises(InputError, match="rack"):
        Suspension.from_dict(CAR.to_dict() | {"rack": {"axis": [0.0, 1.0, 0.0]}})
    with pytest.raises(InputError, match="'rack' is not known"):
        CAR.with_changes({"bushings": {"rack": {"axial_N_per_mm": 1e4}}})


def test_comparison_shows_what_both_have() -> None:
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
def test_arms_that_cannot_move_are_refused(changes: dict[str, Any], refused: Any) -> None:
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


def test_axle_has_no_rack_between_its_sides() -> None:
    axle = Axle.from_dict(REAR | {"anti_roll_bar": BAR})
    found = flat(characteristics.over(axle, "bump", TRAVELS))
    one = characteristics.over(Model(CAR), "travel", TRAVELS)
    np.testing.assert_allclose(found["camber_left"], one["camber"], rtol=0.0, atol=1e-13)
    assert "rack_position" not in found.coords
    with pytest.raises(InputError, match="'steer': this suspension is not steered"):
        characteristics.over(axle, "steer")
    with pytest.raises(InputError, match="not steered"):
        Axle.from_dict(REAR | {"steering": {"angle_deg": [-90.0, 90.0], "rack_mm": [-9.0, 9.0]}})
    held = loads.static(axle, {"corner": {"contact_g": [0.0, 0.5, 1.0]}}, static_load=3400.0)
    assert "rack" not in held["part"].values
    assert "rack_force" not in held


def test_equations_of_an_axle_are_those_of_its_sides() -> None:
    """Without a bar, both sides move by themselves."""
    both, one = AxleModel(Axle.from_dict(REAR)), Model(CAR)
    assert not [name for name in both.input_names if "rack" in name]
    state = np.array([*both.design_state])
    rates = {"arm_angle": 0.7, "spin_angle": -30.0}
    single = one.design_state.copy()
    for name, rate in rates.items():
        single[one.state_names.index(f"{name}_rate")] = rate
        for side in ("right", "left"):
            state[both.state_names.index(f"{side}_{name}_rate")] = rate
    expected = one.evaluate("rhs", single, one.inputs({"road_height": 0.01}))
    roads = {f"{side}_road_height": 0.01 for side in ("right", "left")}
    found = both.evaluate("rhs", state, both.inputs(roads))
    for name in one.state_names:
        for side in ("right", "left"):
            ours = found[both.state_names.index(f"{side}_{name}")]
            assert ours == pytest.approx(expected[one.state_names.index(name)], rel=1e-9, abs=1e-9)


# -- its page -----------------------------------------------------------------------------------


def test_commands_that_steer_refuse_it(kintrafo: Any) -> None:
    for asked in (["characteristics", "--of", "caster"], ["simulate", "--rack-sine", "3"]):
        command, *options = asked
        code, out, err = kintrafo(command, "trailing_arm_car", *options)
        assert code != 0
        assert "not steered" in out + err
