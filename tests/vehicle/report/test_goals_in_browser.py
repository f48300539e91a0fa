"""Targets and limits in a report, in a real browser: each mark is at its value.

A chart tells its own scale: the marker on its curve stands at two positions, whose values the
compiled model has.
"""

import kintrafo
import numpy as np
import pytest
from kintrafo import Model, characteristics, variation
from kintrafo.vehicle.report import goals_chapter
from support import browser as pages

pytestmark = pages.needs_chromium

CAR = Model("reference_car")
TARGET = {"at_mm": [-60, 0, 60], "value": [1.2, 0.1, -0.9], "within": 0.25}
DESCRIBED = {
    "targets": {"camber": TARGET},
    "limits": {
        "camber": {"at_mm": [-80, 80], "least": -4.0, "most": 5.0},
        "scrub_radius": {"over": "rack", "at_mm": [-10, 40], "most": 25.0},
        "toe_by_lateral": {"at_mm": 0, "most": 0.1},
    },
}
GOALS = variation.goals(DESCRIBED)
ENDS = {"travel": 100.0, "rack": 60.0}  # of the charts to either side [mm]
# What of a mark may be off: the marker stands on a curve that is interpolated, by less than a part
# of 1e4 of what the chart has in 140 pixels [px].
PLACE = 0.05

LAST_DIGIT = 0.051  # half of the last digit that a chart writes, and rounding

WITHOUT_WIDTH = """e => {
    const { x, y, width, height } = e.getBBox();
    const { e: left, f: top } = e.getScreenCTM();
    return { x: left + x, y: top + y, width, height };
}"""


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    bushes = {"arm_rear": {"radial_N_per_mm": 900.0}}
    car = Model(CAR.suspension.with_changes({"bushings": bushes}))
    path = tmp_path_factory.mktemp("goals") / "report.html"
    chapters = [goals_chapter(car, GOALS)]
    return kintrafo.report.write(car, path, goals=GOALS, chapters=chapters)


@pytest.fixture(scope="module")
def watched(browser, report):
    watched = pages.Watched(browser, report, color_scheme="light")
    yield watched
    assert watched.complaints == []
    watched.context.close()


def middle(box):
    return np.array([box["x"] + box["width"] / 2, box["y"] + box["height"] / 2])


def value_at(name, over, millimetres):
    """Return what the compiled model has, in the unit of the reader."""
    found = characteristics.over(CAR, over, [millimetres * 1e-3])[name]
    return float(found.values[0] * found.attrs["display_factor"])


def shown(figure):
    return pages.number(figure.locator("output").inner_text())


def scale_of(watched, name, over):
    """Return the pixel of a position and value in a chart, from where its marker stands."""
    key = name if over == "travel" else f"{name}_over_rack"
    figure = pages.show(watched.page, key)
    # wheel travel is on the vertical axis
    seen, along = {}, 0 if over == "travel" else 1
    for at in (-50.0, 40.0):
        pages.slide(watched.page, f"#{over}", at)
        value = value_at(name, over, at)
        # charts that have just come into sight are drawn a little later
        pages.until(lambda v=value: abs(shown(figure) - v) < LAST_DIGIT)
        seen[value] = middle(figure.locator(".marker").bounding_box())[along]
    pages.slide(watched.page, f"#{over}", 0)
    plot = figure.locator(".u-over").bounding_box()
    (first, top), (second, bottom) = seen.items()

    def place(millimetres, value):
        part = 0.5 * (1.0 + millimetres / ENDS[over])
        of_value = top + (value - first) / (second - first) * (bottom - top)
        if over == "travel":
            return [of_value, plot["y"] + (1.0 - part) * plot["height"]]
        return [plot["x"] + part * plot["width"], of_value]

    return figure, place


def box_of(mark):
    """Return where a mark is on the screen, without the width of its lines."""
    return mark.evaluate(WITHOUT_WIDTH)


def boxes(marks):
    return [box_of(mark) for mark in marks.all()]


