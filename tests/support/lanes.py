"""Vectors for tests, and the driver that calls functions in lanes."""

import ctypes
import subprocess
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from kintrafo.simulation.lanes.options import OF_WIDTH

from support.folders import ROOT

HEADERS = ROOT / "runtime/simulation/lanes"
EMITTED = ROOT / "generated/c"
# as setup.py has them, but for speed
FLAGS = ["-O1", "-fno-math-errno", "-ffp-contract=off", "-fPIC"]


def vectors(rows):
    """Return numbers at an address that is one of vectors; the last dimension is that of lanes."""
    memory = np.zeros(rows.size + 8)
    start = (-memory.ctypes.data % 64) // 8
    aligned = memory[start : start + rows.size].reshape(rows.shape)
    aligned[:] = rows
    return aligned


def compiled(folder, source, *flags, name):
    """Compile C into a library, and load it."""
    library = folder / f"{name}.so"
    folders = [f"-I{HEADERS}", f"-I{EMITTED}"]
    command = ["gcc", *FLAGS, *folders, "-shared", str(source), *flags, "-o", str(library)]
    subprocess.run([*command, "-lm"], check=True)
    return ctypes.CDLL(str(library))


def driver(folder, width):
    """Return the driver for a width."""
    source = Path(__file__).parent / "lanes_driver.c"
    flags = [f"-DWIDTH={width}", *OF_WIDTH[width]]
    library = compiled(folder, source, *flags, name=f"driver_{width}")
    for function in ("sin", "cos", "asin", "atan2", "exp", "log", "log2", "exp2"):
        called = getattr(library, f"lane_{function}")
        called.restype = ctypes.c_double
        called.argtypes = [ctypes.c_double] * (2 if function == "atan2" else 1)
    return library


def address(library, function):
    """Return the address of a function."""
    found = ctypes.cast(getattr(library, function), ctypes.c_void_p).value
    assert found is not None
    return found


@cache
def in_lanes(model):
    """Return a model's library in lanes."""
    spec = find_spec(f"kintrafo.generated._{model}_lanes")
    assert spec is not None
    assert spec.origin is not None
    return ctypes.CDLL(spec.origin)


def call(library, function, *arguments, size):
    """Call a function in lanes; returns its results and the status words."""
    width = arguments[0].shape[1]
    out, status = vectors(np.zeros((size, width))), vectors(np.zeros((1, width)))
    caller = library.call_two if len(arguments) == 1 else library.call_three
    given = [vectors(array) for array in arguments]
    caller(function, *(ctypes.c_void_p(a.ctypes.data) for a in (*given, out, status)))
    return out, status.view(np.int64)[0]
