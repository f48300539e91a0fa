"""Wheel travel and a load at once: the equilibria of each by itself, of corner and axles."""

import numpy as np
import pytest
import xarray as xr
from kintrafo import InputError, compliance, load

AT, LOADS = np.array([-0.03, 0.0, 0.04]), np.array([-2000.0, 0.0, 3000.0])
OF_ARMS = {"arm_rear": {"axial_N_per_mm": 500.0, "radial_N_per_mm": 2000.0}}
OF_RODS = {"panhard_rod_chassis": {"axial_N_per_mm": 2000.0}}
SUBJECTS = {
    "reference_car": OF_ARMS,
    "reference_axle": OF_ARMS | {"rack": {"axial_N_per_mm": 3000.0}},
    "rigid_axle": OF_RODS,
}
# Newton's method ends at steps of 1e-9; differences of angles and lengths are of its square, and
# rounding of sums over metres.
CLOSE = 1e-11


@pytest.mark.parametrize("name", SUBJECTS)
def test_without_a_load_it_is_the_motion_on_bushes(name):
    subject, bushes = load(name), SUBJECTS[name]
    found = compliance.combined(subject, bushes, "lateral", LOADS, AT).sel(load=0.0)
    alone = compliance.elastokinematics(subject, bushes, along=AT).isel(data_set=-1)
    for curve in ("toe", "camber", "half_track_change", "wheel_load"):
        scale = CLOSE * max(1.0, float(abs(alone[curve]).max()))
        np.testing.assert_allclose(found[curve], alone[curve], rtol=0.0, atol=scale)


@pytest.mark.parametrize("held", ["height", "spring"])
@pytest.mark.parametrize("name", SUBJECTS)
def test_at_a_travel_it_is_the_load_there(name, held):
    subject, bushes = load(name), SUBJECTS[name]
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


def test_what_cannot_be_used_is_refused():
    car = load("reference_car")
    for given, words in (
        ({"under": "sideways"}, "under"),
        ({"wheels": "opposed"}, "a corner has one wheel"),
        ({"bushings": {}}, "one or more are needed"),
        ({"travel": [np.nan]}, "finite"),
    ):
        arguments = {"bushings": OF_ARMS, "under": "lateral", "amounts": [1.0]}
        with pytest.raises(InputError, match=words):
            compliance.combined(car, **(arguments | given))
