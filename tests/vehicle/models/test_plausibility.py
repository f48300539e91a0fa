"""Common mistakes in hardpoint files, one at a time: each is reported by its name."""

import pytest
from cars.axles import BAR_OF_STRUTS
from cars.driving_cars import car_on_arms
from kintrafo import Axle, Model, Suspension, load
from kintrafo.core.errors import InputError
from kintrafo.vehicle.analysis.checkup import checkup
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.data.starter import packaged
from kintrafo.vehicle.models.plausibility import plausibility

CARS = {name: Suspension.load(name) for name in packaged()}


def changed(name, changes):
    """Return a car with changes; a section stands for all of its numbers, times a factor."""
    return CARS[name].with_changes(changes)


def with_sign(name, axis, *points):
    """Return changes that reverse one coordinate of some points."""
    place = "xyz".index(axis)
    return {
        f"hardpoints.{point}.{axis}": -getattr(CARS[name].hardpoints, point)[place]
        for point in points
    }


def swapped(name, one, other):
    points = CARS[name].hardpoints
    return {
        f"hardpoints.{one}": list(getattr(points, other)),
        f"hardpoints.{other}": list(getattr(points, one)),
    }


@pytest.mark.parametrize("name", CARS)
@pytest.mark.parametrize("mirrored", [False, True])
def test_nothing_is_wrong_with_the_cars_that_come_with_it(name, mirrored):
    car = CARS[name].mirrored() if mirrored else CARS[name]
    assert plausibility(car).problems == ()


REFERENCE, WISHBONE = "reference_car", "double_wishbone_car"
IN_MM_PER_S = {"velocity_m_per_s": [-1000.0, 0.0, 1000.0], "force_N": [-3000.0, 0.0, 1000.0]}
LONG = {"strut.length_max_mm": 3000.0}
MISTAKES = [
    (REFERENCE, with_sign(REFERENCE, "y", "tie_rod_inner"), "tie_rod_inner", "sign of y"),
    (REFERENCE, with_sign(REFERENCE, "y", "strut_top") | LONG, "strut_top", "sign of y"),
    (REFERENCE, with_sign(REFERENCE, "y", "arm_front"), "arm_front", "sign of y"),
    (REFERENCE, with_sign(REFERENCE, "z", "strut_top") | LONG, "strut_top", "z points up"),
    (REFERENCE, swapped(REFERENCE, "tie_rod_inner", "tie_rod_outer"), "tie_rod", "swapped"),
    (REFERENCE, {"rack.axis": [1.0, 0.0, 0.0]}, "[rack] axis", "across the car"),
    (REFERENCE, {"rack.axis": [0.0, 0.0, 1.0]}, "[rack] axis", "across the car"),
    (REFERENCE, {"tyre.rate_N_per_m": 200.0}, "[tyre] rate", "N/mm"),
    (REFERENCE, {"tyre.lateral_rate_N_per_m": 150.0}, "[tyre] lateral_rate", "N/mm"),
    (REFERENCE, {"strut.spring_rate_N_per_m": 25.0}, "[strut] spring_rate", "N/mm"),
    (REFERENCE, {"strut.damper_rate_N_s_per_m": 1.5}, "[strut] damper_rate", "N s/mm"),
    (REFERENCE, {"bodies.wheel.mass_kg": 22000.0}, "bodies", "grams"),
    (REFERENCE, {"bodies.knuckle.mass_kg": 15000.0}, "bodies", "grams"),
    (
        REFERENCE,
        {f"bodies.knuckle.inertia_{e}_kg_m2": 1e5 for e in ("xx", "yy", "zz")},
        "bodies.knuckle",
        "kg mm^2",
    ),
    (
        REFERENCE,
        {"bodies.wheel.inertia_spin_kg_m2": 1.1e6, "bodies.wheel.inertia_diametral_kg_m2": 6e5},
        "bodies.wheel",
        "kg mm^2",
    ),
    (REFERENCE, {"tyre.radius_mm": 0.3}, "[tyre] radius_mm = 0.3 mm", "in m?"),
    (REFERENCE, {"tyre.radius_mm": 326e3}, "[tyre] radius_mm = 326000 mm", "in another unit?"),
    (REFERENCE, {"vehicle.wheelbase_mm": 2.6}, "[vehicle] wheelbase_mm", "in metres"),
    (
        REFERENCE,
        {"vehicle.center_of_gravity_height_mm": 0.55},
        "[vehicle] center_of_gravity_height_mm",
        "in metres",
    ),
    (WISHBONE, with_sign(WISHBONE, "y", "tie_rod_inner"), "tie_rod_inner", "sign of y"),
    (WISHBONE, with_sign(WISHBONE, "y", "spring_top"), "spring_top", "sign of y"),
    (WISHBONE, swapped(WISHBONE, "tie_rod_inner", "tie_rod_outer"), "tie_rod", "swapped"),
    (WISHBONE, {"rack.axis": [1.0, 0.0, 0.0]}, "[rack] axis", "across the car"),
    (WISHBONE, {"tyre.rate_N_per_m": 200.0}, "[tyre] rate", "N/mm"),
    (WISHBONE, {"spring.rate_N_per_m": 60.0}, "[spring] rate", "N/mm"),
    (WISHBONE, {"damper.rate_N_s_per_m": 4.0}, "[damper] rate", "N s/mm"),
    (WISHBONE, {"damper": IN_MM_PER_S}, "[damper] force_N rises by 2 N s/m", "mm/s"),
    (WISHBONE, {"rack.travel_per_turn_mm": 0.05}, "[rack] travel_per_turn_mm", "in m?"),
    (WISHBONE, {"rack.travel_per_turn_mm": 5e4}, "[rack] travel_per_turn_mm", "another unit"),
    (WISHBONE, {"bodies.knuckle.com_mm": [-0.01, -0.71, 0.3]}, "[bodies.knuckle] com_mm", "metres"),
    (WISHBONE, {"bodies.knuckle.com_mm.y": 710.0}, "[bodies.knuckle] com_mm", "sign of y"),
    (
        WISHBONE,
        {"bushings": {"lower_arm_rear": {"axial_N_per_mm": 0.5}}},
        "axial_N_per_mm",
        "kN/mm",
    ),
    (
        WISHBONE,
        {"bushings": {"lower_arm_rear": {"radial_N_per_mm": [9e2, 4e5]}}},
        "radial_N",
        "N/m?",
    ),
]


