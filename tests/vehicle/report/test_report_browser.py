"""The HTML report in a real browser: what a person moves, moves, and shows the model's numbers."""

import re

import kintrafo
import numpy as np
import pytest
from kintrafo import Model, state_at_height
from kintrafo.vehicle.models.points import hardpoints
from kintrafo.vehicle.report.grid import Grid, GridAxis
from support.browser import (
    PHONE,
    Watched,
    luminance,
    needs_chromium,
    number,
    pixels,
    running,
    show,
    slide,
    until,
)

pytestmark = needs_chromium
MODEL = Model("reference_car")
DESIGN_HEIGHT = 0.3


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    return kintrafo.report.write(MODEL, tmp_path_factory.mktemp("report") / "report.html")


@pytest.fixture
def watch(browser, report):
    opened = []

    def watch(of=browser, **context):
        opened.append(Watched(of, report, **context))
        return opened[-1]

    yield watch
    for watched in opened:
        watched.context.close()


@pytest.fixture(scope="module")
def shared(browser, report):
    """Return a page, and its state when it was loaded, which takes seconds."""
    watched = Watched(browser, report, color_scheme="light")
    yield watched, watched.state()
    watched.context.close()


@pytest.fixture
def watched(shared):
    """Return a page as it was when it was loaded."""
    watched, loaded = shared
    watched.start_again()
    assert watched.state() == loaded
    return watched


def compiled_wheel_center(travel, rack, model=MODEL):
    state = state_at_height(model, DESIGN_HEIGHT + travel, rack_position=rack)
    return hardpoints(model, state, model.inputs({"rack_position": rack}))["wheel_center"]


def test_loads_alone_and_without_complaint(watch, report):
    watched = watch()
    watched.page.locator("#play").click()
    until(lambda: watched.state()["time"] > 0.01)
    for heading in watched.page.locator("h2").all():
        heading.scroll_into_view_if_needed()
    assert watched.complaints == []
    assert watched.requests == [report.as_uri()]


@pytest.mark.parametrize(
    ("travel", "rack"), [(0.0, 0.0), (37.5, 0.0), (-62.0, 41.5), (100.0, -60.0)]
)
def test_sliders_move_the_drawn_wheel(watched, travel, rack):
    slide(watched.page, "#travel", travel)
    slide(watched.page, "#rack", rack)
    drawn = watched.state()["wheelCenter"]
    expected = compiled_wheel_center(travel * 1e-3, rack * 1e-3)
    assert drawn == pytest.approx(expected, abs=1e-6)  # the page states less than 0.001 mm
    assert number(watched.page.locator("#travel-value").inner_text()) == travel
    assert number(watched.page.locator("#rack-value").inner_text()) == rack


def test_markers_follow_the_wheel(watched):
    figure = show(watched.page, "camber")
    for travel in (-80.0, 15.0, 90.0):
        slide(watched.page, "#travel", travel)
        state = state_at_height(MODEL, DESIGN_HEIGHT + travel * 1e-3)
        camber = np.degrees(float(MODEL.signal("camber", state)))
        assert number(figure.locator("output").inner_text()) == pytest.approx(camber, abs=0.0051)
        plot = figure.locator(".u-over").bounding_box()
        marker = figure.locator(".marker").bounding_box()
        down = (marker["y"] + marker["height"] / 2 - plot["y"]) / plot["height"]
        assert down == pytest.approx((100.0 - travel) / 200.0, abs=1.0 / plot["height"])
        assert plot["y"] <= marker["y"] + marker["height"] / 2 <= plot["y"] + plot["height"]


def test_curves_follow_the_rack(watched):
    figure = show(watched.page, "camber")
    at_design = pixels(figure)
    slide(watched.page, "#rack", 45.0)
    inputs = MODEL.inputs({"rack_position": 0.045})
    state = state_at_height(MODEL, DESIGN_HEIGHT, rack_position=0.045)
    camber = np.degrees(float(MODEL.signal("camber", state, inputs)))
    assert number(figure.locator("output").inner_text()) == pytest.approx(camber, abs=0.0051)
    until(lambda: pixels(figure) != at_design)


