"""Whole vehicles of Project Chrono: tests/data/chrono/vehicle.json has the files of one, by paths.

What a car must be is computed here from these files once more, in the axes of Chrono's chassis.
"""

import json
import shutil

import kintrafo
import numpy as np
import pytest
from kintrafo import InputError, Model, chrono, sweep, tyres
from kintrafo.vehicle.cli import app
from kintrafo.vehicle.models.car.car import center_of_gravity, masses
from scipy.spatial.transform import Rotation
from support.folders import DATA
from typer.testing import CliRunner

FILES = json.loads((DATA / "chrono/vehicle.json").read_text(encoding="utf-8"))
VEHICLE = "generic/vehicle/Vehicle_DoubleWishbones_ARB.json"
ARM, RACK = "generic/suspension/SemiTrailingArm.json", "generic/steering/RackPinion.json"
IDLER = "Revolute-Spherical Joint"
PITMAN, TIRE = "generic/steering/PitmanArm.json", "generic/tire/RigidTire.json"
FRONT, REAR = (f"generic/suspension/DoubleWishbone{x}.json" for x in ("Curve", ""))


def changed(files, changes):
    """Return files with other values, by the file and the keys in it; None removes one."""
    files = json.loads(json.dumps(files))
    for (*above, key), value in changes.items():
        place = files
        for each in above:
            place = place[each]
        if value is None:
            del place[key]
        else:
            place[key] = value
    return files


def folder(tmp_path, changes=None):
    """Return a folder of data with the files."""
    for name, data in changed(FILES, changes or {}).items():
        file = tmp_path / "data" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps(data), encoding="utf-8")
    return tmp_path / "data"


def read(tmp_path, changes=None):
    root = folder(tmp_path, changes)
    return chrono.read_vehicle(root / VEHICLE, tire=root / TIRE)


@pytest.fixture
def found(tmp_path):
    return read(tmp_path)


def centers():
    """Return the left wheel centres in Chrono's chassis [m]."""
    return {
        end: np.add(FILES[file]["Spindle"]["COM"], axle["Suspension Location"])
        for end, file, axle in zip(
            ("front", "rear"), (FRONT, REAR), FILES[VEHICLE]["Axles"], strict=True
        )
    }


def origin(found):
    """Return where the car's axes begin, in Chrono's chassis: by one of its wheel centres [m]."""
    return centers()["front"] - found.car.wheel_centers["front_left"]


def test_its_points_are_where_chrono_has_them(found):
    at = origin(found)
    assert at[:2] == pytest.approx([centers()["front"][0], 0.0], abs=1e-9)
    for end, file, axle in zip(
        ("front", "rear"), (FRONT, REAR), FILES[VEHICLE]["Axles"], strict=True
    ):
        points = found.car.axles[end].left.hardpoints
        shift = axle["Suspension Location"] - at - [found.car.origins[end], 0.0, 0.0]
        theirs = FILES[file]
        for name, place in {
            "upper_ball_joint": theirs["Upper Control Arm"]["Location Upright"],
            "tie_rod_inner": theirs["Tierod"]["Location Chassis"],
            "spring_top": theirs["Spring"]["Location Chassis"],
            "wheel_center": theirs["Spindle"]["COM"],
        }.items():
            np.testing.assert_allclose(points.metres(name), np.add(place, shift), atol=1e-9)


def test_its_masses_are_those_that_chrono_has_but_for_what_is_listed(found):
    def own(name):
        return sum(
            part["Mass"]
            for part in FILES[name].values()
            if isinstance(part, dict) and "Mass" in part
        )

    wheel = FILES["generic/wheel/WheelSimple.json"]["Mass"] + FILES[TIRE]["Mass"]
    chassis = FILES["generic/chassis/Chassis.json"]["Components"][0]
    expected = chassis["Mass"] + 2.0 * sum(own(name) + wheel for name in (FRONT, REAR))
    assert sum(mass for mass, _ in masses(found.car)) == pytest.approx(expected, rel=1e-12)
    place = found.car.com + origin(found)
    np.testing.assert_allclose(place, chassis["Centroidal Frame"]["Location"], atol=1e-9)
    for left in ("PitmanArm.json > Steering Link: Mass", "AntirollBarRSD.json > Arm: Mass"):
        assert any(line.startswith(left) for line in found.left_out)


