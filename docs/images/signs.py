"""Draw docs/images/signs.png: ``python docs/images/signs.py``.

Every angle and displacement in its positive sense, on the left and on the right side. Wheels and
axes are drawn from the definitions in docs/reference/conventions.md, with large angles.
"""

from pathlib import Path

import numpy as np
from kintrafo.pictures.figures import BLUE, GREEN, ORANGE, STYLE
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, FancyArrowPatch, Polygon
from numpy.typing import NDArray

Array = NDArray[np.float64]

DARK, GREY, FILL = "#333333", "#8a8a8a", "#ececec"
RADIUS, HALF_WIDTH, HALF_TRACK = 300.0, 90.0, 760.0  # of the drawing [mm]
CAMBER, TOE, STEER, CASTER, KINGPIN = np.deg2rad([9.0, 14.0, 20.0, 14.0, 13.0])
SIDE_VIEW, HUB_VIEW = np.deg2rad([24.0, 20.0])
LEFT, RIGHT = 1.0, -1.0
INSTANT = (380.0, 250.0)  # instant centre of the links: beyond the middle, above the road [mm]
SIDES = {LEFT: "left", RIGHT: "right"}

# Seen from behind and from above, y runs to the left of the picture.
Place = tuple[float, float]


def turned(vector: Place, angle: float) -> Array:
    """Return a vector of the picture, turned counterclockwise."""
    cos, sin = np.cos(angle), np.sin(angle)
    return np.array([cos * vector[0] - sin * vector[1], sin * vector[0] + cos * vector[1]])


