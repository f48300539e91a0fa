"""``kintrafo drive``: its tables and files, and messages of mistakes."""

from pathlib import Path

import kintrafo
import numpy as np
import pytest
from kintrafo.core.quantities import variable
from kintrafo.vehicle.analysis.handling import HandlingResult, load_manoeuvre
from kintrafo.vehicle.analysis.handling.result import quantity
from kintrafo.vehicle.cli import drive
from kintrafo.vehicle.cli.loading import note_unused
from kintrafo.vehicle.cli.outputs import SingleFigureOptions
from kintrafo.vehicle.plots import handling
from kintrafo.vehicle.plots.handling import write_curves, write_path
from support.commands import lines_of
from xarray import Dataset


def motion(runs=0):
    """Return the motion of a car along a straight line, in several runs if asked for."""
    time = np.linspace(0.0, 1.0, 11)
    dims, shape = (("amplitude", "time"), (runs, 1)) if runs else (("time",), (1,))
    values = time * np.ones(shape)
    names = {"x": "m", "y": "m", "yaw_angle": "rad", "speed": "m/s", "yaw_rate": "rad/s"}
    found = {name: quantity(dims, values, name, unit) for name, unit in names.items()}
    coordinates = {"time": time}
    if runs:
        coordinates["amplitude"] = variable("amplitude", np.arange(runs) + 1.0, "amplitude", "rad")
    return Dataset(found, coordinates, {"not_valid": [], "title": "a motion"})


def test_numbers_of_each_run_have_columns_of_their_own():
    metrics = Dataset(
        {
            "angle": quantity((), np.deg2rad(20.0), "reference angle", "rad"),
            "ratio": quantity("amplitude", np.array([0.1, 0.2]), "yaw velocity ratio", "1"),
            "gradient": quantity((), np.deg2rad(1.0) / 9.80665, "understeer gradient", "rad s^2/m"),
        },
        {"amplitude": variable("amplitude", np.deg2rad([30.0, 60.0]), "amplitude", "rad")},
    )
    lines = lines_of(drive._tables(HandlingResult(metrics, {"": motion()}), "a car"))
    assert ["reference angle [deg]", "20"] in lines
    assert ["understeer gradient [deg/g]", "1"] in lines
    assert ["amplitude [deg]", "30", "60"] in lines
    assert ["yaw velocity ratio", "0.1", "0.2"] in lines


@pytest.mark.usefixtures("tmp_path")
def test_curves_and_path_with_cones_are_written(tmp_path):
    cones = Dataset({
        "x": quantity("cone", np.array([0.2, 0.8]), "x", "m"),
        "y": quantity("cone", np.array([1.2, -1.2]), "y", "m"),
        "clearance": quantity("cone", np.array([0.3, np.nan]), "clearance", "m"),
    }, attrs={"car_front": 2.0, "car_length": 4.0, "car_width": 1.8})  # fmt: skip
    found = HandlingResult(Dataset(), {"": motion(), "_cones": cones})
    chosen = load_manoeuvre("double_lane_change")
    options = SingleFigureOptions(out=[tmp_path / "a.csv"], plot=[tmp_path / "a.png"])
    pages = (*drive._drawn(chosen), "_path")
    outputs = options.files("car.toml", suffixes=chosen.CURVES, drawn=pages)
    written = drive._write(outputs, found, chosen, "a car")
    assert [path.name for path in written] == ["a.csv", "a_cones.csv", "a.png", "a_path.png"]
    assert all(path.stat().st_size for path in written)


def test_a_straight_path_has_no_picture(tmp_path):
    car = motion()
    car["y"] = 0.05 * car["y"] / np.abs(car["y"]).max()
    chosen = load_manoeuvre("acceleration")
    outputs = SingleFigureOptions(plot=[tmp_path / "a.png"]).files("car.toml", suffixes=("",))
    written = drive._write(outputs, HandlingResult(Dataset(), {"": car}), chosen, "a car")
    assert [path.name for path in written] == ["a.png"]


