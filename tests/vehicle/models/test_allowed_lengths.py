"""Lengths that a strut or a damper cannot have end the travel; no position is beyond them."""

from dataclasses import replace

import numpy as np
import pytest
from kintrafo import (
    Axle,
    AxleModel,
    Model,
    PositionError,
    RigidAxle,
    RigidAxleModel,
    Suspension,
    ensemble,
    equilibrium,
    roads,
    simulate,
    state_at_height,
    travel_range,
)
from kintrafo.core.errors import InputError
from kintrafo.vehicle import studies as variation
from kintrafo.vehicle.analysis.scenario import Scenario
from kintrafo.vehicle.data.starter import write_starter
from kintrafo.vehicle.models.reach import at_rest

KINDS = ("reference_car", "offset_strut_car", "double_wishbone_car", "multi_link_car",
         "push_rod_car", "pull_rod_car", "trailing_arm_car")  # fmt: skip
STEP = {"road_height": roads.step(0.04, at=0.02, end=0.3)}


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
    ("name", "changes"),
    [
        ("reference_car", {"strut.length_min_mm": 700.0}),
        ("reference_car", {"strut.length_min_mm": 0.0}),
        ("double_wishbone_car", {"damper.length_min_mm": 500.0}),
        ("double_wishbone_car", {"damper.length_max_mm": 400.0}),
    ],
)
def test_a_design_position_beyond_an_end_is_refused(name, changes, refused):
    refused(InputError, lambda: Suspension.load(name).with_changes(changes))


@pytest.mark.parametrize("template", ["reference_car", "double_wishbone_car"])
def test_a_first_file_keeps_motions_within_what_there_is(template, tmp_path):
    car = Suspension.load(write_starter(tmp_path / "car.toml", template=template))
    assert car.allowed_lengths()
    assert car.tyre.lifts_off
    assert car.bump_stop.rate_N_per_m > 0.0
    assert car.rebound_stop.rate_N_per_m > 0.0
    assert Suspension.load(template).allowed_lengths() == ()


def limited(name, end, by):
    """Return a packaged car with an end so far from its length at rest, the key and the signal."""
    car = Suspension.load(name)
    section = "strut" if hasattr(car, "strut") else "damper"
    plain = Model(car)
    signal = f"{car.STOPPED}_length"
    length = float(plain.signal(signal, equilibrium(plain)))
    key = f"{section}.length_{end}_mm"
    return Model(car.with_changes({key: 1e3 * (length + by)})), key.partition(".")[2], signal


@pytest.mark.parametrize(
    ("name", "end", "by"),
    [
        *((name, "min", -0.002) for name in KINDS),
        # a strut that is drawn out ends nothing
        *((name, "max", 0.002) for name in KINDS if "strut" not in Suspension.load(name).to_dict()),
    ],
)
def test_a_motion_beyond_a_length_says_so(name, end, by):
    """Of every kind, by the lengths at its outputs; and nothing is said of a motion within."""
    model, key, signal = limited(name, end, by)
    road = roads.step(0.04 if end == "min" else -0.04, at=0.02, end=0.3)
    found = simulate(model, (0.0, 0.3), equilibrium(model), inputs={"road_height": road})
    least, most = found.signals[signal].min(), found.signals[signal].max()
    (beyond,) = [one for one in found.validity if key in one.bound.words]
    assert beyond.worst == (least if end == "min" else most)
    assert not beyond.bound.possible
    rest = simulate(model, (0.0, 0.05), equilibrium(model))
    assert not any(key in one.bound.words for one in rest.validity)


def test_many_cars_say_so_each():
    model, _, signal = limited("double_wishbone_car", "min", -0.030)
    rates = [200.0, 20000.0]
    found = ensemble(
        model, {"damper_rate": rates}, (0.0, 0.3), equilibrium(model), inputs=STEP,
        reductions={signal: "min"},
    )  # fmt: skip
    limit = model.allowed_lengths()[0].limit
    np.testing.assert_array_equal(found["valid"], found[f"{signal}_min"] >= limit)
    assert found["valid"].values.tolist() == [False, True]


def test_ends_are_not_swept(refused):
    """All cars of a sweep have the ends of one."""
    car = Suspension.load("double_wishbone_car").with_changes({"damper.length_min_mm": 380.0})
    values = {"damper.length_min_mm": [370.0, 380.0]}
    refused(InputError, lambda: variation.sweep(car, values, Scenario(inputs=STEP)))


def test_an_axle_says_so_of_the_side():
    car = limited("reference_car", "min", -0.002)[0].suspension
    model = AxleModel(replace(Axle.load("reference_axle"), right=car.mirrored(), left=car))
    raised = {"left_road_height": STEP["road_height"]}
    found = simulate(model, (0.0, 0.3), equilibrium(model), inputs=raised)
    # the bar also lifts the other wheel from its road
    told = [str(one) for one in found.validity if "length_min_mm" in one.bound.words]
    assert told[0].startswith("the left strut is beyond its least length, [strut] length_min_mm")


def test_a_rigid_axle_says_so_and_does_not_rest_beyond(refused):
    axle = RigidAxle.load("rigid_axle")
    plain = RigidAxleModel(axle)
    length = float(plain.signal("left_damper_length", equilibrium(plain)))
    model = RigidAxleModel(axle.with_changes({"damper.length_min_mm": 1e3 * (length - 0.002)}))
    raised = {"left_road_height": STEP["road_height"]}
    found = simulate(model, (0.0, 0.3), equilibrium(model), inputs=raised)
    assert "left_damper_length" in [one.bound.signal for one in found.validity]
    refused(PositionError, lambda: equilibrium(model, road_height={"left": 0.04, "right": 0.04}))
