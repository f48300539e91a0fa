"""Pictures of a car that drives: wheels, forces and path against the simulation they are from."""

import json
import re

import numpy as np
import pytest
import rail_car
from kintrafo import InputError
from kintrafo.vehicle.analysis.handling import HandlingResult, load_manoeuvre
from kintrafo.vehicle.plots.driving import animate
from kintrafo.vehicle.plots.driving.scene import scene_of
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


def test_wheels_are_where_they_roll(scene) -> None:
    # a disc of the rest's height touches the road, but for what loads and leaning change
    assert np.abs(scene.contacts[..., 2]).max() < 0.02
    np.testing.assert_allclose(np.linalg.norm(scene.axes, axis=-1), 1.0, atol=1e-12)
    np.testing.assert_allclose(np.sum(scene.axes * scene.spokes, axis=-1), 0.0, atol=1e-12)
    assert scene.axes[..., 1].min() > 0.5


def test_spokes_turn_as_far_as_the_wheels_roll(scene) -> None:
    # before the car steers: way by rolling radius, modulo whole turns, forward about the axis
    before = scene.times < 0.2
    way = scene.centers[before, :, 0] - scene.centers[0, :, 0]
    spokes = scene.spokes[before]
    turned = np.unwrap(np.arctan2(-spokes[..., 2], spokes[..., 0]), axis=0)
    rolled = turned[-1] - turned[0]
    np.testing.assert_allclose(way[-1] / rolled, rail_car.RADIUS, rtol=0.05)


def test_arrows_are_the_forces_of_the_road(scene, result) -> None:
    motion, total = result.runs[-1].motion, scene.forces.sum(axis=1)
    np.testing.assert_allclose(total[:, 2], motion["fz"].sum("wheel"), rtol=1e-12)
    # turning to the left, mass times lateral acceleration, which other axes share little of
    last, mass = total[-1], result.runs[-1].car.mass
    yaw = float(motion["yaw_angle"][-1])
    across = last[1] * np.cos(yaw) - last[0] * np.sin(yaw)
    assert across == pytest.approx(mass * float(motion["lateral_acceleration"][-1]), rel=0.02)
    assert across > 0.0


def test_a_car_is_seen_in_real_time(result, tmp_path) -> None:
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


def test_a_page_has_the_places_of_the_scene(result, scene, tmp_path) -> None:
    text = animate(result, tmp_path / "a.html", title="a </script> car").read_text(encoding="utf-8")
    assert "a </script> car" not in text
    data = json.loads(re.search(r'id="payload">(.*?)</script>', text).group(1))
    rows = [int(np.argmin(np.abs(scene.times - time))) for time in data["times"]]
    assert len(rows) == round(25 * (scene.times[-1] - scene.times[0])) + 1
    contacts = np.array(data["contacts"]).reshape(-1, 4, 3)
    contacts[..., :2] += np.array(data["places"])[:, None]
    np.testing.assert_allclose(contacts, 1e3 * scene.contacts[rows], atol=1.01)
    np.testing.assert_allclose(
        np.array(data["forces"]).reshape(-1, 4, 3), scene.forces[rows], atol=0.5
    )


def test_what_does_not_move_is_not_shown(tmp_path) -> None:
    with pytest.raises(InputError, match="steady turns are not simulated"):
        animate(HandlingResult(Dataset(), {}), tmp_path / "a.gif")
    with pytest.raises(InputError, match="gif"):
        animate(HandlingResult(Dataset(), {}), tmp_path / "a.mp4")
