"""The generated functions and the native solver run clean under address and UB sanitizers."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from c_text import sources
from cases import MODELS, car_parameters
from kintrafo import Model, state_at_height
from kintrafo.simulation.dead_points import meanings
from kintrafo.simulation.solvers import native_available, native_version

ROOT = Path(__file__).parent.parent
# without optimisation, which takes most of the time and hides what it removes; of what a debugger
# is told, lines are enough
FLAGS = ["-std=gnu99", "-O0", "-g1", "-fno-math-errno", "-fsanitize=address,undefined"]
FLAGS += ["-fno-sanitize-recover=all", "-Wall", "-Wextra", "-Werror"]
SUNDIALS = ["cvode", "arkode", "nvecserial", "sunmatrixdense", "sunlinsoldense"]

needs_gcc = pytest.mark.skipif(shutil.which("gcc") is None, reason="no gcc")

EVERY_FUNCTION = """
#include "{name}.h"
#include <stdlib.h>

int main(void)
{{
    /* exactly as large as they must be, so that one element too far is seen */
    double *parameters = malloc({parameter_count} * sizeof(double));
    double *constants = malloc({constant_count} * sizeof(double));
    double *state = malloc({state_count} * sizeof(double));
    double *inputs = malloc({input_count} * sizeof(double));
    int status = 0;
    {parameters}
    if ({name}_prepare(parameters, constants)) return 1;
    for (int trial = 0; trial < 200; ++trial) {{
        for (int i = 0; i < {state_count}; ++i) state[i] = i == 0 ? 1.2 + 0.005 * trial : 0.1 * i;
        for (int i = 0; i < {input_count}; ++i) inputs[i] = 0.001 * trial;
        {calls}
    }}
    free(parameters); free(constants); free(state); free(inputs);
    return status == -1;
}}
"""
CALL = (
    "{{ double *out = malloc({size} * sizeof(double)); "
    "status |= {name}_{function}(constants, state, inputs, out); free(out); }}"
)

INTEGRATION = """
#include "integrate.h"
#include "macpherson.h"
#include <stdio.h>
#include <stdlib.h>

static int root(double time, const double *state, double *out, void *data)
{{
    (void)time, (void)data;
    out[0] = state[0] - 1.6;
    return 0;
}}

