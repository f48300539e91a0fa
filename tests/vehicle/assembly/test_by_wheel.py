"""The dimension of the wheels, and flat tables."""

import numpy as np
import xarray as xr
from kintrafo import InputError
from kintrafo.vehicle.assembly.by_wheel import flat, of_wheels, wheel_coordinate
from kintrafo.vehicle.assembly.quantity import TRAVEL

VALUES = np.arange(3.0)


def test_one_wheel_has_no_dimension():
    found = xr.Dataset(
        {"camber": of_wheels(TRAVEL, "at", [VALUES])}, {"wheel": wheel_coordinate(["right"])}
    )
    assert found["camber"].dims == ("at",)
    assert found["wheel"].item() == "right"
    assert "wheel" not in flat(found).variables


def test_two_wheels_are_columns_of_a_table():
    found = xr.Dataset(
        {"camber": of_wheels(TRAVEL, ["at"], [VALUES, -VALUES]), "torque": ("at", VALUES)},
        {"wheel": wheel_coordinate(["left", "right"]), "at": VALUES, "rack": 0.1},
        {"title": "both"},
    )
    assert found["camber"].sel(wheel="right").values.tolist() == (-VALUES).tolist()
    table = flat(found)
    assert list(table) == ["camber_left", "camber_right", "torque"]
    assert table["camber_right"].values.tolist() == (-VALUES).tolist()
    assert table["camber_left"].attrs["long_name"] == f"{TRAVEL.long_name}, left"
    assert {*table.coords} == {"at", "rack"}
    assert table.attrs == {"title": "both"}


def test_only_datasets(refused):
    refused(InputError, lambda: flat([1.0]))
