"""Size and time of exports, and the time of communication steps beyond their arithmetic.

``make benchmark-export`` measures the FMUs of the reference car, called from C and by FMPy, and
its right-hand side in JAX.
"""

import os
import re
import subprocess
import sys
import time
import zipfile
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from itertools import islice
from multiprocessing import get_context
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import jax
import typer
from fmpy import read_model_description
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave
from kintrafo import CompilerError, Model, equilibrium, export_model
from kintrafo.core.folders import VARIABLE
from kintrafo.systems.compile.compiler import find_compiler
from rich.console import Console
from rich.markdown import Markdown

from .jax_states import nanoseconds
from .report import children_seconds, environment, fill_page, machine_line, markdown_table

CAR = "reference_car"
DRIVER = Path(__file__).with_name("export_steps.c")
VERSIONS = {2: "guid", 3: "instantiationToken"}
# length of a communication step, one step of the solver, as in export_steps.c [s]; steps by FMPy
LENGTH, STEPS = 1e-5, 2000


def written(folder: Path) -> dict[int, tuple[float, float, int]]:
    """Write the FMUs; return seconds of the command and of `export_model`, and bytes."""
    model = Model(CAR)
    found = {}
    for version in VERSIONS:
        path = folder / f"fmi{version}.fmu"
        command = [sys.executable, "-m", "kintrafo", "export", CAR, "--to", "fmu", "-o", str(path)]
        begin = children_seconds()
        subprocess.run([*command, "--fmi", str(version)], check=True, stdout=subprocess.DEVNULL)
        alone = children_seconds() - begin
        start = equilibrium(model)
        before = time.process_time()
        export_model(model, path, "fmu", fmi=version, state=start)
        found[version] = (alone, time.process_time() - before, path.stat().st_size)
        with zipfile.ZipFile(path) as archive:
            archive.extractall(folder / f"fmi{version}")
    return found


def with_windows(folder: Path) -> str:
    """Return size and time of an FMU with both libraries, if there is a compiler for Windows."""
    path, begin = folder / "both.fmu", children_seconds()
    try:
        export_model(Model(CAR), path, "fmu", platforms=["linux", "windows"])
    except CompilerError as error:
        return f"No library for Windows: {error}"
    size, taken = path.stat().st_size / 1e3, children_seconds() - begin
    return (
        f"With libraries for Linux and Windows an FMU has {size:.0f} kB. In a checkout, the "
        f"compiler takes {taken:.1f} s for that of Windows, once."
    )


def steps(folder: Path, rounds: int) -> list[float]:
    """Return the measurements of the program in C [us, us, us, MB]."""
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
    command = [*compiler.command, "-std=c11", *defined, *files, "-o", str(program)]
    subprocess.run([*command, "-lm", "-ldl"], check=True)
    given = []
    for version, key in VERSIONS.items():
        text = (folder / f"fmi{version}/modelDescription.xml").read_text(encoding="utf-8")
        library = next((folder / f"fmi{version}").glob("binaries/*linux*/*.so"))
        given += [str(library), re.findall(f'{key}="(.*?)"', text)[0]]
    output = subprocess.run([program, *given], check=True, capture_output=True, text=True).stdout
    return [float(number) for number in output.split()]


def by_fmpy(folder: Path, rounds: int) -> list[float]:
    """Return the processor time of a step called by FMPy, in each version of FMI [us]."""
    found = []
    for version, kind in ((2, FMU2Slave), (3, FMU3Slave)):
        place = str(folder / f"fmi{version}")
        known = read_model_description(place)
        name = known.coSimulation.modelIdentifier
        fmu = kind(guid=known.guid, unzipDirectory=place, modelIdentifier=name)
        fmu.instantiate()
        if version == 2:
            fmu.setupExperiment()
        fmu.enterInitializationMode()
        fmu.exitInitializationMode()
        times = iter(LENGTH * k for k in range(STEPS * rounds))
        found.append(1e6 * min(_seconds(fmu.doStep, times) for _ in range(rounds)))
        fmu.freeInstance()
    return found


def _seconds(step: Callable[..., object], times: Iterator[float]) -> float:
    begin = time.process_time()
    for now in islice(times, STEPS):
        step(currentCommunicationPoint=now, communicationStepSize=LENGTH)
    return (time.process_time() - begin) / STEPS


def in_jax(folder: Path, rounds: int) -> str:
    """Return the time of a right-hand side by jax.ffi, state by state and in lanes."""
    compiler = find_compiler()
    assert compiler is not None
    code = folder / "c"
    name = Model(CAR).equations.NAME
    ends = ("", "_derivatives", "_values", "_ffi", "_lanes")
    files = [str(code / f"{name}{end}.c") for end in ends]
    found = []
    for flags in ([], [f"-D{name.upper()}_LANES", "-march=native"]):
        library = folder / f"jax_{len(flags)}.so"
        headers = ["-isystem", jax.ffi.include_dir()]
        options = (*flags, "-shared", *headers, *files, "-o", str(library), "-lm")
        subprocess.run([*compiler.command, *options], check=True)
        # functions are registered once in a process
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
            found.append(
                pool.submit(nanoseconds, code / f"{name}_ffi.py", library, rounds).result()
            )
    one, lanes = found
    return (
        f"A right-hand side by `jax.ffi` takes {one:.0f} ns state by state, and {lanes:.0f} ns in "
        "lanes."
    )


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
        both = "" if quick else with_windows(folder)
        rounds = 1 if quick else 500
        bare, *taken, memory = steps(folder, rounds)
        called = by_fmpy(folder, rounds // 10 + 1)
        lanes = in_jax(folder, rounds // 10 + 1)
    rows = [
        (
            f"{version}.0", f"{size / 1e3:.0f}", f"{alone:.1f}", f"{within:.2f}",
            f"{bare:.2f}", f"{one:.2f}", f"{one - bare:.2f}", f"{python:.1f}",
        )
        for (version, (alone, within, size)), one, python in zip(
            files.items(), taken, called, strict=True
        )
    ]  # fmt: skip
    header = (
        "FMI", "kB", "`kintrafo export` [s]", "`export_model` [s]",
        "arithmetic of a step [µs]", "`DoStep` [µs]", "difference [µs]", "by FMPy [µs]",
    )  # fmt: skip
    blocks = {
        "export": markdown_table(header, rows),
        "windows": both,
        "instances": f"1,000 instances take {memory:.1f} MB.",
        "lanes": lanes,
        "machine": machine_line(environment()),
    }
    Console().print(Markdown("\n\n".join(blocks.values())))
    if page is not None:
        fill_page(page, blocks)


if __name__ == "__main__":
    typer.run(run)
