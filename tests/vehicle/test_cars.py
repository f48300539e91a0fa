"""Cars: their files, their equations against independent ones, their rest and characteristics."""

import kintrafo
import numpy as np
import pytest
from kintrafo.vehicle.analysis.characteristics import datasets
from kintrafo.vehicle.assembly.car import CarAssembly
from kintrafo.vehicle.models.car import Car
from kintrafo.vehicle.models.car.car import center_of_gravity, masses, suspension_masses
from kintrafo.vehicle.models.car.equations import CarModel, _parameters, declared


@pytest.fixture(scope="module")
def quarter():
    return CarModel(Car.load("quarter_car"))


def test_load_returns_a_car():
    car = kintrafo.load("reference_vehicle")
    assert isinstance(car, Car)
    assert car.coordinates == ("heave", "pitch", "roll")
    assert car.wheels == ("front_left", "front_right", "rear_left", "rear_right")
    assert [round(float(c[0]), 9) for c in car.wheel_centers.values()] == [0.0, 0.0, -2.6, -2.6]


def test_a_car_is_written_and_read_again():
    for name in ("quarter_car", "reference_vehicle"):
        car = Car.load(name)
        assert Car.from_dict(car.to_dict()).to_dict() == car.to_dict()


def test_paths_count_from_the_file(tmp_path):
    kintrafo.load("reference_car").save(tmp_path / "corner.toml")
    (tmp_path / "car.toml").write_text(
        'car = "heave"\ncorner = "corner.toml"\n[body]\nmass_kg = 300.0\n', encoding="utf-8"
    )
    car = kintrafo.load(tmp_path / "car.toml")
    assert car.corner.suspension == "macpherson"


@pytest.mark.parametrize(
    "changes",
    [
        {"wheelbase_mm": 2610.0},
        {"rear_origin_mm": 0.0},
        {"body.mass_kg": 0.0},
        {"body.com_mm.x": 100.0},
        {"body.com_mm": None},
        {"body.inertia_yy_kg_m2": 0.0, "body.inertia_xx_kg_m2": 0.0},
        {"body.colour": 1.0},
        {"corner": "reference_car"},
        {"car": "heave"},
        {"car": "fly"},
        {"front": "rear_axle"},
        {"front": "reference_car.toml"},
        {"front.side.vehicle.wheelbase_mm": 2700.0},
        {"rear.side.vehicle.center_of_gravity_height_mm": 500.0},
        {"rear.side.gravity.acceleration_m_per_s2": 1.62},
        {"front.side.vehicle.front_brake_share": 0.6},
        {"body.com_mm.y": 900.0},
    ],
)
def test_what_contradicts_itself_is_refused(changes, refused):
    refused(kintrafo.InputError, lambda: Car.load("reference_vehicle").with_changes(changes))


def test_what_is_not_taken_is_named():
    car = Car.load("reference_vehicle")
    assert [word.partition(":")[0] for word in car.unused] == ["rear axle"]
    ride = car.with_changes({"car": "ride"})
    assert ride.unused[:2] == ("[body] inertia_xx_kg_m2", "[body] inertia_zz_kg_m2")


def test_the_gravity_centre_is_that_of_all_masses():
    car = Car.load("reference_vehicle")
    assert sum(mass for mass, _ in masses(car)) == pytest.approx(1382.4 + 2 * 42.0 + 2 * 41.5)
    # by the numbers of the files: body, and of both sides arm, knuckle, wheel; arms, knuckle, wheel
    moments = (
        1382.4 * 577.4
        + 2 * (5.0 * 590.0 / 3 + 22.0 * 300.0)
        + 2 * 15.0 * (180.0 + 120.0 * 640.0 / np.sqrt(33.0**2 + 125.0**2 + 640.0**2))
        + 2 * (5.0 * (195.0 + 195.0 + 185.0) / 3 + 2.5 * (500.0 + 474.0 + 505.0) / 3)
        + 2 * (12.0 * 300.0 + 22.0 * 300.0)
    )
    assert 1e3 * center_of_gravity(car)[2] == pytest.approx(moments / (1382.4 + 167.0), abs=1e-9)


def _of_any_car(name):
    """Return the data of an axle without those of the whole vehicle."""
    data = kintrafo.load(name).to_dict()
    for part in (data, data.get("side", {})):
        for key in ("wheelbase_mm", "center_of_gravity_height_mm", "front_brake_share"):
            part.get("vehicle", {}).pop(key, None)
    return data


