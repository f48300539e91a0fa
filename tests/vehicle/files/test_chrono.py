"""Files of Project Chrono, and input files as they are written.

tests/data/chrono has files of Project Chrono; their source and licence are named in them. It
publishes no curves of its double wishbone and its multi-link that we know of: their wheels are held
against a carrier on five rods (`oracle.links`) and against their joints in coordinates of all
parts, whose points are taken from the files once more.
"""

import json
import math
import re
from contextlib import suppress
from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest
from kintrafo import InputError, Model, Suspension, chrono, sweep
from kintrafo.vehicle.analysis.characteristics import over
from kintrafo.vehicle.cli import app
from kintrafo.vehicle.data.starter import packaged
from kintrafo.vehicle.input.toml_writer import toml_text, write_toml
from oracle.links import Carrier
from scipy.optimize import root
from scipy.spatial.transform import Rotation
from support.folders import DATA
from typer.testing import CliRunner

FOLDER = DATA / "chrono"
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
        found, _, _ = chrono.read(STRUT, tire=TIRE)
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

    def test_camber_and_toe_turn_the_spindle_as_chrono_does(self, tmp_path):
        """Toe about the vertical, then camber about the spindle's own axis, on the left side."""
        camber, toe = -3.0, 20.0
        data = content() | {"Camber Angle (deg)": camber, "Toe Angle (deg)": toe}
        found, _, _ = chrono.read(written(tmp_path, data))
        c, t = -math.radians(camber), -math.radians(toe)
        about_z = np.array([[np.cos(t), -np.sin(t), 0], [np.sin(t), np.cos(t), 0], [0, 0, 1]])
        about_x = np.array([[1, 0, 0], [0, np.cos(c), -np.sin(c)], [0, np.sin(c), np.cos(c)]])
        expected = about_z @ about_x @ [0.0, 1.0, 0.0]
        np.testing.assert_allclose(found.wheel.spin_axis(1.0), expected, atol=1e-15)

    def test_inertia_of_the_arm_is_turned_out_of_its_own_axes(self):
        """The principal moments stay; about the hinge it is what the file has about x."""
        found, _, _ = chrono.read(STRUT)
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
        del data["Upright"]["Inertia"]
        data["Upright"] |= {
            "Moments of Inertia": [0.03, 0.04, 0.02],
            "Products of Inertia": [0.001, -0.002, 0.003],
        }
        found, _, _ = chrono.read(written(tmp_path, data))
        assert list(found.bodies.control_arm.elements().values())[:3] == [0.0269, 0.06058, 0.03377]
        expected = [0.03, 0.04, 0.02, 0.001, -0.002, 0.003]
        assert list(found.bodies.knuckle.elements().values()) == expected

    @pytest.mark.parametrize("key", ["Damping Curve Data", "Curve Data"])
    def test_a_damper_curve_is_turned_round(self, tmp_path, key):
        """Chrono's curve is over the rate of the length, which is positive in rebound."""
        data = content()
        del data["Shock"]["Damping Coefficient"]
        data["Shock"][key] = [[-1.0, -900.0], [0.0, 0.0], [1.0, 2000.0]]
        found = chrono.read(written(tmp_path, data)).suspension
        assert found.damper.velocity_m_per_s == (-1.0, 0.0, 1.0)
        assert found.damper.force_N == (-2000.0, 0.0, 900.0)

    def test_without_a_tire_the_wheel_is_a_usual_one(self):
        found, assumed, _ = chrono.read(STRUT)
        assert found.bodies.wheel.mass_kg == pytest.approx(21.103, rel=1e-15)
        assert found.tyre.radius_mm is None
        assert "wheel: 20 kg, 1 kg m^2 about its axis" in assumed[2]

    def test_assumptions_are_reported(self, tmp_path):
        _, assumed, left_out = chrono.read(STRUT)
        heads = [text.partition(":")[0] for text in assumed]
        assert heads == ["rack", "tyre", "wheel", "strut", "ground"]
        assert "Strut: Mass = 5.0, Inertia = [0.001, 0.001, 0.001], Radius = 0.02" in left_out
        data = content()
        # on the axis of the strut, but nearer to its lower end
        top, seat = (np.array(data["Spring"][f"Location {end}"]) for end in ("Chassis", "Upright"))
        data["Shock"]["Location Chassis"] = list(0.8 * top + 0.2 * seat)
        data["Spindle"]["Inertia"] = [0.5, 0.1, 0.0]
        _, assumed, _ = chrono.read(written(tmp_path, data), tire=TIRE)
        heads = [text.partition(":")[0] for text in assumed]
        assert heads == ["rack", "tyre", "tire", "wheel", "strut", "damper"]
        assert assumed[3] == "wheel: 17.25 kg m^2 across its axis, the mean of 17.5 and 17"

    def test_the_shaft_of_the_axle_turns_with_the_wheel(self, tmp_path):
        """A tire of a flat disc's moments, (3, 6, 3), beside the spindle's and the shaft's."""
        disc = {"Type": "Tire", "Template": "RigidTire", "Radius": 0.3, "Mass": 35.0,
                "Inertia": [3.0, 6.0, 3.0]}  # fmt: skip
        path = tmp_path / "tire.json"
        path.write_text(json.dumps(disc), encoding="utf-8")
        wheel = chrono.read(STRUT, tire=path).suspension.bodies.wheel
        assert wheel.inertia_spin_kg_m2 == pytest.approx(6.0 + 0.000479 + 0.4, rel=1e-15)
        assert wheel.inertia_diametral_kg_m2 == pytest.approx(3.000487, rel=1e-15)
        assert wheel.inertia_shaft_kg_m2 == 0.4


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
        found, assumed, _ = chrono.read(WISHBONES, tire=TIRE)
        assert [text.partition(":")[0] for text in assumed] == ["rack", "tyre", "tire"]
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
        found, _, _ = chrono.read(WISHBONES, tire=TIRE)
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

    @pytest.mark.parametrize("law", ["rate", "curve"])
    def test_a_damper_with_points_of_its_own_does_the_same_at_design(self, tmp_path, law):
        """Its power is that of Chrono's damper between its points, about the lower arm's hinge."""
        data = content(WISHBONES)
        arm, shock = data["Lower Control Arm"], data["Shock"]
        shock |= {"Location Arm": [0.01, 0.55, -0.27], "Location Chassis": [-0.02, 0.5, 0.3]}
        forces = {-2.0: -2e4, 3.0: 3e4}  # by the rate of its length, positive in rebound
        if law == "curve":
            del shock["Damping Coefficient"]
            forces = {-2.0: -4000.0, 3.0: 9000.0}
            shock["Damping Curve Data"] = [[0.0, 0.0], *([v, f] for v, f in forces.items())]
        found, assumed, _ = chrono.read(written(tmp_path, data), tire=TIRE)
        words = next(text for text in assumed if text.startswith("damper: between"))
        assert '"Location Arm" = [0.01, 0.55, -0.27] m' in words
        model = Model(found)
        front, back = (np.array(arm[f"Location Chassis {end}"]) for end in ("Front", "Back"))
        hinge = (front - back) / np.linalg.norm(front - back)
        end = np.array(shock["Location Arm"])
        line = end - shock["Location Chassis"]
        ratio = abs(np.cross(hinge, end - front) @ line / np.linalg.norm(line))
        rate = f"{model.names.arm}_rate"
        sense = np.sign(float(model.signal("spring_velocity", model.state(**{rate: 1.0}))))
        for speed, force in forces.items():
            moving = model.state(**{rate: sense * speed / ratio})
            ours = [float(model.signal(n, moving)) for n in ("damper_force", "spring_velocity")]
            assert math.prod(ours) == pytest.approx(-force * speed, rel=1e-9)

    def test_a_damper_across_the_motion_has_no_place(self, tmp_path, refused):
        data = content(WISHBONES)
        # from the lower arm's end along its hinge
        data["Shock"] |= {
            "Location Arm": [0.0, 0.62, -0.27],
            "Location Chassis": [0.4, 0.57, -0.27],
        }
        refused(InputError, lambda: chrono.read(written(tmp_path, data)))