def test_the_chassis_is_the_sum_of_its_components(tmp_path):
    chassis = "generic/chassis/Chassis.json"
    one = FILES[chassis]["Components"][0]
    turn = Rotation.from_euler("xyz", [10.0, -20.0, 30.0], degrees=True)
    x, y, z, w = turn.as_quat()
    hole = {
        "Centroidal Frame": {"Location": [0.2, 0.1, 0.6], "Orientation": [w, x, y, z]},
        "Mass": 100.0, "Moments of Inertia": [5.0, 6.0, 8.0],
        "Products of Inertia": [0.1, 0.2, 0.3], "Void": True,
    }  # fmt: skip
    found = read(tmp_path, {(chassis, "Components"): [one, hole]})
    parts = [
        (m, np.array(c["Centroidal Frame"]["Location"]), r @ own @ r.T)
        for c, m, r in ((one, one["Mass"], np.eye(3)), (hole, -100.0, turn.as_matrix()))
        for (a, b, d), (e, f, g) in [(c["Moments of Inertia"], c["Products of Inertia"])]
        for own in [np.sign(m) * np.array([[a, e, f], [e, b, g], [f, g, d]])]
    ]
    mass = sum(m for m, _, _ in parts)
    com = sum(m * place for m, place, _ in parts) / mass
    inertia = sum(
        i + m * ((p - com) @ (p - com) * np.eye(3) - np.outer(p - com, p - com))
        for m, p, i in parts
    )
    body = found.car.described.body
    assert body.mass_kg == pytest.approx(mass)
    got = body.elements()
    assert [got["xx"], got["xy"], got["xz"], got["yz"]] == pytest.approx(
        [inertia[0, 0], inertia[0, 1], inertia[0, 2], inertia[1, 2]], abs=1e-9
    )


def test_the_road_carries_the_front_wheels_in_the_design_position(found):
    """By the balance of moments about the rear wheel centres, with all masses where they are."""
    car = found.car
    tyre = car.axles["front"].left.tyre
    weight = 9.81 * sum(mass for mass, _ in masses(car))
    load = 0.5 * weight * (center_of_gravity(car)[0] + 2.5) / 2.5
    pressed = 1e-3 * tyre.free_height_mm - car.wheel_centers["front_left"][2]
    # arms and uprights are not at the wheel centre, as they are taken to be for this height
    assert tyre.rate_N_per_m * pressed == pytest.approx(load, rel=0.01)
    assert tyre.free_height_mm == tyre.radius_mm == pytest.approx(1e3 * FILES[TIRE]["Radius"])
    assert tyre.lifts_off


def test_its_bar_is_that_of_chrono(found):
    bar = found.car.axles["front"].bar
    theirs = FILES["generic/antirollbar/AntirollBarRSD.json"]
    at = np.array(FILES[VEHICLE]["Axles"][0]["Antirollbar Location"]) - origin(found)
    top = np.add(at, [theirs["Arm"]["Width"], theirs["Arm"]["Length"], 0.0])
    np.testing.assert_allclose(bar.metres("link_top"), top, atol=1e-9)
    foot = np.add(top, [0.0, 0.0, theirs["Droplink"]["Height"]])
    np.testing.assert_allclose(bar.metres("link_foot"), foot, atol=1e-9)
    assert bar.rate_of_bar() == pytest.approx(theirs["RSD"]["Spring Coefficient"], rel=1e-14)
    assert bar.link_on == "lower_arm"  # as GetAntirollBody of ChDoubleWishbone
    assert found.car.axles["rear"].bar is None


def test_a_pitman_arm_keeps_its_points_and_axes(found):
    theirs, place = FILES[PITMAN], FILES[VEHICLE]["Steering Subsystems"][0]
    w, x, y, z = place["Orientation"]
    turned = Rotation.from_quat([x, y, z, w])
    axle = found.car.axles["front"]
    origin = axle.left.hardpoints.metres("lower_ball_joint") - lower_ball_of_chrono()
    arm = axle.left.pitman_arm
    assert axle.left.rack is None
    for name, joint, key in (
        ("pivot", "Revolute Joint", "Location"),
        ("ball", "Universal Joint", "Location"),
        ("idler_pivot", IDLER, "Location Chassis"),
        ("idler_ball", IDLER, "Location Link"),
    ):
        expected = turned.apply(theirs[joint][key]) + place["Location"] + origin
        np.testing.assert_allclose(arm.metres(name), expected, atol=1e-9)
    for name, joint in (("axis", "Revolute Joint"), ("idler_axis", IDLER)):
        expected = turned.apply(theirs[joint]["Direction"])
        np.testing.assert_allclose(getattr(arm, name), expected, atol=1e-9)
    assert any(line.startswith("steering: a Pitman arm, in Chrono") for line in found.assumptions)


def lower_ball_of_chrono():
    """Return where the lower ball joint of the left front is in the axes of the chassis [m]."""
    place = FILES[VEHICLE]["Axles"][0]["Suspension Location"]
    return np.add(FILES[FRONT]["Lower Control Arm"]["Location Upright"], place)