@pytest.mark.parametrize("width", [1440, 390])
def test_marks_are_where_their_numbers_say(watched, width):
    watched.start_again()
    watched.page.set_viewport_size({"width": width, "height": 900})
    figure, place = scale_of(watched, "camber", "travel")
    points = [middle(box) for box in boxes(figure.locator(".plot circle.target"))]
    expected = [place(*pair) for pair in zip(TARGET["at_mm"], TARGET["value"], strict=True)]
    np.testing.assert_allclose(points, expected, atol=PLACE)
    # what matters of a target, to either side
    for box, value in zip(boxes(figure.locator(".plot path.target")), TARGET["value"], strict=True):
        ends = [place(0.0, value + side * TARGET["within"])[0] for side in (-1.0, 1.0)]
        assert [box["x"], box["x"] + box["width"]] == pytest.approx(ends, abs=PLACE)
    # arrows are beyond: left of the least, right of the most
    carets = boxes(figure.locator(".plot .caret"))
    least, most = place(0.0, -4.0)[0], place(0.0, 5.0)[0]
    lefts, rights = [b["x"] for b in carets], [b["x"] + b["width"] for b in carets]
    assert rights[:2] == pytest.approx([least] * 2, abs=PLACE)
    assert lefts[2:] == pytest.approx([most] * 2, abs=PLACE)
    upward = [middle(box)[1] for box in carets]
    assert upward == pytest.approx([place(at, 0.0)[1] for at in (-80, 80, -80, 80)], abs=PLACE)
    # all of them are in sight
    plot = figure.locator(".u-over").bounding_box()
    assert all(plot["x"] <= x <= plot["x"] + plot["width"] for x in [*lefts, *rights])
    legend = figure.locator("p.goals")
    assert legend.inner_text().split() == ["target", "limit"]
    assert legend.is_visible()


def test_marks_stay_with_their_values_while_the_curve_moves(watched):
    watched.start_again()
    figure, place = scale_of(watched, "scrub_radius", "rack")
    line = figure.locator(".plot path.limit")
    box = box_of(line)
    ends = [place(at, 25.0) for at in (-10.0, 40.0)]
    assert [box["x"], box["x"] + box["width"]] == pytest.approx([x for x, _ in ends], abs=PLACE)
    assert box["y"] == pytest.approx(ends[0][1], abs=PLACE)
    before = line.get_attribute("d")
    # the curve at this travel needs more room, and the marks keep their place in it
    pages.slide(watched.page, "#travel", 90)
    pages.until(lambda: line.get_attribute("d") != before)
    box, plot = box_of(line), figure.locator(".u-over").bounding_box()
    assert plot["y"] < box["y"] < plot["y"] + plot["height"]


def test_marks_are_printed(watched):
    """On paper a chart is a drawing of lines: its curve defines its scale."""
    watched.start_again()
    watched.page.pdf()
    drawing = watched.page.locator('figure[data-curve="camber"] .printed')
    numbers = "e => e.getAttribute('d').match(/-?[0-9.]+/g).map(Number)"
    line = np.array(drawing.locator(".line").evaluate(numbers)).reshape(-1, 2)
    # the curve goes from end to end
    values = [value_at("camber", "travel", at) for at in (-100.0, 100.0)]
    slope = (line[-1] - line[0]) / np.array([values[1] - values[0], 200.0])

    def place(millimetres, value):
        return line[0] + slope * [value - values[0], millimetres + 100.0]

    centre = "c => [Number(c.getAttribute('cx')), Number(c.getAttribute('cy'))]"
    points = [c.evaluate(centre) for c in drawing.locator("circle.target").all()]
    expected = [place(*pair) for pair in zip(TARGET["at_mm"], TARGET["value"], strict=True)]
    np.testing.assert_allclose(points, expected, atol=0.1)
    tips = [caret.evaluate(numbers)[:2] for caret in drawing.locator(".caret").all()]
    expected = [place(at, v) for v in (-4.0, 5.0) for at in (-80.0, 80.0)]
    np.testing.assert_allclose(tips, expected, atol=0.1)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_marks_can_be_seen_in_both_schemes(watched, scheme):
    page = watched.page
    page.emulate_media(color_scheme=scheme)
    background = pages.luminance(page.evaluate("getComputedStyle(document.body).backgroundColor"))
    figure = pages.show(page, "camber")
    for mark, of in (("circle.target", "fill"), (".caret", "fill"), (".limit", "stroke")):
        colour = figure.locator(f".plot {mark}").first.evaluate(f"e => getComputedStyle(e).{of}")
        lighter, darker = sorted((background, pages.luminance(colour)), reverse=True)
        assert (lighter + 0.05) / (darker + 0.05) >= 4.5, mark  # WCAG 2 asks for 3 of graphics


@pytest.mark.parametrize("width", [390, 360])
def test_the_table_of_goals_needs_no_scrolling(watched, width):
    page = watched.page
    page.set_viewport_size({"width": width, "height": 900})
    table = page.locator("h3:has-text('Which are met') + .wide")
    table.scroll_into_view_if_needed()
    inside, whole = table.evaluate("e => [e.clientWidth, e.scrollWidth]")
    assert whole <= inside
    assert page.evaluate("document.documentElement.scrollWidth") == width