def leaves(data, above=()):
    for key, value in data.items():
        if isinstance(value, dict):
            yield from leaves(value, (*above, key))
        else:
            yield *above, key


class TestKeys:
    """Every key is used, listed with its value, or refused."""

    @pytest.mark.parametrize("points_only", [False, True])
    @pytest.mark.parametrize("path", [STRUT, WISHBONES])
    def test_none_is_lost(self, tmp_path, path, points_only):
        """Without a key the import is another one, or is refused."""

        def result(data):
            try:
                found = chrono.read(written(tmp_path, data), points_only=points_only)
            except InputError:
                return None
            return found.suspension.to_dict(), found.left_out

        data = content(path)
        data["Lower Control Arm" if path == WISHBONES else "Control Arm"]["Bushing Data"] = {
            "Stiffness Linear": 7e7, "DOF": {"Stiffness Linear": 0}}  # fmt: skip
        data["Spring"] |= {"Minimum Length": 0.2, "Maximum Length": 0.6, "Preload": 10.0}
        data |= {"Camber Angle (deg)": 1.0, "Toe Angle (deg)": 2.0, "Output": True}
        data["Shock"] |= {"Preload": 3.0}
        if path == WISHBONES:
            for part in ("Upright", "Upper Control Arm", "Lower Control Arm"):
                data[part]["Products of Inertia"] = [1e-4, 1e-5, 2e-5]
        whole = result(data)
        for place in leaves(data):
            less = json.loads(json.dumps(data))
            holder = less
            for key in place[:-1]:
                holder = holder[key]
            del holder[place[-1]]
            assert result(less) != whole, place

    def test_what_is_not_read_stands_with_its_value(self, tmp_path):
        data = content(WISHBONES) | {"Wishes": {"Many": [1, 2], "More": {"Deep": "x"}}}
        data["Tierod"] |= {"Mass": 6.0, "Inertia": [0.05, 0.05, 0.5]}
        data["Shock"] |= {"Minimum Length": 0.4, "Maximum Length": 0.6, "Preload": 3.0}
        data["Lower Control Arm"]["Bushing Data"] = {"Stiffness Linear": 7e7}
        left_out = chrono.read(written(tmp_path, data)).left_out
        for words in (
            "Wishes: Many = [1, 2]",
            'Wishes > More: Deep = "x"',
            "Tierod: Mass = 6.0, Inertia = [0.05, 0.05, 0.5]",
            "Shock: Minimum Length = 0.4, Maximum Length = 0.6, Preload = 3.0",
            "Lower Control Arm > Bushing Data: Stiffness Linear = 70000000.0",
        ):
            assert words in left_out

    @pytest.mark.parametrize("points_only", [False, True])
    @pytest.mark.parametrize(
        ("place", "other"),
        [
            (("Camber Angle (deg)",), "Camber Angle"),
            (("Toe Angle (deg)",), "toe angle (deg)"),
            (("Tierod", "Location Upright"), "Location upright"),
            (("Spindle", "COM"), "Com"),
        ],
    )
    def test_other_spellings_are_refused(self, tmp_path, place, other, points_only, refused):
        data = content()
        holder = data if len(place) == 1 else data[place[0]]
        holder[other] = holder.pop(place[-1])
        with refused(InputError):
            chrono.read(written(tmp_path, data), points_only=points_only)

    def test_a_preload_pushes_the_ends_apart(self, tmp_path):
        """Chrono's force is preload - rate (length - free length)."""
        data = content()
        at_rest = data["Spring"]["Free Length"]
        data["Spring"]["Preload"] = 369.149
        strut = chrono.read(written(tmp_path, data)).suspension.strut
        assert strut.spring_free_length_mm == pytest.approx(1e3 * at_rest + 1.0, rel=1e-14)

    def test_a_damper_that_stands_in_the_spring(self, tmp_path):
        data = content()
        data["Spring"]["Damping Coefficient"] = data["Shock"].pop("Damping Coefficient")
        assert (
            chrono.read(written(tmp_path, data)).suspension.strut.damper_rate_N_s_per_m == 22459.0
        )

    @pytest.mark.parametrize(
        ("part", "changes"),
        [
            ("Shock", {"Damping Curve Data": [[-1, -1], [1, 1]]}),
            ("Shock", {"Map Data": [[0, 1]]}),
            ("Shock", {"Degressivity Compression": 0.1}),
            ("Shock", {"Spring Coefficient": 5.0}),
            ("Shock", {"Spring Coefficient": 0.0, "Preload": 5.0}),
            ("Shock", {"Spring Coefficient": 0.0, "Minimum Length": 0.2, "Maximum Length": 0.6}),
            ("Spring", {"Damping Coefficient": 5.0}),
            ("Spring", {"Spring Curve Data": [[0, 0], [1, 1]]}),
            ("Spring", {"Preload": 5.0, "Spring Coefficient": 0.0}),
            ("Shock", {"Location Upright": [0.0, 0.8, 0.2]}),
            ("Upright", {"Moments of Inertia": [1, 1, 1]}),
            ("Spring", {"Preload": None}),
        ],
    )
    def test_what_there_is_no_place_for(self, tmp_path, part, changes, refused):
        data = content()
        data[part] |= changes
        refused(InputError, lambda: chrono.read(written(tmp_path, data)))

    @pytest.mark.parametrize(
        ("part", "key"),
        [
            ("Shock", "Damping Coefficient"),
            ("Spring", "Spring Coefficient"),
            ("Spring", "Free Length"),
            ("Upright", "Inertia"),
        ],
    )
    def test_what_is_missing(self, tmp_path, part, key, refused):
        data = content()
        del data[part][key]
        refused(InputError, lambda: chrono.read(written(tmp_path, data)))

    def test_a_key_that_is_there_twice(self, tmp_path, refused):
        path = tmp_path / "strut.json"
        text = json.dumps(content())
        path.write_text(
            text.replace('"Axle":', '"Axle": {"Inertia": 1}, "Axle":'), encoding="utf-8"
        )
        refused(InputError, lambda: chrono.read(path))


