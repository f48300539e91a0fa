"""Draw docs/images/characteristics.png: ``python docs/images/characteristics.py``.

The suspension is the reference car with angles and offsets made large enough to be seen. Points and
lines are computed, not sketched.
"""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from kintrafo import Model, Suspension
from kintrafo.pictures.figures import BLUE, GREEN, ORANGE, STYLE
from kintrafo.vehicle.assembly import wheel
from kintrafo.vehicle.assembly.corner_kinematics import corner
from kintrafo.vehicle.models.points import hardpoints
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Circle, Polygon
from numpy.typing import NDArray

if TYPE_CHECKING:
    from kintrafo.vehicle.corner.corner import Corner

Array = NDArray[np.float64]

GREY, DARK = "#9a9a9a", "#333333"
HALF_WIDTH = 0.09  # of the tyre, for the drawing only [m]

DRAWN = Suspension.load("reference_car").with_changes(
    {
        "hardpoints.strut_top": [-110.0, -560.0, 790.0],
        "hardpoints.ball_joint": [15.0, -690.0, 185.0],
        "hardpoints.arm_front.z": 245.0,
        "hardpoints.arm_rear.z": 245.0,
        "hardpoints.wheel_center.x": -40.0,
        "hardpoints.wheel_center.y": -800.0,
        "wheel.camber_deg": -6.0,
    }
)


class Drawing:
    """The suspension at design, with what is drawn of it."""

    def __init__(self) -> None:
        model = Model(DRAWN)
        self.points = hardpoints(model, model.design_state)
        self.corner: Corner = corner(model, model.design_state[0])
        self.contact: Array = wheel.contact(self.corner)
        top, ball = self.points["strut_top"], self.points["ball_joint"]
        self.ground = ball + (self.contact[2] - ball[2]) / (top[2] - ball[2]) * (top - ball)
        center = self.points["wheel_center"]
        self.hub = ball + (center[2] - ball[2]) / (top[2] - ball[2]) * (top - ball)


def front_view(axes: Axes, it: Drawing) -> None:
    """Wheel and steering axis from the front."""
    _road(axes, it, -0.96, -0.28)
    _wheel_from_front(axes, it)
    _suspension_from_front(axes, it)
    top, ground, contact = it.points["strut_top"], it.ground, it.contact
    center = it.points["wheel_center"]
    axes.plot(*_yz(top, ground), color=ORANGE, ls="--", lw=1.2)
    _vertical(axes, ground[1], ground[2], 0.52)
    _angle(
        axes,
        (ground[1], ground[2]),
        0.94,
        90.0 - np.rad2deg(wheel.kingpin_inclination(it.corner)),
        90.0,
    )
    axes.text(-0.57, 0.5, "kingpin inclination", fontsize=8.5)
    _vertical(axes, contact[1], contact[2], 0.66)
    lean = np.rad2deg(wheel.camber(it.corner))
    _angle(axes, (contact[1], contact[2]), 1.24, min(90.0, 90.0 + lean), max(90.0, 90.0 + lean))
    upward = center + (center - contact) * 1.15
    axes.plot(*_yz(contact, upward), color=DARK, lw=0.8, ls="-.")
    axes.text(-0.81, 0.685, "camber", ha="right", fontsize=8.5)
    _dimension(axes, (contact[1], -0.085), (ground[1], -0.085), "steering-axis offset at ground")
    _dimension(axes, (center[1], center[2]), (it.hub[1], center[2]), "spindle offset", above=True)
    for point, name, shift in (
        (contact, "C", (-4, -12)),
        (ground, "G", (6, -12)),
        (center, "W", (-14, -10)),
    ):
        _mark(axes, point[1], point[2], name, shift)
    _finish(axes, "front view", (-0.98, -0.26), (-0.15, 0.82))


def centers(axes: Axes, it: Drawing) -> None:
    """Instant centre and roll centre from the front."""
    contact, corner_ = it.contact, it.corner
    y = contact[1] - corner_.vehicle.side * float(wheel.swing_arm_length_geometric(corner_))
    height = float(wheel.roll_center_height_geometric(corner_))
    slope = height / -contact[1]
    instant = np.array([0.0, y, contact[2] + slope * (y - contact[1])])
    roll = np.array([0.0, 0.0, contact[2] + height])
    _road(axes, it, -0.95, y + 0.1)
    _wheel_from_front(axes, it)
    _suspension_from_front(axes, it)
    ball, top = it.points["ball_joint"], it.points["strut_top"]
    for start in (ball, top):
        axes.plot(*_yz(start, instant), color=GREY, lw=1.0, ls="--")
    axes.plot(*_yz(contact, instant), color=GREEN, lw=1.4)
    axes.plot([0.0, 0.0], [-0.04, 0.95], color=DARK, lw=0.8, ls="-.")
    axes.text(0.02, 0.86, "y = 0", fontsize=8.5)
    _mark(axes, instant[1], instant[2], "instant centre", (-14, 7))
    _mark(axes, contact[1], contact[2], "C", (-4, -12))
    _mark(axes, roll[1], roll[2], "roll centre", (6, -12))
    axes.plot([0.0, 0.45], [roll[2]] * 2, color=GREY, lw=0.9, ls=":")
    _dimension(axes, (0.42, contact[2]), (0.42, roll[2]), "roll-centre height", upright=True)
    _dimension(axes, (contact[1], -0.1), (instant[1], -0.1), "front-view swing arm length")
    axes.text(
        0.32, 0.63, "square to the strut", fontsize=8.5, color=GREY, rotation=-11, ha="center"
    )
    axes.text(0.25, 0.365, "arm plane", fontsize=8.5, color=GREY, ha="center", rotation=10)
    _finish(axes, "front view, geometric instant centre", (-1.0, y + 0.12), (-0.19, 0.95))


