"""The input data of a suspension: values, conversions, and errors that say what to change."""

import math
import pickle
import re
from importlib import resources
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from kintrafo.core.errors import InputError, KintrafoError
from kintrafo.vehicle.kinds import Suspension
from kintrafo.vehicle.models.model import Model
from oracle.reference import reference_parameters, vector

CAR = Suspension.load("reference_car")
CAR_TEXT = (resources.files("kintrafo.vehicle.data") / "reference_car.toml").read_text("utf-8")
POINTS = [key for key in CAR.to_dict()["hardpoints"] if key != "unit"]
RIGID_BODIES = ["control_arm", "knuckle", "tie_rod", "rack", "upper_strut"]
ELEMENTS = ["xx", "yy", "zz", "xy", "xz", "yz"]

# A busy machine must not fail a test.
unhurried = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])

# What the equations of motion receive for the reference car, in SI units, but for centres of mass,
# which have tests of their own.
REFERENCE_PARAMETERS = {n: v for n, v in reference_parameters().items() if "_com_" not in n}


def refusal(action, *arguments):
    """Return the error that an action ends with."""
    with pytest.raises(InputError) as caught:
        action(*arguments)
    return caught.value


def only_problem(changes):
    """Return the one problem that the reference car has with these changes."""
    problems = refusal(CAR.with_changes, changes).problems
    assert len(problems) == 1, problems
    return problems[0]


def without(path):
    """Return the reference car's data without one key or section."""
    data = CAR.to_dict()
    *sections, key = path.split(".")
    table = data
    for section in sections:
        table = table[section]
    del table[key]
    return data


class TestReferenceCar:
    def test_parameters_are_the_doubles_nearest_to_the_decimal_values(self):
        parameters = CAR.parameters()
        given = {name: parameters[name] for name in REFERENCE_PARAMETERS}
        assert given == REFERENCE_PARAMETERS  # exactly: no tolerance

    def test_parameters_have_exactly_the_documented_names(self):
        names = {f"{point}_{axis}" for point in POINTS for axis in "xyz"}
        names |= {f"{direction}_axis_{axis}" for direction in ("rack", "spin") for axis in "xyz"}
        names |= {"strut_length_max", "spring_rate", "damper_rate", "spring_free_slide"}
        names |= {"tyre_rate", "tyre_free_height", "gravity"}
        names |= {"wheel_mass", "wheel_inertia_spin", "wheel_inertia_diametral"}
        for body in RIGID_BODIES:
            names |= {f"{body}_mass"} | {f"{body}_com_{axis}" for axis in "xyz"}
            names |= {f"{body}_inertia_{element}" for element in ELEMENTS}
        assert set(CAR.parameters()) == names

    def test_no_negative_zero_reaches_the_equations(self):
        assert all(math.copysign(1.0, v) > 0 for v in CAR.parameters().values() if v == 0.0)

    def test_file_says_whose_numbers_these_are(self):
        header = CAR_TEXT.split("[vehicle]")[0]
        assert "gives\n# neither hardpoints nor masses" in header
        assert "the data are invented" in header