def test_table_follows_the_wheel(watched):
    slide(watched.page, "#travel", 60.0)
    state = state_at_height(MODEL, DESIGN_HEIGHT + 0.06)
    cell = watched.page.locator('[data-now="camber"]').inner_text()
    assert number(cell) == pytest.approx(
        np.degrees(float(MODEL.signal("camber", state))), abs=0.0051
    )


def test_hovering_shows_a_value(watched):
    figure = show(watched.page, "camber")
    box = figure.locator(".u-over").bounding_box()
    watched.page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 0.25 * box["height"])
    tip = figure.locator(".tip")
    tip.wait_for(state="visible")
    place, value = tip.inner_text().split(": ")
    camber = MODEL.signal("camber", state_at_height(MODEL, DESIGN_HEIGHT + number(place) * 1e-3))
    assert number(place) == pytest.approx(50.0, abs=1.5)  # a pixel is 1.4 mm
    assert number(value) == pytest.approx(np.degrees(float(camber)), abs=0.011)


def test_dragging_in_a_chart_moves_the_wheel(watched):
    box = show(watched.page, "camber").locator(".u-over").bounding_box()
    middle = box["x"] + 0.5 * box["width"]
    watched.page.mouse.move(middle, box["y"] + 0.5 * box["height"])
    watched.page.mouse.down()
    watched.page.mouse.move(middle, box["y"] + 0.75 * box["height"])
    watched.page.mouse.up()
    assert watched.state()["travel"] == pytest.approx(-0.05, abs=0.0015)  # within a pixel or two


def test_dragging_the_wheel_moves_it(watched):
    page = watched.page
    page.evaluate("kintrafo.look('side')")  # from outboard: the tyre is around the middle
    page.wait_for_timeout(100)
    box = page.locator("#view canvas").bounding_box()
    x = box["x"] + 0.5 * box["width"]
    for y in np.arange(box["y"] + 60, box["y"] + box["height"], 8.0):
        page.mouse.move(x, y)
        if page.locator("#view canvas").evaluate("c => c.style.cursor") == "ns-resize":
            break
    else:
        pytest.fail("the wheel is nowhere under the pointer")
    page.mouse.down()
    page.mouse.move(x, y - 30.0, steps=3)
    page.mouse.up()
    risen = watched.state()["travel"]
    assert 0.01 < risen <= 0.1
    # elsewhere, the view turns and the wheel stays
    page.mouse.move(box["x"] + 15, box["y"] + 0.7 * box["height"])
    page.mouse.down()
    page.mouse.move(box["x"] + 80, box["y"] + 0.6 * box["height"], steps=3)
    page.mouse.up()
    assert watched.state()["travel"] == risen


def test_wheel_can_be_looked_through(watched):
    page, button = watched.page, watched.page.locator("#through")
    assert button.get_attribute("aria-pressed") == "false"
    button.click()
    assert button.get_attribute("aria-pressed") == "true"
    page.set_viewport_size({"width": 1300, "height": 800})
    page.wait_for_timeout(100)
    assert button.get_attribute("aria-pressed") == "true"
    page.locator('[data-look="corner"]').click()
    assert button.get_attribute("aria-pressed") == "false"
    page.locator('[data-look="front"]').click()
    assert button.get_attribute("aria-pressed") == "true"


def test_playing_shows_the_simulated_motion(watched):
    page = watched.page
    page.locator("#speed").select_option("0.02")
    page.locator("#play").click()
    assert page.locator("#play").inner_text() == "Pause"
    until(lambda: watched.state()["time"] > 0.005)
    page.locator("#play").click()
    first = watched.state()
    assert not first["playing"]
    page.wait_for_timeout(100)
    assert watched.state()["time"] == first["time"]
    page.locator("#play").click()
    until(lambda: watched.state()["time"] > first["time"])
    page.locator("#play").click()
    start = state_at_height(MODEL, 0.325, spin_rate=2.0 * np.pi * 14.8)
    motion = kintrafo.simulate(MODEL, (0.0, 1.0), start, rtol=1e-9, atol=1e-11, dense_output=True)
    for t in (0.0137, 0.0555, 0.3141):
        page.evaluate("time => kintrafo.set({ time })", t)
        height = float(MODEL.signal("wheel_center_z", motion.sol(t)))
        # both integrations, and the samples between which the page interpolates
        assert watched.state()["wheelCenter"][2] == pytest.approx(height, abs=2e-6)


