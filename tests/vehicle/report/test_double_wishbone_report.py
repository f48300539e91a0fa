"""The HTML report of a double wishbone: its words, and the scene in a real browser."""

import json
import re

import kintrafo
import pytest
from kintrafo import Model, state_at_height
from kintrafo.vehicle.models.points import hardpoints
from kintrafo.vehicle.report.grid import Grid, GridAxis
from kintrafo.vehicle.report.page import render
from support.browser import Watched, needs_chromium, slide

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
