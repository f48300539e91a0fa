"""Pictures of a car in motion: wheels, forces and path against the simulation they are from."""

import json
import re

import kintrafo
import numpy as np
import pytest
from cars import rail_car
from kintrafo import InputError
from kintrafo.vehicle.analysis.handling import HandlingResult, load_manoeuvre
from kintrafo.vehicle.plots.handling import first_names
from kintrafo.vehicle.plots.motion import animate, shown_names
from kintrafo.vehicle.plots.motion.scene import scene_of
from PIL import Image
from xarray import Dataset


@pytest.fixture(scope="module")
def result():
    from dataclasses import replace

    runs = []
    car = replace(rail_car.car(), watched=runs.append)
    steer = load_manoeuvre("step_steer", {"duration_s": 1.5, "lateral_acceleration_m_per_s2": 3.0})
    return steer.run(car, lambda _: None)._replace(runs=tuple(runs))


@pytest.fixture(scope="module")
def scene(result):
    return scene_of(result.runs[-1], np.arange(len(result.runs[-1].states)))


def test_wheels_are_where_they_roll(scene):
    # a disc of the rest's height touches the road, but for what loads and leaning change
    assert np.abs(scene.contacts[..., 2]).max() < 0.02
    np.testing.assert_allclose(np.linalg.norm(scene.axes, axis=-1), 1.0, atol=1e-12)
    np.testing.assert_allclose(np.sum(scene.axes * scene.spokes, axis=-1), 0.0, atol=1e-12)
    assert scene.axes[..., 1].min() > 0.5


def test_spokes_turn_as_far_as_the_wheels_roll(scene):
    # before the car steers: way by rolling radius, modulo whole turns, forward about the axis
    before = scene.times < 0.2
    way = scene.centers[before, :, 0] - scene.centers[0, :, 0]
    spokes = scene.spokes[before]
    turned = np.unwrap(np.arctan2(-spokes[..., 2], spokes[..., 0]), axis=0)
    rolled = turned[-1] - turned[0]
    np.testing.assert_allclose(way[-1] / rolled, rail_car.RADIUS, rtol=0.05)


def test_arrows_are_the_forces_of_the_road(scene, result):
    motion, total = result.runs[-1].motion, scene.forces.sum(axis=1)
    np.testing.assert_allclose(total[:, 2], motion["fz"].sum("wheel"), rtol=1e-12)
    # turning to the left, mass times lateral acceleration, which other axes share little of
    last, mass = total[-1], result.runs[-1].car.mass
    yaw = float(motion["yaw_angle"][-1])
    across = last[1] * np.cos(yaw) - last[0] * np.sin(yaw)
    assert across == pytest.approx(mass * float(motion["lateral_acceleration"][-1]), rel=0.02)
    assert across > 0.0


def test_a_car_is_seen_in_real_time(result, tmp_path):
    few = result.runs[-1]
    short = few._replace(motion=few.motion.isel(time=slice(0, 25)), states=few.states[:25],
                         inputs=few.inputs[:25])  # fmt: skip
    made = [
        animate(result._replace(runs=(short,)), tmp_path / f"{name}.gif", title="a car")
        for name in "ab"
    ]
    first, again = (path.read_bytes() for path in made)
    assert first == again
    with Image.open(made[0]) as picture:
        seconds = float(np.ptp(short.motion["time"].values))
        assert picture.n_frames == round(25 * seconds) + 1
        assert picture.info["duration"] == 40


def test_a_long_motion_has_fewer_frames_per_second(result, tmp_path, monkeypatch):
    monkeypatch.setitem(animate.__globals__, "MOST_FRAMES", 12)
    path = animate(result, tmp_path / "long.gif")
    seconds = float(np.ptp(result.runs[-1].motion["time"].values))
    with Image.open(path) as picture:
        assert picture.n_frames <= 12
        shown = picture.n_frames * picture.info["duration"] / 1e3
        assert shown == pytest.approx(seconds, abs=2.0 * picture.info["duration"] / 1e3)