def box(axes: Axes, center: Array, angle: float, *, shade: str = FILL) -> None:
    """Draw a wheel edge on: upright in the picture, turned counterclockwise."""
    corners = [(a * HALF_WIDTH, b * RADIUS) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    outline = [center + turned(corner, angle) for corner in corners]
    axes.add_patch(Polygon(outline, closed=True, fc=shade, ec=DARK, lw=1.3))
    ends = [center + turned((0.0, end * 1.3 * RADIUS), angle) for end in (-1.0, 1.0)]
    axes.plot(*np.transpose(ends), color=DARK, lw=0.9, ls="-.")


def upright(axes: Axes, center: Array, length: float) -> None:
    """Draw the line from which an angle counts."""
    axes.plot([center[0]] * 2, [center[1], center[1] + length], color=GREY, lw=0.9, ls=":")


def arc(axes: Axes, center: Array, radius: float, angle: float, name: str, colour: str) -> None:
    """Draw an arrow from upright to an angle, counterclockwise, with its name outside."""
    steps = np.linspace(0.0, angle, 24)
    points = np.array([center + turned((0.0, radius), step) for step in steps])
    axes.plot(*points[:-2].T, color=colour, lw=1.6)
    arrow(axes, points[-4], points[-1], colour)
    beyond = center + turned((0.0, radius + 40.0), 1.25 * angle)
    ha = "right" if angle > 0.0 else "left"
    axes.text(*beyond, name, color=colour, ha=ha, va="center", fontsize=9)


def arrow(axes: Axes, start: Array, end: Array, colour: str, style: str = "-|>") -> None:
    """Draw an arrow."""
    axes.add_patch(
        FancyArrowPatch(
            tuple(start),
            tuple(end),
            arrowstyle=style,
            mutation_scale=13,
            color=colour,
            lw=1.6,
            shrinkA=0,
            shrinkB=0,
        )
    )


def named_arrow(axes: Axes, start: Place, way: Place, name: str, colour: str) -> None:
    """Draw a displacement with its name at the tip."""
    end = np.add(start, way)
    arrow(axes, np.array(start), end, colour)
    beyond = end + 26.0 * np.array(way) / np.hypot(*way)
    ha = "center" if way[0] == 0.0 else "right" if way[0] < 0.0 else "left"
    va = "center" if way[1] == 0.0 else "top" if way[1] < 0.0 else "bottom"
    axes.text(*beyond, name, color=colour, ha=ha, va=va, fontsize=9)


def axes_cross(axes: Axes, at: Place, right: str, up: str) -> None:
    """Draw two of the vehicle's axes; a minus before the name lets it point the other way."""
    for name, way in ((right, (1.0, 0.0)), (up, (0.0, 1.0))):
        sense = -1.0 if name.startswith("-") else 1.0
        label = {"x": "x forward", "y": "y left", "z": "z up"}[name.removeprefix("-")]
        named_arrow(axes, at, tuple(110.0 * sense * np.array(way)), label, DARK)
    axes.add_patch(Circle(at, 11.0, color=DARK))


def finish(axes: Axes, title: str, x: Place, y: Place) -> None:
    """Put a panel into its frame."""
    axes.set(title=title, xlim=x, ylim=y, aspect="equal")
    axes.axis("off")


def from_behind(axes: Axes) -> None:
    """Draw the angles of wheel and steering axis, the arm, wheel travel and the rack."""
    axes.axhline(0.0, color=DARK, lw=1.2)
    for side, name in SIDES.items():
        out = -side  # outboard in the picture
        wheel = np.array([out * HALF_TRACK, RADIUS])
        box(axes, wheel, side * CAMBER)
        upright(axes, wheel, 1.45 * RADIUS)
        arc(axes, wheel, 1.25 * RADIUS, side * CAMBER, "camber", ORANGE)
        ball = wheel + np.array([-out * 150.0, -130.0])
        steering_axis(axes, side, wheel, ball)
        arm(axes, side, ball)
        travel = (out * (HALF_TRACK + 220.0), RADIUS - 70.0)
        named_arrow(axes, travel, (0.0, 150.0), "wheel\ntravel", DARK)
        axes.text(out * (HALF_TRACK + 60.0), -150.0, f"{name} wheel", ha="center", va="top")
    axes.plot([-130.0, 130.0], [420.0, 420.0], color=DARK, lw=5, solid_capstyle="butt")
    arrow(axes, np.array([75.0, 380.0]), np.array([-75.0, 380.0]), ORANGE)
    axes.text(0.0, 350.0, "rack displacement", color=ORANGE, ha="center", va="top", fontsize=9)
    axes_cross(axes, (0.0, 640.0), "-y", "z")
    finish(axes, "from behind", (-1150.0, 1150.0), (-220.0, 930.0))


def steering_axis(axes: Axes, side: float, wheel: Array, ball: Array) -> None:
    """Draw kingpin inclination and the offsets of the axis at the ground and at the wheel."""
    out, lean = -side, np.tan(KINGPIN)
    top = ball + turned((0.0, 640.0), -side * KINGPIN)
    axes.plot(*np.transpose([ball, top]), color=BLUE, lw=2.2)
    upright(axes, ball, 640.0)
    arc(axes, ball, 560.0, -side * KINGPIN, "kingpin inclination", BLUE)
    contact = np.array([wheel[0] - out * RADIUS * np.sin(CAMBER), 0.0])
    ground, hub = (
        np.array([ball[0] - out * (height - ball[1]) * lean, height]) for height in (0.0, wheel[1])
    )
    axes.plot(*np.transpose([ground, ball]), color=BLUE, lw=1.0, ls="--")
    below = np.array([0.0, 45.0])
    arrow(axes, contact - below, ground - below, GREEN)
    axes.text(
        ground[0], -80.0, "steering-axis offset", color=GREEN, ha="center", va="top", fontsize=9
    )
    axes.plot(*wheel, "o", color=DARK, ms=5)
    arrow(axes, wheel, hub, GREEN)
    aside = "left" if side == LEFT else "right"
    axes.text(
        hub[0] - out * 22.0,
        hub[1],
        "spindle offset",
        color=GREEN,
        ha=aside,
        va="center",
        fontsize=9,
    )


def arm(axes: Axes, side: float, ball: Array) -> None:
    """Draw the lower arm and its angle, from upright to the arm."""
    hinge = ball + np.array([side * 400.0, 0.0])
    axes.plot(*np.transpose([hinge, ball]), color=DARK, lw=2.2)
    axes.plot(*hinge, "^", color=DARK, ms=9)
    axes.plot(*ball, "o", color=DARK, ms=5)
    upright(axes, hinge, 160.0)
    steps = np.linspace(0.0, side * np.pi / 2, 40)
    swing = np.array([hinge + turned((0.0, 100.0), step) for step in steps])
    axes.plot(*swing.T, color=GREEN, lw=1.6)
    arrow(axes, swing[-3], swing[-1], GREEN)
    label = hinge + turned((0.0, 55.0), side * np.pi / 4)
    axes.text(*label, "β1", color=GREEN, ha="center", va="center", fontsize=10)


def centers(axes: Axes) -> None:
    """Draw instant centres, roll centre and the way of the contacts in bump."""
    axes.axhline(0.0, color=DARK, lw=1.2)
    axes.plot([0.0, 0.0], [-30.0, 470.0], color=GREY, lw=0.9, ls="-.")
    for side, level in ((LEFT, -75.0), (RIGHT, -170.0)):
        swing_arm(axes, side, level)
    roll = INSTANT[1] * HALF_TRACK / (HALF_TRACK + INSTANT[0])
    arrow(axes, np.array([0.0, 0.0]), np.array([0.0, roll]), GREEN)
    axes.plot(0.0, roll, "o", color=DARK, ms=5)
    axes.text(0.0, roll + 22.0, "roll centre", ha="center", va="bottom", fontsize=9)
    axes.text(16.0, 70.0, "its height", color=GREEN, ha="left", va="center", fontsize=9)
    finish(axes, "from behind: instant centres", (-1150.0, 1150.0), (-260.0, 640.0))


def swing_arm(axes: Axes, side: float, level: float) -> None:
    """Draw the swing arm of one wheel, with its length at a level below the road."""
    out = -side
    contact = np.array([out * HALF_TRACK, 0.0])
    center = np.array([-out * INSTANT[0], INSTANT[1]])
    box(axes, contact + np.array([0.0, RADIUS]), 0.0)
    axes.plot(*np.transpose([contact, center]), color=GREY, lw=1.0)
    axes.plot(*np.transpose([center, (center[0], level)]), color=GREY, lw=0.9, ls=":")
    axes.plot(*center, "o", color=DARK, ms=5)
    name = f"instant centre,\n{SIDES[side]} wheel"
    axes.text(center[0], center[1] + 25.0, name, ha="center", va="bottom", fontsize=9)
    named_arrow(axes, (contact[0], level), (center[0] - contact[0], 0.0), "swing-arm length", GREEN)
    square = turned(tuple(center - contact), side * np.pi / 2)
    arrow(axes, contact, contact + 190.0 * square / np.hypot(*square), ORANGE)
    axes.text(
        contact[0] + out * 105.0,
        200.0,
        "contact\nin bump",
        color=ORANGE,
        ha="right" if side == LEFT else "left",
        va="center",
        fontsize=9,
    )
    named_arrow(
        axes, (contact[0] + out * 110.0, 65.0), (out * 100.0, 0.0), "half-track\nchange", DARK
    )


def from_above(axes: Axes) -> None:
    """Draw toe and the rolling wheel's spin axis."""
    for side, name in SIDES.items():
        wheel = np.array([-side * 420.0, 0.0])
        box(axes, wheel, -side * TOE)
        upright(axes, wheel, 1.45 * RADIUS)
        arc(axes, wheel, 1.25 * RADIUS, -side * TOE, "toe", ORANGE)
        ends = [wheel + turned((x, 0.0), -side * TOE) for x in (150.0, -230.0)]
        arrow(axes, *ends, BLUE)
        axes.text(
            *(ends[1] + np.array([-8.0, 34.0])), "spin axis", color=BLUE, ha="right", fontsize=9
        )
        axes.text(wheel[0], -1.5 * RADIUS, f"{name} wheel", ha="center", va="top")
    axes_cross(axes, (0.0, 60.0), "-y", "x")
    finish(axes, "from above: toe, spin", (-760.0, 700.0), (-560.0, 560.0))


def steered(axes: Axes) -> None:
    """Draw steer, the same sense on both sides."""
    for side, name in SIDES.items():
        wheel = np.array([-side * 420.0, 0.0])
        box(axes, wheel, STEER)
        upright(axes, wheel, 1.45 * RADIUS)
        arc(axes, wheel, 1.25 * RADIUS, STEER, "steer", ORANGE)
        axes.text(wheel[0], -1.5 * RADIUS, f"{name} wheel", ha="center", va="top")
    axes_cross(axes, (0.0, 60.0), "-y", "x")
    finish(axes, "from above: steer", (-760.0, 700.0), (-560.0, 560.0))


def from_the_side(axes: Axes, side: float) -> None:
    """Draw caster, trail and the sense of rolling, from outside: forward is left on the left."""
    ahead = -side  # forward in the picture
    wheel = wheel_from_the_side(axes)
    ground = np.array([ahead * 170.0, 0.0])
    top = ground + turned((0.0, 780.0), -side * CASTER)
    axes.plot(*np.transpose([ground, top]), color=BLUE, lw=2.2)
    upright(axes, ground, 780.0)
    arc(axes, ground, 690.0, -side * CASTER, "caster", BLUE)
    below = np.array([0.0, 45.0])
    arrow(axes, -below, ground - below, GREEN)
    axes.text(ahead * 85.0, -75.0, "trail", color=GREEN, ha="center", va="top", fontsize=9)
    hub = np.array([ground[0] - ahead * RADIUS * np.tan(CASTER), RADIUS])
    arrow(axes, wheel, hub, GREEN)
    axes.text(
        -ahead * 25.0,
        RADIUS - 25.0,
        "hub trail",
        color=GREEN,
        ha="left" if side == LEFT else "right",
        va="top",
        fontsize=9,
    )
    steps = np.linspace(-0.5, 0.5, 30)
    spin = [wheel + turned((0.0, 190.0), side * step) for step in steps]
    axes.plot(*np.transpose(spin[:-2]), color=ORANGE, lw=1.6)
    arrow(axes, spin[-4], spin[-1], ORANGE)
    axes.text(-ahead * 130.0, RADIUS + 85.0, "spin", color=ORANGE, ha="center", fontsize=9)
    axes_cross(axes, (-ahead * 660.0, 140.0), "-x" if side == LEFT else "x", "z")
    finish(axes, f"{SIDES[side]} wheel, from outside", (-780.0, 780.0), (-170.0, 860.0))


def in_bump(axes: Axes, side: float) -> None:
    """Draw how contact and wheel centre move in bump, from outside."""
    ahead = -side
    wheel = wheel_from_the_side(axes)
    path(axes, side, np.array([0.0, 0.0]), SIDE_VIEW, "side-view\nswing arm angle")
    path(axes, side, wheel, HUB_VIEW, "side-view\nhub angle")
    named_arrow(axes, (ahead * 330.0, RADIUS), (ahead * 110.0, 0.0), "wheelbase\nchange", DARK)
    name = "contact ahead in bump: anti-dive"
    axes.text(0.0, -45.0, name, color=GREEN, ha="center", va="top", fontsize=9)
    axes_cross(axes, (-ahead * 660.0, 140.0), "-x" if side == LEFT else "x", "z")
    finish(axes, f"{SIDES[side]} wheel in bump, from outside", (-780.0, 780.0), (-140.0, 680.0))


def path(axes: Axes, side: float, start: Array, angle: float, name: str) -> None:
    """Draw the way of a point in bump, with its angle from upright named outside the wheel."""
    upright(axes, start, 260.0)
    arrow(axes, start, start + turned((0.0, 270.0), side * angle), DARK)
    arc(axes, start, 215.0, side * angle, "", ORANGE)
    axes.annotate(
        name,
        tuple(start + turned((0.0, 200.0), 0.5 * side * angle)),
        (-side * 320.0, start[1] + 165.0),
        color=ORANGE,
        ha="right" if side == LEFT else "left",
        va="center",
        fontsize=9,
        arrowprops={"arrowstyle": "-", "color": ORANGE, "lw": 0.6, "shrinkB": 0.0},
    )


def wheel_from_the_side(axes: Axes) -> Array:
    """Draw the road and a wheel on it; return its centre."""
    wheel = np.array([0.0, RADIUS])
    axes.axhline(0.0, color=DARK, lw=1.2)
    axes.add_patch(Circle(tuple(wheel), RADIUS, fc=FILL, ec=DARK, lw=1.3))
    axes.plot(*wheel, "o", color=DARK, ms=5)
    return wheel


def main() -> None:
    """Write the picture."""
    with rc_context(STYLE):
        figure = Figure(figsize=(11.0, 17.0), layout="constrained")
        rows = figure.subfigures(5, 1, height_ratios=(1.15, 0.95, 0.95, 1.0, 0.85))
        from_behind(rows[0].subplots())
        toe, steer = rows[1].subplots(1, 2)
        from_above(toe)
        steered(steer)
        for row, draw in ((rows[2], from_the_side), (rows[4], in_bump)):
            for axes, side in zip(row.subplots(1, 2), SIDES, strict=True):
                draw(axes, side)
        centers(rows[3].subplots())
        # no version in the file: the same drawing makes the same bytes
        figure.savefig(Path(__file__).with_suffix(".png"), dpi=110, metadata={"Software": None})


if __name__ == "__main__":
    main()
