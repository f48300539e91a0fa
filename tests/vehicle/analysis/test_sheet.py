"""The K&C sheet: what stands in it, and with which sign in which axes."""

import csv
from pathlib import Path

import numpy as np
import pytest
from kintrafo import Axle, Car, InputError, Model, RigidAxle, characteristics, compliance, load
from kintrafo.vehicle.analysis.sheet import one_page, sheet, tabulated
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.models.positions import arm_angles, design_height
from kintrafo.vehicle.models.reach import at_rest
from kintrafo.vehicle.models.sides import SIDES

BUSHES = {"arm_rear": {"axial_N_per_mm": 400.0, "radial_N_per_mm": 1200.0}}
# x forward, y right, z down
TO_SAE = np.diag([1.0, -1.0, -1.0])
TURNED = {"steer_gradient", "roll_steer", "roll_center_lateral", "heave_steer", "jacking"}


def _heading(model, rack, axes):
    """Return the direction of the knuckle's forward axis about z in some axes [deg]."""
    states, inputs = at_rest(model, arm_angles(model, [design_height(model)], rack), rack)
    turned = model.evaluate("orientations", states, inputs)
    forward = axes @ turned[0, model.equations.BODIES.index("knuckle")] @ [1.0, 0.0, 0.0]
    return float(np.degrees(np.arctan2(forward[1], forward[0])))


@pytest.mark.parametrize(("name", "axes"), [("iso_8855", np.eye(3)), ("sae_j670", TO_SAE)])
def test_steering_counts_about_the_z_axis_of_each_system(name, axes):
    """By the turn of the knuckle, in either system of axes by the right-hand rule."""
    model, step = Model("reference_car"), 1e-4
    turn = _heading(model, step, axes) - _heading(model, -step, axes)
    found = sheet(model).sel(quantity="steer_gradient")
    assert float(found[name]) == pytest.approx(turn / (2e3 * step), rel=1e-5)


def test_only_what_has_a_side_of_the_vehicle_has_another_sign():
    subjects = [Model("reference_car"), Axle.load("reference_axle"), RigidAxle.load("rigid_axle")]
    turned = set()
    for found in map(sheet, subjects):
        signs = zip(found["iso_8855_sign"].values, found["sae_j670_sign"].values, strict=True)
        other = np.array([one != two for one, two in signs])
        iso, sae = found["iso_8855"].values, found["sae_j670"].values
        np.testing.assert_array_equal(np.where(other, -iso, iso), sae)
        names = found["quantity"].values[other]
        turned |= {n.removesuffix("_left").removesuffix("_right") for n in names}
    assert turned == TURNED


def test_the_values_are_those_of_the_curves_at_design_in_the_units_for_people():
    axle = Axle.load("reference_axle")
    found = sheet(axle, BUSHES, held="spring")
    curves = compliance.linear(axle, BUSHES, [0.0], held="spring")
    here = found["iso_8855"].sel(quantity="toe_by_braking_opposed_left")
    toe = np.degrees(curves["toe_by_braking_opposed"].sel(wheel="left").item()) * 1e3
    assert here.item() == pytest.approx(toe, rel=1e-12)
    roll = characteristics.over(axle, "roll", [0.0])["roll_stiffness"].item() * np.pi / 180.0
    assert found["iso_8855"].sel(quantity="roll_stiffness").item() == pytest.approx(roll)
    units = dict(zip(found["quantity"].values, found["unit"].values, strict=True))
    assert units["toe_by_aligning_opposed_left"] == "deg/100 N m"
    assert units["motion_ratio_left"] == "-"
    assert found.attrs["held"] == "spring and stops carry the wheel"


def test_compliance_is_there_where_there_are_bushes():
    model = Model("reference_car")
    assert "compliance" not in sheet(model)["part"].values
    soft = Model(model.suspension.with_changes({"bushings": BUSHES}))
    np.testing.assert_array_equal(sheet(soft)["iso_8855"], sheet(model, BUSHES)["iso_8855"])
    curves = compliance.linear(model, BUSHES, [0.0])
    inward = curves["displacement_by_lateral"].item() * 1e6
    found = sheet(soft)["iso_8855"].sel(quantity="displacement_by_lateral")
    assert found.item() == pytest.approx(inward, rel=1e-12)


def test_a_table_has_both_wheels_side_by_side():
    tables = tabulated(sheet(Axle.load("reference_axle")), "")
    assert [table.title for table in tables] == ["at rest", "in bump", "in roll", "steered"]
    (camber,) = [row for row in tables[2].rows if row[0] == "roll camber"]
    assert camber[1] == camber[2].removeprefix("-")
    assert camber[3:5] == ("", "deg/deg")
    every = [row for table in tables for row in table.rows]
    assert len({row[0] for row in every}) == len(every)


def test_what_cannot_be_is_refused_by_name(refused):
    refused(InputError, lambda: sheet("reference_car"))
    with pytest.raises(InputError, match="held"):
        sheet(Model("reference_car"), held="tight")
    refused(InputError, lambda: sheet(RigidAxle.load("rigid_axle"), BUSHES))