# deformation (of the length, over the free one) [m] and force [N], which pulls where positive
SPRING_CURVE = [[-0.12, -9000.0], [-0.03, -1500.0], [0.0, 0.0], [0.05, 2500.0]]


class TestCurves:
    @pytest.mark.parametrize("path", [STRUT, WISHBONES])
    @pytest.mark.parametrize("key", ["Spring Curve Data", "Curve Data"])
    def test_a_spring_has_chronos_force_at_every_length(self, tmp_path, path, key):
        data = content(path)
        spring = data["Spring"]
        del spring["Spring Coefficient"]
        ends = [spring[k] for k in spring if k.startswith("Location")]
        at_design = math.dist(*ends)
        spring |= {key: SPRING_CURVE, "Preload": 150.0, "Free Length": at_design + 0.04}
        found, assumed, _ = chrono.read(written(tmp_path, data), tire=TIRE)
        assert "spring: beyond its curve the force goes on straight, where" in "; ".join(assumed)
        model = Model(found)
        places = np.linspace(-0.04, 0.04, 9)
        curves = sweep.positions(model, places)
        lengths = curves["spring_length"].values
        assert lengths[4] == pytest.approx(at_design, rel=1e-12)
        expected = 150.0 - np.interp(lengths - spring["Free Length"], *np.transpose(SPRING_CURVE))
        for angle, wanted in zip(curves["arm_angle"].values, expected, strict=True):
            state = model.state(**{model.names.arm: angle})
            assert float(model.signal("spring_force", state)) == pytest.approx(wanted, rel=1e-9)

    def test_points_of_extension_that_are_too_many_are_listed(self, tmp_path, refused):
        data = content(WISHBONES)
        del data["Spring"]["Spring Coefficient"]
        curve = [[x / 50, 1e5 * x + 5e3 * x**3] for x in range(-10, 11)]
        data["Spring"]["Spring Curve Data"] = curve
        found, assumed, _ = chrono.read(written(tmp_path, data), tire=TIRE)
        assert found.spring.compression_mm == pytest.approx([20.0 * x for x in range(11)])
        assert found.spring.force_N == pytest.approx([1e5 * x + 5e3 * x**3 for x in range(11)])
        (words,) = (text for text in assumed if "left out are those" in text)
        assert words.startswith("spring: by 11 points, as many as a curve may have")
        assert "-200 mm: -6e+06 N" in words
        data["Spring"]["Spring Curve Data"] = [[x - 0.3, y - 1e7] for x, y in curve]
        refused(InputError, lambda: chrono.read(written(tmp_path, data)))

    @pytest.mark.parametrize("path", [STRUT, WISHBONES])
    def test_a_damper_has_chronos_force_at_every_speed(self, tmp_path, path):
        data = content(path)
        del data["Shock"]["Damping Coefficient"]
        curve = [[-2.0, -9000.0], [-0.5, -4000.0], [0.0, 0.0], [0.3, 500.0], [2.0, 8000.0]]
        data["Shock"]["Damping Curve Data"] = curve
        found = chrono.read(written(tmp_path, data), tire=TIRE).suspension
        assert found.damper.interpolation == "linear"
        for speed in (-1.5, -0.2, 0.1, 1.0):
            ours = np.interp(-speed, found.damper.velocity_m_per_s, found.damper.force_N)
            assert ours == pytest.approx(-np.interp(speed, *np.transpose(curve)), rel=1e-12)