class TestCentresOfMass:
    def test_control_arm_is_at_the_centroid_of_its_hardpoints(self):
        com = vector(CAR.parameters(), "control_arm_com")
        assert com == pytest.approx([0.025 / 3, -0.47, 0.59 / 3], abs=1e-15)

    def test_knuckle_is_on_the_strut_axis(self):
        parameters = CAR.parameters()
        ball_joint = vector(parameters, "ball_joint")
        strut = vector(parameters, "strut_top") - ball_joint
        from_ball_joint = vector(parameters, "knuckle_com") - ball_joint
        assert np.linalg.norm(from_ball_joint) == pytest.approx(0.12, abs=1e-15)
        assert np.cross(from_ball_joint, strut) == pytest.approx(0.0, abs=1e-16)
        assert from_ball_joint[2] > 0.0

    def test_tie_rod_is_at_its_midpoint(self):
        com = vector(CAR.parameters(), "tie_rod_com")
        assert com == pytest.approx([-0.135, -0.5, 0.27], abs=1e-15)

    @pytest.mark.parametrize(
        ("body", "point"), [("rack", "tie_rod_inner"), ("upper_strut", "strut_top")]
    )
    def test_rack_and_upper_strut_are_at_their_joints(self, body, point):
        parameters = CAR.parameters()
        assert list(vector(parameters, f"{body}_com")) == list(vector(parameters, point))

    @pytest.mark.parametrize("body", [body for body in RIGID_BODIES if body != "knuckle"])
    def test_given_coordinates_replace_the_rule(self, body):
        car = CAR.with_changes({f"bodies.{body}.com_mm": [10.0, -205.0, 820.0]})
        assert list(vector(car.parameters(), f"{body}_com")) == [0.01, -0.205, 0.82]

    def test_knuckle_rule_without_a_distance_takes_120_mm(self):
        car = Suspension.from_dict(without("bodies.knuckle.com_along_strut_mm"))
        assert car.parameters() == CAR.parameters()

    def test_distance_on_the_strut_axis_moves_the_knuckle(self):
        parameters = CAR.with_changes({"bodies.knuckle.com_along_strut_mm": -30.0}).parameters()
        offset = vector(parameters, "knuckle_com") - vector(parameters, "ball_joint")
        assert np.linalg.norm(offset) == pytest.approx(0.03, abs=1e-15)
        assert offset[2] < 0.0

    def test_knuckle_has_one_centre_of_mass(self):
        problem = only_problem({"bodies.knuckle.com_mm": [0.0, -700.0, 300.0]})
        assert problem == (
            "[bodies.knuckle] com_mm = [0.0, -700.0, 300.0] mm and com_along_strut_mm = 120.0 mm "
            "both place the centre of mass; one is allowed. Remove the other."
        )

    def test_none_removes_the_distance_in_favour_of_coordinates(self):
        changes = {
            "bodies.knuckle.com_along_strut_mm": None,
            "bodies.knuckle.com_mm": [0.0, -700.0, 300.0],
        }
        parameters = CAR.with_changes(changes).parameters()
        assert list(vector(parameters, "knuckle_com")) == [0.0, -0.7, 0.3]

    @pytest.mark.parametrize("body", ["tie_rod", "rack", "upper_strut"])
    def test_bodies_that_may_be_massless_can_be_left_out(self, body):
        assert Suspension.from_dict(without(f"bodies.{body}")) == CAR


class TestUnits:
    def test_hardpoints_in_metres_give_the_same_parameters(self):
        data = CAR.to_dict()
        data["hardpoints"] = {
            name: [REFERENCE_PARAMETERS[f"{name}_{axis}"] for axis in "xyz"] for name in POINTS
        } | {"unit": "m"}
        assert Suspension.from_dict(data).parameters() == CAR.parameters()

    @unhurried
    @given(st.integers(-19_999, 19_999))
    def test_whole_millimetres_become_the_nearest_double(self, millimetres):
        car = CAR.with_changes({"hardpoints.wheel_center.z": millimetres})
        assert car.parameters()["wheel_center_z"] == float(f"{millimetres}e-3")

    def test_integers_and_numpy_numbers_are_numbers(self):
        changes = {
            "hardpoints.ball_joint": np.array([5, -710, 180]),
            "strut.damper_rate_N_s_per_m": np.float32(1500.0),
            "gravity.acceleration_m_per_s2": np.float64(9.81),
            "tyre.rate_N_per_m": 200_000,
        }
        assert CAR.with_changes(changes) == CAR


