"""Characteristics of many cars at once, against each car by itself."""

import numpy as np
import pytest
import xarray as xr
from kintrafo import InputError, Model, Suspension, characteristics, variation
from kintrafo.core.errors import KintrafoError
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.models.positions import design_height, travel_range
from kintrafo.vehicle.studies import batch
from kintrafo.vehicle.studies.curves import Curves, changed
from kintrafo.vehicle.studies.design_variables import places_of
from kintrafo.vehicle.studies.evaluation import available

ALL = ["reference_car", "double_wishbone_car", "push_rod_car", "pull_rod_car", "trailing_arm_car",
       "offset_strut_car", "multi_link_car", "chrono_generic"]  # fmt: skip


def drawn(car, count):
    """Return cars of which every number is off: points by a third of a mm, others by 1 %."""
    rng = np.random.default_rng(3)
    found = {}
    for name, place in places_of(car).items():
        if name.startswith("bushings"):
            continue
        size = 1.0 / 3.0 if name.startswith("hardpoints") else 0.01 * place.value
        found[name] = (place.value + size * rng.standard_normal(count)) * place.in_file
    return found


STOPS = {
    f"{side}_stop": {"clearance_mm": 30.0, "rate_N_per_m": 5e4, "progression_N_per_mm3": 0.1}
    for side in ("bump", "rebound")
}
TYRE = {"tyre.radius_mm": 310.0, "tyre.damper_rate_N_s_per_m": 50.0, "tyre.lifts_off": True}
KNUCKLE = {
    "bodies.knuckle.com_mm": [5.0, -690.0, 250.0],
    **{f"bodies.knuckle.inertia_{ii}_kg_m2": 0.3 for ii in ("xx", "yy", "zz")},
    **{f"bodies.knuckle.inertia_{ij}_kg_m2": 0.01 for ij in ("xy", "xz", "yz")},
}
EXTRAS = {
    "reference_car": STOPS
    | TYRE
    | KNUCKLE
    | {
        "hardpoints.strut_lower": [0.0, -700.0, 250.0],
        "hardpoints.spring_top": [-20.0, -590.0, 800.0],
        "hardpoints.spring_seat": [-5.0, -640.0, 560.0],
        "bodies.knuckle.com_along_strut_mm": None,
        "strut.friction_N": 40.0,
        "strut.length_min_mm": 300.0,
        "strut.spring_free_slide_mm": None,
        "strut.spring_free_length_mm": 400.0,
    },
    "double_wishbone_car": STOPS | TYRE | KNUCKLE | {"damper.friction_N": 30.0},
}
"""Keys that packaged files do not have."""


@pytest.mark.parametrize("name", [*ALL, *(f"{name}, with extras" for name in EXTRAS)])
def test_each_car_has_the_curves_that_it_has_alone(name):
    packaged, _, extras = name.partition(",")
    car, count = Suspension.load(packaged), 12
    car = car.with_changes(EXTRAS[packaged]) if extras else car
    values = drawn(car, count)
    model = assembly_of(car)
    looks = [Curves("travel", np.linspace(-0.04, 0.04, 5), available(model, "travel"))]
    if car.steered():
        looks.append(Curves("rack", np.array([-0.03, 0.01, 0.03]), available(model, "rack")))
    found = [np.full((count, len(c.names), c.positions.size), np.nan) for c in looks]
    together = batch._together(car, values, looks, found)
    # bodies whose inertia is off by chance may be none, and then go by themselves
    assert together.sum() >= count // 4
    for one in np.flatnonzero(together):
        itself = changed(car, {place: float(column[one]) for place, column in values.items()})
        for look, rows in zip(looks, found, strict=True):
            wanted = look.of(assembly_of(itself))
            greatest = np.nanmax(np.where(np.isfinite(wanted), np.abs(wanted), 0.0), axis=1)
            # the arm's angle is found to its last digits, by other steps; a rate of the axis of a
            # screw is a difference over a step of 1e-3
            limit = 1e-10 * np.maximum(greatest, 1e-3)[:, None]
            np.testing.assert_array_equal(np.isnan(rows[one]), np.isnan(wanted))
            assert (np.nan_to_num(np.abs(rows[one] - wanted)) <= limit).all()


def alone(car, changes, at, name):
    """Return the curve of one car by itself, or why it has none."""
    try:
        return characteristics.over(Model(car.with_changes(changes)), "travel", at)[name].values
    except KintrafoError as error:
        return str(error)


def held_against_each(car, values, at, name, rounding=1e-14):
    """Hold many cars against each by itself; return who has no curve."""
    found = variation.cars(car, values, positions=at, names=[name])
    for one, reason in enumerate(found["reason"].values.tolist()):
        wanted = alone(car, {p: float(column[one]) for p, column in values.items()}, at, name)
        if isinstance(wanted, str):
            assert reason == wanted
            assert np.isnan(found[name].values[one]).all()
        else:
            assert not reason
            np.testing.assert_allclose(found[name].values[one], wanted, rtol=0, atol=rounding)
    return [bool(reason) for reason in found["reason"].values]


