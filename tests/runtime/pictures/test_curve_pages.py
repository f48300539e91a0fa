"""Pages of curves: scales that mean something, names beside the curves, none of them crossed."""

import numpy as np
import pytest
import xarray as xr
from kintrafo.core.quantities import variable
from kintrafo.pictures.curves import LEAST_SPANS, draw, leaps
from kintrafo.pictures.figures import wrapped
from kintrafo.vehicle.cli.outputs import title_of
from kintrafo.vehicle.plots.curves import figure, grouped
from matplotlib.backends.backend_agg import FigureCanvasAgg

TRAVEL = np.linspace(-0.08, 0.08, 33)


def curves(*lines, names=None, meaning="half-track change", units="m"):
    """Return a dataset of one variable, over wheel travel or of several cars."""
    over = {"wheel_travel": variable("wheel_travel", TRAVEL, "wheel travel", "m")}
    if names is None:
        return xr.Dataset({"one": variable("wheel_travel", lines[0], meaning, units)}, over)
    dimensions = ("data_set", "wheel_travel")
    one = variable(dimensions, np.array(lines), meaning, units)
    return xr.Dataset({"one": one}, over | {"data_set": list(names)})


@pytest.mark.parametrize(("amount", "widened"), [(0.00015, True), (0.003, False)])
def test_little_is_drawn_as_little(amount, widened):
    """0.15 mm takes 15 hundredths of an axis of 1 mm and is in its middle; 3 mm fill theirs."""
    axes = figure(curves(0.07 + amount * TRAVEL / 0.16), ["one"]).axes[0]
    low, high = axes.get_xlim()
    if widened:
        assert high - low == pytest.approx(LEAST_SPANS["mm"])
        assert 0.5 * (low + high) == pytest.approx(70.0, abs=1e-9)
    else:
        assert high - low == pytest.approx(3.0, rel=0.2)


def test_names_stand_beside_their_curves():
    """Labels as they are drawn: in the colour of a line, nearest to it, and crossed by none."""
    lines = 0.02 + TRAVEL**2, -0.02 - TRAVEL**2, 0.001 * np.sin(40.0 * TRAVEL)
    shown = curves(*lines, names=("upper", "lower", "middle")).rename(wheel_travel="rack_position")
    drawn = figure(shown, ["one"])
    canvas = FigureCanvasAgg(drawn)
    canvas.draw()
    (axes,) = drawn.axes
    assert drawn.legends == []
    assert axes.get_legend() is None
    of = {text.get_text(): text for text in axes.texts}
    assert set(of) == {"upper", "lower", "middle"}
    pixels = [axes.transData.transform(line.get_xydata()) for line in axes.get_lines()[:3]]
    fine = [np.array([np.interp(x, *p.T) for x in range(2000)]) for p in pixels]
    for name, line in zip(("upper", "lower", "middle"), axes.get_lines(), strict=False):
        text = of[name]
        assert text.get_color() == line.get_color()
        box = text.get_window_extent(canvas.get_renderer())
        places = range(int(box.x0), int(box.x1) + 1)
        gaps = [[abs(f[x] - 0.5 * (box.y0 + box.y1)) for x in places] for f in fine]
        assert min(map(min, gaps)) > 0.5 * box.height, "crossed"
        nearest = min(range(3), key=lambda k: min(gaps[k]))
        assert axes.get_lines()[nearest] is line


def test_names_without_room_are_in_a_legend():
    lines = 0.02 + TRAVEL, 0.02001 + TRAVEL
    shown = curves(*lines, names=("one", "other")).rename(wheel_travel="rack_position")
    drawn = figure(shown, ["one"])
    assert [t.get_text() for t in drawn.legends[0].get_texts()] == ["one", "other"]


def test_a_figure_calls_a_file_by_its_name():
    assert title_of("/somewhere/deep/my_car.toml") == "my_car"
    assert title_of("reference_car") == "reference_car"


