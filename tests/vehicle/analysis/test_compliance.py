"""Compliance: the unit-load theorem against stiffnesses in maximal coordinates."""

import json
import re
import tomllib
from functools import partial

import numpy as np
import pytest
from kintrafo import Axle, InputError, Model, RigidAxle, Suspension, compliance
from kintrafo.vehicle.assembly.by_wheel import flat
from kintrafo.vehicle.input.toml_writer import write_toml
from kintrafo.vehicle.kinds import KINDS
from kintrafo.vehicle.report.tables import input_tables
from oracle.bushes import BUSHES_OF, LINKED, STRUT, TRAILING, WISHBONES, Stiffness, Z
from support.folders import ROOT

DATA = ROOT / "vehicle/data"


@pytest.mark.parametrize(
    ("held", "travel", "rack"),
    [
        # spring and stop are free of force at design; 1e-9 m beyond it the stop has its rate
        ("spring", 1e-9, 0.0),
        ("height", 1e-9, 0.0),
        ("tyre", 1e-9, 0.0),
        ("locked", 0.06, 0.03),
        ("locked", -0.05, -0.03),
    ],
)
@pytest.mark.parametrize("some", [False, True])
@pytest.mark.parametrize("car", [STRUT, WISHBONES, LINKED, TRAILING], ids=lambda car: car.TITLE)
def test_the_wheel_deflects_as_on_springs(car, some, held, travel, rack):
    """Forces by statics and least energy against stiffnesses and constraints, two theories."""
    bushes, rack = BUSHES_OF[car], rack if car.steered() else 0.0
    if some:
        kept = ("rear", "tie", "arm_outer")
        bushes = {name: bushes[name] for name in bushes if any(part in name for part in kept)}
    found = compliance.linear(Model(car), bushes, [travel], rack_position=rack, held=held)
    ours = found["flexibility"].values[0]
    springs = Stiffness(car, travel, rack)
    theirs = springs.flexibility(bushes, held)
    forward = np.cross(
        springs.pose.rotation[springs.index("wheel") - 1] @ car.wheel.spin_axis(-1.0), Z
    )
    forward /= np.linalg.norm(forward)
    axes = np.stack([forward, np.cross(Z, forward), Z])
    both = np.kron(np.eye(2), axes)
    np.testing.assert_allclose(
        ours, both @ theirs @ both.T, rtol=0.0, atol=1e-6 * abs(theirs).max()
    )


# -- signs and names ------------------------------------------------------------------------------


def test_signs_and_units():
    """A soft rear bush: braking and a lateral force turn the wheel as they turn the arm."""
    model = Model("reference_car")
    found = compliance.linear(model, {"arm_rear": {"radial_N_per_mm": 1000.0}}, [0.0])
    at = found.isel(wheel_travel=0)
    flexible = at["flexibility"].sel(moved="x", by="fx")
    # a right wheel: inward is to the left, as y is; its contact moves by what the force does
    sideways = float(at["flexibility"].sel(moved="y", by="fy"))
    assert float(at["displacement_by_lateral"]) == pytest.approx(sideways, rel=1e-12)
    assert float(at["displacement_by_braking"]) == pytest.approx(float(flexible), rel=1e-12)
    steer = float(at["flexibility"].sel(moved="rz", by="fy"))
    # toe-in of a right wheel is to the left
    assert float(at["toe_by_lateral"]) == pytest.approx(steer, rel=1e-3)
    assert found["toe_by_lateral"].attrs["display_units"] == "deg/kN"
    assert found["toe_by_aligning"].attrs["units"] == "rad/(N m)"
    assert float(at["toe_by_aligning"]) < 0.0 < float(at["displacement_by_braking"])


def test_a_rod_deflects_at_either_end():
    model = Model("reference_car")
    inner, outer = (
        compliance.linear(model, {f"tie_rod_{end}": {"axial_N_per_mm": 500.0}}, [0.0])
        for end in ("inner", "outer")
    )
    np.testing.assert_allclose(inner["flexibility"], outer["flexibility"], rtol=1e-9, atol=1e-18)


def test_a_locked_spring_needs_no_rate():
    car = Suspension.load("reference_car")
    bush = {"arm_rear": {"radial_N_per_mm": np.array([1e3, 2e3])}}
    one, other = (
        compliance.linear(Model(c), bush, [0.0], held="locked")["flexibility"]
        for c in (car, car.with_changes({"strut.spring_rate_N_per_m": 0.0}))
    )
    np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-18)