class TestSpinAxis:
    angles = st.floats(-45.0, 45.0)

    @unhurried
    @given(camber=angles, toe=angles, side=st.sampled_from(["left", "right"]))
    def test_angles_are_found_again(self, camber, toe, side):
        car = CAR if side == "right" else CAR.mirrored()
        sign = 1.0 if side == "left" else -1.0
        car = car.with_changes({"wheel.camber_deg": camber, "wheel.toe_deg": toe})
        axis = vector(car.parameters(), "spin_axis")
        outboard = sign * axis
        assert np.linalg.norm(axis) == pytest.approx(1.0, abs=1e-15)
        assert axis[1] > 0.0
        found_camber = math.degrees(math.atan2(-outboard[2], sign * outboard[1]))
        found_toe = math.degrees(math.atan2(outboard[0], sign * outboard[1]))
        assert found_camber == pytest.approx(camber, abs=1e-12)
        assert found_toe == pytest.approx(toe, abs=1e-12)

    @pytest.mark.parametrize("car", [CAR, CAR.mirrored()], ids=["right", "left"])
    def test_it_is_exactly_y_without_camber_and_toe(self, car):
        assert list(vector(car.parameters(), "spin_axis")) == [0.0, 1.0, 0.0]


class TestRackAxis:
    @pytest.mark.parametrize("length", [1e-5, 7.0, 1e300])
    def test_its_length_does_not_matter(self, length):
        axis = CAR.with_changes({"rack.axis.y": length}).parameters()
        assert list(vector(axis, "rack_axis")) == [0.0, 1.0, 0.0]


@st.composite
def suspensions(draw):
    """Suspensions near the reference car, on both sides, with masses on all bodies."""
    offset, small = st.floats(-20.0, 20.0), st.floats(-5.0, 5.0)
    positive = st.floats(0.0, 1e6)
    changes = {
        f"hardpoints.{point}": [x + draw(offset) for x in getattr(CAR.hardpoints, point)]
        for point in POINTS
    }
    changes |= {"wheel.camber_deg": draw(small), "wheel.toe_deg": draw(small)}
    changes |= {"strut.spring_rate_N_per_m": draw(positive), "tyre.rate_N_per_m": draw(positive)}
    changes |= {"rack.axis": [draw(st.floats(-0.3, 0.3)), 1.0, draw(st.floats(-0.3, 0.3))]}
    for body in RIGID_BODIES:
        changes[f"bodies.{body}.mass_kg"] = draw(st.floats(0.1, 50.0))
        # Smaller products than these cannot make the tensor impossible.
        for element, around in zip(ELEMENTS, (2.0, 2.0, 2.0, 0.0, 0.0, 0.0), strict=True):
            changes[f"bodies.{body}.inertia_{element}_kg_m2"] = around + draw(st.floats(-0.2, 0.2))
        if body != "knuckle" and draw(st.booleans()):
            changes[f"bodies.{body}.com_mm"] = [draw(st.floats(-1000.0, 1000.0)) for _ in range(3)]
    car = CAR.with_changes(changes)
    return car.mirrored() if draw(st.booleans()) else car


class TestRoundTrip:
    @unhurried
    @given(suspensions())
    def test_files(self, tmp_path_factory, car):
        file = tmp_path_factory.mktemp("cars") / "car.toml"
        assert Suspension.load(car.save(file)) == car

    def test_pickle(self):
        assert pickle.loads(pickle.dumps(CAR)) == CAR


class TestMirror:
    @unhurried
    @given(suspensions())
    def test_twice_is_the_same(self, car):
        assert car.mirrored().mirrored() == car

    @unhurried
    @given(suspensions())
    def test_every_parameter_is_that_of_the_mirror_image(self, car):
        before, after = car.parameters(), car.mirrored().parameters()
        for name, value in before.items():
            assert after[name] == pytest.approx(self.image(name, value), rel=1e-14, abs=1e-15), name

    @staticmethod
    def image(name, value):
        if name.startswith(("rack_axis", "spin_axis")):  # these keep pointing left
            return value if name.endswith("_y") else -value
        odd_in_y = name.endswith(("_y", "_xy", "_yz"))
        return -value if odd_in_y else value


