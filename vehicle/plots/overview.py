"""One picture of a suspension: its positions, and camber and toe over travel."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from ...core.named_types import Array
from ...pictures.figures import BLUE, GREEN, ORANGE, STYLE, save
from ..models.model import Model
from ..models.points import hardpoints
from ..models.positions import state_at_height

GREY = "#b8b8b8"
TYRE_WIDTH = 0.205  # of the drawing only [m]
TYRE_RADIUS = 0.300

_COLOURS = {
    "arm": BLUE, "upper arm": GREEN, "rocker": "#cc79a7", "strut": "black", "rod": ORANGE,
    "push rod": "#56b4e9",
}  # fmt: skip


def write_overview(model: Model, path: Path, travel: float = 0.08, *, force: bool = False) -> None:
    """Write a picture of the suspension at three heights, with camber and toe over travel [m]."""
    with rc_context(STYLE):
        figure = Figure(figsize=(10.0, 5.2), layout="constrained")
        front, camber, toe = figure.subplots(1, 3, width_ratios=(1.15, 1.0, 1.0))
        design = float(model.signal("wheel_center_z", model.design_state))
        for offset, colour in ((-travel, GREY), (travel, GREY), (0.0, "black")):
            _draw_front(front, model, state_at_height(model, design + offset), colour)
        _finish_front(front)
        front.set_title(f"from behind, at design and \u00b1{travel * 1e3:.0f} mm")
        figure.legend(loc="outside lower left", ncols=4, frameon=False, fontsize=9)
        _draw_angles(camber, toe, model, design, travel)
        figure.suptitle(
            f"{model.suspension.heading()}, {model.suspension.vehicle.side} side: kinematics"
        )
        save(figure, path, force=force)


def from_behind(models: Sequence[Model]) -> Figure:
    """Return a figure of one suspension at design, or both of an axle, seen from behind."""
    with rc_context(STYLE):
        figure = Figure(figsize=(3.4 * (1 + len(models)), 4.6), layout="constrained")
        axes = figure.subplots()
        for model in models:
            _draw_front(axes, model, model.design_state, "black")
        _finish_front(axes)
        labels = dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
        figure.legend(
            labels.values(), labels.keys(), loc="outside lower left", ncols=3, frameon=False,
            fontsize=9,
        )  # fmt: skip
    return figure


def _draw_front(axes: Axes, model: Model, state: Array, colour: str) -> None:
    points = {name: p[1:] * 1e3 for name, p in hardpoints(model, state).items()}
    strong = colour != GREY
    drawing = model.suspension.drawing()
    for name, (first, second, role) in drawing.links.items():
        line = np.array([points[first], points[second]])
        axes.plot(
            *line.T, color=_COLOURS[role] if strong else colour, linewidth=3.0 if strong else 1.4,
            marker="o", markersize=5 if strong else 3, label=name if strong else None,
            zorder=3 if strong else 2,
        )  # fmt: skip
    spokes = np.array([points[name] for name in drawing.knuckle])
    axes.plot(*spokes.T, color="#666666" if strong else colour, linewidth=1.6, zorder=2)
    _draw_tyre(axes, model, state, points["wheel_center"], strong=strong)


def _draw_tyre(axes: Axes, model: Model, state: Array, center: Array, *, strong: bool) -> None:
    """Draw the section of the tyre in the plane through the spin axis."""
    side = 1.0 if model.suspension.vehicle.side == "left" else -1.0
    lean = side * float(model.signal("camber", state))  # positive: top to the left
    up = np.array([np.sin(lean), np.cos(lean)]) * TYRE_RADIUS * 1e3
    across = np.array([np.cos(lean), -np.sin(lean)]) * TYRE_WIDTH / 2 * 1e3
    corners = np.array([up + across, up - across, -up - across, -up + across, up + across])
    axes.plot(
        *(center + corners).T, color="#333333" if strong else GREY,
        linewidth=1.6 if strong else 1.0, zorder=2 if strong else 1,
    )  # fmt: skip
    if strong:
        axes.fill(*(center + corners).T, color="#f0f0f0", zorder=1)


def _finish_front(axes: Axes) -> None:
    axes.axhline(0.0, color="#888888", linewidth=1.0)
    axes.set_aspect("equal")
    axes.invert_xaxis()  # seen from behind, left is at the left
    axes.set_xlabel("y [mm], positive left")
    axes.set_ylabel("z [mm]")


def _draw_angles(camber: Axes, toe: Axes, model: Model, design: float, travel: float) -> None:
    """Draw the angles with travel on the vertical axis."""
    offsets = np.linspace(-travel, travel, 81)
    signals = model.signals(np.array([state_at_height(model, design + o) for o in offsets]))
    for axes, name, colour, sign in (
        (camber, "camber", BLUE, "positive: top outboard"),
        (toe, "toe", ORANGE, "positive: toe-in"),
    ):
        axes.plot(np.degrees(signals[name]), offsets * 1e3, color=colour)
        axes.axvline(0.0, color="#888888", linewidth=0.8)
        axes.axhline(0.0, color="#888888", linewidth=0.8)
        axes.set_xlabel(f"{name} [deg]\n{sign}")
        axes.yaxis.set_major_locator(MultipleLocator(20.0))
    camber.set_ylabel("wheel travel [mm], positive in bump")