def test_a_bearing_tilts_across_the_spin_axis_whatever_its_axis_is():
    model = Model(WISHBONES)
    plain, turned = (
        compliance.linear(model, {"wheel_center": {"tilt_Nm_per_deg": 3000.0} | axis}, [0.0])
        for axis in ({}, {"axis": [1.0, 0.0, 0.0]})
    )
    np.testing.assert_array_equal(plain["flexibility"], turned["flexibility"])
    assert abs(float(plain["camber_by_lateral"][0])) > 1e-7


WRONG = [
    ({}, {}),
    ({"arm": {}}, {}),
    ({"arm_rear": 1.0}, {}),
    ({"arm_rear": {"radial": 1.0}}, {}),
    ({"arm_rear": {"radial_N_per_mm": 0.0}}, {}),
    ({"arm_rear": {"radial_N_per_mm": [1.0, 2.0, 3.0]}}, {}),
    ({"arm_rear": {"radial_N_per_mm": [[1.0, 2.0], [3.0]]}}, {}),
    ({"wheel_center": {"tilt_Nm_per_deg": [1.0, 2.0, 3.0]}}, {}),
    ({"arm_rear": {"torsion_Nm_per_deg": [1.0, 2.0]}}, {}),
    ({"wheel_center": {"tilt_Nm_per_deg": 9.0, "radial_axis": [0.0, 1.0, 0.0]}}, {}),
    ({"arm_rear": {"radial_curve": {"mm": [0, 1], "N": [0, 1], "interpolation": "none"}}}, {}),
    ({"arm_rear": {"axis": [1.0, 0.0, 0.0]}}, {}),
    ({"arm_rear": {"axial_N_per_mm": 1.0, "axis": [0.0, 0.0, 0.0]}}, {}),
    ({"arm_rear": {"axial_N_per_mm": 1.0, "axis": [1e300, 0.0, 0.0]}}, {}),
    ({"ball_joint": {"axial_N_per_mm": 1.0}}, {}),
    ({"strut_lower": {"axial_N_per_mm": 1.0}}, {}),
    ({"arm_rear": {"radial_axis": [1.0, 0.0, 0.0]}}, {}),
    ({"arm_rear": {"tilt_Nm_per_deg": 1.0}}, {}),
    ({"arm_rear": {"radial_N_per_mm": 1e3}}, {"held": "body"}),
    ({"arm_rear": {"radial_N_per_mm": 1e3}}, {"travel": [np.nan]}),
]


@pytest.mark.parametrize(("bushings", "options"), WRONG)
def test_what_cannot_be_used(bushings, options, refused):
    refused(InputError, lambda: compliance.linear(Model("reference_car"), bushings, **options))


def test_without_a_spring_nothing_holds_the_wheel(refused):
    loose = Suspension.load("reference_car").with_changes({"strut.spring_rate_N_per_m": 0.0})
    refused(
        InputError,
        lambda: compliance.linear(Model(loose), {"arm_rear": {"radial_N_per_mm": 1e3}}, [0.0]),
    )


# -- tyres ----------------------------------------------------------------------------------------

LATERAL, LONGITUDINAL = 1.5e5, 2.5e5
ON_TYRES = {"tyre.lateral_rate_N_per_m": LATERAL, "tyre.longitudinal_rate_N_per_m": LONGITUDINAL}
SOFT_CAR = Suspension.load("reference_car").with_changes(ON_TYRES)
BUSH = {"arm_rear": {"axial_N_per_mm": 500.0, "radial_N_per_mm": 2000.0}}
RODS = {"panhard_rod_chassis": {"axial_N_per_mm": 5000.0}}


