"""The generated functions and the native solver run clean under address and UB sanitizers."""

import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from cars.instants import MODELS, car_parameters
from kintrafo import Model, state_at_height
from kintrafo.simulation.dead_points import meanings
from kintrafo.simulation.solvers import native_available, native_version
from mechanisms.iterated_loops import FIVE_BAR
from support.c_text import sources
from support.folders import ROOT
from support.kept import UNOPTIMISED
from support.models import own

# without optimisation, which takes most of the time and hides code that it removes; of the
# debug information lines are enough
FLAGS = ["-std=gnu11", *UNOPTIMISED, "-g1", "-fno-math-errno", "-fsanitize=address,undefined"]
FLAGS += ["-fno-sanitize-recover=all", "-Wall", "-Wextra", "-Werror"]
SUNDIALS = ["cvode", "arkode", "nvecserial", "sunmatrixdense", "sunlinsoldense"]

needs_gcc = pytest.mark.skipif(shutil.which("gcc") is None, reason="no gcc")

SANITIZED = ROOT / "tests/sanitized"
"""Programs in C."""


def values_of(model, parameters):
    """Return parameters in the order of a compiled model."""
    return [parameters[name] for name in model.PARAMETERS]


def given(**values):
    """Return options of a compiler that define macros, GIVEN_NAME with the values of NAME."""
    lists = {name: np.atleast_1d(numbers).tolist() for name, numbers in values.items()}
    return [f"-DGIVEN_{name}={','.join(map(repr, numbers))}" for name, numbers in lists.items()]


def with_sundials():
    """Return a compiler and flags for the SUNDIALS with which the project was built."""
    since_7 = int(native_version().split(".")[0]) >= 7
    libraries = [*SUNDIALS, "core" if since_7 else "generic"]
    built = ROOT / "build/sundials"
    root = os.environ.get("SUNDIALS_ROOT") or (built if built.is_dir() else None)
    where = [f"-I{root}/include", f"-L{root}/lib", f"-Wl,-rpath,{root}/lib"] if root else []
    # Debian's and Homebrew's 7.x have MPI in their core
    compiler = "mpicc" if since_7 and shutil.which("mpicc") else "gcc"
    return compiler, [*where, *(f"-lsundials_{name}" for name in libraries)]


def run_clean(folder, program, files, flags=(), compiler="gcc"):
    folders = ("generated/c", "runtime/simulation/native", "runtime/simulation/lanes")
    include = [f"-I{ROOT / path}" for path in folders]
    command = [compiler, *FLAGS, *include, program, *files, "-o", folder / "program", *flags]
    built = subprocess.run([*map(str, command), "-lm"], capture_output=True, text=True, check=False)
    if "cannot find" in built.stderr and "asan" in built.stderr:
        pytest.skip("the compiler's sanitizer library is not installed")
    assert built.returncode == 0, built.stderr
    result = subprocess.run([folder / "program"], capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr


@needs_gcc
@pytest.mark.slow
def test_generated_functions(tmp_path):
    """Of the model with all laws of force; what writes the others is the same."""
    model = MODELS["macpherson_general"]
    sizes = {n: f for n, f in model.equations.functions.items() if n in model.ADDRESSES}
    calls = " ".join(f"CALL({n}, {len(function.labels)})" for n, function in sizes.items())
    flags = [
        *given(PARAMETERS=values_of(model, car_parameters(1, model))),
        f"-DGIVEN_CALLS={calls}",
    ]
    run_clean(tmp_path, SANITIZED / "functions.c", sources("macpherson_general"), flags)


def of_the_reference_car(model):
    """Return options of a compiler that define its parameters, start and guards."""
    guards = meanings(model.equations)
    return given(
        PARAMETERS=values_of(MODELS["macpherson"], car_parameters(0)),
        STATE=state_at_height(model, 0.325, spin_rate=93.0),
        GUARDS=guards,
        GUARD_COUNT=len(guards),
        MARGINS=model.usual_margins,
    )


@needs_gcc
@pytest.mark.slow
@pytest.mark.skipif(not native_available(), reason="built without SUNDIALS")
def test_native_solver(tmp_path):
    files = [*sources("macpherson"), *sorted((ROOT / "runtime/simulation/native").glob("*.c"))]
    compiler, flags = with_sundials()
    flags += of_the_reference_car(Model("reference_car"))
    run_clean(tmp_path, SANITIZED / "native_solver.c", files, flags, compiler)


@needs_gcc
@pytest.mark.slow
def test_solver_in_lanes(tmp_path):
    flags = of_the_reference_car(Model("reference_car"))
    # in two lanes, which every processor has; the functions get names that the header has not
    names = ("prepare", "design_state", "rhs", "rhs_rack_held", "signals", "margins")
    flags += ["-std=gnu11", "-DWIDTH=2", '-DMODEL="macpherson.c"']
    flags += [f"-Dmacpherson_{name}=in_lanes_{name}" for name in names]
    folder = ROOT / "runtime/simulation/lanes"
    files = [folder / name for name in ("model.c", "integrate.c", "width.c")]
    run_clean(tmp_path, SANITIZED / "lanes.c", files, flags)


@needs_gcc
@pytest.mark.slow
def test_iteration_in_lanes(tmp_path):
    """In a small loop: longer ones call the same solver of a block."""
    module = own(FIVE_BAR, derivatives=False)
    flags = given(PARAMETERS=[p.default for p in FIVE_BAR.mechanism.parameters])
    flags += [
        "-std=gnu11",
        "-DWIDTH=2",
        '-DMODEL="five_bar.c"',
        f"-I{Path(module.__file__).parent}",
    ]
    flags += [f"-Dfive_bar_{name}=in_lanes_{name}" for name in ("prepare", "design_state", "rhs")]
    source = ROOT / "runtime/simulation/lanes/model.c"
    run_clean(tmp_path, SANITIZED / "iteration.c", [source], flags)


@needs_gcc
@pytest.mark.slow
def test_directions_in_lanes(tmp_path):
    source = ROOT / "runtime/simulation/lanes/directions.c"
    run_clean(tmp_path, SANITIZED / "directions.c", [source], ["-std=gnu11", "-DWIDTH=2"])


@needs_gcc
def test_sanitizer_sees_an_element_too_far(tmp_path):
    body = "double *a = malloc(8); a[1] = 1; free(a); return 0;"
    program = tmp_path / "too_far.c"
    program.write_text(f"#include <stdlib.h>\nint main(void) {{ {body} }}", encoding="utf-8")
    with pytest.raises(AssertionError, match=r"heap-buffer-overflow|insufficient space"):
        run_clean(tmp_path, program, [])