def test_wheel_travel_is_on_the_vertical_axis():
    """With its design position, names once below the panels, and the samples of a measurement."""
    shown = curves(0.02 + TRAVEL, 0.03 + TRAVEL, names=("rig", "car"))
    shown["data_set"].attrs["measured"] = 1
    drawn = figure(shown, ["one"], alone=False)
    (axes,) = drawn.axes
    measured, car, *_ = axes.get_lines()
    np.testing.assert_allclose(measured.get_ydata(), 1e3 * TRAVEL)
    np.testing.assert_allclose(car.get_xdata(), 1e3 * (0.03 + TRAVEL))
    assert (measured.get_marker(), car.get_marker()) == ("o", "None")
    assert axes.get_ylabel().startswith("wheel travel [mm]")
    assert axes.get_legend() is None
    assert [text.get_text() for text in drawn.legends[0].get_texts()] == ["rig", "car"]


def test_no_curve_is_drawn_twice():
    shown = curves(TRAVEL)
    shown["opposite"] = -shown["one"].assign_attrs(shown["one"].attrs)
    names = [name for group in grouped(shown).values() for name in group]
    assert names == ["one"]


@pytest.mark.parametrize("count", [2, 4])
def test_lines_over_wheel_travel_are_named_in_each_panel(count):
    """Few above the curves; many below, and in the first panel of each row of a high figure."""
    lines = [slope * TRAVEL for slope in range(1, count + 1)]
    one = curves(*lines, names=("first", "second", "third", "fourth")[:count])
    several = xr.Dataset({f"curve_{i}": (1.0 + i) * one["one"] for i in range(11)})
    for curve in several.values():
        curve.attrs = dict(one["one"].attrs)
    drawn = figure(several, list(several), alone=False)
    FigureCanvasAgg(drawn).draw()
    panels = drawn.axes
    legends = [panel.get_legend() for panel in panels]
    named = [legend is not None for legend in legends]
    assert named == [count == 2 or index % 3 == 0 for index in range(11)]
    assert len(drawn.legends) == (count > 2)
    for panel, legend in zip(panels, legends, strict=True):
        highest = panel.transData.transform((0.0, 1e3 * TRAVEL[-1]))[1]
        assert legend is None or legend.get_window_extent().y0 > highest


def test_headings_begin_rows():
    """The longest group determines the number of panels in a row."""
    several = xr.Dataset({name: curves(TRAVEL)["one"] for name in "abcdef"})
    drawn = figure(several, list("abcdef"), alone=False, headings={"a": "First", "b": "Second"})
    cells = [
        (place.rowspan.start, place.colspan.start)
        for place in (axes.get_subplotspec() for axes in drawn.axes)
    ]
    assert cells == [(0, 0), (1, 0), (1, 1), (1, 2), (2, 0), (2, 1)]
    titles = [axes.get_title(loc="left").strip() for axes in drawn.axes]
    assert titles == ["First", "Second", "", "", "", ""]


@pytest.mark.parametrize("at", [0.0113, -0.0312, TRAVEL[3] + 1e-6, -0.0799])
def test_a_curve_is_interrupted_at_its_pole(at):
    """Whatever the distance of the pole from the samples, and beside a missing value."""
    values = 1.0 / (TRAVEL - at) + 5.0
    pole = int(np.flatnonzero(at > TRAVEL)[-1])
    np.testing.assert_array_equal(leaps(values), [pole])
    values[pole + 2] = np.nan
    np.testing.assert_array_equal(leaps(values), [pole])
    (axes,) = figure(curves(1.0 / (TRAVEL - at)), ["one"]).axes
    drawn = axes.get_lines()[0].get_xdata()
    np.testing.assert_array_equal(np.flatnonzero(np.isnan(drawn)), [pole])