class TestWithChanges:
    def test_original_stays_as_it_is(self):
        changed = CAR.with_changes({"strut.damper_rate_N_s_per_m": 2000.0})
        assert changed.parameters()["damper_rate"] == 2000.0
        assert CAR.parameters()["damper_rate"] == 1500.0

    def test_nothing_else_changes(self):
        changed = CAR.with_changes({"hardpoints.tie_rod_outer.z": 261.0}).parameters()
        different = {name for name, value in CAR.parameters().items() if changed[name] != value}
        assert different == {"tie_rod_outer_z", "tie_rod_com_z"}

    def test_error_names_what_was_changed(self):
        error = refusal(CAR.with_changes, {"strut.damper_rate_N_s_per_m": -1.0})
        assert str(error).startswith("suspension with changed strut.damper_rate_N_s_per_m: 1 prob")

    def test_all_unknown_places_are_named(self):
        error = refusal(CAR.with_changes, {"a.b": 1.0, "c.d": 2.0})
        assert [problem[:4] for problem in error.problems] == ["a.b:", "c.d:"]

    def test_values_cannot_be_assigned(self):
        with pytest.raises(ValueError, match="frozen"):
            CAR.strut.length_max_mm = 900.0


RANGES = [
    ("strut.spring_rate_N_per_m", -25000.0),
    ("strut.damper_rate_N_s_per_m", -1500.0),
    ("tyre.rate_N_per_m", -1.0),
    ("gravity.acceleration_m_per_s2", -9.81),
    *[(f"bodies.{body}.mass_kg", -0.5) for body in RIGID_BODIES],
    ("bodies.wheel.mass_kg", 0.0),
    ("bodies.wheel.inertia_spin_kg_m2", -1.1),
    ("bodies.wheel.inertia_diametral_kg_m2", 0.0),
    ("wheel.camber_deg", 45.5),
    ("wheel.toe_deg", -46.0),
]

NUMBERS = [
    "strut.length_max_mm",
    "strut.spring_rate_N_per_m",
    "strut.spring_free_slide_mm",
    "strut.damper_rate_N_s_per_m",
    "tyre.rate_N_per_m",
    "tyre.free_height_mm",
    "wheel.camber_deg",
    "wheel.toe_deg",
    "gravity.acceleration_m_per_s2",
    "bodies.wheel.mass_kg",
    "bodies.knuckle.com_along_strut_mm",
    *[f"bodies.{body}.inertia_{element}_kg_m2" for body in RIGID_BODIES for element in ELEMENTS],
]


class TestSingleValues:
    @pytest.mark.parametrize("place", NUMBERS)
    @pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
    def test_infinite(self, place, value):
        section, key = place.rsplit(".", 1)
        problem = only_problem({place: value})
        assert problem.startswith(f"[{section}] {key} = {value} ")

    def test_number_too_large_for_a_double(self):
        problem = only_problem({"strut.length_max_mm": 10**400})
        assert problem.startswith("[strut] length_max_mm = 1000")
        assert len(problem) < 200

    def test_unit_of_a_coordinate_is_that_of_the_section(self):
        data = CAR.to_dict()
        data["hardpoints"] |= {"unit": "m", "strut_top": ["a", 0.0, 0.0]}
        (problem,) = refusal(Suspension.from_dict, data).problems
        assert problem.startswith("[hardpoints] strut_top, x = 'a' m must be a number")

    def test_zero_rates_are_allowed(self):
        changes = {
            "strut.spring_rate_N_per_m": 0.0,
            "strut.damper_rate_N_s_per_m": 0.0,
            "tyre.rate_N_per_m": 0,
            "gravity.acceleration_m_per_s2": 0.0,
        }
        assert CAR.with_changes(changes).parameters()["gravity"] == 0.0

    def test_preload_is_a_negative_free_slide(self):
        car = CAR.with_changes({"strut.spring_free_slide_mm": -20.0})
        assert car.parameters()["spring_free_slide"] == -0.02


