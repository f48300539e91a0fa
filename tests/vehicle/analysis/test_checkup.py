"""The ride frequency of a checkup, from the potential of the spring; usual values on the page."""

import re
from dataclasses import replace

import numpy as np
import pytest
from kintrafo import Model, PositionError, Suspension, load, loads
from kintrafo.vehicle.analysis.checkup import USUAL_HOP, USUAL_RIDE, as_dict, checkup
from kintrafo.vehicle.analysis.wheel_facts import NO_STIFFNESS
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.models.plausibility import typical_ranges
from kintrafo.vehicle.models.points import hardpoints
from kintrafo.vehicle.models.positions import state_at_height
from support.folders import ROOT

PAGE = ROOT / "docs/suspension/characteristics.md"

STEP = 1e-3  # of the wheel's height [m]


def spring_energy(car, free_length, height):
    """Return the energy of a spring between its two points, with the wheel at a height [J]."""
    model = Model(car)
    points = hardpoints(model, state_at_height(model, height))
    length = np.linalg.norm(points["spring_top"] - points["spring_seat"])
    return 0.5 * car.spring.rate_N_per_m * (length - free_length) ** 2


def test_ride_frequency_from_the_potential_of_the_spring():
    car = Suspension.load("double_wishbone_car")
    (wheel,) = checkup(Model(car)).wheels
    found = wheel.equilibrium
    length = car.hardpoints.distance("spring_top", "spring_seat")
    free = length + car.spring.force_at_design_N / car.spring.rate_N_per_m
    below, here, above = (
        spring_energy(car, free, found.height + rise) for rise in (-STEP, 0.0, STEP)
    )
    load = (above - below) / (2.0 * STEP)
    rate = (above - 2.0 * here + below) / STEP**2
    both = 1.0 / (1.0 / rate + 1.0 / car.tyre.rate_N_per_m)
    # central differences: relative error some STEP^2
    expected = np.sqrt(both * 9.81 / load) / (2.0 * np.pi)
    assert found.ride_frequency == pytest.approx(expected, rel=1e-5)


def test_a_spring_that_carries_nothing_has_no_ride_frequency():
    car = Suspension.load("reference_car").with_changes({"strut.spring_rate_N_per_m": 0.0})
    found = checkup(Model(car))
    assert found.wheels[0].equilibrium.ride_frequency is None
    assert as_dict(found)["equilibrium"]["ride_frequency"] is None


SPRINGLESS = {
    "reference_car": {"strut.spring_rate_N_per_m": 0.0},
    "rear_axle": {"side.spring.rate_N_per_m": 0.0},
    "rigid_axle": {"spring.rate_N_per_m": 0.0},
    "twist_beam": {"spring.rate_N_per_m": 0.0},
    "steered_rigid_axle": {"spring.rate_N_per_m": 0.0},
}


@pytest.mark.parametrize("name", SPRINGLESS)
def test_where_only_tyres_hold_the_wheels_load_cases_have_no_equilibrium(name, refused):
    """Rest on the road is stable by the tyres, and constant forces are not carried: both say so."""
    subject = load(name)
    assert NO_STIFFNESS not in " ".join(checkup(subject).notes)
    changes = dict(SPRINGLESS[name])
    for key in [key for key in changes if "spring.rate" in key]:
        force = key.replace("rate_N_per_m", "force_at_design_N")
        changes |= {force: None, key.replace("rate_N_per_m", "free_length_mm"): 300.0}
    without = subject.with_changes(changes)
    found = checkup(without)
    assert NO_STIFFNESS in " ".join(found.notes)
    assert all(wheel.equilibrium is not None for wheel in found.wheels)
    refused(
        PositionError, lambda: loads.static(without, {"static": {"contact_g": [0.0, 0.0, 1.0]}})
    )


@pytest.mark.parametrize("name", ["reference_car", "reference_axle", "rigid_axle"])
def test_a_first_look_has_what_moves_by_itself_and_what_both_wheels_have(name):
    found = checkup(load(name))
    assert [wheel.side for wheel in found.wheels] == ([] if name == "rigid_axle" else ["right"])
    assert (found.axle is None) == (name == "reference_car")
    assert found.problems == ()
    for wheel in found.wheels:
        assert wheel == checkup(Model("reference_car")).wheels[0]


@pytest.mark.parametrize("name", ["reference_car", "reference_axle", "rigid_axle"])
def test_without_friction_nothing_else_changes(name):
    subject = load(name)
    key = {"reference_car": "strut", "rigid_axle": "damper"}.get(name, "")
    if key:
        rough = subject.with_changes({f"{key}.friction_N": 30.0})
    else:
        rough = replace(
            subject,
            **{s: one.with_changes({"strut.friction_N": 30.0}) for s, one in subject.sides.items()},
        )
    smooth = assembly_of(rough).without_friction().subject
    assert smooth == assembly_of(subject).without_friction().subject != rough


def test_the_page_has_the_ranges_that_are_used():
    """Each line of the table: names or words, the range with its unit, the source."""
    _, _, table = PAGE.read_text(encoding="utf-8").partition("## Typical ranges of passenger cars")
    table, _, _ = table.partition("\n## ")
    written = {}
    for names, low, high, unit in re.findall(
        r"^\| (.+?) \| (-?[\d.]+) to (-?[\d.]+) ?(\S*) \|", table, flags=re.MULTILINE
    ):
        for name in re.findall(r"`(\w+)`", names) or [names]:
            written[name] = float(low), float(high), unit
    used = {
        name: (usual["low"], usual["high"], usual["unit"])
        for name, usual in typical_ranges("macpherson").items()
    }
    used |= {"ride frequency": (*USUAL_RIDE, "Hz"), "wheel hop": (*USUAL_HOP, "Hz")}
    assert written == used
