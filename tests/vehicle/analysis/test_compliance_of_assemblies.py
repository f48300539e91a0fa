"""Compliance of corners, axles and rigid axles: what holds for every assembly on its bushes."""

from importlib import import_module

import numpy as np
import pytest
import xarray as xr
from cars.rigid_axles import AXLE, FIVE
from golden.subjects import BUSHES
from kintrafo import Axle, InputError, Model, RigidAxle, compliance, load
from kintrafo.vehicle.data.starter import whole_axles
from oracle.bushes import BAR_OF, BUSHES_OF, LINKED, RACK, STRUT, TRAILING, UNDER, WISHBONES

STIFF_RACK = {"rack": {"axial_N_per_mm": 2500.0}}
RODS = {
    point: {"axial_N_per_mm": rate, "radial_N_per_mm": rate}
    for point, rate in {
        "left_link_chassis": 400.0,
        "right_link_axle": 600.0,
        "upper_link_chassis": 500.0,
        "panhard_rod_axle": 900.0,
    }.items()
}
OF_FIVE = RODS | {"right_upper_link_chassis": {"axial_N_per_mm": 700.0, "radial_N_per_mm": 700.0}}
# Axles without sides besides the rigid one, by their data sets.
OTHERS = [name for name in whole_axles() if name != AXLE.KEY]
FREE = {"gravity.acceleration_m_per_s2": 0.0, "spring.force_at_design_N": 0.0}
HEAVY = {"gravity.acceleration_m_per_s2": 9.81}


def with_rack(car):
    """Return the bushes of a car, and a soft rack if it has one."""
    return BUSHES_OF[car] | (RACK if car.steered() else {})


def force_at_design(car):
    return "strut.spring_force_at_design_N" if car is STRUT else "spring.force_at_design_N"


# Bar, rack and both sides are soft; stops, which only push, are left out.
AXLE_OF_STRUTS = Axle.from_dict(
    {
        "axle": "front",
        "side": STRUT.with_changes({"bump_stop": None}),
        "anti_roll_bar": BAR_OF[STRUT],
    }
)
WITHOUT_LOAD = {
    **{
        car.suspension: (Model(car.with_changes({"bump_stop": None})), BUSHES_OF[car], {})
        for car in (STRUT, WISHBONES, LINKED, TRAILING)
    },
    **{
        f"axle, {wheels}": (AXLE_OF_STRUTS, BUSHES_OF[STRUT] | STIFF_RACK, {"wheels": wheels})
        for wheels in ("parallel", "opposed", "left")
    },
    "rigid axle": (AXLE.with_changes(FREE), RODS, {"wheels": (-1.0, 0.6)}),
    "five rods": (FIVE.with_changes(FREE), OF_FIVE, {"wheels": (-1.0, 0.6)}),
    **{
        name: (load(name).with_changes(FREE), BUSHES[name], {"wheels": (-1.0, 0.6)})
        for name in OTHERS
    },
}


# Corners, axles and axles without sides are each held in all four ways, every one in two of them.
HELD = [
    pytest.param(*case, held, id=f"{name}-{held}")
    for i, (name, case) in enumerate(WITHOUT_LOAD.items())
    for held in (("height", "spring"), ("tyre", "locked"))[i % 2]
]


@pytest.mark.parametrize(("of", "bushes", "options", "held"), HELD)
def test_small_loads_are_those_of_the_unit_load_theorem(of, bushes, options, held):
    """Without a static load both differ by a part in proportion to the load."""
    off, sizes = [], np.array([20.0, 2.0])
    for under in UNDER:
        amounts = sizes if under != "aligning" else 0.3 * sizes
        found = compliance.nonlinear(
            of, bushes, under, amounts, held=held, hardpoints="relaxed", **options
        )
        for name in found.data_vars:
            if name.endswith("_change"):
                by_load = found[name].transpose("data_set", "load", ...).values
                change = by_load.reshape(2, 2, -1)
                least = np.maximum(abs(change[1]), 1e-8 * sizes[:, None])
                off.append(abs(change[0] - change[1]) / least)
    first, second = np.concatenate(off, axis=1)
    # of a beam that moves along its rods, the part is the largest
    assert (first < (0.05 if isinstance(of, RigidAxle) else 0.03)).all()
    # a tenth of it, but for rounding: 1e-10 rad of 1e-6 rad
    assert (second < 0.13 * first + 1e-4).all()


# With a bar that is twisted at design and loads the bushes there.
LOADED = {
    **{
        car.suspension: (
            Model(car.with_changes(HEAVY | {force_at_design(car): 4000.0})),
            with_rack(car),
        )
        for car in (STRUT, WISHBONES, LINKED, TRAILING)
    },
    "axle": (
        Axle.from_dict(
            {
                "axle": "front",
                "side": STRUT.with_changes(HEAVY | {force_at_design(STRUT): 4000.0}),
                "anti_roll_bar": BAR_OF[STRUT] | {"free_twist_deg": 4.0},
            }
        ),
        BUSHES_OF[STRUT] | RACK,
    ),
    "rigid axle": (AXLE, RODS),
    **{name: (load(name), BUSHES[name]) for name in OTHERS},
}
each_loaded = pytest.mark.parametrize(("of", "bushes"), LOADED.values(), ids=LOADED)