class TestKeys:
    @pytest.mark.parametrize(
        "place",
        [
            "vehicle.side",
            "hardpoints.unit",
            "hardpoints.tie_rod_inner",
            "wheel.toe_deg",
            "strut.length_max_mm",
            "strut.damper_rate_N_s_per_m",
            "gravity.acceleration_m_per_s2",
            "rack.axis",
            "bodies.rack.mass_kg",
            "bodies.wheel.inertia_spin_kg_m2",
            "tyre",
            "hardpoints",
            "bodies",
            "bodies.wheel",
        ],
    )
    def test_what_is_missing_is_named_with_its_meaning_and_unit(self, place, as_stored):
        (problem,) = refusal(Suspension.from_dict, without(place)).problems
        as_stored(problem)

    def test_misspelt_key_is_one_problem_not_two(self):
        data = without("strut.spring_rate_N_per_m")
        data["strut"]["sprnig_rate_N_per_m"] = 25000.0
        (problem,) = refusal(Suspension.from_dict, data).problems
        assert problem.endswith(
            "sprnig_rate_N_per_m is not a known key. Did you mean spring_rate_N_per_m?"
        )


# a largest principal moment above the sum of the others
IMPOSSIBLE = {"xx": 0.01, "yy": 0.02, "zz": 0.09, "xy": 0.0, "xz": 0.0, "yz": 0.0}
BALL_JOINT = [5.0, -710.0, 180.0]
GEOMETRY = {
    "arm without base": {"hardpoints.arm_rear": [170.0, -350.0, 205.5]},
    "arm without length": {"hardpoints.arm_front": BALL_JOINT},
    "strut without length": {"hardpoints.strut_top": BALL_JOINT},
    "tie rod without length": {"hardpoints.tie_rod_outer": [-140.0, -310.0, 280.0]},
    "knuckle: wheel at ball joint": {"hardpoints.wheel_center": [5.0, -710.9, 180.0]},
    "knuckle: tie rod at ball joint": {"hardpoints.tie_rod_outer": BALL_JOINT},
    "hinge through ball joint": {"hardpoints.ball_joint": [5.0, -350.0, 205.25]},
    "hinge vertical": {"hardpoints.arm_rear": [169.0, -350.0, 105.0]},
    "bearings swapped": {
        "hardpoints.arm_front": [-150.0, -350.0, 205.0],
        "hardpoints.arm_rear": [170.0, -350.0, 205.0],
    },
    "no steering arm": {"hardpoints.tie_rod_outer": [-11.0, -647.5, 500.0]},
    "tie rod at its dead centre": {"hardpoints.tie_rod_inner": [-265.0, -670.0, 340.5]},
    "coordinate in another unit": {"hardpoints.strut_top.z": 820_000.0},
    "millimetres declared as metres": {"hardpoints.unit": "m"},
    "metres declared as millimetres": {
        f"hardpoints.{p}": [x / 1000 for x in getattr(CAR.hardpoints, p)] for p in POINTS
    },
}


PROBLEMS = {
    **{f"{place} = {value}": {place: value} for place, value in RANGES},
    **{
        f"length = {v!r}": {"strut.length_max_mm": v} for v in (True, "850", [850.0], {"mm": 850.0})
    },
    **{
        f"top = {v!r}": {"hardpoints.strut_top": v} for v in ([1.0, 2.0], [1.0] * 4, 5.0, "1 2", {})
    },
    **{f"side = {v!r}": {"vehicle.side": v} for v in ("Right", "", 1, None)},
    **{
        f"{place} is not known": {place: 1.0}
        for place in (
            "strut.spring_rate",
            "strut.damper_rate_Ns_per_m",
            "hardpoints.Arm_Front",
            "hardpoints.wheel_centre",
            "wheel.camber",
            "bodies.knuckle.inertia_xx",
            "gravity.acceleration",
            "tyre.k2",
            "sturt.length_max_mm",
            "hardpoints.ball_jiont.z",
            "hardpoints.ball_joint.up",
            "strut.length_max_mm.x",
            "strut.length_max_mm.x.y",
            "brakes",
        )
    },
    "no such section": {"strt": {"mass_kg": 1.0}},
    "no such body": {"bodies.control_arms": {"mass_kg": 1.0}},
    "section that is a number": {"gravity": 9.81},
    "unit": {"hardpoints.unit": "inch"},
    "no finite x": {"hardpoints.ball_joint.x": math.nan},
    "com of two numbers": {"bodies.rack.com_mm": [1.0, 2.0]},
    "axis of two numbers": {"rack.axis": [1.0, 2.0]},
    "axis of zeros": {"rack.axis": [0.0, 0.0, 0.0]},
    "axis nearly of zeros": {"rack.axis": [0.0, 1e-7, 0.0]},
    "wheel in the centre plane": {"hardpoints.wheel_center.y": 0.0},
    "strut shorter than at design": {"strut.length_max_mm": 652.9},
    "spin axis along the strut": {
        "hardpoints.strut_top": [5.0, -69.0, 821.0],
        "wheel.camber_deg": 45.0,
        "strut.length_max_mm": 1000.0,
    },
    "strut along x": {"hardpoints.strut_top": [405.0, -710.0, 180.0]},
    "tie rod upright": {"hardpoints.tie_rod_inner": [-130.0, -690.0, -40.0]},
    "wheel flatter than a disc": {"bodies.wheel.inertia_spin_kg_m2": 1.3},
    "negative principal moment": {"bodies.knuckle.inertia_xy_kg_m2": 0.3},
    "inertia without mass": {f"bodies.rack.inertia_{e}_kg_m2": 0.1 for e in ("xx", "yy", "zz")},
    **{
        f"{body} of no body": {f"bodies.{body}.mass_kg": 3.0}
        | {f"bodies.{body}.inertia_{e}_kg_m2": m for e, m in IMPOSSIBLE.items()}
        for body in RIGID_BODIES
    },
    # with the strut of any length, no other check speaks
    **{name: changes | {"strut.length_max_mm": 1e6} for name, changes in GEOMETRY.items()},
}


