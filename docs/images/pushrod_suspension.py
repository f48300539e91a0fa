"""Draw docs/images/pushrod_suspension.png: ``python docs/images/pushrod_suspension.py``.

Left the sketch of docs/mechanisms/own-mechanism.md, right the compiled mechanism at three heights
of the wheel, and its motion after a step of the road.
"""

from pathlib import Path

import kintrafo
import numpy as np
from kintrafo.pictures.figures import BLUE, GREEN, ORANGE, STYLE
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from numpy.typing import NDArray

Array = NDArray[np.float64]

HERE = Path(__file__)
EXAMPLE = HERE.parents[2] / "examples" / "pushrod_suspension.py"
DARK, GREY = "#333333", "#9a9a9a"
FIXED = ("arm_front", "rocker_pivot", "spring_chassis")
MOVING = {
    "arm": ("arm_front", "rod_lower", "wheel_center"),
    "rocker": ("rocker_pivot", "rod_upper", "spring_rocker"),
}
# Where the names stand, seen from their points [mm], and which of their ends is there.
NAMES = {
    "arm_front": (0, -45, "center"),
    "rod_lower": (-5, -45, "center"),
    "wheel_center": (0, 25, "center"),
    "rod_upper": (20, 10, "left"),
    "rocker_pivot": (-20, -35, "right"),
    "spring_rocker": (-5, 22, "center"),
    "spring_chassis": (-25, -60, "left"),
}


def places(system: kintrafo.System, state: Array) -> dict[str, Array]:
    """Return where the points are, in millimetres: y and z in chassis axes."""
    values = system.parameters
    design = {
        name: np.array([values[f"{name}_{axis}"] for axis in "xyz"]) for name in (*FIXED, *NAMES)
    }
    found = {name: design[name] for name in FIXED}
    positions, turned = system.evaluate("positions", state), system.evaluate("orientations", state)
    for body, names in MOVING.items():
        index = system.equations.BODIES.index(body)
        center = np.array([values[f"{body}_com_{axis}"] for axis in "xyz"])
        for name in names:
            found[name] = positions[index] + turned[index] @ (design[name] - center)
    return {name: 1e3 * place[1:] for name, place in found.items()}


def draw(axes: Axes, at: dict[str, Array], colour: str, *, spring: bool = True) -> None:
    """Draw the mechanism, seen from the front."""
    for points in MOVING.values():
        axes.fill(*np.array([at[p] for p in points]).T, fc="none", ec=colour, lw=2.0)
    axes.plot(*np.array([at["rod_lower"], at["rod_upper"]]).T, color=colour, lw=2.0)
    if spring:
        axes.plot(*coil(at["spring_chassis"], at["spring_rocker"]), color=colour, lw=1.2)
    for name in ("rod_lower", "rod_upper", "spring_rocker", "wheel_center"):
        axes.plot(*at[name], "o", color=colour, ms=4)


def coil(start: Array, end: Array) -> Array:
    """Return a zigzag between two points."""
    along = np.linspace(0.0, 1.0, 17)
    across = np.where((along > 0.1) & (along < 0.9), 12.0 * (-1.0) ** np.arange(17), 0.0)
    direction = (end - start) / np.linalg.norm(end - start)
    normal = np.array([-direction[1], direction[0]])
    line: Array = (start + np.outer(along, end - start) + np.outer(across, normal)).T
    return line


def frame(axes: Axes, title: str) -> None:
    """Put a view from the front into its frame."""
    axes.set(title=title, xlabel="y [mm]", ylabel="z [mm]", aspect="equal")
    axes.set(xlim=(-60.0, 880.0), ylim=(-40.0, 660.0))


def sketch(axes: Axes, system: kintrafo.System) -> None:
    """Draw the mechanism with the names of its points."""
    at = places(system, system.design_state)
    axes.axhline(0.0, color=GREY, lw=1.0)
    axes.add_patch(Circle(tuple(at["wheel_center"]), 260.0, fc="#f2f2f2", ec=GREY))
    draw(axes, at, BLUE)
    for name in FIXED:
        axes.plot(*at[name], "^", color=DARK, ms=9)
    for name, (right, up, end) in NAMES.items():
        axes.text(*(at[name] + (right, up)), name, ha=end, fontsize=8)
    frame(axes, "The sketch, seen from the front")


def heights(axes: Axes, system: kintrafo.System) -> None:
    """Draw the mechanism with the wheel low, at design and high."""
    for angle, colour in ((-0.15, ORANGE), (0.15, GREEN), (0.0, BLUE)):
        at = places(system, system.state(arm_angle=angle))
        label = f"arm {np.rad2deg(angle):+.1f}°" if angle else "design"
        draw(axes, at, colour)
        axes.plot([], [], color=colour, label=label)
    for name in FIXED:
        axes.plot(*at[name], "^", color=DARK, ms=9)
    axes.legend(loc="lower left")
    frame(axes, "The mechanism, compiled")


def step(axes: Axes, system: kintrafo.System) -> None:
    """Draw the motion after a step of the road."""
    times = np.linspace(0.0, 0.6, 601)
    rest = kintrafo.rest(system)
    road = ([0.0, 0.1, 0.1, 0.6], [0.0, 0.0, 0.02, 0.02])
    result = kintrafo.simulate(
        system, (0.0, 0.6), rest, inputs={"road_height": road}, t_eval=times, rtol=1e-8
    )
    wheel = 1e3 * (result.signals["wheel_center_z"] - result.signals["wheel_center_z"][0])
    spring = 1e3 * (result.signals["coilover_length"] - result.signals["coilover_length"][0])
    axes.step([0.0, 100.0, 600.0], [0.0, 0.0, 20.0], color=GREY, where="pre", label="road")
    axes.plot(1e3 * times, wheel, color=BLUE, label="wheel centre, up")
    axes.plot(1e3 * times, -spring, color=ORANGE, label="spring, compression")
    axes.set(title="A step of the road by 20 mm", xlabel="time [ms]", ylabel="from rest [mm]")
    axes.legend()


def main() -> None:
    """Write the picture."""
    system = kintrafo.System(kintrafo.compile(EXAMPLE))
    with rc_context(STYLE):
        figure = Figure(figsize=(13.5, 4.2), layout="constrained")
        left, middle, right = figure.subplots(1, 3, width_ratios=(1.25, 1.25, 1.0))
        sketch(left, system)
        heights(middle, system)
        step(right, system)
        figure.savefig(HERE.with_suffix(".png"), dpi=110)


if __name__ == "__main__":
    main()