def test_a_contact_patch_moves_as_wheel_and_tyre_in_series():
    """Each by what it carries: the wheel's linkage, and the tyre's rate along the force."""
    rigid = compliance.linear(Model("reference_car"), BUSH, [0.0])
    found = compliance.linear(Model(SOFT_CAR), BUSH, [0.0])
    assert {*found} - {*rigid} == {f"patch_displacement_by_{n}" for n in ("lateral", "braking")}
    for name in rigid:
        np.testing.assert_array_equal(found[name], rigid[name])
    for load, rate in (("lateral", LATERAL), ("braking", LONGITUDINAL)):
        wheel, patch = (
            float(found[f"{kind}_by_{load}"][0]) for kind in ("displacement", "patch_displacement")
        )
        assert patch == pytest.approx(wheel + 1.0 / rate, rel=1e-12)
        assert found[f"patch_displacement_by_{load}"].attrs["display_units"] == "mm/kN"
        large = compliance.nonlinear(Model(SOFT_CAR), BUSH, load, [-3000.0], held="spring")
        give = large["patch_displacement"] - large["displacement"]
        np.testing.assert_allclose(give, -3000.0 / rate, rtol=1e-9)


@pytest.mark.parametrize(
    ("axle", "bushes"),
    [
        (Axle.from_dict({"axle": "front", "side": SOFT_CAR}), BUSH),
        (RigidAxle.load("rigid_axle").with_changes(ON_TYRES), RODS),
    ],
)
def test_contact_patches_of_both_wheels_go_with_their_own_loads(axle, bushes):
    """A force to the left is inward on the right wheel and outward on the left one."""
    found = flat(compliance.linear(axle, bushes, [0.0]))
    for how, inward in (("parallel", (-1.0, 1.0)), ("opposed", (1.0, 1.0))):
        for side, part in zip(("left", "right"), inward, strict=True):
            name = f"displacement_by_lateral_{how}_{side}"
            give = float(found[f"patch_{name}"][0] - found[name][0])
            assert give == pytest.approx(part / LATERAL, rel=1e-9), name
    large = flat(compliance.nonlinear(axle, bushes, "lateral", [2000.0], wheels=(0.5, -1.0)))
    for side, part in (("left", 0.5), ("right", -1.0)):
        give = large[f"patch_displacement_{side}"] - large[f"displacement_{side}"]
        np.testing.assert_allclose(give, 2000.0 * part / LATERAL, rtol=1e-9)


def test_a_tyre_without_rate_holds_no_wheel(refused):
    free = {"tyre.rate_N_per_m": 0.0}
    car = Suspension.load("reference_car").with_changes(free)
    rigid = RigidAxle.load("rigid_axle").with_changes(free)
    both = Axle.from_dict({"axle": "front", "side": car})
    for subject, bushes in ((car, BUSH), (both, BUSH), (rigid, RODS)):
        for call in (
            partial(compliance.linear, subject, bushes, [0.0], held="tyre"),
            partial(compliance.nonlinear, subject, bushes, "lateral", [10.0], held="tyre"),
        ):
            with refused(InputError):
                call()


# -- bushes of the hardpoint file ---------------------------------------------------------------

OF_THE_FILE = {
    "arm_rear": {"axial_N_per_mm": 500, "radial_N_per_mm": [2000.0, 900.0], "axis": [0.1, 0.9, 0]},
    "strut_top": {"axial_N_per_mm": 900.0, "radial_curve": {"mm": [0, 1, 2], "N": [0, 500, 1500]}},
    "rack": {"axial_N_per_mm": 5000.0},
}
WITH_BUSHES = Suspension.load("reference_car").with_changes({"bushings": OF_THE_FILE})


def test_bushes_of_the_file_are_those_that_are_given(refused):
    plain, soft = Model("reference_car"), Model(WITH_BUSHES)
    assert compliance.linear(soft, None, [0.0]).equals(compliance.linear(plain, OF_THE_FILE, [0.0]))
    other = {"arm_rear": {"axial_N_per_mm": 100.0}}
    assert compliance.linear(soft, other, [0.0]).equals(compliance.linear(plain, other, [0.0]))
    one, same = (
        compliance.nonlinear(model, bushes, "lateral", [1000.0])
        for model, bushes in ((soft, None), (plain, OF_THE_FILE))
    )
    assert one.equals(same)
    assert compliance.elastokinematics(soft, along=[0.0]).equals(
        compliance.elastokinematics(plain, OF_THE_FILE, along=[0.0])
    )
    refused(InputError, lambda: compliance.linear(plain))