@pytest.mark.parametrize(
    ("front", "rear"),
    [
        ("reference_axle", "rear_axle"),
        ("reference_axle", "twist_beam"),
        ("steered_rigid_axle", "rigid_axle"),
    ],
)
def test_masses_are_those_of_the_bodies_in_the_equations(front, rear):
    body = Car.load("reference_vehicle").to_dict()["body"]
    data = {"car": "roll", "wheelbase_mm": 2600.0, "rear_origin_mm": -2600.0, "body": body}
    axles = {"front": _of_any_car(front), "rear": _of_any_car(rear)}
    car = Car.from_dict(data | axles)
    formulation = declared(car)
    needed = {p.name: {"unit": p.unit} for p in formulation.mechanism.parameters}
    values = _parameters(car, needed)
    bodies = [one for one in formulation.mechanism.bodies if formulation.has_mass(one.name)]
    weights = [values[one.mass.name] for one in bodies]
    places = [[values[f"{one.com.name}_{axis}"] for axis in "xyz"] for one in bodies]
    assert sum(mass for mass, _ in masses(car)) == pytest.approx(sum(weights), rel=1e-14)
    assert sum(suspension_masses(car).values()) == pytest.approx(sum(weights[1:]), rel=1e-14)
    # rounding, of sums of some 20 products
    center = np.average(places, axis=0, weights=weights)
    np.testing.assert_allclose(center_of_gravity(car), center, rtol=0.0, atol=1e-14)


def test_characteristics_have_the_data_of_the_car():
    """Wheelbase, brakes and masses are those of its file if those of its axles lack them."""
    given = Car.load("reference_vehicle")
    lacking = {"front": _of_any_car("reference_axle"), "rear": _of_any_car("rear_axle")}
    without = Car.from_dict(
        given.to_dict() | lacking | {"brakes": {"front_share": 0.7, "torque_Nm": 9e3}}
    )
    assert "[brakes], except front_share" in without.unused
    found, expected = (datasets.over(car, "heave", [0.0]) for car in (without, given))
    height = float(center_of_gravity(given)[2])
    assert abs(height - 0.55) > 1e-4
    for name in ("anti_dive", "anti_lift_braked", "anti_lift_driven"):
        # rounding of some ten operations
        np.testing.assert_allclose(found[name], 0.55 / height * expected[name], rtol=1e-14)
    assert without.to_dict()["front"] == lacking["front"]
    # data of the car do not become data of its axles, which would then contradict another car
    assert without.axles["front"].vehicle.center_of_gravity_height_mm is None
    frictionless = CarAssembly(without).without_friction().subject
    assert frictionless.axles["front"].vehicle.center_of_gravity_height_mm is None


def test_a_center_of_gravity_below_the_ground_is_not_given_to_axles():
    given = Car.load("reference_vehicle")
    lacking = {"front": _of_any_car("reference_axle"), "rear": _of_any_car("rear_axle")}
    low = Car.from_dict(given.to_dict() | lacking).with_changes(
        {"body.com_mm": [-1300.0, 0.0, -300.0]}
    )
    assert center_of_gravity(low)[2] < 0.0
    assert "anti_dive" not in datasets.over(low, "heave", [0.0])


@pytest.mark.parametrize("end", ["front", "rear"])
def test_a_car_with_different_sides_of_one_axle_is_not_symmetric(end):
    car = Car.load("reference_vehicle")
    assert CarAssembly(car).symmetric
    assert kintrafo.sheet.sheet(car).attrs["sides"] == "mirror images"
    other = car.with_changes({f"{end}.left.tyre.rate_N_per_m": 2e5})
    assert not CarAssembly(other).symmetric
    assert kintrafo.sheet.sheet(other).attrs["sides"] == "different"


def test_a_quarter_car_rests_on_its_spring(quarter):
    state = kintrafo.equilibrium(quarter)
    assert quarter.signal("tyre_force", state) == pytest.approx(
        9.81 * (345.36 + 42.0), rel=1e-12
    )  # of all masses
    raised = kintrafo.equilibrium(quarter, road_height=0.05)
    assert raised[0] - state[0] == pytest.approx(0.05, abs=1e-12)
    assert raised[1] == pytest.approx(state[1], abs=1e-12)


def test_a_car_without_rest_is_refused(refused):
    car = Car.load("quarter_car")
    heavy = car.with_changes({"body.mass_kg": 4000.0})
    refused(kintrafo.PositionError, lambda: kintrafo.equilibrium(CarModel(heavy)))


@pytest.mark.parametrize("motion", ["heave", "pitch", "roll"])
def test_characteristics_are_those_of_the_axles(motion):
    car = Car.load("reference_vehicle")
    along = np.array([-0.02, 0.0, 0.02])
    found = datasets.over(car, motion, along)
    assert found["camber"].dims == ("wheel", *[d for d in found.dims if d not in ("wheel", "axle")])
    for end, lever in (("front", 1.3), ("rear", -1.3)):
        travels = {"heave": -along, "pitch": lever * np.tan(along), "roll": along}[motion]
        own = datasets.over(car.axles[end], "roll" if motion == "roll" else "bump", travels)
        for side in ("left", "right"):
            np.testing.assert_array_equal(
                found["camber"].sel(wheel=f"{end}_{side}"), own["camber"].sel(wheel=side)
            )
        np.testing.assert_array_equal(
            found["roll_center_height"].sel(axle=end), own["roll_center_height"]
        )
    assert np.isnan(found["bar_torque"].sel(axle="rear")).all()


def test_other_analyses_refuse_a_car(refused):
    car = Car.load("reference_vehicle")
    for analysis in (kintrafo.checkup.checkup, kintrafo.loads.static):
        with refused(kintrafo.InputError):
            analysis(car)