def test_a_page_has_the_places_of_the_scene(result, scene, tmp_path):
    text = animate(result, tmp_path / "a.html", title="a </script> car").read_text(encoding="utf-8")
    assert "a </script> car" not in text
    data = json.loads(re.search(r'type="application/json">(.*?)</script>', text).group(1))
    rows = [int(np.argmin(np.abs(scene.times - time))) for time in data["times"]]
    assert len(rows) == round(25 * (scene.times[-1] - scene.times[0])) + 1
    contacts = np.array(data["contacts"]).reshape(-1, 4, 3)
    contacts[..., :2] += np.array(data["places"])[:, None]
    np.testing.assert_allclose(contacts, 1e3 * scene.contacts[rows], atol=1.01)
    np.testing.assert_allclose(
        np.array(data["forces"]).reshape(-1, 4, 3), scene.forces[rows], atol=0.5
    )
    charts = data["charts"]
    assert text.count("data:image/svg+xml") == len(charts) > 5
    steered = result.runs[-1].motion["steering_wheel_angle"].values[rows]
    (name, values), *_ = charts[0]["lines"]
    assert name == ""
    digit = 10.0 ** -charts[0]["decimals"]
    np.testing.assert_allclose(values, np.degrees(steered), atol=0.6 * digit)


@pytest.fixture(scope="module")
def ridden():
    bump = kintrafo.road_profiles.bump(0.03, 2.0, at=1.0, end=10.0)
    return kintrafo.ride.run(kintrafo.load("quarter_car"), bump, 10.0, duration=0.5)


def test_a_car_that_rides_is_carried_along_its_road(ridden):
    scene = scene_of(ridden, np.arange(len(ridden.states)))
    np.testing.assert_allclose(np.diff(scene.centers[:, 0, 0]), 10.0 * 0.005, atol=1e-3)
    (track,) = scene.tracks
    under = np.interp(scene.contacts[:, 0, 0], track[:, 0], track[:, 2])
    # points of the drawn road are 5 cm apart, and the wheel centre moves forward as it rises
    np.testing.assert_allclose(scene.contacts[:, 0, 2], under, atol=1.5e-3)
    assert under.max() == pytest.approx(0.03, abs=1e-3)
    assert not scene.turns


def test_a_wheel_that_rides_rolls_and_carries_the_load(ridden):
    scene = scene_of(ridden, np.arange(len(ridden.states)))
    np.testing.assert_allclose(scene.forces[:, 0, 2], ridden.motion["load"], rtol=2e-3)
    assert scene.forces[0, 0, 2] > 0.0
    turned = np.unwrap(np.arctan2(-scene.spokes[:, 0, 2], scene.spokes[:, 0, 0]))
    assert turned[-1] - turned[0] == pytest.approx(5.0 / scene.radii[0], rel=0.01)


def test_a_ride_is_written_in_both_ways(ridden, tmp_path):
    page = animate(ridden, tmp_path / "a.html", title="a quarter car")
    data = json.loads(re.search(r'json">(.*?)</script>', page.read_text(encoding="utf-8")).group(1))
    assert max(data["tracks"][0]["z"]) == 30
    with Image.open(animate(ridden, tmp_path / "a.gif")) as picture:
        assert picture.n_frames == 13


def test_what_does_not_move_is_not_shown(tmp_path, refused):
    refused(InputError, lambda: animate(HandlingResult(Dataset(), {}), tmp_path / "a.gif"))
    with pytest.raises(InputError, match="gif"):
        animate(HandlingResult(Dataset(), {}), tmp_path / "a.mp4")


def test_curves_are_in_the_order_in_which_they_are_looked_at():
    """Accelerations come before the pitch, and a curve of rounding alone is not drawn."""
    time = np.linspace(0.0, 1.0, 9)
    names = ("pitch", "driver_acceleration", "body_acceleration")
    coords = {"time": ("time", time, {"units": "s", "long_name": "time"})}
    motion = Dataset({name: ("time", np.sin(time)) for name in names}, coords)
    assert shown_names(motion) == ["body_acceleration", "driver_acceleration", "pitch"]
    straight = Dataset(
        {"speed": ("time", time), "steering_torque": ("time", 1e-10 * np.sin(9.0 * time))}, coords
    )
    assert first_names(straight) == ["speed"]
