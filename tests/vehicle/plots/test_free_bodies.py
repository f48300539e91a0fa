"""Pictures of free bodies: labels name their neighbours and points, and none is on another."""

from itertools import combinations

import numpy as np
import pytest
from cars.rigid_axles import LOPSIDED, STOPPED
from kintrafo import Axle, Model, loads
from kintrafo.vehicle.plots.loads import free_bodies
from matplotlib.backends.backend_agg import FigureCanvasAgg


@pytest.mark.parametrize(
    ("of", "case"),
    [
        (Model("reference_car"), "brake"),
        (Model("push_rod_car"), "brake"),
        (STOPPED, "brake"),
        (STOPPED, "corner"),
        (LOPSIDED, "trail_brake"),
    ],
    ids=["strut", "push rod", "stopped brake", "stopped corner", "lopsided trail brake"],
)
def test_labels_do_not_overlap(of, case):
    usual = {case: loads.standard_cases(of)[case]}
    figure = free_bodies(loads.static(of, usual), case)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    count = 0
    for axes in figure.axes:
        shown = [text for text in axes.texts if text.get_text()]
        boxes = [text.get_window_extent(canvas.get_renderer()) for text in shown]
        for (one, first), (other, second) in combinations(zip(shown, boxes, strict=True), 2):
            assert not first.overlaps(second), (one.get_text(), other.get_text())
        frame = axes.get_window_extent().padded(1.0)
        assert all(frame.contains(*end) for box in boxes for end in (box.p0, box.p1))
        count += len(shown)
        words = {text.get_text().splitlines()[1] for text in shown if "N" in text.get_text()}
        assert all(word.startswith("at ") or word.endswith(" N") for word in words)
    assert count > 20


def test_every_force_is_drawn_and_the_part_connects_its_points():
    """An arrow, or a symbol where it is across the drawing; the right link has 4 N of 12,000."""
    found = loads.static(STOPPED, {"corner": loads.standard_cases(STOPPED)["corner"]})
    of_beam = found.sel(case="corner").isel(load=(found["part"] == "beam").values)
    forces = np.linalg.norm(of_beam["force"].values, axis=1) > 0.5
    points = len({str(name) for name in of_beam["point"].values} - {"mass"})
    for axes in free_bodies(found, "corner", ["beam"]).axes:
        arrows = [text for text in axes.texts if getattr(text, "arrowprops", None)]
        heads = [text for text in arrows if text.arrowprops["arrowstyle"] == "-|>"]
        across = [line for line in axes.get_lines() if line.get_markersize() == 9]
        assert len(heads) + len(across) == forces.sum()
        members = [line for line in axes.get_lines() if line.get_linewidth() == 6.0]
        assert len(members) == points - 1


def test_a_part_without_forces_is_drawn_if_it_is_named():
    """The anti-roll bar of an axle at design, and its drop links, without labels."""
    found = loads.static(Axle.load("reference_axle"), {"static": {"contact_g": [0.0, 0.0, 1.0]}})
    figure = free_bodies(found, "static", ["anti_roll_bar", "drop_link_left"])
    assert [len(axes.texts) for axes in figure.axes] == [0] * 4
    assert all(axes.get_lines() for axes in figure.axes)
    drawn = {axes.get_title().partition(",")[0] for axes in free_bodies(found, "static").axes}
    assert "knuckle left" in drawn
    assert drawn.isdisjoint({"anti roll bar", "drop link left", "drop link right"})