@pytest.mark.parametrize(
    "values",
    [
        TRAVEL, TRAVEL**3, np.sign(TRAVEL), np.sin(300.0 * TRAVEL), np.full(33, np.nan),
        np.where(np.arange(33) == 7, 40.0, -TRAVEL - 0.1),
        np.random.default_rng(1).normal(size=33), 1.0 / (TRAVEL - 0.01) ** 2,
    ],
    ids=["line", "cubic", "step", "wave", "missing", "outlier", "noise", "same sign"],
)  # fmt: skip
def test_a_curve_without_a_pole_is_whole(values):
    assert leaps(values).size == 0


def over_time(*values, amplitudes=()):
    """Return a dataset of curves over time, each of several amplitudes where there are some."""
    dims = ("time", "amplitude") if amplitudes else ("time",)
    time = variable("time", np.linspace(0.0, 1.0, len(values[0])), "time", "s")
    runs = {"amplitude": variable("amplitude", list(amplitudes), "amplitude", "N")}
    lines = [np.multiply.outer(one, amplitudes) if amplitudes else one for one in values]
    return xr.Dataset(
        {f"curve_{i}": variable(dims, line, "force", "N") for i, line in enumerate(lines)},
        {"time": time} | (runs if amplitudes else {}),
    )


@pytest.mark.parametrize("count", [3, 5])
def test_names_of_many_lines_cover_no_curve(count):
    """They are below the panels."""
    several = over_time(*[np.arange(9.0) ** i for i in range(1, count + 1)], amplitudes=[1.0, 2.0])
    drawn = draw(several, list(several), alone=False)
    assert len(drawn.axes) == count
    assert all(axes.get_legend() is None for axes in drawn.axes)
    (legend,) = drawn.legends
    assert [text.get_text() for text in legend.get_texts()] == ["1 N", "2 N"]


def test_lines_of_a_page_are_equally_wide():
    """Thin beside a curve with many turns; turns that are rounding do not count."""
    x = np.linspace(0.0, 1.0, 1001)
    smooth, dense = np.sin(2 * np.pi * x), np.sin(200 * np.pi * x)
    rounded = np.where(x < 0.5, 1e-12 * dense, x - 0.5)
    widths = []
    for both in ((smooth, dense), (smooth, rounded)):
        panels = draw(dataset := over_time(*both), list(dataset), alone=False).axes
        widths.append({axes.get_lines()[0].get_linewidth() for axes in panels})
    assert [len(own) for own in widths] == [1, 1]
    assert widths[0].pop() < 1.0 < widths[1].pop()


def test_units_in_labels_are_not_broken():
    assert wrapped("damping ratio of heave, deviation", 28) == "damping ratio of heave,\ndeviation"
    lines = wrapped("weighted acceleration, RMS [m/s^2 per N s/m]", 30).split("\n")
    assert lines == ["weighted acceleration, RMS", "[m/s\u00b2\xa0per\xa0N\xa0s/m]"]


def test_wheels_and_axles_of_a_car_are_both_named():
    """Wheels have no space beside four curves, axles have: a legend names the wheels in words."""
    wheels = ["front_left", "front_right", "rear_left", "rear_right"]
    along = {"roll_angle": variable("roll_angle", TRAVEL, "roll angle", "rad")}
    of_wheels = variable(("wheel", "roll_angle"), np.outer(range(4), TRAVEL), "camber", "rad")
    of_axles = variable(("axle", "roll_angle"), np.outer((1.0, -1.0), TRAVEL**2), "height", "m")
    shown = xr.Dataset({"camber": of_wheels, "height": of_axles}, along)
    shown = shown.assign_coords(wheel=wheels, axle=["front", "rear"])
    drawn = figure(shown, ["camber", "height"], alone=False)
    (legend,) = drawn.legends
    assert [text.get_text() for text in legend.get_texts()] == [w.replace("_", " ") for w in wheels]
    assert {text.get_text() for text in drawn.axes[1].texts} == {"front", "rear"}
