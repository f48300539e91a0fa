"""Results with the same bits on other processors: ``python -m benchmarks.same_bits``.

The emitted arithmetic is compiled without contraction, and its sines, cosines and inverses are made
of it. So its results should have the same bits with every compiler and on every machine. This
program compiles every shipped model in several ways (those that are installed: on Debian, ``apt-get
install clang gcc-aarch64-linux-gnu qemu-user``), evaluates it at random states, and counts the
results that are not those of the first way.
"""

import os
import shutil
import subprocess
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from types import ModuleType
from typing import Annotated, Any

import numpy as np
import typer
from kintrafo import generated
from kintrafo.systems.compile.compiler import FLAGS
from rich.console import Console
from rich.markdown import Markdown

from . import older_processor
from .report import count, fill_page, markdown_table

STATES = 2000
SPREAD = 0.01  # of the states about design, in their SI units
FUNCTIONS = ("rhs", "rhs_jacobian", "signals", "margins", "poses")
SOURCES = Path(generated.__file__).parent / "c"

Array = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True)
class Way:
    """How a program is compiled and run."""

    name: str
    compiler: tuple[str, ...]  # with what differs of its options
    # command that runs the program, such as an emulator; empty for none
    runner: tuple[str, ...] = ()
    older: bool = False  # whether it sees a processor of 2008

    @property
    def there(self) -> bool:
        """Whether it is installed."""
        return all(shutil.which(c[0]) for c in (self.compiler, self.runner) if c)

    def evaluated(self, name: str, folder: Path) -> Array:
        """Return the results of a model, a row for each state."""
        program = folder / f"{name}-{WAYS.index(self)}"
        parts = SOURCES / f"{name}.c", SOURCES / f"{name}_derivatives.c"
        sources = [str(folder / f"{name}_main.c"), *map(str, parts)]
        compiler, *options = self.compiler
        command = [compiler, *FLAGS, *options, f"-I{SOURCES}", *sources, "-lm", "-o", str(program)]
        subprocess.run(command, check=True)
        more = older_processor.environment() if self.older else {}
        done = subprocess.run(
            [*self.runner, str(program)], env=os.environ | more, capture_output=True, check=True
        )
        # minus zero is zero
        return np.frombuffer(done.stdout, dtype="<f8").reshape(STATES, -1) + 0.0


WAYS = (
    Way("GCC", ("gcc",)),
    Way("GCC, a processor without AVX", ("gcc",), older=True),
    Way("GCC without optimisation", ("gcc", "-O0")),
    Way("Clang", ("clang",)),
    Way("GCC for aarch64, in QEMU", ("aarch64-linux-gnu-gcc", "-static"), ("qemu-aarch64",)),
)


def sizes(model: ModuleType) -> dict[str, int]:
    """Return how many numbers each function of a model gives."""
    return {f: len(getattr(model, f).labels) for f in FUNCTIONS if f in model.ADDRESSES}


def program(name: str, model: ModuleType) -> str:
    """Return C that evaluates a model at many states, and writes all results."""
    of_results = sizes(model)
    size = {"p": len(model.PARAMETERS), "c": len(model.CONSTANTS), "s": len(model.STATE)}
    values = ", ".join(repr(entry["default"]) for entry in model.PARAMETERS.values())
    calls = "\n        ".join(
        f"{name}_{function}(c, x, in, out);\n        fwrite(out, 8, {length}, stdout);"
        for function, length in of_results.items()
    )
    return f"""\
#include <stdint.h>
#include <stdio.h>
#include "{name}.h"

static double p[] = {{{values}}};
static double c[{size["c"]}], s[{size["s"]}], x[{size["s"]}];
static double in[{max(1, len(model.INPUTS))}], out[{max(of_results.values())}];

int main(void)
{{
    uint32_t random = 1;
    {name}_prepare(p, c);
    {name}_design_state(p, s);
    for (int k = 0; k < {STATES}; ++k) {{
        for (int i = 0; i < {size["s"]}; ++i) {{
            random = random * 1664525u + 1013904223u;
            x[i] = s[i] + {SPREAD} * (random / 2147483648.0 - 1.0);
        }}
        {calls}
    }}
    return 0;
}}
"""


def differing(name: str, ways: list[Way], folder: Path) -> list[int]:
    """Return how many results there are of a model, and how many have other bits in each way."""
    model = import_module(f"{generated.__name__}.{name}")
    (folder / f"{name}_main.c").write_text(program(name, model), encoding="utf-8")
    with ThreadPoolExecutor() as pool:
        first, *others = pool.map(lambda way: way.evaluated(name, folder), ways)
    ends = np.cumsum([*sizes(model).values()])

    def apart(found: Array) -> Iterator[int]:
        other = first.view(np.int64) != found.view(np.int64)
        for part in np.split(other, ends[:-1], axis=1):
            yield int(part.any(axis=1).sum())

    return [STATES * len(ends), *(sum(apart(found)) for found in others)]


def main(
    *, page: Annotated[Path | None, typer.Option(help="Put the table into this page.")] = None
) -> None:
    """Evaluate every model in all ways, and compare the bits."""
    ways = [way for way in WAYS if way.there]
    names = sorted(path.stem for path in SOURCES.parent.glob("*.json"))
    with TemporaryDirectory() as folder:
        rows = [[f"`{name}`", *map(count, differing(name, ways, Path(folder)))] for name in names]
    table = markdown_table(["model", "results", *(way.name for way in ways[1:])], rows)
    Console().print(Markdown(table))
    if page:
        fill_page(page, {"bits": table})


if __name__ == "__main__":
    typer.run(main)
