"""Files of Project Chrono, and input files as they are written.

tests/data/chrono has files of Project Chrono; their source and licence are named in them. It
publishes no curves of its double wishbone and its multi-link that we know of: their wheels are held
against a carrier on five rods (`oracle.links`) and against their joints in coordinates of all
parts, whose points are taken from the files once more.
"""

import json
import math
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from kintrafo import InputError, Model, Suspension, chrono, sweep
from kintrafo.cli import app
from kintrafo.study.characteristics import travel
from kintrafo.suspension.starter import packaged
from kintrafo.suspension.toml_writer import toml_text, write_toml
from oracle.links import Carrier
from scipy.optimize import root
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

FOLDER = Path(__file__).parent / "data/chrono"
STRUT, TIRE = FOLDER / "MacPhersonStrut.json", FOLDER / "RigidTire.json"
WISHBONES, LINKS = FOLDER / "DoubleWishbone.json", FOLDER / "MultiLink.json"
GENERIC = Suspension.load("chrono_generic")


def content(path=STRUT):
    text = path.read_text(encoding="utf-8")
    return json.loads(re.sub("//.*", "", text))


def written(folder, data):
    path = folder / "strut.json"
    path.write_text(json.dumps(data), encoding="utf-8")
    return path


class TestReading:
    def test_is_the_packaged_data_set(self):
        found, _ = chrono.read(STRUT, tire=TIRE)
        for name in ("ball_joint", "strut_top", "strut_lower", "tie_rod_outer", "wheel_center"):
            np.testing.assert_allclose(
                found.hardpoints.metres(name), GENERIC.hardpoints.metres(name), atol=1e-15
            )
        assert found.vehicle.side == GENERIC.vehicle.side == "left"
        assert found.tyre.radius_mm == GENERIC.tyre.radius_mm
        ours, packaged_ones = found.parameters(), GENERIC.parameters()
        for name in ("control_arm_mass", "knuckle_mass", "wheel_mass", "knuckle_com_y"):
            assert ours[name] == pytest.approx(packaged_ones[name], rel=1e-15)
        # the packaged data set is rounded to what can be read
        for name in ("wheel_inertia_spin", "wheel_inertia_diametral"):
            assert ours[name] == pytest.approx(packaged_ones[name], rel=1e-4)

    def test_has_its_characteristics(self):
        found, _ = chrono.read(STRUT, tire=TIRE)
        at = [-0.05, 0.0, 0.05]
        ours, theirs = (travel(Model(s), at) for s in (found, GENERIC))
        for name in ("camber", "toe", "caster", "roll_center_height_kinematic"):
            np.testing.assert_allclose(ours[name], theirs[name], atol=1e-13)

    def test_camber_and_toe_turn_the_spindle_as_chrono_does(self, tmp_path):
        """Toe about the vertical, then camber about the spindle's own axis, on the left side."""
        camber, toe = -3.0, 20.0
        data = content() | {"Camber Angle (deg)": camber, "Toe Angle (deg)": toe}
        found, _ = chrono.read(written(tmp_path, data))
        c, t = -math.radians(camber), -math.radians(toe)
        about_z = np.array([[np.cos(t), -np.sin(t), 0], [np.sin(t), np.cos(t), 0], [0, 0, 1]])
        about_x = np.array([[1, 0, 0], [0, np.cos(c), -np.sin(c)], [0, np.sin(c), np.cos(c)]])
        expected = about_z @ about_x @ [0.0, 1.0, 0.0]
        np.testing.assert_allclose(found.wheel.spin_axis(1.0), expected, atol=1e-15)

    def test_inertia_of_the_arm_is_turned_out_of_its_own_axes(self):
        """The principal moments stay; about the hinge it is what the file has about x."""
        found, _ = chrono.read(STRUT)
        arm = found.bodies.control_arm
        xx, yy, zz, xy, xz, yz = arm.elements().values()
        tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        np.testing.assert_allclose(
            np.linalg.eigvalsh(tensor), sorted((0.0269, 0.06058, 0.03377)), rtol=1e-12
        )
        hinge = np.array([0.52, 0.013, -0.019]) / np.linalg.norm([0.52, 0.013, -0.019])
        assert hinge @ tensor @ hinge == pytest.approx(0.0269, rel=1e-12)

    def test_inertia_in_the_axes_of_the_vehicle_is_taken_as_it_is(self, tmp_path):
        data = content() | {"Vehicle-Frame Inertia": True}
        data["Upright"] |= {
            "Moments of Inertia": [0.03, 0.04, 0.02],
            "Products of Inertia": [0.001, -0.002, 0.003],
        }
        found, _ = chrono.read(written(tmp_path, data))
        assert list(found.bodies.control_arm.elements().values())[:3] == [0.0269, 0.06058, 0.03377]
        expected = [0.03, 0.04, 0.02, 0.001, -0.002, 0.003]
        assert list(found.bodies.knuckle.elements().values()) == expected

    def test_a_damper_curve_is_turned_round(self, tmp_path):
        """Chrono's curve is over the rate of the length, which is positive in rebound."""
        data = content()
        del data["Shock"]["Damping Coefficient"]
        data["Shock"]["Curve Data"] = [[-1.0, -900.0], [0.0, 0.0], [1.0, 2000.0]]
        found, _ = chrono.read(written(tmp_path, data))
        assert found.damper.velocity_m_per_s == (-1.0, 0.0, 1.0)
        assert found.damper.force_N == (-2000.0, 0.0, 900.0)

    def test_without_a_tire_the_wheel_is_a_usual_one(self):
        found, told = chrono.read(STRUT)
        assert found.bodies.wheel.mass_kg == pytest.approx(21.103, rel=1e-15)
        assert found.tyre.radius_mm is None
        assert "wheel: 20 kg, 1 kg m^2 about its axis" in told[2]

    def test_assumptions_are_told(self, tmp_path):
        _, told = chrono.read(STRUT)
        assert [text.partition(":")[0] for text in told] == [
            "rack",
            "tyre",
            "wheel",
            "strut",
            "upper strut",
        ]
        data = content()
        data["Strut"]["Mass"] = 0.0
        data["Shock"]["Location Upright"][0] += 0.03
        data["Spring"] |= {"Minimum Length": 0.2, "Maximum Length": 0.4}
        _, told = chrono.read(written(tmp_path, data), tire=TIRE)
        assert [text.partition(":")[0] for text in told] == [
            "rack",
            "tyre",
            "strut",
            "damper",
            "stops",
        ]