@pytest.mark.parametrize("changes", PROBLEMS.values(), ids=PROBLEMS)
def test_one_mistake_is_one_problem(changes, as_stored):
    as_stored(only_problem(changes))


class TestGeometry:
    @pytest.mark.parametrize(
        "changes",
        [
            {"hardpoints.arm_rear": [168.9, -350.0, 205.0]},  # base of 1.1 mm
            {"hardpoints.arm_rear": [167.0, -350.0, 105.0]},  # 1.7 degrees from the vertical
            {"hardpoints.ball_joint": [5.0, -350.0, 206.1]},  # arm of 1.1 mm
            {"hardpoints.strut_top": [-150.0, -450.0, 180.0]},  # horizontal strut
            {"hardpoints.strut_top": [5.0, -710.0, 820.0]},  # vertical strut
            {"hardpoints.wheel_center": [0.0, -1.1, 300.0]},  # just on the right side
        ],
    )
    def test_unusual_but_possible(self, changes):
        CAR.with_changes(changes | {"strut.length_max_mm": 1e6})

    @pytest.mark.parametrize(
        ("car", "other"), [(CAR, "left"), (CAR.mirrored(), "right")], ids=["right", "left"]
    )
    def test_wheel_on_the_wrong_side(self, car, other, as_stored):
        (problem,) = refusal(car.with_changes, {"vehicle.side": other}).problems
        as_stored(problem)

    def test_a_strut_as_long_as_at_design_is_allowed(self):
        """The shortest length that the message of a shorter one allows."""
        CAR.with_changes({"strut.length_max_mm": 653.0})


def inertia(body, **elements):
    return {f"bodies.{body}.inertia_{name}_kg_m2": value for name, value in elements.items()}


def tensor_of_points(positions, masses):
    """Return the elements of the inertia tensor of point masses about their centre of mass."""
    centred = positions - masses @ positions / masses.sum()
    second_moments = np.einsum("i,ij,ik->jk", masses, centred, centred)
    tensor = np.trace(second_moments) * np.eye(3) - second_moments
    return {name: float(tensor["xyz".index(name[0]), "xyz".index(name[1])]) for name in ELEMENTS}