@pytest.mark.parametrize(("name", "changes", "what", "why"), MISTAKES)
def test_a_mistake_is_a_problem(name, changes, what, why):
    told = plausibility(changed(name, changes)).problems
    assert any(what in text and why in text for text in told), told


def test_a_strut_on_the_other_side_is_reported_by_its_sign(refused):
    refused(InputError, lambda: changed(REFERENCE, with_sign(REFERENCE, "y", "strut_top")))


def test_metres_among_millimetres():
    inner = {"hardpoints.tie_rod_inner": [-0.14, -0.31, 0.28]}
    assert any("in metres" in text for text in plausibility(changed(REFERENCE, inner)).problems)


def test_the_caster_of_a_sign_is_unusual():
    leaning = changed(REFERENCE, {"hardpoints.strut_top.x": 228.0})
    assert any("caster" in text and "sign of x" in text for text in plausibility(leaning).notes)


def test_a_wheel_that_leans_as_on_no_car_is_unusual():
    leaning = changed(REFERENCE, {"wheel.camber_deg": 40.0})
    assert any("camber_deg = 40 deg" in text for text in plausibility(leaning).notes)


def test_a_checkup_reports_it():
    found = checkup(Model(changed(REFERENCE, with_sign(REFERENCE, "y", "tie_rod_inner"))))
    assert any("sign of y" in text for text in found.problems)


def test_a_joint_on_the_axis_of_steering_is_refused_by_name(refused):
    on_axis = [-31.999999678024796, -580.0000007297222, 814.9999990761419]
    refused(InputError, lambda: changed("offset_strut_car", {"hardpoints.tie_rod_inner": on_axis}))


# -- friction -------------------------------------------------------------------------------------


def test_friction_does_not_overdamp_the_wheel():
    """Smoothed friction is a damper at rest: what it makes of the ratio is said beside it."""
    (smooth,) = checkup(CARS[REFERENCE]).wheels
    (rough,) = checkup(changed(REFERENCE, {"strut.friction_N": 50.0})).wheels
    assert rough.equilibrium.damping_ratio == pytest.approx(
        smooth.equilibrium.damping_ratio, rel=1e-9
    )
    assert smooth.equilibrium.damping_ratio_with_friction is None
    assert rough.equilibrium.damping_ratio_with_friction > 1.0
    assert not any("overdamped" in note for note in rough.notes)


def test_the_paper_of_a_rough_strut_says_so_too():
    from kintrafo.vehicle.analysis import paper
    from kintrafo.vehicle.cli.paper import _hop

    smooth, rough = Model(CARS[REFERENCE]), Model(changed(REFERENCE, {"strut.friction_N": 50.0}))
    text = _hop(rough, paper.rest(rough))
    assert text == f"{paper.rest(smooth).hop.text}, without friction"
    assert "overdamped" in paper.rest(rough).hop.text


@pytest.mark.parametrize(
    ("key", "value"), [("diameter_mm", 0.021), ("length_mm", 0.8)], ids=["thin", "short"]
)
def test_a_bar_in_metres(key, value):
    bar = BAR_OF_STRUTS | {
        "rate_Nm_per_deg": None,
        "diameter_mm": 21.0,
        "length_mm": 800.0,
        key: value,
    }
    axle = Axle.from_dict({"axle": "front", "side": CARS[REFERENCE], "anti_roll_bar": bar})
    (found,) = assembly_of(axle).plausibility().problems
    assert found.startswith(f"[anti_roll_bar] {key} = {value} mm")


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("brakes.torque_Nm", 8.0),
        ("brakes.standstill_rad_per_s", 500.0),
        ("air.density_kg_per_m3", 0.0012),
        ("air.drag_area_m2", 6500.0),
        ("air.rear_lift_area_m2", -6500.0),
    ],
)
def test_brakes_and_air_in_other_units(key, value):
    section, name = key.split(".")
    car = load("driving_car").with_changes({key: value})
    (found,) = assembly_of(car).plausibility().problems
    assert found.startswith(f"[{section}] {name} = {value:g}")


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({}, ()),
        ({"body.com_mm": [-1200.0, 0.0, -70.0]}, ("[body] com_mm",)),
        ({f"body.inertia_{axis}_kg_m2": 2e9 for axis in ("xx", "yy", "zz")}, ("in kg mm^2",)),
    ],
    ids=["as it is", "almost on the ground", "kg mm^2"],
)
def test_the_body_of_a_car(changes, words):
    """Axles without the height of the centre of gravity take that of the car, but not this one."""
    car = assembly_of(car_on_arms().with_changes(changes))
    found = car.plausibility().problems
    assert len(found) == len(words)
    assert all(word in text for word, text in zip(words, found, strict=True))
    assert not any(checkup(part).problems for part in car.held_parts.values())