class TestDoubleWishbone:
    def test_its_wheel_moves_as_a_carrier_on_five_rods(self):
        data = content(WISHBONES)
        points = {"wheel_center": data["Spindle"]["COM"]}
        for arm, key in (("lower", "Lower Control Arm"), ("upper", "Upper Control Arm")):
            points[f"{arm}_arm_front"] = data[key]["Location Chassis Front"]
            points[f"{arm}_arm_rear"] = data[key]["Location Chassis Back"]
            points[f"{arm}_ball_joint"] = data[key]["Location Upright"]
        points["tie_rod_inner"] = data["Tierod"]["Location Chassis"]
        points["tie_rod_outer"] = data["Tierod"]["Location Upright"]
        points = {name: np.array(point, dtype=float) for name, point in points.items()}
        carrier = Carrier(points, np.array([0.0, 1.0, 0.0]))
        found, told = chrono.read(WISHBONES, tire=TIRE)
        assert [text.partition(":")[0] for text in told] == ["rack", "tyre"]
        places = np.array([-0.06, -0.02, 0.0, 0.03, 0.06])
        ours = sweep.positions(Model(found), places)
        for i, place in enumerate(places):
            pose = carrier.at(place, 0.0)
            x, y, z = pose.rotation @ [0.0, 1.0, 0.0]  # outboard on the left
            assert ours["toe"].values[i] == pytest.approx(np.arctan2(x, y), abs=1e-13)
            assert ours["camber"].values[i] == pytest.approx(np.arctan2(-z, y), abs=1e-13)
            for at, axis in enumerate("xyz"):
                center = ours[f"wheel_center_{axis}"].values[i]
                assert center == pytest.approx(pose.center[at], abs=1e-13)

    def test_spring_damper_and_masses_are_those_of_the_file(self):
        found, _ = chrono.read(WISHBONES, tire=TIRE)
        model = Model(found)
        moving = model.state(**{f"{model.names.arm}_rate": 1.0})
        force = 5e5 * (0.51 - math.hypot(0.04, 0.1, 0.5))
        assert float(model.signal("spring_force", moving)) == pytest.approx(force, rel=1e-9)
        rate = float(model.signal("spring_velocity", moving))
        assert abs(rate) > 0.1
        damping = float(model.signal("damper_force", moving))
        assert damping == pytest.approx(-1e4 * rate, rel=1e-12)
        for body, mass, moments in (
            (found.bodies.lower_arm, 1.611, (0.0151, 0.0207, 0.0355)),
            (found.bodies.upper_arm, 1.032, (0.00591, 0.0019, 0.00769)),
            (found.bodies.knuckle, 1.397, (0.0138, 0.0146, 0.00283)),
        ):
            xx, yy, zz, xy, xz, yz = body.elements().values()
            tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
            assert body.mass_kg == mass
            np.testing.assert_allclose(np.linalg.eigvalsh(tensor), sorted(moments), rtol=1e-11)

    def test_what_is_left_out_is_told(self, tmp_path):
        data = content(WISHBONES)
        data["Shock"]["Location Arm"][1] += 0.02
        data["Shock"] |= {"Curve Data": [[-1.0, -900.0], [0.0, 0.0], [1.0, 2000.0]]}
        data["Tierod"]["Mass"] = 6.0
        data["Lower Control Arm"]["Bushing Data"] = {"Stiffness Linear": [7e7, 7e7, 7e7]}
        data["Spring"] |= {"Minimum Length": 0.4, "Maximum Length": 0.6}
        found, told = chrono.read(written(tmp_path, data), tire=TIRE)
        heads = ["rack", "tyre", "damper", "tie rod", "bushes", "stops"]
        assert [text.partition(":")[0] for text in told] == heads
        assert found.damper.force_N == (-2000.0, 0.0, 900.0)


