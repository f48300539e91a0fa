"""Draw docs/images/excavator.png: ``python docs/images/excavator.py``.

Left the compiled excavator in three positions, with all that the pin of its bucket can reach; right
how boom, arm and bucket turn with the strokes of their cylinders.
"""

from pathlib import Path

import numpy as np
from kintrafo.generated import excavator
from kintrafo.pictures.figures import BLUE, GREEN, ORANGE, STYLE
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

Array = NDArray[np.float64]

DARK, GREY = "#333333", "#9a9a9a"
STROKES = {"boom": (-0.55, 0.55), "arm": (-0.45, 0.85), "bucket": (-0.35, 0.55)}  # m
COLOURS = {"boom": BLUE, "arm": ORANGE, "bucket": GREEN}
GIVEN = {name: entry["default"] for name, entry in excavator.PARAMETERS.items()}
LINKS = {
    "boom": ("boom_foot", "boom_rod_pin", "arm_barrel_pin", "arm_pin"),
    "arm": ("arm_rod_pin", "arm_pin", "bucket_barrel_pin", "rocker_pin", "bucket_pin"),
    "rocker": ("rocker_pin", "knee"),
    "link": ("knee", "link_pin"),
    "bucket": ("bucket_pin", "link_pin"),
}
CYLINDERS = {
    "boom": (("chassis", "boom_barrel_pin"), ("boom", "boom_rod_pin")),
    "arm": (("boom", "arm_barrel_pin"), ("arm", "arm_rod_pin")),
    "bucket": (("arm", "bucket_barrel_pin"), ("rocker", "knee")),
}
# The bucket's sides in its own design position; no hardpoints, for the picture only [m].
SHELL = ((6.4, 1.75), (6.84, 1.78), (7.1, 1.35), (7.05, 0.85), (6.7, 0.45), (6.2, 0.35))
POSITIONS = ((0.0, 0.0, 0.0), (-0.5, -0.3, -0.25), (0.5, -0.35, 0.3))


def hardpoint(name: str) -> Array:
    """Return a hardpoint at the design position, m."""
    return np.array([GIVEN[f"{name}_x"], 0.0, GIVEN[f"{name}_z"]])


def carried(body: str, at: Array, strokes: Array) -> Array:
    """Return where a body takes a place of the design position, x and z, at some strokes."""
    if body == "chassis":
        return np.broadcast_to(at[[0, 2]], (*strokes.shape[:-1], 2))
    state = np.concatenate((strokes, np.zeros_like(strokes)), axis=-1)
    index = excavator.BODIES.index(body)
    center = excavator.positions(state)[..., index, :]
    turned = excavator.orientations(state)[..., index, :, :] @ (at - hardpoint(f"{body}_com"))
    return (center + turned)[..., [0, 2]]


def draw_machine(axes: Axes, strokes: Array, alpha: float) -> None:
    """Draw the machine in one position."""
    for body, points in LINKS.items():
        line = np.array([carried(body, hardpoint(p), strokes) for p in points])
        axes.plot(*line.T, color=DARK, linewidth=3.0, alpha=alpha, solid_joinstyle="round")
        axes.plot(*line.T, "o", color="white", markeredgecolor=DARK, markersize=3.5, alpha=alpha)
    shell = [carried("bucket", np.array([x, 0.0, z]), strokes) for x, z in SHELL]
    axes.fill(*np.transpose(shell), color=GREY, alpha=0.6 * alpha)
    for name, pins in CYLINDERS.items():
        low, high = (carried(body, hardpoint(pin), strokes) for body, pin in pins)
        barrel = low + 0.55 * (high - low)
        axes.plot(*np.transpose([low, barrel]), color=COLOURS[name], linewidth=5.0, alpha=alpha)
        axes.plot(*np.transpose([low, high]), color=COLOURS[name], linewidth=2.0, alpha=alpha)


def draw_reach(axes: Axes) -> None:
    """Draw what the pin of the bucket reaches: the ends of both strokes, one after the other."""
    along = np.linspace(0.0, 1.0, 60)
    (b0, b1), (a0, a1) = STROKES["boom"], STROKES["arm"]
    boom, arm = b0 + (b1 - b0) * along, a0 + (a1 - a0) * along
    sides = [
        (boom, np.full(60, a0)),
        (np.full(60, b1), arm),
        (boom[::-1], np.full(60, a1)),
        (np.full(60, b0), arm[::-1]),
    ]
    strokes = np.concatenate([np.transpose([b, a, np.zeros(60)]) for b, a in sides])
    edge = carried("arm", hardpoint("bucket_pin"), strokes)
    axes.fill(*edge.T, color="#e8f1f7", zorder=0)
    axes.plot(*edge.T, color="#b8d4e6", linewidth=1.0, zorder=0)


def draw_angles(axes: Axes) -> None:
    """Draw the angle of each body over the stroke of its cylinder."""
    names = list(excavator.RELATIVE_COORDINATES)
    for i, (name, ends) in enumerate(STROKES.items()):
        state = np.zeros((200, 6))
        state[:, i] = np.linspace(*ends, 200)
        angle = excavator.relative_coordinates(state)[:, names.index(f"{name}_angle")]
        axes.plot(1e3 * state[:, i], np.degrees(angle), color=COLOURS[name], label=name)
    axes.set(xlabel="stroke from the start [mm]", ylabel="angle from the start [°]")
    axes.legend(frameon=False)


def draw() -> Figure:
    """Return the picture."""
    figure = Figure(figsize=(9.4, 4.8), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.0))
    draw_reach(left)
    for strokes, alpha in zip(POSITIONS, (1.0, 0.3, 0.3), strict=True):
        draw_machine(left, np.array(strokes), alpha)
    left.fill([-2.2, 0.9, 0.9, 0.45, -0.2, -2.2], [1.1, 1.1, 1.5, 2.1, 2.3, 2.3], color="#d9d9d9")
    left.axhline(0.0, color=GREY, linewidth=1.0)
    left.set(aspect="equal", xlabel="x [m]", ylabel="z [m]")
    draw_angles(right)
    return figure


def main() -> None:
    """Write the picture beside this script."""
    with rc_context(STYLE):
        draw().savefig(Path(__file__).with_suffix(".png"), dpi=120)


if __name__ == "__main__":
    main()