class TestInertia:
    def test_point_mass(self):
        car = CAR.with_changes(inertia("knuckle", xx=0.0, yy=0.0, zz=0.0))
        assert car.parameters()["knuckle_mass"] == 15.0

    def test_a_drive_shaft_adds_to_the_moment_about_the_axis_alone(self):
        """A wheel of a flat disc's moments, 1.2 and 0.6 kg m^2, and a shaft of 0.4 kg m^2."""
        spin, shaft = "bodies.wheel.inertia_spin_kg_m2", "bodies.wheel.inertia_shaft_kg_m2"
        model = Model(CAR.with_changes({spin: 1.6, shaft: 0.4}))  # of the equations, too
        assert model.parameters["wheel_inertia_spin"] == 1.6
        assert "1.7 kg m^2 without inertia_shaft_kg_m2 = 0.4" in only_problem(
            {spin: 1.7, shaft: 0.4}
        )
        assert "allowed is less than that" in only_problem({shaft: 9.0})

    def test_flat_disc(self):
        CAR.with_changes({"bodies.wheel.inertia_spin_kg_m2": 1.2})

    coordinates = st.tuples(*[st.floats(-1.0, 1.0)] * 3)

    @unhurried
    @given(
        positions=st.lists(coordinates, min_size=2, max_size=6),
        masses=st.lists(st.floats(0.01, 20.0), min_size=6, max_size=6),
    )
    def test_what_a_body_can_have_is_accepted(self, positions, masses):
        # Two points make a slender rod, points in a plane a disc: the limits of what is possible.
        elements = tensor_of_points(np.array(positions), np.array(masses[: len(positions)]))
        parameters = CAR.with_changes(inertia("knuckle", **elements)).parameters()
        assert all(
            parameters[f"knuckle_inertia_{name}"] == value for name, value in elements.items()
        )

    @unhurried
    @given(
        small=st.floats(0.0, 1.0),
        middle=st.floats(0.0, 1.0),
        excess=st.floats(1e-3, 1.0),
        axis=coordinates.filter(lambda axis: np.linalg.norm(axis) > 0.1),
        angle=st.floats(-3.0, 3.0),
    )
    def test_what_no_body_can_have_is_refused_in_any_axes(self, small, middle, excess, axis, angle):
        unit = np.array(axis) / np.linalg.norm(axis)
        cross = np.cross(np.eye(3), unit)
        turn = np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross
        tensor = turn @ np.diag([small, middle, small + middle + excess]) @ turn.T
        elements = {n: float(tensor["xyz".index(n[0]), "xyz".index(n[1])]) for n in ELEMENTS}
        problem = only_problem(inertia("knuckle", **elements))
        assert "principal moments" in problem