def test_playing_ends_at_the_end_and_starts_again(watched):
    page = watched.page
    page.locator("#speed").select_option("1")
    page.evaluate("kintrafo.set({ time: 0.95 })")
    page.locator("#play").click()
    until(lambda: not watched.state()["playing"])
    assert watched.state()["time"] == 1.0
    page.locator("#speed").select_option("0.02")
    page.locator("#play").click()
    again = watched.state()
    assert again["playing"]
    assert again["time"] < 0.5


# What is focused and goes away leaves its place: the keyboard begins there, as on a new page.
AT_THE_START = """() => {
    const first = document.createElement("button");
    document.body.prepend(first);
    first.focus();
    first.remove();
}"""


def test_keyboard_reaches_and_moves_everything(watched):
    page = watched.page
    page.evaluate(AT_THE_START)
    reached = []
    for _ in range(14):
        page.keyboard.press("Tab")
        reached.append(
            page.evaluate("document.activeElement.id || document.activeElement.dataset.look")
        )
    wanted = {"view", "corner", "front", "side", "top", "travel", "rack", "time", "play", "speed"}
    assert wanted | {"design"} <= set(reached)
    page.locator("#travel").focus()
    for _ in range(4):
        page.keyboard.press("ArrowRight")
    assert watched.state()["travel"] == pytest.approx(0.002, abs=1e-12)
    page.locator("#view").focus()
    page.keyboard.press("ArrowDown")
    page.keyboard.press("ArrowLeft")
    state = watched.state()
    assert (state["travel"], state["rack"]) == pytest.approx((-0.0005, 0.0025), abs=1e-12)
    assert page.locator("#travel").get_attribute("aria-valuetext") == "\u22120.5\u00a0mm"


def test_phone_needs_no_sideways_scrolling(watched):
    page = watched.page
    viewport = page.locator("meta[name=viewport]").get_attribute("content")
    assert viewport == "width=device-width, initial-scale=1"
    for details in page.locator("details").all():
        details.evaluate("d => d.open = true")
    for width in (390, 320):
        page.set_viewport_size({**PHONE, "width": width})
        # charts take their new width in the next frame
        until(lambda w=width: page.evaluate("document.documentElement.scrollWidth") == w)
        # the sliders stay in sight
        page.locator("footer").scroll_into_view_if_needed()
        assert page.locator("#travel").is_visible()
        assert 0 <= page.locator("#travel").bounding_box()["y"] < PHONE["height"]


def test_rows_keep_their_names_on_a_phone(watched):
    """The summary fits; what is wider is scrolled past the first column, which stays in sight."""
    page = watched.page
    for details in page.locator("details").all():
        details.evaluate("d => d.open = true")
    page.set_viewport_size(PHONE)
    frames = page.locator(".wide")
    room = "frame => frame.scrollWidth - frame.clientWidth"
    until(lambda: frames.first.evaluate(room) == 0)
    page.set_viewport_size({**PHONE, "width": 240})
    until(lambda: frames.first.evaluate(room) > 0)
    first_cells = """frame => {
      frame.scrollLeft = 9999;
      const left = frame.getBoundingClientRect().left;
      const cells = [...frame.querySelectorAll("tr > th:first-child:not(.part)")];
      return cells.map((cell) => Math.abs(cell.getBoundingClientRect().left - left));
    }"""
    for frame in frames.all():
        off = frame.evaluate(first_cells)
        assert off
        assert max(off) < 0.5


