"""The HTML report of a double wishbone: its numbers, its words, and the scene in a real browser."""

import json
import re

import kintrafo
import pytest
from browser import Watched, needs_chromium, slide
from kintrafo import Model, state_at_height
from kintrafo.vehicle.models.points import hardpoints
from kintrafo.vehicle.report.grid import Grid, GridAxis
from kintrafo.vehicle.report.page import render
from kintrafo.vehicle.report.poses import reachable_grid

MODEL = Model("double_wishbone_car")


@pytest.fixture(scope="module")
def page():
    with pytest.MonkeyPatch.context() as patch:
        # few positions: the numbers between them do not matter here
        grid = Grid(GridAxis(-0.05, 0.025, 5), GridAxis(-0.04, 0.02, 5))
        patch.setattr("kintrafo.vehicle.report.page.reachable_grid", lambda _: grid)
        return render(MODEL)


@pytest.fixture(scope="module")
def data(page):
    return json.loads(re.search(r'id="payload">(.*?)</script>', page, re.DOTALL).group(1))


def test_it_says_what_it_is(page, data):
    assert "<h1>Double wishbone suspension, front right</h1>" in page
    assert data["suspension"] == "double_wishbone"
    assert "control arms</li>" in page
    assert ">strut</li>" not in page
    for key in ("force_at_design_N", "rate_N_s_per_m", "upper_ball_joint", "suspension"):
        assert f"<code>{key}</code>" in page


def test_every_hardpoint_is_in_the_scene(data):
    points = MODEL.suspension.hardpoints
    assert set(data["points"]) == set(points.names())
    for name, sampled in data["points"].items():
        assert sampled["design"] == pytest.approx(points.metres(name), abs=1e-15), name


def test_every_characteristic_of_the_strut_has_its_curve(data):
    strut = Model("reference_car")
    over_travel = kintrafo.characteristics.over(strut, "travel", [0.0])
    assert set(over_travel) <= {curve["key"] for curve in data["curves"]}


def test_motion_is_a_second_that_dies_out(data):
    assert data["motion"]["time"] == {"first": 0.0, "step": 1e-3, "count": 1001}
    names = {signal["key"] for signal in data["motion"]["signals"]}
    assert {"wheel_center_z_over_time", "damper_force_over_time"} <= names


def test_grid_is_as_wide_as_a_page_covers():
    grid = reachable_grid(MODEL)
    assert (grid.travel.first, grid.travel.last) == pytest.approx((-0.1, 0.1), abs=1e-12)
    assert (grid.rack.first, grid.rack.last) == pytest.approx((-0.06, 0.06), abs=1e-12)


@pytest.mark.parametrize("side", ["right", "left"])
class TestInABrowser:
    pytestmark = needs_chromium

    def test_the_scene_moves_without_complaint(self, browser, tmp_path, side):
        model = MODEL if side == "right" else Model(MODEL.suspension.mirrored())
        watched = Watched(browser, kintrafo.report.write(model, tmp_path / "report.html"))
        canvas = watched.page.locator("#view canvas")
        at_design = canvas.screenshot()
        for travel, rack in [(37.5, 0.0), (-62.0, 41.5), (100.0, -60.0)]:
            slide(watched.page, "#travel", travel)
            slide(watched.page, "#rack", rack)
            state = state_at_height(model, 0.3 + 1e-3 * travel, rack_position=1e-3 * rack)
            inputs = model.inputs({"rack_position": 1e-3 * rack})
            expected = hardpoints(model, state, inputs)["wheel_center"]
            drawn = watched.state()["wheelCenter"]
            assert drawn == pytest.approx(expected, abs=1e-6)  # of the interpolation
        assert canvas.screenshot() != at_design
        assert watched.complaints == []
        watched.context.close()
