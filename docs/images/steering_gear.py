"""Draw docs/images/steering_gear.png: ``python docs/images/steering_gear.py``.

Left the mechanism of examples/steering_gear.py from the side; right how far its rack goes for a
turn of the column, for forks of the shaft that are turned against each other.
"""

from math import cos, radians, sin
from pathlib import Path

import kintrafo
import numpy as np
from kintrafo.pictures.figures import BLUE, GREEN, ORANGE, STYLE
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

HERE = Path(__file__)
EXAMPLE = HERE.parents[2] / "examples" / "steering_gear.py"
DARK, GREY = "#333333", "#9a9a9a"
COLUMN_TOP, PINION_END = -0.28, 0.38  # x of the ends that are drawn [m]
FORKS = {0.0: BLUE, 45.0: GREEN, 90.0: ORANGE}  # by how far the lower one is turned [degrees]
TURN = np.linspace(0.0, 2.0 * np.pi, 361)


def draw_side(axes: Axes, system: kintrafo.System) -> None:
    """Draw column, shaft, pinion and rack in the plane of the shafts."""
    given = system.parameters
    upper, lower = (np.array([given[f"{end}_x"], given[f"{end}_z"]]) for end in ("upper", "lower"))
    slope = given["axis_z"] / given["axis_x"]
    top = upper + (COLUMN_TOP - upper[0]) * np.array([1.0, slope])
    end = lower + (PINION_END - lower[0]) * np.array([1.0, slope])
    middle = upper + 0.55 * (lower - upper)
    for line, colour, width in (
        ((top, upper), DARK, 4.0),
        ((upper, middle), BLUE, 6.0),
        ((upper, lower), BLUE, 3.0),
        ((lower, end), DARK, 4.0),
    ):
        axes.plot(*(1e3 * np.transpose(line)), color=colour, linewidth=width)
    for point in (upper, lower):
        axes.plot(*(1e3 * point), "o", color="white", markeredgecolor=DARK, markersize=9.0)
    rack = 1e3 * (lower + (end - lower) * 0.55 + [0.0, -0.012])
    axes.plot(*rack, "s", color=GREY, markersize=9.0)
    for text, place, to in (
        ("column", 0.5 * (top + upper), (-8, 12)),
        ("shaft", 0.5 * (upper + lower), (12, 6)),
        ("pinion", end, (-2, 10)),
        ("rack", rack / 1e3, (-40, -6)),
    ):
        axes.annotate(text, 1e3 * np.asarray(place), to, textcoords="offset points", color=DARK)
    axes.set(aspect="equal", xlabel="x [mm]", ylabel="z [mm]")
    axes.margins(0.08, 0.2)


def draw_travel(axes: Axes, system: kintrafo.System) -> None:
    """Draw the travel of the rack for each turn of the column, over the angle of the column."""
    states = np.transpose([TURN, np.zeros_like(TURN)])
    for turned, colour in FORKS.items():
        x, y = sin(radians(turned)), cos(radians(turned))
        fork = {"lower_fork_x": 0.2 * x, "lower_fork_y": y * 1.04**0.5, "lower_fork_z": x}
        geared = kintrafo.System(system.equations, fork)
        rates = geared.evaluate("relative_jacobian", states)[:, :, 0]
        angle = np.unwrap(geared.evaluate("relative_coordinates", states)[:, 0])
        travel = 2e3 * np.pi * rates[:, 2] / rates[:, 0]
        order = np.argsort(np.degrees(angle) % 360.0)
        axes.plot(
            (np.degrees(angle) % 360.0)[order],
            travel[order],
            color=colour,
        )
        words = f"forks turned\nby {turned:.0f}°" if turned else "forks\nin phase"
        axes.text(367.0, travel[order][-1], words, color=colour, va="center")
    axes.set(
        xlabel="angle of the column [°]",
        ylabel="travel of the rack [mm per turn]",
        xlim=(0.0, 360.0),
        xticks=range(0, 361, 90),
        yticks=range(40, 57, 5),
    )


def draw() -> Figure:
    """Return the picture."""
    system = kintrafo.System(kintrafo.compile(EXAMPLE))
    figure = Figure(figsize=(9.4, 3.9), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.15, 1.0))
    draw_side(left, system)
    draw_travel(right, system)
    return figure


def main() -> None:
    """Write the picture beside this script."""
    with rc_context(STYLE):
        draw().savefig(HERE.with_suffix(".png"), dpi=120)


if __name__ == "__main__":
    main()