# distance pressed in [m] and force [N]: the curve that enable_stops() of Chrono's SpringForce has
STOP_CURVE = [
    (0.0, 0.0), (2e-3, 200.0), (4e-3, 400.0), (6e-3, 600.0), (8e-3, 800.0), (1e-2, 1000.0),
    (2e-2, 2500.0), (3e-2, 4500.0), (4e-2, 7500.0), (5e-2, 12500.0), (6e-2, 125000.0),
]  # fmt: skip


def chronos_force(spring, length):
    """LinearSpringForce::evaluate() of Chrono."""

    def pressed(x):
        return np.interp(x, *np.transpose(STOP_CURVE))

    force = spring.get("Preload", 0.0)
    force -= spring["Spring Coefficient"] * (length - spring["Free Length"])
    if "Minimum Length" in spring and "Maximum Length" in spring:
        force += pressed(max(0.0, spring["Minimum Length"] - length))
        force -= pressed(max(0.0, length - spring["Maximum Length"]))
    return force


class TestStops:
    @pytest.mark.parametrize("path", [STRUT, WISHBONES])
    @pytest.mark.parametrize(
        "inside", [(-0.03, 0.02), (-0.005, 0.004), (-0.01, 0.001), (0.01, 0.03)]
    )
    def test_spring_and_stops_have_chronos_force_at_every_length(self, tmp_path, path, inside):
        """Inside, at and beyond the stops; some springs are pressed into a stop at design."""
        data = content(path)
        spring = data["Spring"]
        at_design = math.dist(*(spring[k] for k in spring if k.startswith("Location")))
        shortest, longest = (at_design + away for away in inside)
        spring |= {"Minimum Length": shortest, "Maximum Length": longest, "Preload": 150.0}
        found, assumed, left_out = chrono.read(written(tmp_path, data), tire=TIRE)
        assert any(text.startswith("spring: touches its stops at lengths of ") for text in assumed)
        assert not any("Length" in line for line in left_out)
        model = Model(found)
        touched = [x - at_design for x in (shortest, longest)]
        assert found.bump_stop.clearance_mm == pytest.approx(-1e3 * touched[0], abs=1e-8)
        assert found.rebound_stop.clearance_mm == pytest.approx(1e3 * touched[1], abs=1e-8)
        curves = sweep.positions(model, np.linspace(-0.08, 0.08, 33))
        lengths = curves["spring_length"].values
        assert lengths.min() < shortest - 0.01
        assert lengths.max() > longest + 0.01
        for angle, length in zip(curves["arm_angle"].values, lengths, strict=True):
            if not shortest - 0.06 <= length <= longest + 0.05:
                continue
            state = model.state(**{model.names.arm: angle})
            ours = sum(float(model.signal(f"{part}_force", state))
                       for part in ("spring", "bump_stop", "rebound_stop"))  # fmt: skip
            # lengths to 1e-12 m of some 0.5 m, by as much as 1.2e7 N/m
            assert ours == pytest.approx(chronos_force(spring, length), rel=1e-9, abs=1e-4)

    @pytest.mark.parametrize("path", [STRUT, WISHBONES])
    @pytest.mark.parametrize("key", ["Minimum Length", "Maximum Length"])
    def test_one_alone_has_no_effect_as_in_chrono(self, tmp_path, path, key):
        before = chrono.read(path)
        data = content(path)
        data["Spring"][key] = 0.25
        found = chrono.read(written(tmp_path, data))
        assert found.suspension == before.suspension
        assert f"Spring: {key} = 0.25" in found.left_out

    @pytest.mark.parametrize("path", [STRUT, WISHBONES])
    @pytest.mark.parametrize(
        "changes",
        [
            {"Minimum Length": 0.5, "Maximum Length": 0.4},
            {"Minimum Length": 0.05, "Maximum Length": 0.4},
            {"Minimal Length": 0.2},
        ],
    )
    def test_what_cannot_be_read_is_refused_but_for_the_points(
        self, tmp_path, path, changes, refused
    ):
        data = content(path)
        spring = data["Spring"] | changes
        data["Spring"] = {key: value for key, value in spring.items() if value is not None}
        refused(InputError, lambda: chrono.read(written(tmp_path, data)))
        assert chrono.read(written(tmp_path, data), points_only=True).suspension

    @pytest.mark.parametrize("path", [STRUT, WISHBONES])
    def test_beside_a_spring_by_a_curve_have_nearly_chronos_force(self, tmp_path, path):
        """Up to 50 mm pressed in: by a rate and a cubic term, of 5.5 % at most."""
        data = content(path)
        stops = {"Minimum Length": 0.2, "Maximum Length": 0.4}
        data["Spring"] |= stops | {"Spring Curve Data": SPRING_CURVE}
        del data["Spring"]["Spring Coefficient"]
        found, assumed, _ = chrono.read(written(tmp_path, data), tire=TIRE)
        assert any("within 5 % up to 50 mm" in text for text in assumed)
        for stop in (found.bump_stop, found.rebound_stop):
            for x, force in STOP_CURVE[5:-1]:
                own = stop.rate_N_per_m * x + stop.progression_N_per_mm3 * 1e9 * x**3
                assert own == pytest.approx(force, rel=0.056)