def test_a_rack_goes_as_far_as_its_pinion(tmp_path):
    places = [{"Input File": RACK, "Location": [1, 0, 0], "Orientation": [1, 0, 0, 0]}]
    found = read(tmp_path, {(VEHICLE, "Steering Subsystems"): places})
    rack = found.car.axles["front"].left.rack
    radius = FILES[RACK]["Pinion"]["Radius"]
    assert rack.travel_per_turn_mm == pytest.approx(2e3 * np.pi * radius, abs=1e-6)
    assert rack.axis == (0.0, 1.0, 0.0)


def test_brakes_and_driveline_give_shares(tmp_path):
    rear = "generic/brake/Rear.json"
    brake = FILES["generic/brake/BrakeSimple.json"]
    changes = {(rear,): brake | {"Maximum Torque": 1000.0}}
    changes |= {(VEHICLE, "Axles", 1, f"{s} Brake Input File"): rear for s in ("Left", "Right")}
    simple = "generic/driveline/DrivelineSimple.json"
    changes[VEHICLE, "Driveline"] = {"Input File": simple, "Suspension Indexes": [0, 1]}
    changes[simple, "Front Torque Fraction"] = 0.3
    axles = read(tmp_path, changes).car.axles
    front = brake["Maximum Torque"]
    for axle in axles.values():
        assert axle.right.vehicle.front_brake_share == pytest.approx(front / (front + 1000.0))
    assert [a.drive.share for a in axles.values()] == pytest.approx([0.3, 0.7])


def test_an_inertia_that_no_body_has_is_raised_and_listed(found):
    """The lower arm has 0.4, 0.4, 0.8938 kg m^2: 0.4469 is half the largest."""
    arm = found.car.axles["rear"].left.bodies.lower_arm.elements()
    tensor = [[arm["xx"], arm["xy"], arm["xz"]], [arm["xy"], arm["yy"], arm["yz"]],
              [arm["xz"], arm["yz"], arm["zz"]]]  # fmt: skip
    np.testing.assert_allclose(np.linalg.eigvalsh(tensor), [0.4469, 0.4469, 0.8938], rtol=1e-12)
    assert any("read as [0.4469, 0.4469, 0.8938]" in line for line in found.assumptions)


def test_a_semi_trailing_arm_swings_about_its_bearings(tmp_path):
    suspension = chrono.read(folder(tmp_path) / ARM, tire=tmp_path / "data" / TIRE).suspension
    arm = FILES[ARM]["Trailing Arm"]
    inner, outer = (np.array(arm[f"Location Chassis {x}"]) for x in ("Inner", "Outer"))
    axis = (outer - inner) / np.linalg.norm(outer - inner)
    found = sweep.positions(Model(suspension), np.array([-0.05, 0.0, 0.05]))
    at = np.array(FILES[ARM]["Spindle"]["COM"])
    for i, angle in enumerate(found["arm_angle"].values - found["arm_angle"].values[1]):
        own = min(
            (inner + Rotation.from_rotvec(s * angle * axis).apply(at - inner) for s in (1.0, -1.0)),
            key=lambda place: abs(place[2] - [-0.05, 0.0, 0.05][i]),
        )
        got = [found[f"wheel_center_{x}"].values[i] for x in "xyz"]
        np.testing.assert_allclose(got, own, atol=1e-9)


def test_a_car_with_a_semi_trailing_arm_is_read(tmp_path):
    found = read(tmp_path, {(VEHICLE, "Axles", 1, "Suspension Input File"): ARM})
    assert found.car.axles["rear"].right.suspension == "trailing_arm"


def test_a_file_that_names_vehicle_and_tire_is_read(tmp_path, found):
    outer = {"Name": "x", "Type": "Vehicle", "Template": "WheeledVehicle", "Zombie": 1,
             "Vehicle": {"Input File": VEHICLE}, "Tire": {"Input File": TIRE}}  # fmt: skip
    root = folder(tmp_path, {("generic/Whole.json",): outer})
    whole = chrono.read_vehicle(root / "generic/Whole.json")
    assert whole.car.to_dict() == found.car.to_dict()
    assert "Whole.json > Zombie = 1" in whole.left_out


def test_a_tyre_that_rolls_is_that_of_a_car_that_drives(tmp_path):
    root = folder(tmp_path)
    tire = shutil.copy(DATA / "chrono/TMeasyTire.json", root / "generic/tire/TMeasyTire.json")
    found = chrono.read_vehicle(root / VEHICLE, tire=tire)
    brake = FILES["generic/brake/BrakeSimple.json"]["Maximum Torque"]
    assert found.car.described.brakes.torque_Nm == pytest.approx(4.0 * brake)
    drives = found.car.with_changes({"car": "full"})
    assert drives.tyre("rear_left").radius == found.car.axles["rear"].left.tyre.radius_mm / 1e3
    # the rate of its tyre spring is the slope of the load over the deflection at the nominal load
    tyre = tyres.load(tire)
    loads = tyre.nominal_load * np.array([0.999, 1.001])
    radii = tyre.evaluate(load=loads).loaded_radius
    rate = found.car.axles["front"].left.tyre.rate_N_per_m
    assert rate == pytest.approx(-np.diff(loads)[0] / np.diff(radii)[0], rel=1e-5)


