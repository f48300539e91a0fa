"""Which results are the same bits on another processor: ``python -m benchmarks.same_bits``.

The emitted arithmetic is compiled without contraction, so that sums, products, quotients and roots
are the same bits wherever it runs. Sine, cosine and their inverses come from the C library, which
chooses among its versions by what the processor has, and these round a value now and then
differently. This program evaluates every shipped model at random states twice, the second time as a
processor without AVX and fused operations would, and counts what differs.
"""

import json
import os
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from kintrafo import System, generated
from rich.console import Console
from rich.markdown import Markdown

from . import older_processor
from .report import count, fill_page, markdown_table

STATES = 2000
SPREAD = 0.01  # of the states about design, in their SI units
FUNCTIONS = ("rhs", "rhs_jacobian", "mass_matrix", "signals", "positions")


def models() -> list[str]:
    """Return the names of the shipped models."""
    folder = Path(generated.__file__).parent
    return sorted(path.stem for path in (folder / "c").glob("*.h"))


def results(name: str) -> dict[str, list[str]]:
    """Return the functions of a model at random states, one text of bits for each state."""
    system = System(import_module(f"{generated.__name__}.{name}"))
    shape = STATES, len(system.state_names)
    states = system.design_state + SPREAD * np.random.default_rng(0).standard_normal(shape)
    found = {
        function: system.evaluate(function, states).reshape(STATES, -1)
        for function in FUNCTIONS
        if hasattr(system.equations, function)
    }
    # minus zero is zero
    return {name: [(row + 0.0).tobytes().hex() for row in rows] for name, rows in found.items()}


def differing(name: str) -> tuple[int, int]:
    """Return how many results of a model differ on the older processor, and of how many."""
    here, there = _evaluated(name, {}), _evaluated(name, older_processor.environment())
    same = [a == b for f in here for a, b in zip(here[f], there[f], strict=True)]
    return same.count(False), len(same)


def _evaluated(name: str, environment: dict[str, str]) -> dict[str, list[str]]:
    command = [sys.executable, "-m", "benchmarks.same_bits", "--only", name]
    done = subprocess.run(
        command, env=os.environ | environment, capture_output=True, text=True, check=True
    )
    found: dict[str, list[str]] = json.loads(done.stdout)
    return found


def main(
    *,
    page: Annotated[Path | None, typer.Option(help="Put the table into this page.")] = None,
    only: Annotated[str | None, typer.Option(hidden=True)] = None,
) -> None:
    """Evaluate every model on this processor and as an older one would, and compare the bits."""
    if only:
        typer.echo(json.dumps(results(only)))
        return
    rows = []
    for name in models():
        different, total = differing(name)
        rows.append([f"`{name}`", count(total), count(different)])
    table = markdown_table(["model", "results", "of these other bits"], rows)
    Console().print(Markdown(table))
    if page:
        fill_page(page, {"bits": table})


if __name__ == "__main__":
    typer.run(main)
