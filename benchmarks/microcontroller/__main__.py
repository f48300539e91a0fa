"""Instructions, stack and memory on a microcontroller: ``make benchmark-microcontroller``."""

import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import kintrafo
import typer
from kintrafo.generated import four_bar
from rich.console import Console
from rich.markdown import Markdown

from ..report import fill_page, markdown_table
from .build import COMPILER, EMULATOR, FUNCTIONS, PACKAGES, UNITS, Program, missing

_HEADER = (
    "equations", "function", "operations", "instructions", "without the unit", "stack [bytes]",
)  # fmt: skip


def systems() -> dict[str, kintrafo.System]:
    """Return the systems that are measured, by name."""
    return {
        "four_bar": kintrafo.System(four_bar),
        "reference_car": kintrafo.Model("reference_car"),
        "reference_axle": kintrafo.model_of(kintrafo.load("reference_axle")),
    }


def run(
    page: Annotated[Path | None, typer.Option(help="Page of docs/ with the table.")] = None,
) -> None:
    """Measure exported C on a Cortex-M7."""
    if missing():
        print(f"{' and '.join(missing())} not installed: apt-get install {PACKAGES}")
        raise typer.Exit(1)
    rows, sizes = [], []
    for name, system in systems().items():
        with TemporaryDirectory() as folder:
            program = Program(system, Path(folder) / "m7")
            bits = program.here()
            hard, soft = (program.on_board(unit) for unit in UNITS)
        assert hard.bits == soft.bits == bits, name
        sizes.append(f"{name} {hard.code / 1e3:.0f} kB")
        for function in FUNCTIONS:
            operations = getattr(system.equations, function).operations["total"]
            counted = (hard.instructions[function], soft.instructions[function])
            numbers = (operations, *counted, hard.stack[function])
            rows.append((name, f"`{function}`", *map(str, numbers)))
    versions = [
        subprocess.run([tool, "--version"], check=True, capture_output=True, text=True).stdout
        for tool in (COMPILER, EMULATOR)
    ]
    lines = [
        markdown_table(_HEADER, rows),
        f"Code of these functions, and constants: {', '.join(sizes)}.",
        f"By {'; '.join(text.splitlines()[0] for text in versions)}.",
    ]
    blocks = {"microcontroller": "\n\n".join(lines)}
    Console().print(Markdown(blocks["microcontroller"]))
    if page is not None:
        fill_page(page, blocks)


if __name__ == "__main__":
    typer.run(run)
