"""The report of a car: its chapters, and its animations in a browser."""

import json
import re

import kintrafo
import numpy as np
import pytest
from kintrafo import characteristics
from kintrafo.vehicle.plots.by_axle import by_axle, names_by_axle
from kintrafo.vehicle.plots.goals import about
from kintrafo.vehicle.plots.ride import response_figures
from kintrafo.vehicle.report.chapters import axle, handling
from kintrafo.vehicle.report.chapters.goals import goals_chapter
from support.browser import CHROMIUM, running
from xarray import Dataset

GOALS = """
[targets.heave_frequency]
over = "speed"
value = 5.0
within = 0.1
[limits.weighted_rms]
over = "speed"
road = "C"
at_km_per_h = 60.0
most = 30.0
"""
WHEELS = ["front_left", "front_right", "rear_left", "rear_right"]


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    from kintrafo.vehicle import cli

    path = tmp_path_factory.mktemp("car") / "quarter.html"
    goals = path.with_name("goals.toml")
    goals.write_text(GOALS, encoding="utf-8")
    with pytest.MonkeyPatch.context() as patch:
        words = ["kintrafo", "report", "quarter_car", str(path), "--goals", str(goals)]
        patch.setattr("sys.argv", words)
        cli.run()
    return path


def test_a_quarter_car_has_the_chapters_that_apply_to_it(report):
    text = report.read_text(encoding="utf-8")
    titles = re.findall(r"<h2>(.*?)</h2>", text)
    assert titles == [
        "The car at rest", "Ride", "Targets and limits", "K&amp;C sheet: corner", "Input data"
    ]  # fmt: skip
    assert "1 of 2 are met, 1 missed." in text
    assert report.stat().st_size < 1e6
    assert not re.findall(r'(?:src|href)="(?!data:|#)', text)
    assert "<code>[corner tyre]</code>" in text


def test_the_car_at_rest_is_drawn_where_it_rests(report):
    text = report.read_text(encoding="utf-8")
    still, moving = (
        json.loads(data) for data in re.findall(r'application/json">(.*?)</script>', text)
    )
    rest = kintrafo.ride.at_rest(kintrafo.load("quarter_car"))
    assert still["times"] == [0.0]
    assert still["forces"][0][2] == pytest.approx(float(rest["load"]), abs=1.0)
    assert len(moving["times"]) == 76


def test_curves_of_wheels_are_those_of_each_axle():
    motion = Dataset(
        {"fz": (("wheel", "time"), np.ones((4, 2))), "speed": ("time", [1.0, 2.0])},
        {"wheel": WHEELS, "time": [0.0, 1.0]},
    )
    names = names_by_axle(motion, ["speed", "fz", "not there"])
    assert names == ["speed", "fz_front", "fz_rear"]
    assert set(names) <= set(by_axle(motion))


def test_chapters_of_a_car_that_does_not_drive_have_the_reason():
    car = kintrafo.load("reference_vehicle")
    for chapter in (handling.steady_turns_chapter(car), handling.step_steer_chapter(car)):
        assert "does not travel" in chapter.words[0]
        assert not chapter.players


def test_goals_of_wheels_are_in_the_curves_of_their_axles():
    limits = {"camber_rear_left": {"at_mm": [-10.0, 10.0], "least": -3.0, "most": 3.0}}
    wanted = kintrafo.variation.goals({"limits": limits}, ["heave", "pitch", "roll"])
    chapter = goals_chapter(kintrafo.load("reference_vehicle"), wanted)
    assert chapter.words[0] == "1 of 1 are met, 0 missed."
    (table,), (picture,) = chapter.tables, chapter.pictures
    assert table.rows[0][:2] == ("limit: camber, rear left [deg]", "met")
    assert picture.words == "Curves over heave of the body with targets and limits"
    curves = by_axle(characteristics.over(kintrafo.load("reference_vehicle"), "heave", [0.0]))
    front, rear = (
        about(wanted, curves[f"camber_{end}"], "body_heave") for end in ("front", "rear")
    )
    assert not any(front.values())
    assert [*map(len, rear.values())] == [0, 1, 0]


def test_one_wheel_has_no_motions_of_a_rig(refused):
    refused(kintrafo.InputError, lambda: axle.axle_chapter(kintrafo.load("quarter_car")))


def test_curves_of_a_car_are_small_pictures(monkeypatch):
    monkeypatch.setattr(axle, "_DRAWN", {"heave": ("camber",)})
    chapter = axle.axle_chapter(kintrafo.load("formula_student_car"))
    assert chapter.pictures == ()
    words = "camber [deg]: the body rises and falls on all wheels"
    assert [panel.words for panel in chapter.panels] == [f"front: {words}", f"rear: {words}"]


@pytest.mark.parametrize("option", ["--cases", "--bushes"])
def test_options_of_axles_need_the_file_of_one(option, ends):
    ends(2, "report", "quarter_car", option, "some.toml")


@pytest.mark.parametrize("command", ["loads", "compliance"])
def test_commands_name_the_files_of_a_cars_axles(kintrafo, command):
    code, _, message = kintrafo(command, "driving_car")
    assert code == 2
    words = " ".join(message.split())
    assert f"kintrafo {command} reference_axle or kintrafo {command} rear_axle" in words


@pytest.mark.browser
@pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed (apt-get install chromium)")
@pytest.mark.parametrize("width", [390, 1440])
def test_the_car_is_played_on_every_width(report, width):
    playwright = pytest.importorskip("playwright.sync_api")
    with playwright.sync_playwright() as driver, running(driver.chromium) as browser:
        page = browser.new_page(viewport={"width": width, "height": 900})
        complaints, requests = [], []
        page.on("console", lambda message: complaints.append(message.text))
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on("request", lambda request: requests.append(request.url))
        page.goto(report.as_uri())
        moving = page.locator("[data-player]").nth(1)
        moving.locator("input.time").fill("25")
        assert moving.locator(".instant").inner_text().startswith("t = 1.00 s")
        cursors = moving.locator(".cursor").evaluate_all("all => all.map((c) => c.style.left)")
        assert len(cursors) > 3
        curve = moving.locator(".curve").first
        curve.scroll_into_view_if_needed()
        box = curve.bounding_box()
        page.mouse.click(box["x"] + 0.95 * box["width"], box["y"] + 0.5 * box["height"])
        assert int(moving.locator("input.time").input_value()) > 65
        before = moving.locator("canvas").first.evaluate("canvas => canvas.toDataURL()")
        moving.get_by_text("From above").click()
        assert moving.locator("canvas").first.evaluate("canvas => canvas.toDataURL()") != before
        wide = "document.documentElement.scrollWidth - document.documentElement.clientWidth"
        assert page.evaluate(wide) == 0
        assert complaints == []
        assert requests == [report.as_uri()]


def test_curves_over_the_frequency_are_within_their_axes():
    """In display units: a response of the tyre is in N/mm, and its greatest value inside."""
    figures = response_figures(kintrafo.ride.response(kintrafo.load("quarter_car"), 20.0))
    assert any("N/mm" in words for words in figures)
    for words, figure in figures.items():
        (axes,) = figure.axes
        (line,) = (one for one in axes.get_lines() if len(one.get_xdata()) > 2)
        low, high = axes.get_ylim()
        drawn = line.get_ydata()
        assert 3.0 * drawn.max() == pytest.approx(high), words
        assert low < 0.1 * drawn.max(), words