def test_many_runs_have_a_row_each():
    runs = variable("amplitude", np.deg2rad(np.arange(20.0)), "amplitude", "rad")
    ratio = quantity("amplitude", np.arange(20.0), "ratio", "1")
    metrics = Dataset({"ratio": ratio}, {"amplitude": runs})
    lines = lines_of(drive._tables(HandlingResult(metrics, {"": motion()}), "a car"))
    assert lines[-20] == ["0", "0"]
    assert lines[-1] == ["19", "19"]


@pytest.fixture
def drawn(monkeypatch):
    """Return the figures that are drawn, in place of files."""
    figures = []
    monkeypatch.setattr(handling, "save", lambda figure, path, **_: figures.append(figure) or path)
    return figures


def names_in(figure):
    own = [legend for axes in figure.axes if (legend := axes.get_legend())]
    named = [text for axes in figure.axes for text in axes.texts]
    named += [text for legend in (*own, *figure.legends) for text in legend.get_texts()]
    return [text.get_text() for text in named]


def test_wheels_and_runs_have_names(drawn):
    wheels = ["front_left", "front_right", "rear_left", "rear_right"]
    loads = np.linspace(0.0, 1.0, 11)[:, None] * [1.0, 2.0, 3.0, 4.0]
    car = motion().assign(fz=quantity(("time", "wheel"), loads, "load", "N"))
    write_curves(car.assign_coords(wheel=wheels), "wheels.svg")
    write_path(motion(runs=3), "path.svg")
    assert names_in(drawn[0]) == ["front left", "front right", "rear left", "rear right"]
    assert names_in(drawn[1]) == ["57.3 deg", "114.6 deg", "171.9 deg"]


def test_the_path_to_follow_is_drawn_beside_that_of_the_car(drawn):
    wanted = kintrafo.handling.load_manoeuvre("path_following").wanted_path()
    np.testing.assert_allclose(wanted[[0, -1]], [[0.0, 0.0], [140.0, 0.0]], atol=1e-12)
    write_path(motion(), "path.svg", wanted=wanted)
    assert names_in(drawn[0]) == ["car", "path to follow"]


def test_a_straight_path_is_drawn_straight(drawn):
    car = motion()
    car["x"], car["y"] = 100.0 * car["x"], 1e-14 * car["y"]
    write_path(car, "path.svg")
    low, high = drawn[0].axes[0].get_ylim()
    assert high - low >= 1.0


def test_the_sideslip_angle_of_a_car_that_turns_round_does_not_leap():
    turning = np.linspace(0.0, 4.0, 11)
    car = motion().assign(
        sideslip_angle=quantity("time", np.angle(np.exp(1j * turning)), "sideslip angle", "rad")
    )
    drawn = handling.for_print(car, "time")
    np.testing.assert_allclose(drawn["sideslip_angle"], turning, atol=1e-12)


def test_values_that_are_not_used_are_counted(capsys):
    note_unused(kintrafo.load("driving_car"), "my_car.toml")
    shown = "not used: 5 entries of the files of this car, listed by kintrafo check my_car.toml"
    assert " ".join(capsys.readouterr().err.split()) == shown


def test_mistakes_are_named_before_equations_are_derived(ends):
    for line in (
        "quarter_car",
        "reference_vehicle",
        "reference_axle",
        "driving_car --manoeuvre step_ster",
        "driving_car --manoeuvre constant_speed_circle --speed 0",
        "driving_car --speed -5",
        "driving_car --manoeuvre coast_down --turn left",
        "driving_car --manoeuvre braking --speed 5",
        "driving_car --manoeuvre circle --speed 50",
        "driving_car --manoeuvre circle --animate a.gif",
        "driving_car --manoeuvre parking --loads a.csv",
        "driving_car --animate a.mp4",
    ):
        ends(2, "drive", *line.split())
    assert not list(Path().glob("*.png"))


def test_a_manoeuvre_is_written_to_edit(kintrafo, tmp_path):
    file = tmp_path / "my_step.toml"
    code, out, _ = kintrafo("new", str(file), "--template", "step_steer")
    assert code == 0
    assert "kintrafo drive" in out
    assert load_manoeuvre(file).manoeuvre == "step_steer"