def test_cars_that_cannot_be_say_why_and_the_others_go_on():
    values = {
        "hardpoints.tie_rod_inner.z": np.array([280.0, 281.0, 1e9, 279.0, 280.0]),
        "strut.spring_rate_N_per_m": np.array([25e3, 24e3, 25e3, -1.0, 25e3]),
    }
    car = Suspension.load("reference_car")
    gone = held_against_each(car, values, [0.0, 0.02], "toe")
    assert gone == [False, False, True, True, False]


def test_a_position_beyond_the_reach_of_some_is_theirs_alone():
    car = Suspension.load("reference_car")
    values = {"hardpoints.strut_top.z": 820.0 + np.array([0.0, -4.0, 4.0, 1.0, -0.2, 0.2])}
    model = Model(car)
    end = travel_range(model).height[0] - design_height(model) + 1e-5
    # beside a dead point a rounding of the height is more than one of the angle
    gone = held_against_each(car, values, [end, 0.0], "camber", rounding=1e-12)
    assert any(gone)
    assert not all(gone)


LENGTHS = {
    "multi_link_car": {"damper.length_min_mm": 420.0, "damper.length_max_mm": 590.0},
    "pull_rod_car": {"damper.length_min_mm": 260.0, "damper.length_max_mm": 345.0},
}


@pytest.mark.parametrize("name", LENGTHS)
def test_cars_go_together_up_to_the_ends_of_their_dampers(name, monkeypatch):
    """Within the last step of the arm, too, where only who does not get there goes by himself."""
    car = Suspension.load(name).with_changes(LENGTHS[name])
    model, off = Model(car), np.array([0.0, 0.3, -0.3, 0.1, -0.1, 0.05])
    top, length = car.hardpoints.wheel_center[2], LENGTHS[name]["damper.length_min_mm"]
    cars = {
        "hardpoints.wheel_center.z": top + off[::-1],
        "damper.length_min_mm": length + off,  # the end is another for each
    }
    # the dampers of some end before that
    ends = np.array(travel_range(model).height) - design_height(model)
    at = [float(ends[0]) + 1e-3, 0.0, float(ends[1]) - 1e-4]
    by_themselves = []

    def counted(*given, **options):
        by_themselves.append(given)
        return assembly_of(*given, **options)

    monkeypatch.setattr(batch, "assembly_of", counted)
    # an angle is found to its last digits, by other steps
    gone = held_against_each(car, cars, at, "toe", rounding=1e-13)
    assert 0 < sum(gone) < len(gone)
    assert len(by_themselves) == sum(gone)


def test_another_branch_is_not_taken_for_somebody():
    """With friction the equations are others: such cars go by themselves."""
    car = Suspension.load("reference_car")
    found = variation.cars(
        car, {"strut.friction_N": [0.0, 0.0, 50.0, 0.0]}, positions=[0.01], names=["wheel_rate"]
    )
    np.testing.assert_allclose(found["wheel_rate"].values[2], found["wheel_rate"].values[0])
    assert not found["reason"].values.any()


def test_grids_reductions_and_threads():
    car = Suspension.load("reference_car")
    grid = xr.Dataset(
        coords={
            "hardpoints.tie_rod_inner.z": [278.0, 280.0, 282.0],
            "strut.spring_rate_N_per_m": [20e3, 25e3],
        }
    )
    whole = variation.cars(car, grid, positions=[-0.03, 0.0, 0.03], names=["toe", "wheel_rate"])
    assert whole["toe"].dims[:2] == ("hardpoints.tie_rod_inner.z", "strut.spring_rate_N_per_m")
    picked = whole["wheel_rate"].sel({"strut.spring_rate_N_per_m": 25e3})
    assert (picked.values > whole["wheel_rate"].values[:, 0]).all()
    rows = {"hardpoints.tie_rod_inner.z": np.linspace(278.0, 282.0, 1100)}
    asked = {"positions": [-0.03, 0.0, 0.03], "names": ["toe"]}
    curves = variation.cars(car, rows, **asked, threads=2)
    kept = variation.cars(car, rows, **asked, threads=1, reductions=["min", "max", "mean", "range"])
    for name, reduced in (("min", np.min), ("max", np.max), ("mean", np.mean), ("range", np.ptp)):
        wanted = reduced(curves["toe"].values, axis=1)
        np.testing.assert_array_equal(kept[f"toe_{name}"].values, wanted)


@pytest.mark.parametrize(
    "values",
    [
        {},
        {"hardpoints.ball_joint.w": [1.0]},
        {"hardpoints.ball_joint.z": [1.0, np.nan]},
        {"hardpoints.ball_joint.z": [1.0, 2.0], "wheel.toe_deg": [0.0] * 3},
        3.0,
    ],
)
def test_what_cannot_be_used_is_refused_by_name(values, refused):
    refused(
        InputError, lambda: variation.cars(Suspension.load("reference_car"), values, names=["toe"])
    )