int main(void)
{{
    double parameters[MACPHERSON_PARAMETER_COUNT] = {{0}}, constants[MACPHERSON_CONSTANT_COUNT];
    {parameters}
    if (macpherson_prepare(parameters, constants)) return 1;
    double inputs[MACPHERSON_INPUT_COUNT] = {{0}}, atol[4] = {{1e-9, 1e-9, 1e-9, 1e-9}};
    double breaks[3] = {{0.0, 0.5, 1.0}};
    double coefficients[8] = {{0.01, 0.0, 0.0, 0.01, 0.0, 0.01, 0.0, 0.0}};
    kt_spline spline = {{2, breaks, coefficients,
                        {{MACPHERSON_INPUT_RACK_POSITION, MACPHERSON_INPUT_RACK_VELOCITY,
                          MACPHERSON_INPUT_RACK_ACCELERATION}}}};
    kt_event event = {{MACPHERSON_SIGNAL_TYRE_FORCE, 0.0}};
    int directions[2] = {{0, 0}}, terminal[2] = {{0, 0}}, guards[] = {{{guards}}};
    double usual_margins[] = {{{usual_margins}}};
    kt_problem problem = {{
        .rhs = macpherson_rhs, .jacobian = macpherson_rhs_jacobian, .signals = macpherson_signals,
        .margins = macpherson_margins, .guard_count = {guard_count}, .guards = guards,
        .usual_margins = usual_margins,
        .state_count = 4, .input_count = MACPHERSON_INPUT_COUNT,
        .signal_count = MACPHERSON_SIGNAL_COUNT, .constants = constants, .inputs = inputs,
        .spline_count = 1, .splines = &spline, .event_count = 1, .events = &event, .root_count = 1,
        .roots = root, .directions = directions, .terminal = terminal}};
    double state[4] = {{{state}}}, times[101];
    for (int i = 0; i < 101; ++i) times[i] = 0.01 * i;
    for (int method = KT_BDF; method <= KT_RUNGE_KUTTA; ++method) {{
        for (int every_step = 0; every_step < 2; ++every_step) {{
            for (long max_steps = 5; max_steps < 1000000; max_steps *= 1000) {{
                kt_options options = {{.method = method, .table = "ARKODE_VERNER_8_5_6",
                                      .rtol = 1e-6, .atol = atol, .max_steps = max_steps,
                                      .stop_at_outputs = !every_step, .dense = 1}};
                kt_result result;
                int outcome = kt_integrate(&problem, &options, state, times, 101, every_step,
                                           &result);
                if (outcome != KT_DONE && outcome != KT_TOO_MANY_STEPS) return 2 + outcome;
                kt_free(&result);
            }}
        }}
    }}
    inputs[MACPHERSON_INPUT_STRUT_FORCE] = -1e6; /* a loop that will not close */
    kt_options options = {{.method = KT_BDF, .rtol = 1e-6, .atol = atol, .max_steps = 100000}};
    kt_result result;
    int outcome = kt_integrate(&problem, &options, state, times, 101, 1, &result);
    kt_free(&result);
    return outcome == KT_STATE ? 0 : 1;
}}
"""


def assignments(model, parameters):
    values = enumerate(parameters[name] for name in model.PARAMETERS)
    return " ".join(f"parameters[{i}] = {value!r};" for i, value in values)


def listed(values):
    return ", ".join(repr(value) for value in values.tolist())


def with_sundials():
    """Return a compiler and flags for the SUNDIALS with which the project was built."""
    since_7 = int(native_version().split(".")[0]) >= 7
    libraries = [*SUNDIALS, "core" if since_7 else "generic"]
    root = os.environ.get("SUNDIALS_ROOT")
    where = [f"-I{root}/include", f"-L{root}/lib", f"-Wl,-rpath,{root}/lib"] if root else []
    # Debian's and Homebrew's 7.x have MPI in their core
    compiler = "mpicc" if since_7 and shutil.which("mpicc") else "gcc"
    return compiler, [*where, *(f"-lsundials_{name}" for name in libraries)]


def run_clean(folder, text, files, flags=(), compiler="gcc"):
    program = folder / "program.c"
    program.write_text(text, encoding="utf-8")
    include = [f"-I{ROOT / 'generated/c'}", f"-I{ROOT / 'runtime/simulation/native'}"]
    command = [compiler, *FLAGS, *include, program, *files, "-o", folder / "program", *flags]
    built = subprocess.run([*map(str, command), "-lm"], capture_output=True, text=True, check=False)
    if "cannot find" in built.stderr and "asan" in built.stderr:
        pytest.skip("the compiler's sanitizer library is not installed")
    assert built.returncode == 0, built.stderr
    result = subprocess.run([folder / "program"], capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr


@needs_gcc
@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(MODELS))
def test_generated_functions(tmp_path, name):
    model = MODELS[name]
    sizes = {n: f for n, f in model.equations.functions.items() if n in model.ADDRESSES}
    calls = [
        CALL.format(name=name, function=n, size=len(function.labels))
        for n, function in sizes.items()
    ]
    text = EVERY_FUNCTION.format(
        name=name,
        parameter_count=len(model.PARAMETERS),
        constant_count=len(model.CONSTANTS),
        state_count=len(model.STATE),
        input_count=len(model.INPUTS),
        parameters=assignments(model, car_parameters(1, model)),
        calls="\n        ".join(calls),
    )
    run_clean(tmp_path, text, sources(name))


@needs_gcc
@pytest.mark.slow
@pytest.mark.skipif(not native_available(), reason="built without SUNDIALS")
def test_native_solver(tmp_path):
    model = Model("reference_car")
    start = state_at_height(model, 0.325, spin_rate=93.0)
    guards = meanings(model.equations)
    text = INTEGRATION.format(
        parameters=assignments(MODELS["macpherson"], car_parameters(0)),
        state=listed(start),
        guard_count=len(guards),
        guards=listed(guards),
        usual_margins=listed(model.usual_margins),
    )
    files = [*sources("macpherson"), *sorted((ROOT / "runtime/simulation/native").glob("*.c"))]
    compiler, flags = with_sundials()
    run_clean(tmp_path, text, files, flags, compiler)


@needs_gcc
def test_sanitizer_sees_an_element_too_far(tmp_path):
    body = "double *a = malloc(8); a[1] = 1; free(a); return 0;"
    text = f"#include <stdlib.h>\nint main(void) {{ {body} }}"
    with pytest.raises(AssertionError, match=r"heap-buffer-overflow|insufficient space"):
        run_clean(tmp_path, text, [])