class TestMultiLink:
    def test_its_wheel_moves_on_the_five_links_that_the_refusal_tells(self):
        """Against the joints of Chrono: a hinge of the arm, and rods of constant length."""
        with pytest.raises(InputError, match="upper arm is two links with one outer point"):
            chrono.read(LINKS)
        data = content(LINKS)
        arm, links = data["Upper Arm"], (data["Lateral"], data["Trailing Link"], data["Tierod"])
        rods = [(link["Location Chassis"], link["Location Upright"]) for link in links]
        names = ("front_lower_link", "rear_lower_link", "tie_rod")
        ends = dict(zip(names, rods, strict=True)) | {
            f"{end}_upper_link": (arm[f"Location Chassis {key}"], arm["Location Upright"])
            for end, key in (("front", "Front"), ("rear", "Back"))
        }
        points = {f"{name}_{end}": p for name, pair in ends.items()
                  for end, p in zip(("inner", "outer"), pair, strict=True)}  # fmt: skip
        points["wheel_center"] = data["Spindle"]["COM"]
        points |= {"spring_top": data["Spring"]["Location Chassis"],
                   "spring_seat": data["Spring"]["Location Link"]}  # fmt: skip
        changes = {f"hardpoints.{name}.{axis}": 1e3 * value for name, point in points.items()
                   for axis, value in zip("xyz", point, strict=True)}  # fmt: skip
        straight = {"wheel.camber_deg": 0.0, "wheel.toe_deg": 0.0, "tyre.radius_mm": 300.0}
        left = Suspension.load("multi_link_car").mirrored().with_changes(changes | straight)
        places = np.array([-0.05, 0.0, 0.05])
        ours = sweep.positions(Model(left), places)
        center = np.array(points["wheel_center"])
        front, back, ball = (np.array(arm[f"Location {key}"]) for key in
                             ("Chassis Front", "Chassis Back", "Upright"))  # fmt: skip
        hinge = (front - back) / np.linalg.norm(front - back)

        def left_over(pose, height):
            turned = Rotation.from_rotvec(pose[3:6]).as_matrix()
            arm_turned = Rotation.from_rotvec(pose[6] * hinge).as_matrix()
            moved = center + pose[:3] + turned @ (ball - center)
            lengths = [
                np.linalg.norm(center + pose[:3] + turned @ (np.array(outer) - center) - inner)
                - np.linalg.norm(np.subtract(outer, inner))
                for inner, outer in rods
            ]
            return [*(moved - back - arm_turned @ (ball - back)), *lengths, pose[2] - height]

        for i, place in enumerate(places):
            found = root(left_over, np.zeros(7), args=(place,), tol=1e-13)
            x, y, z = Rotation.from_rotvec(found.x[3:6]).apply([0.0, 1.0, 0.0])
            assert ours["toe"].values[i] == pytest.approx(np.arctan2(x, y), abs=1e-10)
            assert ours["camber"].values[i] == pytest.approx(np.arctan2(-z, y), abs=1e-10)
            assert ours["wheel_center_y"].values[i] == pytest.approx(
                center[1] + found.x[1], abs=1e-10
            )