def side_view(axes: Axes, it: Drawing) -> None:
    """Wheel and steering axis from the right: forward is to the right."""
    center, top, ground, hub = it.points["wheel_center"], it.points["strut_top"], it.ground, it.hub
    axes.plot([-0.42, 0.42], [it.contact[2]] * 2, color=DARK, lw=1.4)
    axes.add_patch(Circle((center[0], center[2]), 0.3, fill=False, color=DARK, lw=1.4))
    axes.plot([top[0], ground[0]], [top[2], ground[2]], color=ORANGE, ls="--", lw=1.4)
    _vertical(axes, ground[0], ground[2], 0.74)
    caster = np.rad2deg(wheel.caster(it.corner))
    _angle(axes, (ground[0], ground[2]), 1.3, 90.0, 90.0 + caster)
    axes.text(it.ground[0] - 0.01, 0.67, "caster", fontsize=8.5, ha="right")
    _dimension(axes, (it.contact[0], -0.085), (ground[0], -0.085), "trail")
    _dimension(axes, (center[0], center[2]), (hub[0], center[2]), "hub trail", above=True)
    for point, name, shift in (
        (it.contact, "C", (-4, -12)),
        (ground, "G", (-3, -12)),
        (center, "W", (-14, -10)),
        (top, "strut top", (8, 0)),
        (it.points["ball_joint"], "ball joint", (8, -3)),
    ):
        _mark(axes, point[0], point[2], name, shift)
    axes.annotate(
        "forward",
        (0.42, 0.5),
        (0.24, 0.5),
        arrowprops={"arrowstyle": "->"},
        fontsize=8.5,
        va="center",
    )
    _finish(axes, "side view", (-0.44, 0.46), (-0.15, 0.82))


def _yz(*points: Array) -> tuple[list[float], list[float]]:
    return [float(p[1]) for p in points], [float(p[2]) for p in points]


def _road(axes: Axes, it: Drawing, left: float, right: float) -> None:
    axes.plot([left, right], [it.contact[2]] * 2, color=DARK, lw=1.4)


def _wheel_from_front(axes: Axes, it: Drawing) -> None:
    center, up = it.points["wheel_center"], it.points["wheel_center"] - it.contact
    across = HALF_WIDTH * np.array([0.0, up[2], -up[1]]) / np.linalg.norm(up)
    corners = [center + a * up + b * across for a, b in ((1, 1), (1, -1), (-1, -1), (-1, 1))]
    axes.add_patch(Polygon([(p[1], p[2]) for p in corners], fc="#ececec", ec=DARK, lw=1.2))


def _suspension_from_front(axes: Axes, it: Drawing) -> None:
    points = it.points
    for ends, colour in (
        (("arm_front", "ball_joint"), BLUE),
        (("strut_top", "ball_joint"), "black"),
        (("tie_rod_inner", "tie_rod_outer"), GREY),
    ):
        axes.plot(*_yz(*(points[end] for end in ends)), color=colour, marker="o", ms=3.5)


def _vertical(axes: Axes, x: float, low: float, length: float) -> None:
    axes.plot([x, x], [low, low + length], color=GREY, lw=0.9, ls=":")


def _angle(axes: Axes, center: tuple[float, float], size: float, first: float, last: float) -> None:
    axes.add_patch(Arc(center, size, size, theta1=first, theta2=last, color=DARK, lw=0.9))


def _mark(axes: Axes, x: float, y: float, name: str, shift: tuple[float, float]) -> None:
    axes.plot(x, y, "o", color=DARK, ms=4.0, zorder=5)
    axes.annotate(name, (x, y), shift, textcoords="offset points", fontsize=8.5)


def _dimension(
    axes: Axes,
    start: tuple[float, float],
    end: tuple[float, float],
    text: str,
    *,
    above: bool = False,
    upright: bool = False,
) -> None:
    arrow = {"arrowstyle": "<->", "color": GREEN, "lw": 1.1, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", start, end, arrowprops=arrow)
    middle = 0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])
    place = (5, 0) if upright else (0, 4 if above else -4)
    axes.annotate(
        text,
        middle,
        place,
        textcoords="offset points",
        fontsize=8.5,
        color=GREEN,
        ha="left" if upright else "center",
        va="center" if upright else "bottom" if above else "top",
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.6, "alpha": 0.85},
    )


def _finish(axes: Axes, title: str, x: tuple[float, float], y: tuple[float, float]) -> None:
    axes.set(title=title, xlim=x, ylim=y, aspect="equal")
    axes.axis("off")


def main() -> None:
    """Write the picture."""
    it = Drawing()
    with rc_context(STYLE):
        figure = Figure(figsize=(10.5, 8.2), layout="constrained")
        upper, lower = figure.subfigures(2, 1)
        front, side = upper.subplots(1, 2, width_ratios=(1.0, 1.25))
        front_view(front, it)
        side_view(side, it)
        centers(lower.subplots(), it)
        figure.savefig(Path(__file__).with_suffix(".png"), dpi=130)


if __name__ == "__main__":
    main()
