"""What an export takes: files, seconds, and communication steps above their arithmetic.

``make benchmark-export`` measures the units of the reference car, called from C.
"""

import os
import re
import subprocess
import time
import zipfile
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import typer
from kintrafo import CompilerError, Model, equilibrium, export_model
from kintrafo.core.folders import VARIABLE
from kintrafo.systems.compile.compiler import FLAGS, find_compiler
from rich.console import Console
from rich.markdown import Markdown

from .report import environment, fill_page, machine_line, markdown_table

CAR = "reference_car"
DRIVER = Path(__file__).with_name("export_steps.c")
VERSIONS = {2: "guid", 3: "instantiationToken"}


def written(folder: Path) -> dict[int, tuple[float, float, int]]:
    """Write the units; return seconds with and without a compiler, and bytes."""
    model = Model(CAR)
    found = {}
    for version in VERSIONS:
        seconds = []
        for _ in range(2):
            begin = time.perf_counter()
            path = folder / f"fmi{version}.fmu"
            export_model(model, path, "fmu", fmi=version, state=equilibrium(model))
            seconds.append(time.perf_counter() - begin)
        with zipfile.ZipFile(path) as archive:
            archive.extractall(folder / f"fmi{version}")
        found[version] = (seconds[0], seconds[1], path.stat().st_size)
    return found


def with_windows(folder: Path) -> str:
    """Return how large a unit with both libraries is, where there is a compiler for Windows."""
    path = folder / "both.fmu"
    try:
        export_model(Model(CAR), path, "fmu", platforms=["linux", "windows"])
    except CompilerError as error:
        return f"No library for Windows: {error}"
    return f"With libraries for Linux and Windows a unit has {path.stat().st_size / 1e3:.0f} kB."


def steps(folder: Path, rounds: int) -> list[float]:
    """Return what the program in C measures [us, us, us, MB]."""
    compiler = find_compiler()
    assert compiler is not None
    model = Model(CAR)
    name = model.equations.NAME
    code = export_model(model, folder / "c", "c", state=equilibrium(model))
    sources = [f"{name}.c", f"{name}_derivatives.c", f"{name}_values.c"]
    macros = {
        "EQUATIONS": name,
        "STATES": str(len(model.state_names)),
        "ROUNDS": str(rounds),
        "METHOD": f'"{folder}/fmi2/sources/dormand_prince.h"',
        "VALUES": f'"{code / name}_values.h"',
        **{f"FMI{v}": f'"{folder}/fmi{v}/sources/fmi{v}Functions.h"' for v in VERSIONS},
    }
    program = folder / "steps"
    defined = [f"-D{macro}={value}" for macro, value in macros.items()]
    files = [str(DRIVER), *(str(code / source) for source in sources)]
    command = [compiler.command[0], *FLAGS, "-std=c11", *defined, *files, "-o", str(program)]
    subprocess.run([*command, "-lm", "-ldl"], check=True)
    given = []
    for version, key in VERSIONS.items():
        text = (folder / f"fmi{version}/modelDescription.xml").read_text(encoding="utf-8")
        library = next((folder / f"fmi{version}").glob("binaries/*linux*/*.so"))
        given += [str(library), re.findall(f'{key}="(.*?)"', text)[0]]
    said = subprocess.run([program, *given], check=True, capture_output=True, text=True).stdout
    return [float(number) for number in said.split()]


def run(
    page: Annotated[Path | None, typer.Option(help="Page of docs/ with the table.")] = None,
    *,
    quick: Annotated[bool, typer.Option("--quick", help="One round.")] = False,
) -> None:
    """Measure exports."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        if not quick:
            os.environ[VARIABLE] = str(folder / "cache")  # nothing is compiled yet
        files = written(folder)
        both = with_windows(folder)
        bare, *taken, memory = steps(folder, 1 if quick else 30)
    rows = [
        (
            f"{version}.0", f"{size / 1e3:.0f}", f"{first:.1f}", f"{again:.2f}",
            f"{bare:.2f}", f"{one:.2f}", f"{one - bare:.2f}",
        )
        for (version, (first, again, size)), one in zip(files.items(), taken, strict=True)
    ]  # fmt: skip
    header = (
        "FMI", "kB", "written, compiling [s]", "written again [s]",
        "arithmetic of a step [µs]", "`DoStep` [µs]", "above it [µs]",
    )  # fmt: skip
    blocks = {
        "export": markdown_table(header, rows),
        "windows": both,
        "instances": f"1,000 instances take {memory:.1f} MB.",
        "machine": machine_line(environment()).replace("Processor time on", "Measured on"),
    }
    Console().print(Markdown("\n\n".join(blocks.values())))
    if page is not None:
        fill_page(page, blocks)


if __name__ == "__main__":
    typer.run(run)