class TestNoBody:
    """An inertia that no body can have."""

    ARM: ClassVar = {"Moments of Inertia": [0.4, 0.4, 0.8938]}

    def test_is_reported_by_the_keys_of_the_file(self, tmp_path, as_stored):
        data = content(WISHBONES)
        data["Lower Control Arm"] |= self.ARM
        path = written(tmp_path, data)
        with pytest.raises(InputError) as caught:
            chrono.read(path)
        (problem,) = caught.value.problems
        assert problem.startswith('"Lower Control Arm > Moments of Inertia" = [0.4, 0.4, 0.8938], ')
        as_stored(problem)
        assert "--points-only" in problem
        assert "inertia_xx" not in problem
        assert chrono.read(path, points_only=True).suspension.hardpoints.lower_arm_front

    @pytest.mark.parametrize(
        ("path", "part", "changes", "key"),
        [
            (WISHBONES, "Spring", {"Spring Coefficient": -5.0}, "Spring"),
            (WISHBONES, "Spring", {"Free Length": -1.0}, "Spring"),
            (WISHBONES, "Shock", {"Damping Coefficient": -5.0}, "Shock"),
            (WISHBONES, "Upper Control Arm", {"Mass": 0.0}, "Upper Control Arm"),
            (STRUT, "Spring", {"Spring Coefficient": -5.0}, "Spring"),
            (STRUT, "Shock", {"Damping Coefficient": -5.0}, "Shock"),
            (STRUT, "Spindle", {"Inertia": [-9, 0, 0]}, 'Spindle" with "Axle'),
            (STRUT, "Control Arm", {"Location Upright": [0.22, 0.52, -0.156]},
             "Control Arm > Location Upright"),
        ],
    )  # fmt: skip
    def test_other_values_too(self, tmp_path, path, part, changes, key):
        data = content(path)
        data[part] |= changes
        with pytest.raises(InputError) as caught:
            chrono.read(written(tmp_path, data))
        assert any(f'In the file: "{key}"' in problem or f', "{key}"' in problem
                   for problem in caught.value.problems), caught.value  # fmt: skip


