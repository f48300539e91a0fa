"""What a front axle made of two suspensions costs, and what its anti-roll bar does.

``python -m benchmarks.front_axle`` counts the operations of the axle, of the axle without its bar,
and of one suspension; computes the wheel rates in parallel and in opposite travel; drives the left
wheel over a bump with and without the bar; and fills the page in docs/.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from kintrafo import Simulation, System, simulate
from kintrafo.generated import front_axle as equations
from kintrafo.generator import Formulation
from kintrafo.generator.backends.counting import operations_of
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.mechanisms import front_axle, macpherson
from kintrafo.pictures.figures import BLUE, ORANGE, STYLE
from matplotlib import rc_context
from matplotlib.figure import Figure
from rich.console import Console
from rich.markdown import Markdown
from scipy.optimize import brentq

from .report import count, fill_page, markdown_table

Array = np.ndarray[Any, np.dtype[np.float64]]

COUNTED = {
    "rhs": "right-hand side",
    "rhs_rack_held": "right-hand side, rack held",
    "rhs_jacobian_rack_held": "its Jacobian, rack held",
    "dynamics": "mass matrix, bias and forces",
    "prepare": "constants, once for a parameter set",
}
"""Functions of the table, with what they are."""

SIDES = ("right", "left")
BUMP, LENGTH, SPEED = 0.04, 1.5, 10.0  # height and length of the bump [m], speed of the car [m/s]
DURATION = 0.6  # [s]
WITHOUT, WITH = {"bar_rate": 0.0}, {}


# -- operations -----------------------------------------------------------------------------------


def operations(model: Formulation) -> dict[str, int]:
    """Return the number of operations of the functions of the table."""
    derived = generate(model)
    functions = derived.emitted | {"prepare": derived.prepare}
    return {name: operations_of(functions[name]).total() for name in COUNTED}


def counts() -> str:
    """Return the table of operations."""
    one = operations(macpherson.MODELS[0])
    bare = operations(front_axle.model(front_axle.without_bar()))
    axle = operations(front_axle.MODELS[0])
    header = ("", "one suspension", "twice that", "axle without bar", "axle")
    rows = [
        (what, *(count(number) for number in (one[n], 2 * one[n], bare[n], axle[n])))
        for n, what in COUNTED.items()
    ]
    return markdown_table(header, rows)


# -- wheel rates ----------------------------------------------------------------------------------


def angle_at(axle: System, side: str, travel: float) -> float:
    """Return the arm angle at which a wheel is some travel above its design height [rad]."""
    name = f"{side}_beta1"

    def height(angle: float) -> float:
        state = axle.state(**{name: angle})
        return float(axle.signal(f"{side}_front_wheel_center_z", state))

    design = float(axle.design_state[axle.state_names.index(name)])
    target = height(design) + travel
    return float(brentq(lambda angle: height(angle) - target, design - 0.3, design + 0.3))


def holding_force(axle: System, travel: dict[str, float]) -> float:
    """Return the force up on the right wheel that holds it at some travels, without tyres [N].

    By virtual work: what springs, bar and weight do on the arm's angle, over the wheel's rise for
    it.
    """
    angles = {f"{side}_beta1": angle_at(axle, side, travel[side]) for side in SIDES}
    state = axle.state(**angles)
    moving = axle.state(**angles, right_beta1_rate=1.0)
    rise = float(axle.signal("right_front_wheel_velocity", moving))
    return -float(axle.evaluate("forces", state)[0]) / rise


def wheel_rate(changes: dict[str, float], sense: float) -> float:
    """Return the rate of the right wheel at design [N/m], the left one moving in some sense."""
    axle = System(equations, {"tyre_rate": 0.0} | changes)
    step = 1e-4
    up, down = (holding_force(axle, {"right": s, "left": sense * s}) for s in (step, -step))
    return (up - down) / (2.0 * step)


def rates() -> str:
    """Return the table of wheel rates."""
    rows = [
        (what, *(f"{1e-3 * wheel_rate(changes, sense):.1f}" for changes in (WITHOUT, WITH)))
        for what, sense in (("both wheels rise", 1.0), ("one rises, one falls", -1.0))
    ]
    return markdown_table(("wheel rate [N/mm]", "without bar", "with bar"), rows)


# -- a bump under the left wheel ------------------------------------------------------------------


@dataclass(frozen=True)
class Bump:
    """A smooth bump of the road: a raised cosine."""

    start: float = 0.05  # [s]

    def __call__(self, time: float) -> float:
        """Return the height of the road [m]."""
        passed = (time - self.start) * SPEED / LENGTH
        return 0.5 * BUMP * (1.0 - np.cos(2.0 * np.pi * passed)) if 0.0 < passed < 1.0 else 0.0


def drive(changes: dict[str, float]) -> Simulation:
    """Return the motion over the bump."""
    axle = System(equations, changes)
    times = np.linspace(0.0, DURATION, 601)
    road = times, np.array([Bump()(t) for t in times])
    return simulate(
        axle,
        (0.0, DURATION),
        axle.design_state,
        inputs={"left_road_height": road},
        t_eval=times,
        rtol=1e-8,
        max_step=0.01,  # from rest at rest, no step shall pass over the bump
    )


def figure() -> Figure:
    """Return the heights of both wheels over time, with and without the bar."""
    drawn = Figure(figsize=(8.0, 4.6), layout="constrained")
    motions = {"without bar": drive(WITHOUT), "with bar": drive(WITH)}
    panels = drawn.subplots(2, 1, sharex=True, height_ratios=[3, 2])
    for axes, side in zip(panels, reversed(SIDES), strict=True):
        for (label, motion), colour in zip(motions.items(), (ORANGE, BLUE), strict=True):
            height = motion.signals[f"{side}_front_wheel_center_z"]
            line = "--" if label.startswith("without") else "-"
            axes.plot(motion.t, 1e3 * (height - height[0]), line, color=colour, label=label)
        axes.set(title=f"{side} wheel", ylabel="travel [mm]")
    times = next(iter(motions.values())).t
    road = [1e3 * Bump()(t) for t in times]
    panels[0].plot(times, road, color="#999999", linewidth=1.0, label="road under the left wheel")
    panels[0].legend(frameon=False)
    panels[1].set(xlabel="time [s]", xlim=(0.0, DURATION))
    return drawn


# -- results --------------------------------------------------------------------------------------


def run(
    page: Annotated[Path, typer.Option(help="The page that tables and picture go into.")] = Path(
        "docs/mechanisms/composition.md"
    ),
) -> None:
    """Count operations, compute wheel rates, drive over a bump, and fill the page."""
    console = Console()
    blocks = {"operations": counts(), "rates": rates()}
    for block in blocks.values():
        console.print(Markdown(block))
    with rc_context(STYLE):
        figure().savefig(
            page.parents[1] / "images" / "front_axle.png", dpi=130, metadata={"Software": None}
        )
    fill_page(page, blocks)
    console.print(f"written to {page}")


if __name__ == "__main__":
    typer.run(run)