@pytest.mark.parametrize(("scheme", "background_is_light"), [("light", True), ("dark", False)])
def test_text_can_be_read_in_both_schemes(watched, scheme, background_is_light):
    page = watched.page
    page.emulate_media(color_scheme=scheme)
    background = luminance(page.evaluate("getComputedStyle(document.body).backgroundColor"))
    assert (background > 0.5) == background_is_light
    for text in ("h1", "p.muted", "figcaption output", ".within", "td.now", "summary"):
        colour = page.locator(text).first.evaluate("e => getComputedStyle(e).color")
        lighter, darker = sorted((background, luminance(colour)), reverse=True)
        assert (lighter + 0.05) / (darker + 0.05) >= 4.5, text  # WCAG 2, level AA


def test_changing_the_scheme_redraws(watched):
    page = watched.page
    figure = show(page, "camber")
    before = pixels(figure)
    page.emulate_media(color_scheme="dark")
    until(lambda: pixels(figure) != before)
    assert watched.complaints == []


def test_without_webgl_the_rest_works(driver, watch):
    with running(driver, "--disable-3d-apis") as flat:
        watched = watch(of=flat)
        assert watched.page.get_by_text("The 3D view needs WebGL").is_visible()
        assert watched.page.locator("#view canvas").count() == 0
        figure = show(watched.page, "camber")
        slide(watched.page, "#travel", 50.0)
        camber = MODEL.signal("camber", state_at_height(MODEL, DESIGN_HEIGHT + 0.05))
        shown = number(figure.locator("output").inner_text())
        assert shown == pytest.approx(np.degrees(float(camber)), abs=0.0051)
        assert watched.state()["wheelCenter"] is None


def test_wheel_rate_jumps_where_the_stops_begin_to_act(browser, tmp_path_factory):
    """The page shows the model's values on both sides of a stop, and draws the jump as one."""
    car = Model("offset_strut_car")
    watched = Watched(
        browser, kintrafo.report.write(car, tmp_path_factory.mktemp("stops") / "stops.html")
    )
    travels = np.linspace(-0.09, 0.09, 61)  # 3 mm, between the lines of the grid and on them
    exact = kintrafo.characteristics.over(car, "travel", travels, rack_position=0.011)["wheel_rate"]
    shown = []
    for travel in travels:
        watched.page.evaluate(f"kintrafo.set({{travel: {travel}, rack: 0.011}})")
        shown.append(watched.state()["curves"]["wheel_rate"])
    assert np.ptp(np.diff(exact.values)) > 2e4  # N/m: both stops are on the way
    assert np.abs(np.array(shown) - 1e-3 * exact.values).max() < 0.05  # N/mm
    assert not watched.complaints
    watched.context.close()


def test_what_is_interpolated_says_so(browser, tmp_path, monkeypatch):
    """On a coarse grid: at its positions values are computed, between them they are in doubt."""
    grid = Grid(GridAxis(-0.05, 0.025, 5), GridAxis(-0.04, 0.02, 5))
    monkeypatch.setattr("kintrafo.vehicle.report.page.reachable_grid", lambda _: grid)
    watched = Watched(browser, kintrafo.report.write(MODEL, tmp_path / "coarse.html"))
    shown_values = {}
    for travel in (0.0, 0.025, 0.010):
        watched.page.evaluate(f"kintrafo.set({{ travel: {travel}, rack: 0 }})")
        cell = watched.page.locator('[data-now="bump_steer"]').inner_text()
        shown_values[travel] = cell
    exact = kintrafo.characteristics.over(MODEL, "travel", list(shown_values))["bump_steer"].values
    for (travel, text), value in zip(shown_values.items(), np.degrees(exact) * 1e-3, strict=True):
        assert text.startswith("\u2248") == (travel == 0.010), shown_values
        number = float(text.lstrip("\u2248\u00a0").replace("\u2212", "-"))
        assert travel == 0.010 or number == pytest.approx(value, abs=0.51e-4)
    watched.context.close()