class TestPointsOnly:
    @pytest.mark.parametrize("path", [STRUT, WISHBONES])
    def test_hardpoints_camber_and_toe_are_those_of_the_file(self, tmp_path, path):
        """The wheel moves as that of the whole file, whatever else is in it."""
        data = content(path) | {"Camber Angle (deg)": -1.0, "Toe Angle (deg)": 0.5}
        whole = chrono.read(written(tmp_path, data)).suspension
        for part in ("Spring", "Shock", "Upright"):
            data[part] = {k: v for k, v in data[part].items() if k.startswith("Location")}
        del data["Axle"]
        found, assumed, left_out = chrono.read(written(tmp_path, data), points_only=True)
        for name in whole.hardpoints.given():
            np.testing.assert_allclose(
                found.hardpoints.metres(name), whole.hardpoints.metres(name), rtol=0, atol=1e-15
            )
        assert found.wheel == whole.wheel
        at = [-0.04, 0.0, 0.04]
        ours, theirs = (over(Model(car), "travel", at) for car in (found, whole))
        for name in ("camber", "toe", "caster"):
            np.testing.assert_allclose(ours[name], theirs[name], atol=1e-13)
        assert assumed[0].startswith(
            "spring, damper, masses, tyre and vehicle: as in the packaged "
        )
        assert any(line.startswith("Spindle: Mass = 1.103, ") for line in left_out)

    def test_the_command(self, tmp_path, monkeypatch, refused):
        monkeypatch.chdir(tmp_path)
        data = content(WISHBONES)
        data["Lower Control Arm"] |= TestNoBody.ARM
        path = written(tmp_path, data)
        arguments = ["import", str(path), "car.toml", "--points-only", "--side", "right"]
        result = CliRunner().invoke(app, arguments)
        assert result.exit_code == 0, result.output
        assert "  left out  Lower Control Arm: Mass = 1.611" in result.output
        car = Suspension.load("car.toml")
        assert car == chrono.read(path, points_only=True).suspension.mirrored()
        refused(InputError, lambda: chrono.read(path, tire=TIRE, points_only=True))


def tire_of(template, **parts):
    return {"Name": "mine", "Type": "Tire", "Template": template} | parts


DESIGN = {"Unloaded Radius [m]": 0.33, "Mass [kg]": 11.5, "Inertia [kg.m2]": [0.4, 0.7, 0.4],
          "Width [m]": 0.245}  # fmt: skip