class TestMistakes:
    @pytest.mark.parametrize(
        ("changes", "words"),
        [
            ({"Template": "RigidSuspension"}, "only 'MacPhersonStrut' and 'DoubleWishbone' can"),
            ({"Template": None}, '"Template" is null'),
            ({"Template": "MultiLink"}, "write a multi_link file"),
            ({"Template": "DoubleWishbone"}, '"Upper Control Arm" is missing'),
            ({"Spindle": None}, '"Spindle" = null'),
            ({"Tierod": {"Location Chassis": [0, 0, 0]}}, '"Tierod > Location Upright" is missing'),
            ({"Axle": {"Inertia": -1}}, '"Axle > Inertia" = -1'),
            ({"Axle": {"Inertia": "1"}}, '"Axle > Inertia" = "1"'),
            ({"Axle": {"Inertia": True}}, '"Axle > Inertia" = true'),
            ({"Vehicle-Frame Inertia": 1}, '"Vehicle-Frame Inertia" = 1'),
            ({"Toe Angle (deg)": "no"}, '"Toe Angle (deg)" = "no"'),
        ],
    )
    def test_are_named(self, tmp_path, changes, words):
        with pytest.raises(InputError, match=re.escape(words)):
            chrono.read(written(tmp_path, content() | changes))

    def test_a_spring_by_a_curve(self, tmp_path):
        data = content()
        del data["Spring"]["Spring Coefficient"]
        with pytest.raises(InputError, match="a spring by a curve cannot be read"):
            chrono.read(written(tmp_path, data))

    @pytest.mark.parametrize(
        ("text", "words"),
        [(b"{\n,}", "Line 2 is not valid JSON"), (b"[1]", "no keys"), (b"\xff", "not UTF-8")],
    )
    def test_no_json(self, tmp_path, text, words):
        path = tmp_path / "strut.json"
        path.write_bytes(text)
        with pytest.raises(InputError, match=words):
            chrono.read(path)

    def test_impossible_geometry_names_the_file(self, tmp_path):
        data = content()
        data["Control Arm"]["Location Chassis Back"] = data["Control Arm"]["Location Upright"]
        path = written(tmp_path, data)
        with pytest.raises(InputError, match=re.escape(str(path))):
            chrono.read(path)

    def test_comments_are_let_pass_but_not_in_texts(self, tmp_path):
        path = tmp_path / "strut.json"
        text = json.dumps(content() | {"Name": "a // b /* c */"})
        path.write_text("/* before\n */" + text + "// after", encoding="utf-8")
        assert chrono.read(path).suspension.vehicle.side == "left"

    @pytest.mark.parametrize(
        ("text", "words"),
        [
            # of the length of the text, and not of its square or worse: minutes before
            ('{"a":"' + '\\"' * 200_000, "Line 1 is not valid JSON"),
            ("/*/" * 200_000, "is not valid JSON"),
            ('{"a": 1} /* never closed', "Line 1 is not valid JSON"),
            ('{\n/* two\nlines */ "a": ?}', "Line 3 is not valid JSON"),
            ('{"a":' * 100_000, "too deeply"),
            ('{"a": ' + "9" * 5000 + "}", "thousands of digits"),
        ],
        ids=["text", "comments", "open comment", "lines", "deep", "digits"],
    )
    def test_what_no_person_writes(self, tmp_path, text, words):
        path = tmp_path / "strut.json"
        path.write_text(text, encoding="utf-8")
        with pytest.raises(InputError, match=words):
            chrono.read(path)

    def test_no_such_file(self, tmp_path):
        with pytest.raises(InputError, match="cannot be read: No such file"):
            chrono.read(tmp_path / "strut.json")