def test_a_printed_report_has_a_picture_and_all_charts(watch):
    watched = watch(color_scheme="dark")
    page = watched.page
    slide(page, "#travel", 30.0)
    pdf = page.pdf()
    assert b"/Subtype /Image" in pdf  # of the mechanism
    assert page.locator("#picture-position").text_content().startswith("Wheel travel +30.0\u00a0mm")
    lines = page.locator("figure[data-curve] .printed .line")
    drawn = lines.evaluate_all("lines => lines.map((line) => line.getAttribute('d'))")
    assert len(drawn) == page.locator("figure[data-curve]").count() > 40
    # of 41 samples at least; a swing arm is drawn where it is not endless
    assert min(d.count("L") for d in drawn) > 15
    # from -100 mm to 100 mm, upward
    places = [float(y) for y in re.findall(r"[ML][\d.]+ ([\d.]+)", drawn[0])]
    circle = page.locator("figure[data-curve] .printed .at").first
    expected = places[0] + 130.0 / 200.0 * (places[-1] - places[0])
    assert float(circle.get_attribute("cy")) == pytest.approx(expected, abs=0.1)
    assert page.evaluate("document.documentElement.className") == "alive"  # as on the screen again
    assert watched.complaints == []


@pytest.mark.parametrize("width", [700, 1100])
def test_on_paper_of_any_width_charts_cover_no_words(watch, width):
    page = watch().page
    page.set_viewport_size({"width": width, "height": 1000})
    page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    page.emulate_media(media="print")
    drawn = page.locator("figure[data-curve] .printed").first.bounding_box()
    room = page.locator("figure[data-curve] .plot").first.bounding_box()
    assert drawn["width"] > 0.4 * width
    assert drawn["y"] + drawn["height"] <= room["y"] + room["height"]


def test_on_paper_tables_are_open_and_keys_whole(watched):
    page = watched.page
    closed = page.locator("details:not([open])")
    before = closed.count()
    page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    page.emulate_media(media="print")
    shown = "all => all.filter((e) => !e.closest('figure') && e.checkVisibility()).length"
    assert closed.evaluate_all(shown) == 0
    key = page.locator("th code", has_text="center_of_gravity_height_mm")
    assert key.evaluate("code => code.getClientRects().length") == 1
    page.evaluate("window.dispatchEvent(new Event('afterprint'))")
    assert closed.count() == before


def test_design_position_is_before_anything_has_moved(watched):
    watched.page.evaluate("kintrafo.set({ time: 0.4 })")
    watched.page.locator("#design").click()
    state = watched.state()
    assert (state["time"], state["travel"], state["rack"]) == (0.0, 0.0, 0.0)


def test_what_is_for_paper_is_not_on_the_screen(watched):
    page = watched.page
    shown = "elements => elements.filter((e) => e.checkVisibility()).length"
    for_paper, for_screen = page.locator(".on-paper"), page.locator(".on-screen")
    assert for_paper.count() >= 2
    assert for_paper.evaluate_all(shown) == 0
    assert for_screen.evaluate_all(shown) == for_screen.count()
    page.emulate_media(media="print")
    assert for_paper.evaluate_all(shown) == for_paper.count()
    assert for_screen.evaluate_all(shown) == 0


@pytest.mark.parametrize("side", ["right", "left"])
def test_the_scene_of_wishbones_moves_without_complaint(browser, tmp_path, side):
    model = Model("double_wishbone_car")
    model = model if side == "right" else Model(model.suspension.mirrored())
    watched = Watched(browser, kintrafo.report.write(model, tmp_path / "report.html"))
    canvas = watched.page.locator("#view canvas")
    at_design = canvas.screenshot()
    for travel, rack in [(37.5, 0.0), (-62.0, 41.5), (100.0, -60.0)]:
        slide(watched.page, "#travel", travel)
        slide(watched.page, "#rack", rack)
        expected = compiled_wheel_center(1e-3 * travel, 1e-3 * rack, model)
        # of the interpolation
        assert watched.state()["wheelCenter"] == pytest.approx(expected, abs=1e-6)
    assert canvas.screenshot() != at_design
    assert watched.complaints == []
    watched.context.close()
