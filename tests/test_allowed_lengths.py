"""Lengths that a strut or a damper cannot have end the travel; no position is beyond them."""

import numpy as np
import pytest
from kintrafo import Model, PositionError, Suspension, state_at_height, travel_range
from kintrafo.core.errors import InputError
from kintrafo.suspension.reach import at_rest
from kintrafo.suspension.starter import write_starter


def lengths(model, signal):
    """Return a length over the whole reach [m]."""
    return model.signals(*at_rest(model, np.linspace(*travel_range(model).arm_angle, 500)))[signal]


def test_no_strut_goes_through_its_own_mount():
    """Its lower end is 50 mm below the mount, and the wheel could rise by more."""
    car = Suspension.load("offset_strut_car")
    top, lower = (np.array(getattr(car.hardpoints, n)) for n in ("strut_top", "strut_lower"))
    near = top + 50.0 * (lower - top) / np.linalg.norm(lower - top)
    model = Model(car.with_changes({"hardpoints.strut_lower": near.tolist()}))
    reach = travel_range(model)
    assert "drawn in until its ends strut_top and strut_lower meet" in reach.upper_limit
    assert (lengths(model, "strut_length") > 0.0).all()


def test_a_strut_has_a_least_length():
    car = Suspension.load("reference_car")
    model = Model(car.with_changes({"strut.length_min_mm": 500.0}))
    reach = travel_range(model)
    assert "[strut] length_min_mm = 500 mm" in reach.upper_limit
    found = lengths(model, "strut_length")
    # the end is found to 1e-12 rad
    assert found.min() == pytest.approx(0.5, abs=1e-11)
    with pytest.raises(PositionError, match="length_min_mm"):
        state_at_height(model, reach.height[1] + 1e-6)


def test_a_damper_beside_the_spring_has_two_ends():
    car = Suspension.load("double_wishbone_car")
    changes = {"damper.length_min_mm": 380.0, "damper.length_max_mm": 480.0}
    model = Model(car.with_changes(changes))
    reach = travel_range(model)
    assert "length_max_mm = 480 mm" in reach.lower_limit
    assert "length_min_mm = 380 mm" in reach.upper_limit
    found = lengths(model, "spring_length")
    assert [found.min(), found.max()] == pytest.approx([0.38, 0.48], abs=1e-11)


@pytest.mark.parametrize(
    ("name", "changes", "words"),
    [
        ("reference_car", {"strut.length_min_mm": 700.0}, "more than the length at design"),
        ("reference_car", {"strut.length_min_mm": 0.0}, "out of range"),
        ("double_wishbone_car", {"damper.length_min_mm": 500.0}, "at design the damper is"),
        ("double_wishbone_car", {"damper.length_max_mm": 400.0}, "at design the damper is"),
    ],
)
def test_a_design_position_beyond_an_end_is_refused(name, changes, words):
    with pytest.raises(InputError, match=words):
        Suspension.load(name).with_changes(changes)


@pytest.mark.parametrize("template", ["reference_car", "double_wishbone_car"])
def test_a_first_file_keeps_motions_within_what_there_is(template, tmp_path):
    car = Suspension.load(write_starter(tmp_path / "car.toml", template=template))
    assert car.allowed_lengths()
    assert car.tyre.lifts_off
    assert car.bump_stop.rate_N_per_m > 0.0
    assert car.rebound_stop.rate_N_per_m > 0.0
    assert Suspension.load(template).allowed_lengths() == ()