@each_loaded
def test_loaded_bushes_leave_the_design_as_it_is(of, bushes):
    found = compliance.elastokinematics(of, bushes, along=[0.0, 0.03])
    at_design = found.isel({dim: 0 for dim in found.dims if dim not in ("data_set", "wheel")})
    for name in ("toe", "camber", "half_track_change", "wheelbase_change"):
        kinematic, elastic = at_design[name].transpose("data_set", ...).values
        np.testing.assert_allclose(elastic, kinematic, rtol=0.0, atol=1e-10, err_msg=name)
    rigid, soft = at_design["wheel_load"].transpose("data_set", ...).values
    assert np.min(rigid) > 2000.0
    np.testing.assert_allclose(soft, rigid, rtol=1e-9)
    if isinstance(of, Axle):  # the bar, by hand
        torque = -of.bar.rate() * of.bar.free_twist()
        np.testing.assert_allclose(at_design["bar_torque"], torque, rtol=1e-9)
        assert np.ptp(soft) > 100.0
    relaxed = compliance.elastokinematics(of, bushes, along=[0.0], hardpoints="relaxed")
    assert abs(relaxed["toe"].diff("data_set")).max() > 1e-5


@each_loaded
def test_many_positions_are_looked_at_in_parts(of, bushes, monkeypatch):
    """The bearing that holds an arm along its axis does not depend on the positions either."""
    places = np.linspace(-0.05, 0.05, 7)
    whole = compliance.elastokinematics(of, bushes, along=places)
    # the function has the name of its module
    module = import_module("kintrafo.vehicle.analysis.compliance.elastokinematics")
    monkeypatch.setattr(module, "_TOGETHER", 3)
    parts = compliance.elastokinematics(of, bushes, along=places)
    assert parts.sizes == whole.sizes
    np.testing.assert_allclose(parts["toe"], whole["toe"], rtol=0.0, atol=1e-12)
    assert parts.attrs == whole.attrs


@pytest.mark.parametrize("hardpoints", ["loaded", "relaxed"])
@each_loaded
def test_other_positions_change_nothing(of, bushes, hardpoints):
    """Axes across the spin axis are chosen anew where toe and camber change their sizes."""
    places = np.array([-0.04, -0.02, 0.0, 0.02])
    whole = compliance.elastokinematics(of, bushes, along=places, hardpoints=hardpoints)
    for order in ([3, 2, 1, 0], [2, 0, 3], [1]):
        found = compliance.elastokinematics(of, bushes, along=places[order], hardpoints=hardpoints)
        for name in ("toe", "camber", "half_track_change", "wheelbase_change", "wheel_load"):
            # forces of 1e4 N in the last step of Newton's method, 1e-9 m or rad
            atol = 1e-2 if name == "wheel_load" else 1e-9
            (along,) = (dim for dim in whole[name].dims if dim not in ("data_set", "wheel"))
            wanted = whole[name].isel({along: order})
            np.testing.assert_allclose(found[name], wanted, rtol=0.0, atol=atol)


# -- wheel travel and a load at once: the equilibria of each by itself ---------------------------

AT, LOADS = np.array([-0.03, 0.0, 0.04]), np.array([-2000.0, 0.0, 3000.0])
OF_ARMS = {"arm_rear": {"axial_N_per_mm": 500.0, "radial_N_per_mm": 2000.0}}
SOFT_PANHARD_ROD = {"panhard_rod_chassis": {"axial_N_per_mm": 2000.0}}
COMBINED = {
    "reference_car": OF_ARMS,
    "reference_axle": OF_ARMS | {"rack": {"axial_N_per_mm": 3000.0}},
    "rigid_axle": SOFT_PANHARD_ROD,
}
# Newton's method ends at steps of 1e-9; differences of angles and lengths are of its square, and
# rounding of sums over metres.
CLOSE = 1e-11


@pytest.mark.parametrize("name", COMBINED)
def test_without_a_load_it_is_the_motion_on_bushes(name):
    subject, bushes = load(name), COMBINED[name]
    found = compliance.combined(subject, bushes, "lateral", LOADS, AT).sel(load=0.0)
    alone = compliance.elastokinematics(subject, bushes, along=AT).isel(data_set=-1)
    for curve in ("toe", "camber", "half_track_change", "wheel_load"):
        scale = CLOSE * max(1.0, float(abs(alone[curve]).max()))
        np.testing.assert_allclose(found[curve], alone[curve], rtol=0.0, atol=scale)


@pytest.mark.parametrize("held", ["height", "spring"])
@pytest.mark.parametrize("name", COMBINED)
def test_at_a_travel_it_is_the_load_there(name, held):
    subject, bushes = load(name), COMBINED[name]
    found = compliance.combined(subject, bushes, "lateral", LOADS, AT, held=held)
    for travel in AT:
        here = found.sel(wheel_travel=travel)
        alone = compliance.nonlinear(subject, bushes, "lateral", LOADS, travel=travel, held=held)
        alone = alone.sel(data_set="equilibrium")
        for angle in ("toe", "camber"):
            change = here[angle] - here[angle].sel(load=0.0)
            xr.testing.assert_allclose(
                change.drop_vars(("wheel", "wheel_travel"), errors="ignore"),
                alone[f"{angle}_change"].drop_vars(("wheel", "data_set"), errors="ignore"),
                rtol=0.0, atol=CLOSE,
            )  # fmt: skip
    assert found["toe"].dims[-2:] == ("load", "wheel_travel")
    assert np.ptp(found["toe"].values, axis=-2).max() > 1e-5


def test_what_cannot_be_used_is_refused(refused):
    car = load("reference_car")
    for given in (
        {"under": "sideways"},
        {"wheels": "opposed"},
        {"bushings": {}},
        {"travel": [np.nan]},
    ):
        arguments = {"bushings": OF_ARMS, "under": "lateral", "amounts": [1.0]}
        with refused(InputError):
            compliance.combined(car, **(arguments | given))
