"""Least time of the arithmetic of a function in lanes, without waiting for operands.

The instructions that the compiler made of it are counted. As many products, sums, quotients and
roots, none of which waits for one just before it, are then timed on the same processor.
"""

import ctypes
import re
import shutil
import subprocess
from dataclasses import astuple, dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from kintrafo.simulation import lanes
from kintrafo.simulation.lanes.options import OF_WIDTH
from kintrafo.systems.compile.compiler import find_compiler

from .report import seconds_of

ROUNDS = 30
CHAINS = 8  # of each kind: more than any processor computes at once of what waits for itself
# As the compiler names them for vectors of doubles, on x86-64 and on aarch64.
MNEMONICS = {
    "products": r"v?mulpd|fmul",
    "sums": r"v?(add|sub)pd|fadd|fsub",
    "quotients": r"v?divpd|fdiv",
    "roots": r"v?sqrtpd|fsqrt",
}
FORMS = ("p{} *= one;", "s{} += one;", "q{} = one / q{};", "r{} = root(r{});")


@dataclass(frozen=True)
class Operations:
    """How many vectors are computed by each kind of operation."""

    products: int
    sums: int
    quotients: int
    roots: int


def operations(library: Path, function: str) -> Operations | None:
    """Count the operations of a compiled function without loops; None where nothing shows them."""
    if shutil.which("objdump") is None:
        return None
    command = ["objdump", f"--disassemble={function}", "--no-show-raw-insn", str(library)]
    text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    names = re.findall(r"^\s+[0-9a-f]+:\s+(\S+)", text, re.MULTILINE)
    counts = {
        kind: sum(bool(re.fullmatch(pattern, name)) for name in names)
        for kind, pattern in MNEMONICS.items()
    }
    return Operations(**counts)


def least_seconds(counted: Operations, width: int, times: int) -> float:
    """Return how long so many operations on vectors of a width take, side by side [s]."""
    compiler = find_compiler()
    assert compiler is not None  # lanes were built
    headers = Path(lanes.__file__).parent
    options = (*compiler.command, *OF_WIDTH[width], f"-DWIDTH={width}", f"-I{headers}")
    with TemporaryDirectory() as folder:
        source, built = Path(folder) / "alone.c", Path(folder) / "alone.so"
        source.write_text(_source(counted), encoding="utf-8")
        replace(compiler, command=options).build([source], built)
        alone = ctypes.CDLL(str(built)).alone
        ones = np.ones((1 + len(FORMS) * CHAINS) * width)
        given = ctypes.c_void_p(ones.ctypes.data), ctypes.c_long(times)
        return min(seconds_of(lambda: alone(*given)) for _ in range(ROUNDS)) / times


def _source(counted: Operations) -> str:
    """Return C that computes so much again and again, the kinds spread evenly."""
    lines = []
    for count, form in zip(astuple(counted), FORMS, strict=True):
        lines += [((i + 0.5) / count, form.replace("{}", str(i % CHAINS))) for i in range(count)]
    names = ["one", *(f"{kind}{chain}" for kind in "psqr" for chain in range(CHAINS))]
    # each read by itself: the same twice would be computed once
    read = [f"memcpy(&{name}, given + {i} * WIDTH, sizeof one);" for i, name in enumerate(names)]
    return f"""\
#include <string.h>
#include "vectors.h"

double alone(const double *given, long times)
{{
    real {", ".join(names)};
    {" ".join(read)}
    for (long i = 0; i < times; ++i) {{
        {" ".join(line for _, line in sorted(lines))}
    }}
    one = {" + ".join(names)};
    return one[0];
}}
"""