class TestCommand:
    @pytest.mark.parametrize("side", ["left", "right"])
    def test_writes_a_file_that_is_checked_next(self, tmp_path, monkeypatch, side):
        monkeypatch.chdir(tmp_path)
        arguments = [str(STRUT), "car.toml", "--tire", str(TIRE), "--side", side]
        result = CliRunner().invoke(app, ["import-chrono", *arguments])
        assert result.exit_code == 0, result.output
        assert "assumed  rack" in result.output
        car, expected = Suspension.load("car.toml"), chrono.read(STRUT, tire=TIRE).suspension
        assert car == (expected if side == "left" else expected.mirrored())
        text = Path("car.toml").read_text(encoding="utf-8")
        assert text.startswith("# From MacPhersonStrut.json and RigidTire.json of Project Chrono")
        assert CliRunner().invoke(app, ["check", "car.toml"]).exit_code == 0

    def test_nothing_is_overwritten_or_left_behind(self, tmp_path, monkeypatch):
        monkeypatch.chdir(tmp_path)
        Path("car.toml").write_text("mine")
        run = CliRunner().invoke
        with pytest.raises(InputError, match="there already"):
            run(app, ["import-chrono", str(STRUT), "car.toml"], catch_exceptions=False)
        with pytest.raises(InputError, match="side 'up' is not known"):
            run(
                app, ["import-chrono", str(STRUT), "x.toml", "--side", "up"], catch_exceptions=False
            )
        assert [path.name for path in tmp_path.iterdir()] == ["car.toml"]
        assert Path("car.toml").read_text() == "mine"


class TestWriting:
    @pytest.mark.parametrize("name", packaged())
    def test_packaged_files_come_back(self, tmp_path, name):
        car = Suspension.load(name)
        path = write_toml(car, tmp_path / "car.toml", head=["A car", "", "of ours"])
        assert Suspension.load(path) == car
        assert path.read_text(encoding="utf-8").startswith("# A car\n")

    @settings(max_examples=25, deadline=None)
    @given(
        height=st.floats(700.0, 900.0),
        rate=st.floats(0.0, 1e6),
        camber=st.floats(-5.0, 5.0),
        stop=st.booleans(),
    )
    def test_every_digit_comes_back(self, tmp_path_factory, height, rate, camber, stop):
        changes = {
            "hardpoints.strut_top.z": height,
            "tyre.rate_N_per_m": rate,
            "wheel.camber_deg": camber,
            "strut.length_max_mm": 1000.0,
        }
        if stop:
            changes["bump_stop"] = {"clearance_mm": 60.0, "rate_N_per_m": rate}
        car = Suspension.load("reference_car").with_changes(changes)
        path = tmp_path_factory.mktemp("written") / "car.toml"
        assert Suspension.load(write_toml(car, path)) == car

    def test_sections_are_apart_and_points_in_a_line(self):
        text = toml_text(Suspension.load("reference_car"))
        assert "\n\n[strut]\n" in text
        assert "\nball_joint = [5.0, -710.0, 180.0]\n" in text
        assert "\n\n\n" not in text
        assert text.endswith("\n")
        assert text.index("[strut]") < text.index("[bodies")

    def test_names_without_the_ending_are_refused(self, tmp_path):
        with pytest.raises(InputError, match=r"car\.toml"):
            write_toml(GENERIC, tmp_path / "car.txt")
