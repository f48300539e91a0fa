"""Steps of one length: errors of a second of motion, and what a step takes.

``make benchmark-real-time`` measures the reference car by RK4 in `simulate`, which looks whether
each step is stable, one at a time by `Stepper`, and in a loop over the equations in Python.
"""

from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from kintrafo import Model, SimulationError, Stepper, equilibrium, simulate, state_at_height
from rich.console import Console
from rich.markdown import Markdown

from .report import count, environment, fill_page, machine_line, markdown_table, seconds_of

SPAN = (0.0, 1.0)
TIMES = np.linspace(*SPAN, 101)
STEPS = (50e-3, 20e-3, 10e-3, 5e-3, 2e-3, 1e-3, 0.5e-3)  # [s]
REPEATS = 5


def measured(steps: tuple[float, ...]) -> tuple[list[tuple[str, ...]], dict[float, float]]:
    """Return the row of each stable step, and the longest stable step for each of the others."""
    model = Model("reference_car")
    start = state_at_height(model, 0.325, spin_rate=93.0)
    truth = simulate(model, SPAN, start, method="DOP853", t_eval=TIMES, rtol=1e-13, atol=1e-15).y[0]
    inputs = np.zeros(len(model.input_names))
    in_python = min(
        seconds_of(lambda: [model.evaluate("rhs", start, inputs) for _ in range(400)])
        for _ in range(REPEATS)
    )
    rows, unstable = [], {}
    for step in steps:
        stepper = Stepper(model, step, equilibrium(model))
        shown = f"{step * 1e3:g}"
        try:
            found = simulate(model, SPAN, start, method="RK4", step=step, t_eval=TIMES)
        except SimulationError as error:
            longest = error.reason.partition("needs steps of ")[2].partition(" s")[0]
            unstable[step] = float(longest)
            continue
        stepped = min(
            seconds_of(lambda stepper=stepper: [stepper.step() for _ in range(1000)])
            for _ in range(REPEATS)
        )
        taken = min(
            seconds_of(
                lambda step=step: simulate(
                    model, (0.0, 20.0), start, method="RK4", step=step, t_eval=[20.0]
                )
            )
            for _ in range(REPEATS)
        )
        rows.append((
            shown, count(found.steps), count(found.nfev),
            f"{np.abs(found.y[0] - truth).max():.1e}", f"{taken / (20.0 / step) * 1e6:.2g}",
            f"{stepped / 1000.0 * 1e6:.2g}", f"{in_python / 100.0 * 1e6:.2g}",
        ))  # fmt: skip
    return rows, unstable


def run(
    page: Annotated[Path | None, typer.Option(help="Page of docs/ with the table.")] = None,
    *,
    quick: Annotated[bool, typer.Option("--quick", help="One length.")] = False,
) -> None:
    """Measure steps of one length."""
    header = (
        "step [ms]", "steps", "evaluations", "error [rad]", "a step in `simulate` [µs]",
        "one of `Stepper` [µs]", "four evaluations in Python [µs]",
    )  # fmt: skip
    rows, unstable = measured(STEPS[:2] if quick else STEPS)
    table = markdown_table(header, rows)
    sentences = [
        f"A step of {step * 1e3:g} ms is an error, since it is not stable: the longest stable step "
        f"at the time of the error is {longest * 1e3:g} ms."
        for step, longest in unstable.items()
    ]
    blocks = {
        "steps": "\n\n".join((table, *sentences)),
        "machine": machine_line(environment()).replace("Processor time on", "Measured on"),
    }
    Console().print(Markdown("\n\n".join(blocks.values())))
    if page is not None:
        fill_page(page, blocks)


if __name__ == "__main__":
    typer.run(run)