class TestFiles:
    def write(self, folder, text, encoding="utf-8"):
        file = folder / "my_car.toml"
        file.write_bytes(text.encode(encoding))
        return file

    def test_name_and_path_give_the_same(self, tmp_path):
        file = self.write(tmp_path, CAR_TEXT)
        assert Suspension.load(file) == Suspension.load(str(file)) == CAR

    @pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-8"])
    @pytest.mark.parametrize("newline", ["\n", "\r\n"])
    def test_what_windows_editors_write(self, tmp_path, encoding, newline):
        assert (
            Suspension.load(self.write(tmp_path, CAR_TEXT.replace("\n", newline), encoding)) == CAR
        )

    def test_all_problems_of_a_file_stand_in_one_message(self, tmp_path):
        text = (
            CAR_TEXT.replace('side = "right"', 'side = "left"')
            .replace("[ 170.0, -350.0, 205.0]", "[-150.0, -350.0, 205.0]")
            .replace("length_max_mm = 850.0", "length_max_mm = 600.0")
            .replace("rate_N_per_m = 200000.0", "rate_N_per_m = -200000.0")
            .replace("free_height_mm", "free_heigth_mm")
            .replace("[gravity]", "[gravitation]")
            .replace("inertia_zz_kg_m2 = 0.09", "inertia_zz_kg_m2 = 0.9")
        )
        file = self.write(tmp_path, text)
        error = refusal(Suspension.load, file)
        head, *bullets = str(error).split("\n")
        assert head == f"{file}: 7 problems"
        assert all(bullet.startswith("  - ") for bullet in bullets)
        expected = [
            "[tyre] rate_N_per_m = -200000.0 N/m is out of range",
            "[tyre] free_heigth_mm is not a known key. Did you mean free_height_mm?",
            "[bodies.control_arm] inertia_xx_kg_m2 = 0.06",
            "[gravitation] is not a known section. Did you mean gravity?",
            "[hardpoints] arm_front = [-150.0, -350.0, 205.0] mm and arm_rear",
            '[vehicle] side = "left"',
            "[strut] length_max_mm = 600.0 mm",
        ]
        for beginning in expected:
            own = (problem for problem in error.problems if beginning in problem)
            assert any(re.fullmatch(r"line \d+: ", each.partition(beginning)[0]) for each in own)

    @pytest.mark.parametrize(
        ("right", "wrong"),
        [
            ('side = "right"', 'side "right"'),
            ("toe_deg = 0.0", "toe_deg = 0,0"),
            ("camber_deg = 0.0", "camber_deg = +-0.0"),
            ("[tyre]", "[strut]"),
        ],
    )
    def test_syntax_error_names_and_shows_the_line(self, tmp_path, right, wrong):
        text = CAR_TEXT.replace(right, wrong, 1)
        problem = refusal(Suspension.load, self.write(tmp_path, text)).problems[0]
        number = CAR_TEXT[: CAR_TEXT.index(right)].count("\n") + 1
        begin = text.splitlines()[number - 1].strip()[:60]  # a long line is shown in part
        assert problem.startswith(f"Line {number} `{begin}")

    @pytest.mark.parametrize("text", ['[vehicle]\nside = "right', "[vehicle]\na = [1,\n\n", "a ="])
    def test_syntax_error_at_the_end_names_the_last_line(self, tmp_path, text):
        problem = refusal(Suspension.load, self.write(tmp_path, text)).problems[0]
        assert problem.startswith(f"Line {len(text.rstrip().splitlines())} `")

    def test_empty_file(self, tmp_path):
        error = refusal(Suspension.load, self.write(tmp_path, ""))
        assert len(error.problems) == 8
        assert all("is missing. Add this section" in problem for problem in error.problems)

    def test_other_encoding_names_the_line(self, tmp_path):
        file = self.write(tmp_path, "[vehicle]\n# 5° camber\n", "latin-1")
        (problem,) = refusal(Suspension.load, file).problems
        assert problem.startswith("Line 2 has a character that is not UTF-8. Save the file")

    def test_what_is_no_file(self, tmp_path, monkeypatch, refused):
        """A path is never taken for the name of a data set."""
        monkeypatch.chdir(tmp_path)
        for source in (tmp_path / "nowhere.toml", "refrence_car", Path("reference_car")):
            with refused(InputError):
                Suspension.load(source)
        with pytest.raises(InputError, match="file"):
            Suspension.load(tmp_path)


class TestErrors:
    def test_constructor_checks_the_same(self):
        sections = {name: getattr(CAR, name) for name in type(CAR).model_fields}
        assert type(CAR)(**sections) == CAR
        sections["vehicle"] = CAR.mirrored().vehicle
        assert "[vehicle] side" in str(refusal(lambda: type(CAR)(**sections)))

    def test_kind(self):
        error = refusal(Suspension.load, "nothing")
        assert isinstance(error, KintrafoError)
        assert isinstance(error, ValueError)

    def test_pickle(self):
        error = InputError(["[tyre] is missing."], "car.toml")
        again = pickle.loads(pickle.dumps(error))
        assert (again.problems, again.source, str(again)) == (
            ("[tyre] is missing.",),
            "car.toml",
            "car.toml: 1 problem\n  - [tyre] is missing.",
        )


def test_what_is_saved_is_loaded_again(tmp_path, refused):
    car = Suspension.load("double_wishbone_car").with_changes({"wheel.camber_deg": -1.25})
    path = car.save(tmp_path / "my_car.toml")
    assert Suspension.load(path) == car
    path.write_text("# mine\n", encoding="utf-8")
    refused(InputError, lambda: car.save(path))
    assert path.read_text(encoding="utf-8") == "# mine\n"
    assert Suspension.load(car.save(path, force=True)) == car
    refused(InputError, lambda: car.save(tmp_path / "my_car.txt"), lambda: car.save(3))