OWN = {"Mass": 11.5, "Inertia": [0.4, 0.7, 0.4]}
PAC89 = {"Unloaded Radius": 0.33, "Vertical Stiffness": 2.5e5, "Width": 0.2}
TIRES = {
    "RigidTire": OWN | {"Radius": 0.33},
    "TMeasyTire": {"Design": DESIGN},
    "TMsimpleTire": {"Design": DESIGN},
    "FialaTire": OWN | {"Fiala Parameters": PAC89},
    "Pac89Tire": OWN | {"Design Parameters": PAC89},
    "Pac02Tire": OWN | {"Dimension": {"Unloaded Radius": 0.33}},
    "MFTire": OWN | {"UNITS": {"LENGTH": "meter"}, "DIMENSION": {"UNLOADED_RADIUS": 0.33}},
    "ANCFTire": {"Tire Radius": 0.33, "Rim Radius": 0.2},
    "ReissnerTire": {"Tire Radius": 0.33},
    "FEATire": {"Tire Radius": 0.33},
}
TIR = "[UNITS]\nLENGTH = 'mm'\n[DIMENSION]\nUNLOADED_RADIUS = 330.0 $ free\n"


class TestTires:
    def read(self, folder, data):
        path = folder / "tire.json"
        path.write_text(json.dumps(data), encoding="utf-8")
        return chrono.read(STRUT, tire=path)

    @pytest.mark.parametrize("template", TIRES)
    def test_radius_mass_and_inertia(self, tmp_path, template):
        found, assumed, left_out = self.read(tmp_path, tire_of(template, **TIRES[template]))
        elements = template in ("ANCFTire", "ReissnerTire", "FEATire")
        mass, spin = (20.0, 1.0) if elements else (11.5, 0.7)
        assert found.tyre.radius_mm == 330.0
        assert found.bodies.wheel.mass_kg == pytest.approx(mass + 1.103, rel=1e-15)
        assert found.bodies.wheel.inertia_spin_kg_m2 == pytest.approx(spin + 0.400479, rel=1e-15)
        assert any(f"of the template {template}" in text for text in assumed)
        assert any("inertia of a usual one" in text for text in assumed) == elements
        assert any(line.startswith('tire > Name = "mine"') for line in left_out)

    @pytest.mark.parametrize("template", TIRES)
    def test_no_key_is_lost(self, tmp_path, template):
        data = tire_of(template, **TIRES[template])
        whole = self.read(tmp_path, data)
        for place in leaves(data):
            holder = less = json.loads(json.dumps(data))
            for key in place[:-1]:
                holder = holder[key]
            value = holder.pop(place[-1])
            if place in (("Type",), ("Template",)):
                continue
            with suppress(InputError):
                assert self.read(tmp_path, less)[::2] != whole[::2], place
            holder[f"{place[-1]} "] = value
            try:
                other = self.read(tmp_path, less)
            except InputError:
                continue
            assert any(place[-1] in line for line in other.left_out), place

    def test_a_rate_that_is_one_is_taken(self, tmp_path):
        data = tire_of("FialaTire", **TIRES["FialaTire"])
        assert self.read(tmp_path, data).suspension.tyre.rate_N_per_m == 2.5e5
        curved = PAC89 | {"Vertical Curve Data": [[0, 0], [0.1, 2e4]]}
        found = self.read(tmp_path, data | {"Fiala Parameters": curved})
        assert found.suspension.tyre.rate_N_per_m == chrono.TYRE_RATE
        assert any("Vertical Stiffness = 250000.0" in line for line in found.left_out)

    @pytest.mark.parametrize("key", ["TIR Specification File", "Pacejka Parameter File"])
    def test_a_radius_in_a_file_beside(self, tmp_path, key):
        template = "Pac02Tire" if key.startswith("TIR") else "PacejkaTire"
        data = tire_of(template, **OWN, **{key: "hmmwv/tire/own.tir"})
        found = self.read(tmp_path, data)
        assert found.suspension.tyre.radius_mm is None
        assert any("Enter radius_mm in [tyre]" in text for text in found.assumptions)
        (tmp_path / "own.tir").write_text(TIR, encoding="utf-8")
        found = self.read(tmp_path, data)
        assert found.suspension.tyre.radius_mm == 330.0
        assert "only UNLOADED_RADIUS is read" in found.assumptions[-1]

    @pytest.mark.parametrize(
        "data",
        [
            tire_of("TMeasyTire", Design=DESIGN | {"Mass [kg]": -1}),
            tire_of("TMeasyTire", Design={}),
            tire_of("TMeasyTire", Design={"Unloaded Radius": 1}),
            tire_of("RigidTire", **OWN, radius=0.3),
            tire_of("RigidTire", **OWN | {"Inertia": [0.1, 0.7, 0.1]}, Radius=0.3),
            tire_of("OwnTire"),
            {"Type": "Wheel", "Template": "Wheel"},
            tire_of("MFTire", **OWN, UNITS={"LENGTH": "mm"}),
            tire_of("RigidTire", **OWN, Radius=0),
            tire_of("RigidTire", Mass=1, Inertia=[1, 2], Radius=1),
        ],
    )  # fmt: skip
    def test_mistakes_are_named(self, tmp_path, data, refused):
        refused(InputError, lambda: self.read(tmp_path, data))