MISTAKES = {
    "no such file": {(VEHICLE, "Chassis", "Input File"): "generic/chassis/Other.json"},
    "outside": {(VEHICLE, "Chassis", "Input File"): "../../etc/passwd"},
    "three axles": {(VEHICLE, "Axles"): FILES[VEHICLE]["Axles"] * 2},
    "order of axles": {(VEHICLE, "Axles", 0, "Suspension Location"): [-2.0, 0.0, -0.21]},
    "rear steering": {(VEHICLE, "Axles", 1, "Steering Index"): 0},
    "no steering of this index": {(VEHICLE, "Axles", 0, "Steering Index"): 3},
    "double wheels": {(VEHICLE, "Axles", 1, "Wheel Separation"): 0.3},
    "two wheels": {(VEHICLE, "Axles", 1, "Left Wheel Input File"): TIRE},
    "more bodies": {(VEHICLE, "Rear Chassis"): [{"Input File": "x"}]},
    "misspelt": {(VEHICLE, "Wheel base"): 2.5},
    "tracks": {(VEHICLE, "Axles"): None, (VEHICLE, "Template"): "TrackedVehicle"},
    "kind": {(REAR, "Template"): "SolidAxle"},
    "steering": {(PITMAN, "Template"): "RotaryArm"},
    "no axis": {(PITMAN, "Revolute Joint", "Direction"): [0, 0, 0]},
    "no idler arm": {(PITMAN, IDLER, "Location Link"): FILES[PITMAN][IDLER]["Location Chassis"]},
    "damper": {(REAR, "Shock", "Map Data"): [[0, 1], [2, 3]]},
    "no mass": {("generic/chassis/Chassis.json", "Components", 0, "Mass"): 0.0},
    "quaternion": {(VEHICLE, "Steering Subsystems", 0, "Orientation"): [2, 0, 0, 0]},
    "driven": {(VEHICLE, "Driveline", "Suspension Indexes"): [5]},
}


@pytest.mark.parametrize("name", MISTAKES)
def test_mistakes_are_named(tmp_path, monkeypatch, name, refused):
    monkeypatch.chdir(folder(tmp_path, MISTAKES[name]))
    refused(InputError, lambda: chrono.read_vehicle(VEHICLE, tire=TIRE))


def test_a_tire_is_asked_for(tmp_path, monkeypatch, refused):
    monkeypatch.chdir(folder(tmp_path))
    refused(InputError, lambda: chrono.read_vehicle(VEHICLE))


class TestCommand:
    def run(self, *given):
        return CliRunner().invoke(app, ["import", *given])

    def test_writes_five_files_that_are_the_car(self, tmp_path, monkeypatch):
        root = folder(tmp_path)
        monkeypatch.chdir(tmp_path)
        result = self.run(str(root / VEHICLE), "car.toml", "--tire", str(root / TIRE))
        assert result.exit_code == 0, result.output
        names = ("car", "car_front", "car_front_side", "car_rear", "car_rear_side")
        assert sorted(file.stem for file in tmp_path.glob("*.toml")) == sorted(names)
        expected = chrono.read_vehicle(root / VEHICLE, tire=root / TIRE)
        assert kintrafo.load("car.toml").to_dict() == expected.car.to_dict()
        for line in (*expected.assumptions, *expected.left_out):
            assert line.split()[0] in result.output

    def test_writes_nothing_where_one_file_is_in_the_way(self, tmp_path, monkeypatch):
        root = folder(tmp_path)
        monkeypatch.chdir(tmp_path)
        (tmp_path / "car_rear.toml").write_text("mine", encoding="utf-8")
        result = self.run(str(root / VEHICLE), "car.toml", "--tire", str(root / TIRE))
        assert result.exit_code == 1
        assert [file.name for file in tmp_path.glob("*.toml")] == ["car_rear.toml"]
        assert (tmp_path / "car_rear.toml").read_text(encoding="utf-8") == "mine"

    @pytest.mark.parametrize("option", [["--side", "right"], ["--points-only"]])
    def test_options_of_a_suspension_are_refused(self, tmp_path, option):
        root = folder(tmp_path)
        result = self.run(str(root / VEHICLE), str(tmp_path / "car.toml"), *option)
        assert result.exit_code == 2
        assert "is not for a whole vehicle" in result.output
