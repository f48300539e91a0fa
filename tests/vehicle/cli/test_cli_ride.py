"""Tables of ``kintrafo ride``: the wheels have a column each, the body has its figures in one."""

import json
from pathlib import Path

import numpy as np
import pytest
from kintrafo.vehicle.assembly.by_wheel import WHEEL
from kintrafo.vehicle.cli import ride
from kintrafo.vehicle.plots.curves import figure
from support.commands import lines_of
from xarray import Dataset


def test_wheels_are_columns_and_the_linear_prediction_is_a_row():
    wheels = {WHEEL: ["front_left", "rear_right"]}
    of_wheels = {"rms": [40.0, 50.0], "largest": [4e3, 5e3], "units": "N"}
    of_body = {"rms": 0.5, "weighted_rms": 0.4, "units": "m/s^2"}
    motion = Dataset(
        {"body_acceleration": ((), 0.0, of_body), "load": (WHEEL, [0.0, 0.0], of_wheels)}, wheels
    )
    linear = Dataset({"load_psd": (WHEEL, [0.0, 0.0], {"rms": [41.0, 51.0]})}, wheels)
    lines = lines_of(ride._ride(motion, linear, "a road"))
    assert ["wheels", "", "front left", "rear right"] in lines
    assert ["load [N]", "rms", "40", "50"] in lines
    assert ["", "largest", "4000", "5000"] in lines
    assert ["", "rms, linear", "41", "51"] in lines
    assert ["body", "rms", "weighted rms"] in lines
    assert ["body acceleration [m/s^2]", "0.5", "0.4"] in lines


def test_at_rest_no_value_of_the_body_is_below_a_wheel():
    wheels = {WHEEL: ["front_left", "rear_right"]}
    found = Dataset(
        {"load": (WHEEL, [3.0, 4.0], {"units": "N"}), "heave": ((), 2e-3, {"units": "m"})}, wheels
    )
    lines = lines_of(ride._rest(found, "my_car"))
    assert ["load [N]", "3", "4"] in lines
    assert ["heave [mm]", "2"] in lines


def test_a_bump_that_no_wheel_meets_is_refused(ends):
    ends(2, "ride", "quarter_car", "--bump-height", "20", "--wheels", "left")


def test_mistakes_are_named_before_equations_are_derived(ends, monkeypatch):
    Path("short.csv").write_text(
        "distance_m,left_height_mm,right_height_mm\n0,0,0\n0.5,0,0\n1,0,0\n1.5,0,0\n2,0,0\n",
        encoding="utf-8",
    )

    def derived(assembly):
        raise AssertionError(f"derives {assembly}")

    monkeypatch.setattr(ride, "derived", derived)
    for line in (
        "driving_car",
        "quarter_car --road C --bump-height 20",
        "quarter_car --bump-length 1",
        "quarter_car --wheels left",
        "quarter_car --bump-height 20 --seed 2",
        "quarter_car --seed -1",
        "quarter_car --contact-length -5",
        "reference_vehicle --road short.csv",
    ):
        ends(2, "ride", *line.split())


def test_a_motion_that_is_not_valid_has_an_exit_code(kintrafo):
    words = [
        "--bump-height",
        "80",
        "--bump-length",
        "1",
        "--speed",
        "60",
        "--duration",
        "1",
        "--json",
    ]
    code, printed, err = kintrafo("ride", "quarter_car", *words)
    assert code == 1
    (reason,) = json.loads(printed)["not_valid"]
    assert "pulls at the road" in reason
    assert reason in " ".join(err.split())


def test_a_sweep_of_a_car_is_a_table_of_its_numbers(kintrafo, ends):
    grid = ["sweep", "quarter_car", "body.mass_kg=340,390"]
    code, printed, _ = kintrafo(
        *grid, "--over", "speed:road=C", "--of", "weighted_rms,heave_frequency", "--json"
    )
    assert code == 0
    found = json.loads(printed)
    # a mass on a spring: the frequency falls as the root of the mass grows, but for the tyre
    low, high = found["variables"]["heave_frequency"]["values"]
    assert high / low == pytest.approx((340.0 / 390.0) ** 0.5, rel=0.02)
    ends(2, *grid, "--keep", "toe:max")
    ends(2, "sweep", "quarter_car", "body.mas_kg=340,390")


def test_curves_of_four_wheels_are_drawn():
    wheels = ["front_left", "front_right", "rear_left", "rear_right"]
    loads = np.outer([1.0, 2.0, 3.0, 4.0], np.ones(3))
    motion = Dataset({"load": ((WHEEL, "time"), loads)}, {WHEEL: wheels, "time": [0.0, 1.0, 2.0]})
    assert figure(motion, ["load"], title="a ride").axes