@pytest.mark.parametrize("axle", ["reference_axle", "rigid_axle"])
def test_an_axle_with_bushes_has_one_page(axle, kintrafo):
    point = "panhard_rod_chassis" if axle == "rigid_axle" else "arm_rear"
    Path("bushes.toml").write_text(f"[bushings.{point}]\naxial_N_per_mm = 400\n", encoding="utf-8")
    code, out, err = kintrafo("sheet", axle, "--bushes", "bushes.toml")
    assert code == 0, err
    lines = out.splitlines()
    assert len(lines) <= 60
    assert max(map(len, lines)) <= 110
    found = sheet(load(axle), {point: {"axial_N_per_mm": 400.0}})["iso_8855"]
    row = next(line for line in lines if line.startswith("lateral, both to the left"))
    sides = [found.sel(quantity=f"toe_by_lateral_parallel_{side}").item() for side in SIDES]
    assert [float(cell) for cell in row.split()[5:7]] == pytest.approx(sides, rel=1e-3)
    assert ("to left *" in out) == (axle == "rigid_axle")  # the other sign in SAE J670


def test_the_command_prints_it_and_writes_definitions(kintrafo):
    code, out, err = kintrafo("sheet", "rigid_axle", "-o", "sheet.csv")
    assert code == 0, err
    assert "IN ROLL" in out
    assert "roll steer *" in out  # the other sign in SAE J670
    assert "SAE J670, z down" in out
    with Path("sheet.csv").open(encoding="utf-8") as file:
        rows = {row["quantity"]: row for row in csv.DictReader(file)}
    steer = rows["roll_steer"]
    assert float(steer["iso_8855"]) == -float(steer["sae_j670"]) != 0.0
    assert steer["sae_j670_sign"].endswith("steers to the right")
    assert steer["definition"]


def test_a_car_has_the_sheets_of_its_axles(refused):
    """Values of both axle files, without the steering of the rear, whose rack is fixed."""
    car = load("reference_vehicle")
    soft = {"front": BUSHES, "rear": {"upper_arm_rear": BUSHES["arm_rear"]}}
    axles = {end: assembly_of(axle).with_bushings(soft[end]) for end, axle in car.axles.items()}
    found = sheet(car.with_changes({end: axle.to_dict() for end, axle in axles.items()}))
    values = dict(zip(found["quantity"].values, found["iso_8855"].values, strict=True))
    wanted = {}
    for end, axle in axles.items():
        own = sheet(axle)
        rows = zip(own["quantity"].values, own["part"].values, own["iso_8855"].values, strict=True)
        for name, part, value in rows:
            stem = name.removesuffix("_left").removesuffix("_right")
            if end == "front" or part != "steered":
                wanted[f"{stem}_{end}{name.removeprefix(stem)}"] = value
    assert values == wanted
    assert "toe_by_lateral_opposed_rear_right" in values
    assert "steer_gradient_rear_left" not in values
    refused(InputError, lambda: sheet(car, BUSHES))


def test_axles_whose_signs_differ_have_rows_of_their_own():
    """The jacking coefficient counts inboard forces, and those to the left on a rigid axle."""
    data = load("reference_vehicle").to_dict()
    data["rear"] = load("rigid_axle").to_dict()
    del data["rear"]["vehicle"], data["front"]["side"]["vehicle"]["center_of_gravity_height_mm"]
    found = sheet(Car.from_dict(data))
    rows = [row for table in tabulated(found, "") for row in table.rows if "jacking" in row[0]]
    front, rear = ([bool(cell) for cell in row[1:-3]] for row in rows)
    assert [a or b for a, b in zip(front, rear, strict=True)].count(True) == 3
    assert not any(a and b for a, b in zip(front, rear, strict=True))
    assert [row[-1] for row in rows] == ["the same", "the other sign"]
    (page,) = one_page(found, "")
    assert [row[0] for row in page.rows if "jack" in row[0]] == [
        "jacking coefficient",
        "jacking coefficient of the axle *",
    ]


def test_the_page_of_a_car_has_a_column_for_each_axle_of_mirror_images(kintrafo):
    code, out, err = kintrafo("sheet", "bmw_e90")
    assert code == 0, err
    assert "front axle   rear axle" in out
    car = load("bmw_e90")
    row = next(line for line in out.splitlines() if line.startswith("bump steer"))
    steer = [sheet(axle).sel(quantity="bump_steer_left") for axle in car.axles.values()]
    cells = [float(cell) for cell in row.split()[2:4]]
    assert cells == pytest.approx([one["iso_8855"].item() for one in steer], rel=1e-4)


@pytest.mark.parametrize("rear", ["rigid_axle", "twist_beam"])
def test_rows_of_a_car_with_different_axles_have_different_names(rear):
    """Quantities with one name have one row, so that front and rear are side by side."""
    data = load("reference_vehicle").to_dict()
    data["rear"] = load(rear).to_dict()
    del data["rear"]["vehicle"], data["front"]["side"]["vehicle"]["center_of_gravity_height_mm"]
    for table in tabulated(sheet(Car.from_dict(data)), ""):
        names = [row[0] for row in table.rows]
        assert len({*names}) == len(names)
