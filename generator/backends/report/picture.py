"""Draw the joint graph of a mechanism, in the style of the paper's Figure 2."""

from __future__ import annotations

from typing import TYPE_CHECKING

import matplotlib as mpl

mpl.use("Agg")
import networkx as nx
from matplotlib.figure import Figure

from ....core.files import replacing

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from matplotlib.axes import Axes

    from ...loops.planner import Plan

LOOP_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7")
BODY_STYLE = {"boxstyle": "round,pad=0.45", "facecolor": "#d9d9d9", "edgecolor": "#333333"}
JOINT_STYLE = {"boxstyle": "circle,pad=0.25", "facecolor": "white", "edgecolor": "#333333"}


def draw(plan: Plan, path: Path, *, force: bool = False) -> None:
    """Write a picture of bodies (grey), joints (white) and the loops of the basis (coloured).

    The ending of the path gives the format; `force` is whether a file that kintrafo did not write
    is replaced, see `kintrafo.core.files`.
    """
    mechanism, topology = plan.formulation.mechanism, plan.topology
    positions = nx.kamada_kawai_layout(topology.graph, weight=None)
    figure = Figure(figsize=(9.0, 6.2), layout="constrained")
    axes = figure.add_subplot()
    axes.set_axis_off()
    for joint in mechanism.joints:
        (x0, y0), (x1, y1) = (positions[b] for b in joint.bodies)
        axes.plot([x0, x1], [y0, y1], color="#999999", linewidth=1.2, zorder=1)
        middle = ((x0 + x1) / 2, (y0 + y1) / 2)
        axes.annotate(
            f"{joint.name}\n{joint.kind}, {joint.freedoms}",
            middle,
            ha="center",
            va="center",
            fontsize=8,
            bbox=JOINT_STYLE | {"boxstyle": "round4,pad=0.3"},
            zorder=3,
        )
    for index in range(len(plan.transformers)):
        _draw_loop(axes, positions, plan, index)
    for body, number in mechanism.numbers.items():
        axes.annotate(
            f"{number} {body.replace('_', ' ')}",
            positions[body],
            ha="center",
            va="center",
            fontsize=10,
            bbox=BODY_STYLE,
            zorder=4,
        )
    axes.set_title(
        f"{mechanism.title}: joint graph\nmobility {topology.mobility}, "
        f"{topology.loop_count} independent loops; on each joint its number of degrees of freedom",
        fontsize=11,
    )
    axes.margins(0.12)
    axes.legend(loc="lower left", frameon=False, fontsize=9)
    with replacing(path, force=force) as temporary:
        figure.savefig(temporary, dpi=160)


def _draw_loop(
    axes: Axes, positions: Mapping[str, tuple[float, float]], plan: Plan, index: int
) -> None:
    """Draw one loop of the basis inside its bodies, shrunk so that loops do not overlap."""
    cycle = plan.transformers[index].cycle
    corners = [positions[b] for b in (*cycle.bodies, cycle.bodies[0])]
    count = len(cycle.bodies)
    center = [sum(c[i] for c in corners[:-1]) / count for i in (0, 1)]
    shrink = 0.9
    xs = [center[0] + shrink * (c[0] - center[0]) for c in corners]
    ys = [center[1] + shrink * (c[1] - center[1]) for c in corners]
    numbers = ", ".join(str(plan.formulation.mechanism.numbers[body]) for body in cycle.bodies)
    axes.plot(
        xs,
        ys,
        color=LOOP_COLOURS[index % len(LOOP_COLOURS)],
        linewidth=2.2,
        alpha=0.75,
        label=f"transformer {index + 1}: bodies {numbers} (length {cycle.length})",
        zorder=2,
    )