def test_bushes_are_written_and_mirrored(tmp_path):
    path = write_toml(WITH_BUSHES, tmp_path / "soft.toml")
    assert Suspension.load(path) == WITH_BUSHES
    image = WITH_BUSHES.mirrored()
    assert image.bushings["arm_rear"]["axis"] == [0.1, -0.9, 0.0]
    assert image.mirrored() == WITH_BUSHES
    here, there = (compliance.linear(Model(side), None, [0.0]) for side in (WITH_BUSHES, image))
    for name in ("toe_by_lateral", "camber_by_braking", "displacement_by_lateral"):
        np.testing.assert_allclose(here[name], there[name], rtol=1e-9)
    assert WITH_BUSHES.with_changes({"bushings.arm_rear": None}).bushings.keys() == {
        "strut_top",
        "rack",
    }


@pytest.mark.parametrize("kind", KINDS)
def test_a_new_file_shows_how_bushes_are_written(kind):
    """The lines that are comments there are an input file without their signs."""
    text = (DATA / f"{KINDS[kind].STARTER}.toml").read_text(encoding="utf-8")
    (lines,) = re.findall(r"(# \[bushings\..*?)\n\n", text, flags=re.DOTALL)
    described = tomllib.loads(re.sub(r"^# ", "", lines, flags=re.MULTILINE))
    soft = Suspension.from_dict(tomllib.loads(text) | described)
    assert abs(float(compliance.linear(Model(soft), None, [0.0])["camber_by_lateral"][0])) > 0.0


def test_each_side_of_an_axle_has_its_own_bushes(refused):
    other = WITH_BUSHES.mirrored().with_changes({"bushings.arm_rear.axial_N_per_mm": 5000.0})
    even = Axle.from_dict({"axle": "front", "side": WITH_BUSHES})
    odd = Axle.from_dict({"axle": "front", "right": WITH_BUSHES, "left": other})
    plain = Axle.from_dict({"axle": "front", "side": "reference_car"})
    found = compliance.linear(even, None, [0.0])
    assert found.equals(compliance.linear(plain, OF_THE_FILE, [0.0]))
    uneven = compliance.linear(odd, None, [0.0])
    assert abs(float(uneven["toe_by_braking_parallel"].sel(wheel="left")[0])) < 0.9 * abs(
        float(found["toe_by_braking_parallel"].sel(wheel="left")[0])
    )
    two = other.with_changes({"bushings.rack.axial_N_per_mm": 1.0})
    refused(
        InputError, lambda: Axle.from_dict({"axle": "front", "right": WITH_BUSHES, "left": two})
    )


@pytest.mark.parametrize(
    "bushings",
    [
        {"nowhere": {"axial_N_per_mm": 1.0}},
        {"arm_rear": {"axial_N_per_mm": 1.0, "axial_damping_N_s_per_mm": 1.0}},
        {"arm_rear": {"axial_N_per_mm": 1.0, "loss_factor": 0.1}},
        {"arm_rear": 3},
        3,
        {"rack": {}},
    ],
)
def test_bushes_of_the_file_that_are_none(bushings, refused):
    refused(
        InputError, lambda: Suspension.load("reference_car").with_changes({"bushings": bushings})
    )


def test_commands_take_bushes_from_the_file(kintrafo, tmp_path, ends):
    write_toml(WITH_BUSHES, tmp_path / "soft.toml")
    text = "[bushings.arm_rear]\naxial_N_per_mm = 400.0\n"
    (tmp_path / "b.toml").write_text(text, encoding="utf-8")
    soft = ("soft.toml", "--bushes", "b.toml")
    code, out, err = kintrafo("compliance", "soft.toml", "--bump", 10, "--rebound", 10)
    assert (code, "in place of" in err + out) == (0, False)
    ends(0, "compliance", *soft, "--bump", 10, "--rebound", 10)
    code, out, _ = kintrafo("compliance", *soft, "--json")
    assert (code, "toe_by_lateral" in json.loads(out)["variables"]) == (0, True)
    assert kintrafo("compliance", "soft.toml", "--nonlinear", "--bump", 10, "--rebound", 10)[0] == 0
    ends(2, "compliance", "reference_car")


def test_the_report_shows_the_bushes_of_the_file():
    """Each as a section of the input data, and what it does as a chapter of its own."""
    tables = {table.name: table.rows for table in input_tables(WITH_BUSHES)}
    assert tables["bushings.arm_rear"][1][:2] == ("radial_N_per_mm", "2000, 900")
    assert tables["bushings.strut_top"][1][1] == "mm: 0, 1, 2; N: 0, 500, 1500"
    assert tables["bushings.rack"][0][2] == "stiffness along its axis"