class TestMultiLink:
    def test_its_wheel_moves_on_the_five_links_that_the_refusal_reports(self, refused):
        """Against the joints of Chrono: a hinge of the arm, and rods of constant length."""
        refused(InputError, lambda: chrono.read(LINKS))
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
        "changes",
        [
            {"Template": "RigidSuspension"},
            {"Template": None},
            {"Template": "MultiLink"},
            {"Template": "DoubleWishbone"},
            {"Spindle": None},
            {"Tierod": {"Location Chassis": [0, 0, 0]}},
            {"Axle": {"Inertia": -1}},
            {"Axle": {"Inertia": "1"}},
            {"Axle": {"Inertia": True}},
            {"Vehicle-Frame Inertia": 1},
            {"Toe Angle (deg)": "no"},
            {"Spindle": [1]},
        ],
    )
    def test_are_named(self, tmp_path, changes, refused):
        refused(InputError, lambda: chrono.read(written(tmp_path, content() | changes)))

    @pytest.mark.parametrize("points", [[[0, 0], [0, 0, 1]], [[0, "a"], [1, 1]], [[0, 0]], 5])
    def test_points_of_a_curve_are_named_once(self, tmp_path, points, refused):
        data = content()
        data["Spring"]["Spring Curve Data"] = points
        refused(InputError, lambda: chrono.read(written(tmp_path, data)))

    @pytest.mark.parametrize("text", [b"{\n,}", b"[1]", b"\xff"])
    def test_no_json(self, tmp_path, text, refused):
        path = tmp_path / "strut.json"
        path.write_bytes(text)
        refused(InputError, lambda: chrono.read(path))

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
        "text",
        [
            # of the length of the text, and not of its square or worse: minutes before
            '{"a":"' + '\\"' * 200_000,
            "/*/" * 200_000,
            '{"a": 1} /* never closed',
            '{\n/* two\nlines */ "a": ?}',
            '{"a":' * 100_000,
            '{"a": ' + "9" * 5000 + "}",
        ],
        ids=["text", "comments", "open comment", "lines", "deep", "digits"],
    )
    def test_what_no_person_writes(self, tmp_path, text, refused):
        path = tmp_path / "strut.json"
        path.write_text(text, encoding="utf-8")
        refused(InputError, lambda: chrono.read(path))

    def test_no_such_file(self, tmp_path):
        with pytest.raises(InputError, match="cannot be read: No such file"):
            chrono.read(tmp_path / "strut.json")


class TestCommand:
    @pytest.mark.parametrize("side", ["left", "right"])
    def test_writes_a_file_that_is_checked_next(self, tmp_path, monkeypatch, side):
        monkeypatch.chdir(tmp_path)
        arguments = [str(STRUT), "car.toml", "--tire", str(TIRE), "--side", side]
        result = CliRunner().invoke(app, ["import", *arguments])
        assert result.exit_code == 0, result.output
        assert "assumed   rack" in result.output
        car, expected = Suspension.load("car.toml"), chrono.read(STRUT, tire=TIRE).suspension
        assert car == (expected if side == "left" else expected.mirrored())
        text = Path("car.toml").read_text(encoding="utf-8")
        assert text.startswith("# From MacPhersonStrut.json and RigidTire.json of Project Chrono")
        assert CliRunner().invoke(app, ["check", "car.toml"]).exit_code == 0

    def test_nothing_is_overwritten_or_left_behind(self, tmp_path, monkeypatch, refused):
        monkeypatch.chdir(tmp_path)
        Path("car.toml").write_text("mine")
        run = CliRunner().invoke
        refused(
            InputError, lambda: run(app, ["import", str(STRUT), "car.toml"], catch_exceptions=False)
        )
        assert run(app, ["import", str(STRUT), "x.toml", "--side", "up"]).exit_code == 2
        assert [path.name for path in tmp_path.iterdir()] == ["car.toml"]
        assert Path("car.toml").read_text() == "mine"


class TestWriting:
    @pytest.mark.parametrize("name", packaged())
    def test_packaged_files_come_back(self, tmp_path, name):
        car = Suspension.load(name)
        path = write_toml(car, tmp_path / "car.toml", head=["A car", "", "of ours"])
        assert Suspension.load(path) == car
        assert path.read_text(encoding="utf-8").startswith("# A car\n")

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
